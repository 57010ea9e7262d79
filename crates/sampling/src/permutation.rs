//! Random permutations evaluated at one place, without a table.

/// Where `x < 2^bits` goes in a pseudo-random permutation of `0..2^bits` chosen by `key` (a hash), `bits ≤ 32`.
///
/// Multiplications by odd numbers carry bits upward, xor-shifts by half the width carry them down again.
#[inline(always)]
pub(crate) fn permute_bits(x: u32, bits: u32, key: u64) -> u32 {
    let mask = ((1u64 << bits) - 1) as u32;
    let down = bits.div_ceil(2);
    let (a, b) = (key as u32, (key >> 32) as u32);
    let mut x = x ^ (a & mask);
    for odd in [b | 1, a.rotate_left(13) | 1, 0x9e37_79b1, b.rotate_left(19) | 1] {
        x = x.wrapping_mul(odd) & mask;
        x ^= x.checked_shr(down).unwrap_or(0);
        x = x.wrapping_add(a.wrapping_mul(odd) >> 7) & mask;
    }
    x
}

/// Where `x < n` goes in a pseudo-random permutation of `0..n` chosen by `key`: walks the cycle of a permutation of
/// the next power of two until it comes back below `n` (Black & Rogaway 2002; Kensler 2013). Fewer than two steps on
/// average. `n = 0` and `x ≥ n` give 0.
#[inline]
pub(crate) fn permute(x: u32, n: u32, key: u64) -> u32 {
    if x >= n {
        return 0;
    }
    let bits = 32 - (n - 1).leading_zeros();
    let mut y = permute_bits(x, bits, key);
    while y >= n {
        y = permute_bits(y, bits, key);
    }
    y
}
