use etendue_core::{UVec2, Vec2};

use super::{
    Distribution1d, DistributionError, checked_total, find, guide_len, interval, kept, position, push_guide,
    push_sums,
};
use crate::remap::clamp_unit;

/// A piecewise constant density on [0, 1)²: `width × height` equal cells with given weights, row by row from y = 0.
/// A row is chosen by the marginal sums, then a cell within it; both by inversion.
///
/// This is the table behind environment maps: [`Distribution2d::pdf`] reads two neighbouring numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution2d {
    width: usize,
    height: usize,
    /// Prefix sums within each row, `width + 1` values a row.
    sums: Vec<f64>,
    /// Guides of each row, `guide_len(width)` entries a row.
    guides: Vec<u32>,
    rows: Distribution1d,
    /// Density per weight: cells over total.
    scale: f64,
}

/// A draw from [`Distribution2d`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample2d {
    /// Position in [0, 1)², inside the cell.
    pub p: Vec2,
    /// Density at `p`.
    pub pdf: f32,
    /// Column and row.
    pub cell: UVec2,
    /// Fresh numbers in [0, 1)²: where in the cell.
    pub u: Vec2,
}

impl Distribution2d {
    /// From `width · height` weights that are finite and not negative, row by row.
    ///
    /// # Errors
    /// [`DistributionError`] where a weight is unfit, their number is not `width · height`, or none is positive.
    pub fn new<W: Into<f64> + Copy>(
        weights: &[W],
        width: usize,
        height: usize,
    ) -> Result<Self, DistributionError> {
        if weights.is_empty() || width == 0 {
            return Err(DistributionError::Empty);
        }
        if width.checked_mul(height) != Some(weights.len()) || u32::try_from(width.max(height)).is_err() {
            return Err(DistributionError::SizeMismatch { width, height, got: weights.len() });
        }
        let total = checked_total(weights.iter().map(|&w| w.into()))?;
        let mut sums = Vec::with_capacity((width + 1) * height);
        let mut guides = Vec::with_capacity(guide_len(width) * height);
        let mut totals = Vec::with_capacity(height);
        for row in weights.chunks_exact(width) {
            let start = sums.len();
            totals.push(push_sums(&mut sums, row.iter().map(|&w| kept(w.into(), total))));
            push_guide(&mut guides, &sums[start..]);
        }
        let rows = Distribution1d::new(totals)?;
        let scale = weights.len() as f64 / rows.total();
        Ok(Self { width, height, sums, guides, rows, scale })
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Sum of the weights.
    pub fn total(&self) -> f64 {
        self.rows.total()
    }

    /// Density at `p` in [0, 1)²; positions outside count as the nearest inside.
    #[inline]
    pub fn pdf(&self, p: Vec2) -> f32 {
        let at = interval(p.y, self.height) * (self.width + 1) + interval(p.x, self.width);
        match self.sums.get(at..at + 2) {
            Some(&[a, b]) => ((b - a) * self.scale) as f32,
            _ => 0.0,
        }
    }

    /// A position; `None` only where `u` is not in [0, 1)².
    #[inline]
    pub fn sample(&self, u: Vec2) -> Option<Sample2d> {
        let row = self.rows.sample(u.y);
        let start = row.index * (self.width + 1);
        let sums = self.sums.get(start..start + self.width + 1)?;
        let entries = guide_len(self.width);
        let guide = self.guides.get(row.index * entries..(row.index + 1) * entries)?;
        let found = find(sums, guide, f64::from(u.x))?;
        Some(Sample2d {
            p: Vec2::new(position(found.index, found.within, self.width), row.x),
            pdf: (found.width * self.scale) as f32,
            cell: UVec2::new(found.index as u32, row.index as u32),
            u: Vec2::new(clamp_unit(found.within as f32), row.u),
        })
    }
}
