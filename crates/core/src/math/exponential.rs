use std::f64::consts::{LN_2, LOG2_E};

use super::kernel::{poly, power_of_two, round, split_exponent};

/// (2^f − 1) / f on |f| ≤ 1/2; error 2⁻³².
const EXP2: [f64; 7] = [
    LN_2,
    0.240_226_509_222_887_57,
    0.055_504_108_839_096_185,
    0.009_618_056_678_524_637,
    0.001_333_350_238_616_277,
    0.000_154_614_446_985_691_3,
    1.529_732_376_070_107_5e-5,
];
/// (atanh s / s − 1) / s² on |s| ≤ (√2 − 1)/(√2 + 1); error 2⁻⁴⁵, so that `pow` can multiply it by 128.
const ATANH: [f64; 6] = [
    0.333_333_333_333_310_4,
    0.200_000_000_056_032_52,
    0.142_857_120_691_620_8,
    0.111_114_311_400_543_58,
    0.090_700_969_014_329_96,
    0.083_109_085_764_294_64,
];

/// 2^t as `(1 + tail) · scale`, `t` clamped to ±200: past that single precision has overflowed or vanished.
#[inline(always)]
pub(super) fn exp2_parts(t: f64) -> (f64, f64) {
    let t = t.clamp(-200.0, 200.0);
    let (k, k_bits) = round(t);
    let f = t - k;
    (f * poly(f, &EXP2), power_of_two(k_bits))
}

/// 2^t in double precision, rounded nowhere but in the last step.
#[inline(always)]
pub(super) fn exp2_wide(t: f64) -> f32 {
    let (tail, scale) = exp2_parts(t);
    // Scaling is exact; the conversion rounds once, into subnormals and to infinity too.
    ((1.0 + tail) * scale) as f32
}

/// ln of `m = (1 + s)/(1 - s)` from `s`.
#[inline(always)]
fn ln_from_ratio(s: f64) -> f64 {
    let z = s * s;
    2.0 * (s + s * z * poly(z, &ATANH))
}

/// log₂ of a positive, finite, single-precision number, to 2⁻⁴⁵.
#[inline(always)]
pub(super) fn log2_wide(x: f32) -> f64 {
    let (m, e) = split_exponent(f64::from(x));
    e + ln_from_ratio((m - 1.0) / (m + 1.0)) * LOG2_E
}

/// Logarithms of what is not positive and finite.
#[cold]
fn logarithm_of_special(x: f32) -> f32 {
    if x == 0.0 {
        f32::NEG_INFINITY
    } else if x > 0.0 {
        x
    } else {
        f32::NAN
    }
}

/// e^x. Overflows to ∞ above 88.73, passes through subnormals to 0 below −103.97.
#[inline]
pub fn exp(x: f32) -> f32 {
    exp2_wide(f64::from(x) * LOG2_E)
}

/// 2^x; exact for integral `x`.
#[inline]
pub fn exp2(x: f32) -> f32 {
    exp2_wide(f64::from(x))
}

/// e^x − 1, accurate for small `x` too: `-exp_m1(-t)` is what a medium of optical thickness `t` takes away.
#[inline]
pub fn exp_m1(x: f32) -> f32 {
    // Within |x| < 2⁻²⁶ the value is x itself to 2⁻²⁷; it also keeps −0 and subnormals.
    if x.abs() < 1.490_116_1e-8 {
        return x;
    }
    let (tail, scale) = exp2_parts(f64::from(x) * LOG2_E);
    (tail * scale + (scale - 1.0)) as f32
}

/// Natural logarithm; −∞ at 0, NaN below.
#[inline]
pub fn ln(x: f32) -> f32 {
    if !(x > 0.0 && x < f32::INFINITY) {
        return logarithm_of_special(x);
    }
    let (m, e) = split_exponent(f64::from(x));
    (e * LN_2 + ln_from_ratio((m - 1.0) / (m + 1.0))) as f32
}

/// Logarithm to base 2; exact for powers of two; −∞ at 0, NaN below.
#[inline]
pub fn log2(x: f32) -> f32 {
    if !(x > 0.0 && x < f32::INFINITY) {
        return logarithm_of_special(x);
    }
    log2_wide(x) as f32
}

/// ln(1 + x), accurate for small `x` too; −∞ at −1, NaN below.
#[inline]
pub fn ln_1p(x: f32) -> f32 {
    if !(x > -1.0 && x < f32::INFINITY) {
        return if x == -1.0 { f32::NEG_INFINITY } else { logarithm_of_special(x) };
    }
    let x = f64::from(x);
    let (m, e) = split_exponent(1.0 + x);
    // Where no exponent was taken out, m − 1 is x itself, without the rounding of 1 + x.
    let s = if e == 0.0 { x / (2.0 + x) } else { (m - 1.0) / (m + 1.0) };
    let l = (e * LN_2 + ln_from_ratio(s)) as f32;
    if x == 0.0 { x as f32 } else { l }
}
