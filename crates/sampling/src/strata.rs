//! Strata dealt to the points of a set by hashed permutations: what the stratified samplers share.

use crate::hash::{keyed, mix};
use crate::permutation::permute;
use crate::stream::Stream;

/// The stratum among `n ≥ points` of the point at `at`, for the draw keyed by `what`. Every `points` samples form a
/// set; within a set no stratum is dealt twice.
#[inline(always)]
pub(crate) fn stratum(at: Stream, points: u32, what: u32, n: u32) -> u32 {
    // The remainder is taken at the draw: `index` must stay whole for the jitter.
    let (set, place) = (at.index / points, at.index % points);
    permute(place, n, mix(keyed(at.key, set, what)))
}

/// (stratum + jitter) / n in 32-bit fixed point, rounded down.
#[inline(always)]
pub(crate) fn within(stratum: u32, jitter: u32, n: u32) -> u32 {
    ((u64::from(stratum) << 32 | u64::from(jitter)) / u64::from(n.max(1))) as u32
}

/// A single draw: the point's stratum of `points`, jittered.
#[inline(always)]
pub(crate) fn jittered(at: Stream, points: u32, dimension: u32) -> u32 {
    within(stratum(at, points, dimension, points), (at.hash(dimension) >> 32) as u32, points)
}

/// Sets pairs' permutations and jitter apart from single draws'.
pub(crate) const PAIR: u32 = 1 << 31;
