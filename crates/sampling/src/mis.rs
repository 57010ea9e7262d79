//! Weights of multiple importance sampling (Veach & Guibas 1995), safe at every extreme of the densities.
//!
//! A density that is not positive (zero, negative, NaN) gets weight 0; an infinite one (a delta direction) takes all
//! from a finite one, and two infinite ones share evenly. Otherwise the two weights of a pair add up to 1 within
//! 2 ulp. The ratio is taken small over large, so densities above 1.8 · 10¹⁹ do not overflow when squared.
//!
//! ```
//! use etendue_sampling::mis;
//! assert_eq!(mis::power(3.0, 1.0), 0.9);
//! assert_eq!(mis::power(1e38, 1e38), 0.5);
//! assert_eq!(mis::balance(0.0, 0.0), 0.0);
//! ```

/// small/large of two densities and whether `pa` is the large one; `None` where `pa` deserves no weight.
#[inline(always)]
fn ratio(pa: f64, pb: f64) -> Option<(f64, bool)> {
    if pa <= 0.0 || pa.is_nan() {
        return None;
    }
    let pb = if pb > 0.0 { pb } else { 0.0 };
    if pa >= pb {
        // inf/inf counts as equal.
        Some((if pb == pa { 1.0 } else { pb / pa }, true))
    } else {
        Some((pa / pb, false))
    }
}

#[inline(always)]
fn weight(r: f64, large: bool) -> f32 {
    (if large { 1.0 / (1.0 + r) } else { r / (1.0 + r) }) as f32
}

/// Balance heuristic: pa / (pa + pb).
#[inline]
pub fn balance(pa: f32, pb: f32) -> f32 {
    ratio(pa.into(), pb.into()).map_or(0.0, |(r, large)| weight(r, large))
}

/// Power heuristic with β = 2: pa² / (pa² + pb²).
#[inline]
pub fn power(pa: f32, pb: f32) -> f32 {
    ratio(pa.into(), pb.into()).map_or(0.0, |(r, large)| weight(r * r, large))
}

/// Balance heuristic with sample counts: na pa / (na pa + nb pb).
#[inline]
pub fn balance_n(na: u32, pa: f32, nb: u32, pb: f32) -> f32 {
    let (a, b) = (scaled(na, pa), scaled(nb, pb));
    ratio(a, b).map_or(0.0, |(r, large)| weight(r, large))
}

/// Power heuristic (β = 2) with sample counts: (na pa)² / ((na pa)² + (nb pb)²).
#[inline]
pub fn power_n(na: u32, pa: f32, nb: u32, pb: f32) -> f32 {
    let (a, b) = (scaled(na, pa), scaled(nb, pb));
    ratio(a, b).map_or(0.0, |(r, large)| weight(r * r, large))
}

/// A technique that is never used has density 0, whatever it would be.
#[inline(always)]
fn scaled(n: u32, p: f32) -> f64 {
    if n == 0 { 0.0 } else { f64::from(n) * f64::from(p) }
}
