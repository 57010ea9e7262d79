use super::{
    DistributionError, Found, checked_total, find, guide_len, interval, kept, position, push_guide, push_sums,
};
use crate::remap::clamp_unit;

/// A piecewise constant density on [0, 1): `n` equal intervals with given weights.
///
/// ```
/// use etendue_sampling::Distribution1d;
/// let d = Distribution1d::new([1.0f32, 0.0, 3.0])?;
/// let s = d.sample(0.5);
/// assert_eq!(s.index, 2);
/// assert_eq!(s.pmf, 0.75);
/// assert_eq!(s.pdf, d.pdf(s.x));
/// # Ok::<(), etendue_sampling::DistributionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution1d {
    /// Prefix sums: n + 1 values from 0 to the total.
    sums: Vec<f64>,
    guide: Vec<u32>,
    total: f64,
}

/// A draw from [`Distribution1d`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample1d {
    /// Position in [0, 1), inside the interval.
    pub x: f32,
    /// Density at `x`.
    pub pdf: f32,
    /// Which interval.
    pub index: usize,
    /// Probability of the interval.
    pub pmf: f32,
    /// Fresh number in [0, 1): where in the interval.
    pub u: f32,
}

impl Distribution1d {
    /// From weights that are finite and not negative.
    ///
    /// # Errors
    /// [`DistributionError`] where a weight is unfit, there is none, or none is positive.
    pub fn new<W: Into<f64>>(weights: impl IntoIterator<Item = W>) -> Result<Self, DistributionError> {
        let weights: Vec<f64> = weights.into_iter().map(Into::into).collect();
        let total = checked_total(weights.iter().copied())?;
        let mut sums = Vec::with_capacity(weights.len() + 1);
        let total = push_sums(&mut sums, weights.iter().map(|&w| kept(w, total)));
        let mut guide = Vec::with_capacity(guide_len(weights.len()));
        push_guide(&mut guide, &sums);
        Ok(Self { sums, guide, total })
    }

    /// Number of intervals.
    #[inline]
    pub fn len(&self) -> usize {
        self.sums.len() - 1
    }

    /// Never: a distribution has at least one interval.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Sum of the weights.
    #[inline]
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Probability of interval `index`; 0 outside.
    #[inline]
    pub fn pmf(&self, index: usize) -> f32 {
        match (self.sums.get(index), self.sums.get(index.wrapping_add(1))) {
            (Some(a), Some(b)) => ((b - a) / self.total) as f32,
            _ => 0.0,
        }
    }

    /// Density at `x` in [0, 1).
    #[inline]
    pub fn pdf(&self, x: f32) -> f32 {
        self.density(interval(x, self.len()))
    }

    fn density(&self, index: usize) -> f32 {
        match (self.sums.get(index), self.sums.get(index + 1)) {
            (Some(a), Some(b)) => ((b - a) / self.total * self.len() as f64) as f32,
            _ => 0.0,
        }
    }

    /// A position by inversion: monotone in `u` in [0, 1) (f32 or f64), so stratification passes through.
    #[inline]
    pub fn sample(&self, u: impl Into<f64>) -> Sample1d {
        let Found { index, width, within } = self.invert(u.into());
        Sample1d {
            x: position(index, within, self.len()),
            pdf: self.density(index),
            index,
            pmf: (width / self.total) as f32,
            u: clamp_unit(within as f32),
        }
    }

    /// Weight of interval `index`, 0 if it is never drawn or there is none.
    pub(super) fn width(&self, index: usize) -> f64 {
        match (self.sums.get(index), self.sums.get(index.wrapping_add(1))) {
            (Some(a), Some(b)) => b - a,
            _ => 0.0,
        }
    }

    /// The interval that `u` falls into.
    #[inline]
    pub(super) fn invert(&self, u: f64) -> Found {
        find(&self.sums, &self.guide, u).unwrap_or_else(|| {
            // Only where the caller's number was not in [0, 1): the end of the last interval that has width.
            let index = self.sums.partition_point(|&s| s < self.total).saturating_sub(1);
            Found { index, width: self.total - self.sums.get(index).copied().unwrap_or(0.0), within: 1.0 }
        })
    }
}
