use etendue_core::{Fingerprint, Vec2};

use crate::hash::{keyed, mix2};
use crate::permutation::permute;
use crate::strata::{PAIR, jittered, stratum, within};
use crate::stream::{Stream, stands};
use crate::{Dim, Sampler, unit_f32};

/// Correlated multi-jittered sampling (Kensler 2013): of `spp` = m · n samples, every two-dimensional draw has one in
/// each cell of an m × n grid *and* one in each of m · n columns and of m · n rows. Different draws are joined at
/// random, and each pair has a pattern of its own.
///
/// *When.* As [`Stratified`](crate::Stratified), where a two-dimensional draw is also projected: along straight edges
/// and for functions nearly of one coordinate (variance N⁻³ on sums of functions of one number each, about N⁻¹·⁵ on
/// smooth functions and edges in two dimensions, where plain jittering has N⁻² and N⁻¹·⁵).
///
/// The columns inside a column of cells are dealt to the cells by *one* permutation for all columns of cells, which is
/// the correlation of the name: the points are better spread than in multi-jittering with a permutation for each
/// (Chiu, Shirley & Wang 1994).
///
/// *Limits.* The number of samples is fixed beforehand, and best a product m · n of sides no further apart than 1 : 2.
/// For another `spp` the grid has a few more cells than samples, a random choice of which stays empty; every sample
/// stays uniform, and cells, columns and rows hold at most one. Samples past `spp` begin another, independent set. The
/// order within a set is random. Two dimensions are as many as are stratified together; a single number has one sample
/// in each of `spp` intervals and is unrelated to the pair that begins with the same dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CorrelatedMultiJittered {
    at: Stream,
    /// Points in a set: at least 1.
    points: u32,
    /// Columns and rows of cells; columns · rows ≥ points.
    columns: u32,
    rows: u32,
}

impl CorrelatedMultiJittered {
    /// A sampler of the given seed in sets of `spp` samples; 0 counts as 1.
    pub fn new(seed: u64, spp: u32) -> Self {
        Self { at: Stream::new(seed, spp), points: 1, columns: 1, rows: 1 }.with_grid()
    }

    /// Deals the samples to `r` replicates (see [`Sampler::replicates`]); 0 counts as 1. Each replicate is a pattern of
    /// its own of `spp / r` samples.
    #[must_use]
    pub fn with_replicates(mut self, r: u32) -> Self {
        self.at.replicates = r.max(1);
        self.with_grid()
    }

    fn with_grid(mut self) -> Self {
        self.points = self.at.points().max(1);
        (self.columns, self.rows) = grid(self.points);
        self
    }

    /// Columns and rows of cells of the pattern of one set.
    pub fn cells(&self) -> (u32, u32) {
        (self.columns, self.rows)
    }
}

/// The squarest grid of exactly `points` cells whose sides are within 1 : 2, else a near-square one of a few cells more.
fn grid(points: u32) -> (u32, u32) {
    let side = points.isqrt().max(1);
    let exact = (1..=side).rev().take_while(|&m| points / m <= 2 * m).find(|&m| points.is_multiple_of(m));
    let columns = exact.unwrap_or(side);
    (columns, points.div_ceil(columns))
}

/// Names of the permutations that deal columns within a column of cells, and rows within a row.
const COLUMNS: u64 = 1;
const ROWS: u64 = 2;

impl Sampler for CorrelatedMultiJittered {
    stands!();

    #[inline]
    fn bits_1d(&self, dim: Dim) -> u32 {
        jittered(self.at, self.points, dim.index())
    }

    #[inline]
    fn get_2d(&self, dim: Dim) -> Vec2 {
        let d = dim.index() | PAIR;
        let (m, n) = (self.columns, self.rows);
        let cell = stratum(self.at, self.points, d, m * n);
        let (column, row) = (cell % m, cell / m);
        // The column of all m · n that a cell takes depends on its row alone, and the other way about.
        let pattern = keyed(self.at.key, self.at.index / self.points, d);
        let x = column * n + permute(row, n, mix2(pattern, COLUMNS));
        let y = row * m + permute(column, m, mix2(pattern, ROWS));
        let jitter = self.at.hash(d);
        Vec2::new(
            unit_f32(within(x, jitter as u32, m * n)),
            unit_f32(within(y, (jitter >> 32) as u32, m * n)),
        )
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("correlated-multi-jittered");
        f.u64(self.at.seed);
        f.u64(u64::from(self.at.spp));
        f.u64(u64::from(self.at.replicates));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_are_exact_where_sides_are_near() {
        for (points, cells) in
            [(1, (1, 1)), (2, (1, 2)), (32, (4, 8)), (35, (5, 7)), (64, (8, 8)), (37, (6, 7))]
        {
            assert_eq!(grid(points), cells, "{points}");
        }
        for points in (1..5000).chain([u32::MAX, u32::MAX - 1, 1 << 31]) {
            let (m, n) = grid(points);
            assert!(m * n >= points && m * n - points < m && n <= 2 * m + 1, "{points}: {m} × {n}");
        }
    }
}
