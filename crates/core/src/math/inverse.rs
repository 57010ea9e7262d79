use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use super::kernel::poly;

/// (asin s / s − 1) / s² on |s| ≤ 1/2, in powers of s²; error 2⁻³².
const ASIN: [f64; 7] = [
    0.166_666_666_860_856_43,
    0.074_999_924_044_018_38,
    0.044_647_663_888_134_85,
    0.030_269_138_728_589_183,
    0.023_611_817_008_891_752,
    0.010_574_415_516_912_909,
    0.030_974_540_371_355_073,
];
/// (atan t / t − 1) / t² on |t| ≤ tan(π/8); error 2⁻³⁰.
const ATAN: [f64; 6] = [
    -0.333_333_332_792_548,
    0.199_999_772_586_883_86,
    -0.142_841_511_936_286_14,
    0.110_713_650_218_847_94,
    -0.086_246_761_452_494_94,
    0.050_481_385_120_797_445,
];
const TAN_PI_8: f64 = 0.414_213_562_373_095_03;

/// asin of `a` in [0, 1/2], and of `sqrt((1 - a)/2)` for `a` above: the half-angle form keeps the accuracy at 1.
#[inline(always)]
fn asin_kernel(a: f64) -> (f64, bool) {
    let upper = a > 0.5;
    let z = if upper { (1.0 - a) * 0.5 } else { a * a };
    let s = if upper { z.sqrt() } else { a };
    (s + s * z * poly(z, &ASIN), upper)
}

/// Angle in [-π/2, π/2] whose sine is `x`; NaN outside [-1, 1] (clamp first where rounding may leave it).
#[inline]
pub fn asin(x: f32) -> f32 {
    let (p, upper) = asin_kernel(f64::from(x.abs()));
    let a = if upper { FRAC_PI_2 - 2.0 * p } else { p };
    (a as f32).copysign(x)
}

/// Angle in [0, π] whose cosine is `x`; NaN outside [-1, 1] (clamp first where rounding may leave it).
#[inline]
pub fn acos(x: f32) -> f32 {
    let (p, upper) = asin_kernel(f64::from(x.abs()));
    let negative = x < 0.0;
    let a = match (upper, negative) {
        (true, false) => 2.0 * p,
        (true, true) => PI - 2.0 * p,
        (false, false) => FRAC_PI_2 - p,
        (false, true) => FRAC_PI_2 + p,
    };
    a as f32
}

/// Angle in [-π/2, π/2] whose tangent is `x`.
#[inline]
pub fn atan(x: f32) -> f32 {
    atan2(x, 1.0)
}

/// The angle of the point (x, y), in [-π, π], counter-clockwise from the x axis. `atan2(±0, +0)` is ±0 and
/// `atan2(±0, -0)` is ±π, as in IEEE 754.
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    if x.is_nan() || y.is_nan() {
        return f32::NAN;
    }
    // A stand-in for infinity that keeps ∞/∞ at 1 and finite/∞ at (what rounds to) 0.
    let bounded = |v: f32| {
        let v = f64::from(v.abs());
        if v < 1e300 { v } else { 1e300 }
    };
    let (ax, ay) = (bounded(x), bounded(y));
    let steep = ay > ax;
    let (n, d) = if steep { (ax, ay) } else { (ay, ax) };
    // Above tan(π/8), atan(n/d) = π/4 + atan((n - d)/(n + d)): one division either way.
    let upper = n > TAN_PI_8 * d;
    let (num, den, base) = if upper { (n - d, n + d, FRAC_PI_4) } else { (n, d, 0.0) };
    let t = if den > 0.0 { num / den } else { 0.0 };
    let z = t * t;
    let a = base + (t + t * z * poly(z, &ATAN));
    let a = if steep { FRAC_PI_2 - a } else { a };
    let a = if x.is_sign_negative() { PI - a } else { a };
    (a as f32).copysign(y)
}
