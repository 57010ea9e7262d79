//! Pieces that several functions share.

/// Adding and subtracting 1.5 · 2⁵² rounds a double of magnitude below 2⁵¹ to the nearest integer (ties to even),
/// and leaves that integer in the low mantissa bits.
pub(super) const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// `x` rounded to an integer, as a double, and its low 32 bits in two's complement.
#[inline(always)]
pub(super) fn round(x: f64) -> (f64, u32) {
    let shifted = x + ROUNDER;
    (shifted - ROUNDER, shifted.to_bits() as u32)
}

/// `c[0] + c[1] z + …`, even and odd powers apart so that the two chains run in parallel.
#[inline(always)]
pub(super) fn poly<const N: usize>(z: f64, c: &[f64; N]) -> f64 {
    let z2 = z * z;
    let (mut even, mut odd) = (0.0, 0.0);
    let mut i = N;
    while i > 0 {
        i -= 1;
        if i & 1 == 0 {
            even = if i + 2 >= N { c[i] } else { even * z2 + c[i] };
        } else {
            odd = if i + 2 >= N { c[i] } else { odd * z2 + c[i] };
        }
    }
    even + odd * z
}

/// (sin, cos) of an angle in quadrant `q` whose first-quadrant kernels are `s` and `c`: exchanged and negated by
/// bits, because a branch on a random quadrant is mispredicted half of the time.
#[inline(always)]
pub(super) fn place_in_quadrant(s: f64, c: f64, q: u32) -> (f32, f32) {
    let (s, c) = ((s as f32).to_bits(), (c as f32).to_bits());
    let exchange = (s ^ c) & 0u32.wrapping_sub(q & 1);
    let sin = (s ^ exchange) ^ ((q & 2) << 30);
    let cos = (c ^ exchange) ^ ((q.wrapping_add(1) & 2) << 30);
    (f32::from_bits(sin), f32::from_bits(cos))
}

/// `x = m · 2^e` with m in [√½, √2), for a positive normal double; near 1 the exponent is 0, so that logarithms
/// keep their relative accuracy there. Returns (m, e).
#[inline(always)]
pub(super) fn split_exponent(x: f64) -> (f64, f64) {
    const SQRT_HALF_BITS: u64 = 0x3FE6_A09E_667F_3BCD;
    let bits = x.to_bits();
    let e = (bits.wrapping_sub(SQRT_HALF_BITS) as i64) >> 52;
    (f64::from_bits(bits.wrapping_sub((e << 52) as u64)), e as f64)
}

/// 2^k for an integral k in [-1022, 1023], given its two's complement.
#[inline(always)]
pub(super) fn power_of_two(k: u32) -> f64 {
    f64::from_bits((i64::from(k as i32).wrapping_add(1023) as u64) << 52)
}
