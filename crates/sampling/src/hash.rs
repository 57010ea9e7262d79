//! Integer hashing: the source of every random bit here.

/// An odd constant near 2⁶⁴/φ: successive multiples of it are far apart.
pub(crate) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// A bijection of 64-bit words in which every input bit flips every output bit with probability ½ (the finaliser
/// structure of MurmurHash3 with the constants of Stafford 2011, variant 13).
#[inline(always)]
pub fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A hash of two words; not symmetric.
#[inline(always)]
pub fn mix2(a: u64, b: u64) -> u64 {
    mix(mix(a.wrapping_add(GOLDEN)) ^ b.wrapping_mul(GOLDEN))
}

/// 64 bits for a pair of small numbers under a key that is itself a hash.
#[inline(always)]
pub(crate) fn keyed(key: u64, high: u32, low: u32) -> u64 {
    mix(key.wrapping_add((u64::from(high) << 32 | u64::from(low)).wrapping_mul(GOLDEN)))
}
