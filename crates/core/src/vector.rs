//! Vector helpers whose bits do not depend on the target.
//!
//! glam's SSE2 and scalar builds round `normalize`, `min` and `max` differently; these do not.

use glam::Vec3A;

/// Component-wise `if a < b { a } else { b }`: a NaN in `a` yields `b`.
#[inline]
pub fn min(a: Vec3A, b: Vec3A) -> Vec3A {
    Vec3A::select(a.cmplt(b), a, b)
}

/// Component-wise `if a > b { a } else { b }`: a NaN in `a` yields `b`.
#[inline]
pub fn max(a: Vec3A, b: Vec3A) -> Vec3A {
    Vec3A::select(a.cmpgt(b), a, b)
}

/// The largest component.
#[inline]
pub fn max_element(v: Vec3A) -> f32 {
    let m = if v.x > v.y { v.x } else { v.y };
    if m > v.z { m } else { v.z }
}

/// The index of the largest component (the lowest index on ties).
#[inline]
pub fn max_axis(v: Vec3A) -> usize {
    if v.x >= v.y && v.x >= v.z {
        0
    } else if v.y >= v.z {
        1
    } else {
        2
    }
}

/// The power of two that brings `x` (finite, positive) near 1: multiplying by it is exact.
#[inline]
fn exponent_scale(x: f32) -> f32 {
    // A denormal has exponent field 0; 2^126 lifts it into range, which is all that is needed here.
    let e = ((x.to_bits() >> 23) & 0xff) as i32;
    f32::from_bits(((254 - e.clamp(1, 253)) as u32) << 23)
}

/// `v / |v|`, or `None` where `v` is zero or not finite. Scaling `v` by a power of two does not change the result
/// as long as it stays normal: lengths whose square would leave the range are first scaled by an exact exponent.
#[inline]
pub fn try_normalize(v: Vec3A) -> Option<Vec3A> {
    let l2 = v.dot(v);
    // Between these bounds neither the square nor the relative accuracy of the sum is in danger.
    if l2 > 1e-30 && l2 < 1e30 {
        return Some(v / l2.sqrt());
    }
    let m = max_element(v.abs());
    if !(m > 0.0 && m.is_finite() && v.is_finite()) {
        return None;
    }
    let mut w = v * exponent_scale(m);
    let l2 = w.dot(w);
    if l2 < 0.25 {
        // v was denormal: one more exact step.
        w *= exponent_scale(max_element(w.abs()));
    }
    Some(w / w.dot(w).sqrt())
}

/// `v / |v|`. The caller knows that `v` is neither zero nor infinite; a zero vector comes back as zero.
#[inline]
pub fn normalize(v: Vec3A) -> Vec3A {
    try_normalize(v).unwrap_or(Vec3A::ZERO)
}

/// `|v|` without intermediate overflow or underflow.
#[inline]
pub fn length(v: Vec3A) -> f32 {
    let l2 = v.dot(v);
    if l2 > 1e-30 && l2 < 1e30 {
        return l2.sqrt();
    }
    let m = max_element(v.abs());
    if !(m > 0.0 && m.is_finite()) {
        return m;
    }
    let s = exponent_scale(m);
    let w = v * s;
    w.dot(w).sqrt() / s
}

/// `a b - c d` evaluated in double precision: the difference of two f32 products, rounded once.
#[inline]
pub fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    (f64::from(a) * f64::from(b) - f64::from(c) * f64::from(d)) as f32
}

/// The cross product with each component rounded once or twice at most (products of f32 are exact in f64), so that
/// slivers keep an accurate normal.
#[inline]
pub fn cross(a: Vec3A, b: Vec3A) -> Vec3A {
    Vec3A::new(
        difference_of_products(a.y, b.z, a.z, b.y),
        difference_of_products(a.z, b.x, a.x, b.z),
        difference_of_products(a.x, b.y, a.y, b.x),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalize_is_scale_invariant_and_total() {
        let v = Vec3A::new(0.3, -1.7, 2.9);
        let n = normalize(v);
        for k in [-100, -60, -20, -1, 1, 20, 60, 100] {
            let s = f32::from_bits(((127 + k) as u32) << 23);
            assert_eq!(normalize(v * s), n, "2^{k}");
        }
        assert!(try_normalize(Vec3A::ZERO).is_none());
        assert!(try_normalize(Vec3A::splat(f32::NAN)).is_none());
        assert!(try_normalize(Vec3A::new(f32::INFINITY, 0.0, 0.0)).is_none());
        let tiny = try_normalize(Vec3A::new(1e-44, 0.0, 0.0)).unwrap();
        assert!((length(tiny) - 1.0).abs() < 1e-6);
        let huge = try_normalize(Vec3A::splat(3e38)).unwrap();
        assert!((length(huge) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn length_does_not_overflow() {
        assert!((length(Vec3A::new(3e30, 4e30, 0.0)) / 5e30 - 1.0).abs() < 1e-6);
        assert!((length(Vec3A::new(3e-30, 4e-30, 0.0)) / 5e-30 - 1.0).abs() < 1e-6);
        assert_eq!(length(Vec3A::ZERO), 0.0);
    }
}
