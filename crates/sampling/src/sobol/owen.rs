//! Owen's nested uniform scrambling (Owen 1995) by hashing (Laine & Karras 2011; Burley 2020).

/// Scrambles a bit-reversed digit string: each digit is flipped by a hash of the digits before it. All operations
/// carry influence upward only, from bit 0, the first digit (constants of Vegdahl 2021).
#[inline(always)]
pub(super) fn scramble(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// As [`scramble`], and back to the ordinary digit order.
#[inline(always)]
pub(super) fn scrambled(x: u32, seed: u32) -> u32 {
    scramble(x, seed).reverse_bits()
}

/// Two at once: one reversal of 64 bits serves both.
#[inline(always)]
pub(super) fn scrambled_pair(x: [u32; 2], seeds: [u32; 2]) -> [u32; 2] {
    let both = u64::from(scramble(x[0], seeds[0])) << 32 | u64::from(scramble(x[1], seeds[1]));
    let both = both.reverse_bits();
    [both as u32, (both >> 32) as u32]
}
