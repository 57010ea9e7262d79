use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use super::kernel::{place_in_quadrant, poly, round};

/// The leading 33 bits of π/2: times an integer below 2²⁰ it is exact.
const PI_2_HI: f64 = 1.570_796_326_734_125_6;
/// π/2 − [`PI_2_HI`].
const PI_2_LO: f64 = 6.077_100_506_506_192e-11;
/// Up to here the two-part reduction is exact enough.
const CODY_WAITE_LIMIT: f32 = 1_048_576.0;

/// (sin r / r − 1) / r² on |r| ≤ π/4, in powers of r²; relative error 2⁻³⁵.
const SIN: [f64; 4] = [
    -0.166_666_666_638_552_9,
    0.008_333_331_874_710_208,
    -0.000_198_400_867_353_848_46,
    2.724_992_580_305_979e-6,
];
/// (cos r − 1) / r² on |r| ≤ π/4; error 2⁻³¹ · r².
const COS: [f64; 4] = [
    -0.499_999_999_691_193_1,
    0.041_666_650_644_517_03,
    -0.001_388_758_915_560_057_6,
    2.446_378_829_326_574_6e-5,
];
/// sin(πf/2) / f on |f| ≤ 1/2, in powers of f².
const SIN_QUARTER: [f64; 5] = [
    1.570_796_326_788_1,
    -0.645_964_096_146_795_4,
    0.079_692_582_725_630_62,
    -0.004_681_266_256_726_245,
    0.000_158_206_303_556_477_33,
];
/// (cos(πf/2) − 1) / f² on |f| ≤ 1/2.
const COS_QUARTER: [f64; 4] = [
    -1.233_700_549_374_219_2,
    0.253_669_410_357_108_5,
    -0.020_861_528_342_199_967,
    0.000_906_739_898_403_266_5,
];
/// The first 320 bits of 2/π.
const TWO_OVER_PI: [u64; 5] = [
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
];

/// An angle as a quadrant number (mod 4) and what is left of it, |r| ≤ π/4.
#[inline(always)]
fn reduce(x: f32) -> (f64, u32) {
    if x.abs() < CODY_WAITE_LIMIT {
        let x = f64::from(x);
        let (k, q) = round(x * FRAC_2_PI);
        ((x - k * PI_2_HI) - k * PI_2_LO, q)
    } else {
        reduce_large(x)
    }
}

/// Payne & Hanek (1983): only those bits of 2/π are multiplied that decide the quadrant and the remainder.
#[cold]
fn reduce_large(x: f32) -> (f64, u32) {
    if !x.is_finite() {
        return (f64::NAN, 0);
    }
    let bits = x.to_bits();
    // |x| = m 2^e, m of 24 bits, e in [-3, 104].
    let m = u128::from((bits & 0x7f_ffff) | 0x80_0000);
    let e = ((bits >> 23) & 0xff) as i32 - 150;
    // Leading bits of 2/π whose product with m 2^e is a multiple of 4 are skipped.
    let skip = (e - 2).clamp(0, 127) as u32;
    let (word, shift) = ((skip / 64) as usize, skip % 64);
    let take = |i: usize| u128::from(TWO_OVER_PI.get(i).copied().unwrap_or(0));
    let high = (take(word) << 64) | take(word + 1);
    let window = if shift == 0 { high } else { (high << shift) | (take(word + 2) >> (64 - shift)) };
    let window = window >> (2 - e).clamp(0, 127);
    // In units of 2⁻¹²⁶ quarter turns, modulo 4.
    let turns = m.wrapping_mul(window);
    let q = (turns.wrapping_add(1 << 125) >> 126) as u32;
    let rest = turns.wrapping_sub(u128::from(q) << 126) as i128;
    let r = rest as f64 * (1.0 / (1u128 << 126) as f64) * FRAC_PI_2;
    if x < 0.0 { (-r, q.wrapping_neg()) } else { (r, q) }
}

#[inline(always)]
fn sin_cos_kernel(r: f64) -> (f64, f64) {
    let z = r * r;
    (r * (1.0 + z * poly(z, &SIN)), 1.0 + z * poly(z, &COS))
}

/// (sin x, cos x), `x` in radians. Accurate for every finite argument; infinite ones give NaN.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let (r, q) = reduce(x);
    let (s, c) = sin_cos_kernel(r);
    place_in_quadrant(s, c, q)
}

/// sin x, `x` in radians.
#[inline]
pub fn sin(x: f32) -> f32 {
    sin_cos(x).0
}

/// cos x, `x` in radians.
#[inline]
pub fn cos(x: f32) -> f32 {
    sin_cos(x).1
}

/// tan x, `x` in radians.
#[inline]
pub fn tan(x: f32) -> f32 {
    let (r, q) = reduce(x);
    let (s, c) = sin_cos_kernel(r);
    let (over, under) = if q & 1 == 0 { (s, c) } else { (-c, s) };
    (over / under) as f32
}

/// (sin, cos) of `quarters` · π/2, |quarters| < 2⁵¹. The remainder is exact: no reduction error at all.
#[inline(always)]
fn sin_cos_quarters(quarters: f64) -> (f32, f32) {
    let (k, q) = round(quarters);
    let f = quarters - k;
    let z = f * f;
    place_in_quadrant(f * poly(z, &SIN_QUARTER), 1.0 + z * poly(z, &COS_QUARTER), q)
}

/// (sin 2πu, cos 2πu): the way to turn a random number into an angle. Exact at multiples of a quarter; any finite
/// argument is right, [0, 1) is the intended range.
#[inline]
pub fn sin_cos_turns(u: f32) -> (f32, f32) {
    // From 2⁴⁰ on an f32 is a whole number of turns.
    if u.abs() < 1.099_511_6e12 { sin_cos_quarters(4.0 * f64::from(u)) } else { whole_turns(u) }
}

/// (sin πx, cos πx). Exact at multiples of a half; any finite argument is right.
#[inline]
pub fn sin_cos_pi(x: f32) -> (f32, f32) {
    if x.abs() < 1.099_511_6e12 { sin_cos_quarters(2.0 * f64::from(x)) } else { whole_turns(x) }
}

#[cold]
fn whole_turns(u: f32) -> (f32, f32) {
    if u.is_finite() { (0.0f32.copysign(u), 1.0) } else { (f32::NAN, f32::NAN) }
}
