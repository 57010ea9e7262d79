//! Tabulated densities: choose an index or a position with probability proportional to given weights.
//!
//! Sums are kept in double precision. A weight of zero is never drawn, whatever the random number; weights that are
//! negative or not finite are refused when the table is built, and so is a table without any positive weight. Weights
//! below 10⁻³⁶ of the total count as zero: every density that is returned is positive and has a finite reciprocal.
//!
//! | table | draws | cost | keeps stratification |
//! |---|---|---|---|
//! | [`Distribution1d`] | an index and a position in [0, 1) | O(log n) | yes |
//! | [`LinearDistribution1d`] | a position in [0, 1), on lines | O(log n) | yes |
//! | [`Distribution2d`] | a cell and a position in [0, 1)² | O(log n) | yes |
//! | [`AliasTable`] | an index | O(1) | no |

mod alias;
mod linear;
mod one;
mod two;

pub use alias::{AliasSample, AliasTable};
pub use linear::{LinearDistribution1d, LinearSample1d};
pub use one::{Distribution1d, Sample1d};
pub use two::{Distribution2d, Sample2d};

/// Why weights make no distribution.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistributionError {
    /// No weights.
    #[error("the distribution has no weights: pass at least one")]
    Empty,
    /// One value, where lines need two.
    #[error("one value makes no line: pass at least two, for both ends of [0, 1]")]
    OneValue,
    /// A NaN or infinite weight.
    #[error(
        "weight {index} is {value}: weights must be finite; look for NaN or overflow where it is computed"
    )]
    NotFinite {
        /// Which weight.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A negative weight.
    #[error("weight {index} is {value}: weights must not be negative; take the absolute value or clamp to 0")]
    Negative {
        /// Which weight.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// No weight is positive.
    #[error("all weights are zero: nothing could be drawn; fall back to a uniform distribution or drop it")]
    AllZero,
    /// The sum leaves the range of f64.
    #[error("the sum of the weights overflows: scale them down")]
    Overflow,
    /// Not `width · height` weights.
    #[error("{got} weights for a {width} × {height} table: pass one per cell, row by row")]
    SizeMismatch {
        /// Columns asked for.
        width: usize,
        /// Rows asked for.
        height: usize,
        /// Weights passed.
        got: usize,
    },
    /// More weights than a 32-bit index can name.
    #[error("{got} weights are more than an alias table can index (2³²)")]
    TooMany {
        /// Weights passed.
        got: usize,
    },
}

/// The sum of weights, each of which must be finite and not negative.
fn checked_total(weights: impl Iterator<Item = f64>) -> Result<f64, DistributionError> {
    let mut total = 0.0;
    let mut any = false;
    for (index, value) in weights.enumerate() {
        if !value.is_finite() {
            return Err(DistributionError::NotFinite { index, value });
        }
        if value < 0.0 {
            return Err(DistributionError::Negative { index, value });
        }
        any = true;
        total += value;
    }
    if !any {
        Err(DistributionError::Empty)
    } else if total <= 0.0 {
        Err(DistributionError::AllZero)
    } else if total < f64::INFINITY {
        Ok(total)
    } else {
        Err(DistributionError::Overflow)
    }
}

/// Smaller shares of the total count as nothing: their probability would leave the normal range of f32, and its
/// reciprocal the range altogether.
const NEGLIGIBLE: f64 = 1e-36;

/// `weight` unless it is a negligible part of `total`.
fn kept(weight: f64, total: f64) -> f64 {
    if weight < total * NEGLIGIBLE { 0.0 } else { weight }
}

/// Appends the prefix sums of `weights`, starting with 0, and returns the last.
fn push_sums(sums: &mut Vec<f64>, weights: impl Iterator<Item = f64>) -> f64 {
    let mut sum = 0.0;
    sums.push(0.0);
    for w in weights {
        sum += w;
        sums.push(sum);
    }
    sum
}

/// The interval of prefix sums that holds a number, and how far in. Half-open intervals: one without width cannot hold
/// anything.
struct Found {
    index: usize,
    width: f64,
    /// In [0, 1).
    within: f64,
}

/// How many entries a guide for `intervals` has: a power of two, so that bucket borders are exact.
fn guide_len(intervals: usize) -> usize {
    if u32::try_from(intervals).is_ok() { (intervals / 4).max(1).next_power_of_two() } else { 0 }
}

/// Appends a guide to prefix sums: for each of `guide_len` equal parts of [0, 1) the interval that its beginning falls
/// into, so that a search starts a few intervals from its goal (Chen & Asau 1974).
fn push_guide(guide: &mut Vec<u32>, sums: &[f64]) {
    let buckets = guide_len(sums.len().saturating_sub(1));
    let total = sums.last().copied().unwrap_or(0.0);
    let mut index = 0;
    for bucket in 0..buckets {
        let target = bucket as f64 / buckets as f64 * total;
        while sums.get(index + 1).is_some_and(|&s| s <= target) {
            index += 1;
        }
        guide.push(index as u32);
    }
}

/// The interval for `u` in [0, 1). The guide only narrows the search; the result is that of searching all.
#[inline]
fn find(sums: &[f64], guide: &[u32], u: f64) -> Option<Found> {
    let target = u * sums.last()?;
    // Casts saturate. `u` at or past a bucket's border means `target` at or past the border's: rounding is monotone.
    let bucket = (u * guide.len() as f64) as usize;
    let first = guide.get(bucket).map_or(0, |&i| i as usize);
    let last = guide.get(bucket + 1).map_or(sums.len() - 1, |&i| i as usize);
    let narrowed = sums.get(first..=last)?;
    // The last sum not above the target begins the interval; the next one is above it, so the width is positive.
    let index = first + narrowed.partition_point(|&s| s <= target).checked_sub(1)?;
    let (start, end) = (*sums.get(index)?, *sums.get(index + 1)?);
    let width = end - start;
    Some(Found { index, width, within: (target - start) / width })
}

/// `(index + within) / n` in single precision, in the `index`-th of `n` intervals even after rounding.
fn position(index: usize, within: f64, n: usize) -> f32 {
    let x = ((index as f64 + within) / n as f64) as f32;
    if interval(x, n) > index || x >= 1.0 { x.next_down() } else { x }
}

/// Which of `n` equal intervals of [0, 1) holds `x`; positions outside are clamped.
fn interval(x: f32, n: usize) -> usize {
    // Casts of floats saturate: below 0 and NaN give the first, above 1 the last.
    ((f64::from(x) * n as f64) as usize).min(n - 1)
}
