use std::collections::TryReserveError;

use etendue_core::{Spectrum, UVec2};

use crate::fixed::to_fixed;
use crate::planes::{FirstHit, PlaneSums, Planes, filled};

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TileRect {
    /// Top left pixel.
    pub lo: UVec2,
    /// One past the bottom right pixel.
    pub hi: UVec2,
}

impl TileRect {
    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.hi.x.saturating_sub(self.lo.x) as usize * self.hi.y.saturating_sub(self.lo.y) as usize
    }

    /// Every pixel, row by row.
    pub fn iter(&self) -> impl Iterator<Item = UVec2> + use<> {
        let Self { lo, hi } = *self;
        (lo.y..hi.y).flat_map(move |y| (lo.x..hi.x).map(move |x| UVec2::new(x, y)))
    }

    /// The tiles of a picture, row by row; those at the border are cut off.
    pub fn split(size: UVec2, side: u32) -> Vec<Self> {
        let side = side.max(1);
        let mut out = Vec::new();
        for y in (0..size.y).step_by(side as usize) {
            for x in (0..size.x).step_by(side as usize) {
                let lo = UVec2::new(x, y);
                let hi = UVec2::new(x.saturating_add(side).min(size.x), y.saturating_add(side).min(size.y));
                out.push(Self { lo, hi });
            }
        }
        out
    }
}

/// The sums of one rectangle of a film: what one task fills and the film then absorbs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    pub(crate) rect: TileRect,
    pub(crate) replicates: u32,
    /// Pixel-major, one entry per replicate.
    pub(crate) sums: Vec<[i128; 3]>,
    pub(crate) counts: Vec<u64>,
    pub(crate) planes: PlaneSums,
}

impl Tile {
    /// An empty tile for a film of `replicates` replicates and `planes`.
    ///
    /// # Errors
    /// More memory than can be had.
    pub fn try_new(rect: TileRect, replicates: u32, planes: Planes) -> Result<Self, TryReserveError> {
        let cells = rect.pixels().saturating_mul(replicates.max(1) as usize);
        Ok(Self {
            rect,
            replicates: replicates.max(1),
            sums: filled([0; 3], cells)?,
            counts: filled(0, cells)?,
            planes: PlaneSums::try_new(planes, rect.pixels())?,
        })
    }

    /// The pixels covered.
    pub fn rect(&self) -> TileRect {
        self.rect
    }

    /// The pixel's place, or `usize::MAX` outside the rectangle: a neighbour's cell must not be touched by mistake.
    #[inline]
    fn pixel_index(&self, pixel: UVec2) -> usize {
        let TileRect { lo, hi } = self.rect;
        if pixel.x < lo.x || pixel.y < lo.y || pixel.x >= hi.x || pixel.y >= hi.y {
            return usize::MAX;
        }
        (pixel.y - lo.y) as usize * (hi.x - lo.x) as usize + (pixel.x - lo.x) as usize
    }

    /// Adds one sample. False where it is not finite or too large: it then counts as black, so that the mean stays
    /// honest about how many samples were drawn. False also outside the rectangle, where nothing is counted.
    #[inline]
    pub fn add(&mut self, pixel: UVec2, replicate: u32, l: Spectrum) -> bool {
        let cell = self
            .pixel_index(pixel)
            .saturating_mul(self.replicates as usize)
            .saturating_add((replicate % self.replicates) as usize);
        let (Some(sum), Some(count)) = (self.sums.get_mut(cell), self.counts.get_mut(cell)) else {
            return false;
        };
        *count += 1;
        let [r, g, b] = l.to_array();
        let (Some(r), Some(g), Some(b)) = (to_fixed(r), to_fixed(g), to_fixed(b)) else {
            return false;
        };
        *sum = [sum[0].wrapping_add(r), sum[1].wrapping_add(g), sum[2].wrapping_add(b)];
        true
    }

    /// Adds the alpha of one sample, if the plane is kept.
    pub fn add_alpha(&mut self, pixel: UVec2, alpha: f32) {
        let i = self.pixel_index(pixel);
        self.planes.add_alpha(i, alpha);
    }

    /// Adds what the auxiliary planes want of the sample with this index.
    pub fn add_first_hit(&mut self, pixel: UVec2, index: u64, hit: &FirstHit) {
        let i = self.pixel_index(pixel);
        self.planes.add(i, index, hit);
    }
}
