//! Double-precision siblings, for set-up work such as solid angles and table building. Same construction, same bits
//! on every target; errors are a few units in the last place of f64 on the stated ranges.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LN_2, LOG2_E, PI, TAU};

use super::kernel::{poly, power_of_two, round, split_exponent};

const PI_2_HI: f64 = 1.570_796_326_734_125_6;
const PI_2_MID: f64 = 6.077_100_506_303_966e-11;
const PI_2_LO: f64 = 2.022_266_248_795_950_6e-21;
/// π/2 minus its double.
const PI_2_TAIL: f64 = 6.123_233_995_736_766e-17;

const SIN: [f64; 7] = [
    -0.166_666_666_666_666_66,
    0.008_333_333_333_333_331,
    -0.000_198_412_698_412_650_65,
    2.755_731_921_933_916_7e-6,
    -2.505_210_623_244_757_8e-8,
    1.605_853_161_898_614_7e-10,
    -7.586_697_117_706_918e-13,
];
const COS: [f64; 7] = [
    -0.5,
    0.041_666_666_666_666_64,
    -0.001_388_888_888_888_077_5,
    2.480_158_729_369_346e-5,
    -2.755_731_556_634_189_5e-7,
    2.087_588_673_804_705_2e-9,
    -1.136_799_865_402_244_9e-11,
];
const ASIN: [f64; 14] = [
    0.166_666_666_666_666_66,
    0.075_000_000_000_001_18,
    0.044_642_857_142_551_895,
    0.030_381_944_475_532_52,
    0.022_372_157_443_507_22,
    0.017_352_816_540_325_496,
    0.013_963_780_012_203_57,
    0.011_566_459_612_121_669,
    0.009_621_842_970_100_282,
    0.009_319_560_794_767_446,
    0.003_044_879_909_455_677_3,
    0.019_554_513_336_123_378,
    -0.019_241_671_746_743_04,
    0.029_612_011_264_955_12,
];
const ATAN: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_2,
    -0.142_857_142_846_665_42,
    0.111_111_110_152_563_61,
    -0.090_909_045_781_239_03,
    0.076_921_831_908_260_87,
    -0.066_645_114_473_819_48,
    0.058_581_489_128_022_1,
    -0.050_854_497_379_402_6,
    0.039_231_658_295_587_19,
    -0.019_176_887_119_062_26,
];
const EXP2: [f64; 11] = [
    LN_2,
    0.240_226_506_959_100_97,
    0.055_504_108_664_821_6,
    0.009_618_129_107_606_888,
    0.001_333_355_814_641_693_6,
    0.000_154_035_304_417_360_5,
    1.525_273_382_983_612e-5,
    1.321_544_258_792_169e-6,
    1.017_806_244_584_577_4e-7,
    7.072_585_949_269_223e-9,
    4.454_960_598_186_516_5e-10,
];
const ATANH: [f64; 8] = [
    0.333_333_333_333_333_3,
    0.200_000_000_000_004_4,
    0.142_857_142_854_018_07,
    0.111_111_111_958_569_58,
    0.090_908_978_200_664_53,
    0.076_931_198_514_073_29,
    0.066_343_865_693_284_43,
    0.065_433_130_739_200_51,
];
const TAN_PI_8: f64 = 0.414_213_562_373_095_03;

/// (sin x, cos x), radians. To 2 ulp (or 2⁻⁵⁴ absolute near a zero) for |x| ≤ 2²⁰; beyond that the argument is
/// first taken modulo the double nearest 2π.
pub fn sin_cos(x: f64) -> (f64, f64) {
    if !x.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    let x = if x.abs() < 1_048_576.0 { x } else { x % TAU };
    let (k, q) = round(x * FRAC_2_PI);
    let r = ((x - k * PI_2_HI) - k * PI_2_MID) - k * PI_2_LO;
    let z = r * r;
    let (s, c) = (r + r * z * poly(z, &SIN), 1.0 + z * poly(z, &COS));
    match q & 3 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

fn asin_kernel(a: f64) -> (f64, bool) {
    let upper = a > 0.5;
    let z = if upper { (1.0 - a) * 0.5 } else { a * a };
    let s = if upper { z.sqrt() } else { a };
    (s + s * z * poly(z, &ASIN), upper)
}

/// Angle in [-π/2, π/2] whose sine is `x`; NaN outside [-1, 1].
pub fn asin(x: f64) -> f64 {
    let (p, upper) = asin_kernel(x.abs());
    let a = if upper { FRAC_PI_2 - (2.0 * p - PI_2_TAIL) } else { p };
    a.copysign(x)
}

/// Angle in [0, π] whose cosine is `x`; NaN outside [-1, 1].
pub fn acos(x: f64) -> f64 {
    let (p, upper) = asin_kernel(x.abs());
    match (upper, x < 0.0) {
        (true, false) => 2.0 * p,
        (true, true) => PI - (2.0 * p - 2.0 * PI_2_TAIL),
        (false, false) => FRAC_PI_2 - (p - PI_2_TAIL),
        (false, true) => FRAC_PI_2 + (p + PI_2_TAIL),
    }
}

/// The angle of the point (x, y), in [-π, π], with the signed zeros of IEEE 754.
pub fn atan2(y: f64, x: f64) -> f64 {
    if x.is_nan() || y.is_nan() {
        return f64::NAN;
    }
    let (mut ax, mut ay) = (x.abs(), y.abs());
    if ax == f64::INFINITY || ay == f64::INFINITY {
        ax = if ax == f64::INFINITY { 1.0 } else { 0.0 };
        ay = if ay == f64::INFINITY { 1.0 } else { 0.0 };
    }
    // Halving the range keeps n + d from overflowing; the quotient does not change.
    if ax > 1e300 || ay > 1e300 {
        (ax, ay) = (ax * 0.5, ay * 0.5);
    }
    let steep = ay > ax;
    let (n, d) = if steep { (ax, ay) } else { (ay, ax) };
    let upper = n > TAN_PI_8 * d;
    let (num, den, base) = if upper { (n - d, n + d, FRAC_PI_4) } else { (n, d, 0.0) };
    let t = if den > 0.0 { num / den } else { 0.0 };
    let z = t * t;
    let tail = if upper { 0.5 * PI_2_TAIL } else { 0.0 };
    let a = base + (t + (t * z * poly(z, &ATAN) + tail));
    let a = if steep { FRAC_PI_2 - (a - PI_2_TAIL) } else { a };
    let a = if x.is_sign_negative() { PI - (a - 2.0 * PI_2_TAIL) } else { a };
    a.copysign(y)
}

/// e^x to 2 ulp for |x| ≤ 1; the relative error grows as |x| · 2⁻⁵³ beyond. Overflows to ∞ above 709, and is 0
/// below −708 (no subnormal results).
pub fn exp(x: f64) -> f64 {
    if x > 709.7 {
        return f64::INFINITY;
    }
    if x < -708.0 {
        return 0.0;
    }
    let (k, k_bits) = round(x * LOG2_E);
    // ln 2 in two parts: the first has 33 bits, so k times it is exact.
    let r = (x - k * 0.693_147_180_485_539_1) - k * 7.440_617_110_012_397e-11;
    let f = r * LOG2_E;
    // 2^1024 is no double: the last binade is reached in two steps.
    (1.0 + f * poly(f, &EXP2)) * power_of_two(k_bits.wrapping_sub(1)) * 2.0
}

/// Natural logarithm to 2 ulp; −∞ at 0, NaN below.
pub fn ln(x: f64) -> f64 {
    if !(x > 0.0 && x < f64::INFINITY) {
        return if x == 0.0 {
            f64::NEG_INFINITY
        } else if x > 0.0 {
            x
        } else {
            f64::NAN
        };
    }
    // Subnormals are lifted by 2^54 first.
    let (lifted, offset) =
        if x < f64::MIN_POSITIVE { (x * 18_014_398_509_481_984.0, 54.0) } else { (x, 0.0) };
    let (m, e) = split_exponent(lifted);
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    (e - offset) * LN_2 + 2.0 * (s + s * z * poly(z, &ATANH))
}
