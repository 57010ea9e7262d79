use super::QualityError;
use super::error::check;

/// The most cells of a grid: 128 MiB of counts.
const MOST_CELLS: usize = 1 << 24;

/// What the star discrepancy lies between, up to the rounding of double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StarBounds {
    /// Of some box: at least this much.
    pub lower: f64,
    /// Of no box more than this.
    pub upper: f64,
}

/// Bounds of the star discrepancy, by a grid of `cells` equal intervals an axis: the lower one is the worst of all
/// boxes whose far corner is on the grid; the upper one brackets every other box between those of its cell's two corners
/// (the simplest cover of Thiémard 2001: equal cells). They are at most 1 - (1 - 1/cells)^D < D/cells apart.
/// O(D (N + (cells + 1)^D)) time, 8 bytes a corner.
///
/// # Errors
///
/// [`QualityError`] if there are no points, or not all of them are in [0, 1)^D; [`QualityError::Grid`] if there are no
/// cells, or more than 2²⁴ corners.
///
/// ```
/// use etendue_sampling::quality::{star_discrepancy, star_discrepancy_bounds};
/// let points = [[0.1, 0.7, 0.4], [0.6, 0.2, 0.9], [0.8, 0.5, 0.3]];
/// let exact = star_discrepancy(&points).unwrap();
/// let bounds = star_discrepancy_bounds(&points, 50).unwrap();
/// assert!(bounds.lower <= exact && exact <= bounds.upper && bounds.upper - bounds.lower < 0.06);
/// ```
pub fn star_discrepancy_bounds<const D: usize>(
    points: &[[f64; D]],
    cells: usize,
) -> Result<StarBounds, QualityError> {
    check(points)?;
    let refused = QualityError::Grid { cells, dimensions: D };
    let side = cells.checked_add(1).ok_or(refused)?;
    let corners = u32::try_from(D).ok().and_then(|d| side.checked_pow(d)).ok_or(refused)?;
    if cells == 0 || corners > MOST_CELLS {
        return Err(refused);
    }
    let below = counts_below(points, cells, corners);
    let n = points.len() as f64;
    let mut bounds = StarBounds { lower: 0.0, upper: 0.0 };
    // Far corners of the cells, counted like an odometer; (1, …, 1) is the first.
    let mut far = [1; D];
    loop {
        let index = far.iter().fold(0, |index, j| index * side + j);
        let near_index = far.iter().fold(0, |index, j| index * side + (j - 1));
        let volume: f64 = far.iter().map(|&j| line(j, cells)).product();
        let near_volume: f64 = far.iter().map(|&j| line(j - 1, cells)).product();
        let (share, near_share) = (below[index] as f64 / n, below[near_index] as f64 / n);
        bounds.lower = bounds.lower.max((share - volume).abs());
        // A box that ends in this cell has no more points than its far corner's and no less volume than its near one's;
        // and the other way round.
        bounds.upper = bounds.upper.max(share - near_volume).max(volume - near_share);
        let Some(axis) = (0..D).rev().find(|&axis| far[axis] < cells) else { return Ok(bounds) };
        far[axis] += 1;
        far[axis + 1..].fill(1);
    }
}

/// Where the `j`-th line of the grid is.
fn line(j: usize, cells: usize) -> f64 {
    j as f64 / cells as f64
}

/// How many points are strictly below each corner of the grid, in all their coordinates; the last axis runs fastest.
fn counts_below<const D: usize>(points: &[[f64; D]], cells: usize, corners: usize) -> Vec<usize> {
    let side = cells + 1;
    let mut counts = vec![0; corners];
    for p in points {
        // Each counts from the first corner on that is above it.
        counts[p.iter().fold(0, |index, &x| index * side + first_line_above(x, cells))] += 1;
    }
    let mut stride = 1;
    for _ in 0..D {
        for i in 0..corners {
            if i / stride % side > 0 {
                counts[i] += counts[i - stride];
            }
        }
        stride *= side;
    }
    counts
}

/// The first line of the grid above `x` in [0, 1), as its position is rounded: a guess, and a step where it is off.
fn first_line_above(x: f64, cells: usize) -> usize {
    let guess = ((x * cells as f64) as usize + 1).min(cells);
    if line(guess, cells) <= x {
        guess + 1
    } else if line(guess - 1, cells) > x {
        guess - 1
    } else {
        guess
    }
}
