use etendue_core::{Fingerprint, Vec2};

use crate::strata::{PAIR, jittered, stratum, within};
use crate::stream::{Stream, stands};
use crate::{Dim, Sampler, unit_f32};

/// Jittered sampling: of `spp` samples, every one-dimensional draw has one in each of `spp` intervals, and every
/// two-dimensional draw at most one in each cell of a near-square grid. Different draws are joined at random.
///
/// Any `spp` will do: where it is no product of the grid's sides, the grid has a few more cells than samples and a
/// random choice of cells stays empty, which keeps every sample uniform. Samples past `spp` begin another, independent
/// set. The order within a set is random (hashed permutations, Kensler 2013), so no prefix is special.
///
/// A dimension is drawn either alone or as the first of a pair; the two draws are unrelated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stratified {
    at: Stream,
    /// Points in a set.
    points: u32,
    /// Columns and rows of the grid; columns · rows ≥ points.
    columns: u32,
    rows: u32,
}

impl Stratified {
    /// A sampler that stratifies `spp` samples a pixel.
    pub fn new(seed: u64, spp: u32) -> Self {
        Self { at: Stream::new(seed, spp), points: 1, columns: 1, rows: 1 }.with_grid()
    }

    /// Deals the samples to `r` replicates (see [`Sampler::replicates`]); 0 counts as 1. Each replicate stratifies
    /// its `spp / r` samples.
    #[must_use]
    pub fn with_replicates(mut self, r: u32) -> Self {
        self.at.replicates = r.max(1);
        self.with_grid()
    }

    fn with_grid(mut self) -> Self {
        self.points = self.at.points().max(1);
        self.columns = self.points.isqrt().max(1);
        self.rows = self.points.div_ceil(self.columns);
        self
    }
}

impl Sampler for Stratified {
    stands!();

    #[inline]
    fn bits_1d(&self, dim: Dim) -> u32 {
        jittered(self.at, self.points, dim.index())
    }

    #[inline]
    fn get_2d(&self, dim: Dim) -> Vec2 {
        let d = dim.index() | PAIR;
        // An excess of cells over points is left empty at random; `permute` spreads the points over all cells.
        let cell = stratum(self.at, self.points, d, self.columns * self.rows);
        let jitter = self.at.hash(d);
        let (column, row) = (cell % self.columns, cell / self.columns);
        Vec2::new(
            unit_f32(within(column, jitter as u32, self.columns)),
            unit_f32(within(row, (jitter >> 32) as u32, self.rows)),
        )
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("stratified");
        f.u64(self.at.seed);
        f.u64(u64::from(self.at.spp));
        f.u64(u64::from(self.at.replicates));
    }
}
