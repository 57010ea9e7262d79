//! Discrete choices that give the random number back: what is left of `u` after the choice is stretched to [0, 1)
//! and serves again. Stratification passes through, and no dimension is spent on the choice.
//!
//! Each use costs the number about −log₂(probability) of its 24 bits; a choice among thousands should take the 32 bits
//! of [`AliasTable`](crate::AliasTable) or [`Distribution1d`](crate::Distribution1d) instead.

/// The largest f32 below 1.
pub(crate) const ONE_MINUS_ULP: f32 = 1.0 - f32::EPSILON / 2.0;

/// `x` brought into [0, 1) against rounding; NaN becomes 0.
#[inline(always)]
pub(crate) fn clamp_unit(x: f32) -> f32 {
    if x >= 1.0 {
        ONE_MINUS_ULP
    } else if x >= 0.0 {
        x
    } else {
        0.0
    }
}

/// Outcome of [`coin`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coin {
    /// Whether the event of probability `p` happened.
    pub heads: bool,
    /// Fresh number in [0, 1).
    pub u: f32,
}

/// An event of probability `p`. Never happens for `p ≤ 0`, always for `p ≥ 1`.
#[inline]
pub fn coin(u: f32, p: f32) -> Coin {
    if u < p {
        Coin { heads: true, u: clamp_unit(u / if p < 1.0 { p } else { 1.0 }) }
    } else {
        let p = if p > 0.0 { p } else { 0.0 };
        Coin { heads: false, u: clamp_unit((u - p) / (1.0 - p)) }
    }
}

/// Outcome of [`choose`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Which weight was hit.
    pub index: usize,
    /// Its probability.
    pub pmf: f32,
    /// Fresh number in [0, 1).
    pub u: f32,
}

/// One of a few `weights` with probability proportional to it. Weights that are not positive are never chosen;
/// `None` where none is positive or one is infinite.
#[inline]
pub fn choose(u: f32, weights: &[f32]) -> Option<Choice> {
    let positive = |w: f32| if w > 0.0 { f64::from(w) } else { 0.0 };
    let total: f64 = weights.iter().map(|&w| positive(w)).sum();
    if !(total > 0.0 && total < f64::INFINITY) {
        return None;
    }
    let target = f64::from(u) * total;
    let (mut below, mut hit) = (0.0, None);
    for (index, &w) in weights.iter().enumerate() {
        let w = positive(w);
        if w > 0.0 {
            // The last positive weight is kept if rounding leaves the target above the sum.
            hit = Some((index, below, w));
            if target < below + w {
                break;
            }
        }
        below += w;
    }
    hit.map(|(index, below, w)| Choice {
        index,
        pmf: (w / total) as f32,
        u: clamp_unit(((target - below) / w) as f32),
    })
}
