use super::{DistributionError, checked_total, kept};
use crate::remap::clamp_unit;

/// Draws an index with given probabilities in constant time (Walker 1977; the numerically safe construction of
/// Vose 1991).
///
/// Every slot holds at most two indices. The map from `u` to the index is not monotone: use [`super::Distribution1d`]
/// where stratification of the choice matters.
///
/// ```
/// use etendue_sampling::AliasTable;
/// let table = AliasTable::new([1.0f32, 0.0, 3.0])?;
/// assert_eq!(table.pmf(2), 0.75);
/// assert!((0..1000).all(|i| table.sample(f64::from(i) / 1000.0).index != 1));
/// # Ok::<(), etendue_sampling::DistributionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AliasTable {
    slots: Vec<Slot>,
    total: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Slot {
    /// The slot's own index is drawn below this share of the slot, the other above.
    threshold: f64,
    other: u32,
    pmf: f32,
}

/// A draw from [`AliasTable`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AliasSample {
    /// Which weight.
    pub index: usize,
    /// Its probability.
    pub pmf: f32,
    /// Fresh number in [0, 1).
    pub u: f32,
}

impl AliasTable {
    /// From weights that are finite and not negative.
    ///
    /// # Errors
    /// [`DistributionError`] where a weight is unfit, there is none, or none is positive.
    pub fn new<W: Into<f64>>(weights: impl IntoIterator<Item = W>) -> Result<Self, DistributionError> {
        let mut share: Vec<f64> = weights.into_iter().map(Into::into).collect();
        let total = checked_total(share.iter().copied())?;
        let n = share.len();
        if u32::try_from(n).is_err() {
            return Err(DistributionError::TooMany { got: n });
        }
        for w in &mut share {
            *w = kept(*w, total);
        }
        let full = |(i, w): (usize, &f64)| Slot { threshold: 1.0, other: i as u32, pmf: (w / total) as f32 };
        let mut slots: Vec<Slot> = share.iter().enumerate().map(full).collect();
        // In units of the mean weight, a slot's capacity.
        for w in &mut share {
            *w = *w / total * n as f64;
        }
        let heaviest = (0..n).fold(0, |best, i| if share[i] > share[best] { i } else { best });
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| share[i] < 1.0);
        while let (Some(&s), Some(&l)) = (small.last(), large.last()) {
            small.pop();
            slots[s].threshold = share[s];
            slots[s].other = l as u32;
            // In this order the subtraction loses nothing that matters (Vose).
            share[l] = (share[l] + share[s]) - 1.0;
            if share[l] < 1.0 {
                large.pop();
                small.push(l);
            }
        }
        // Left over by rounding: full slots of their own, except that nothing of weight zero may be drawn.
        for i in small {
            if slots[i].pmf <= 0.0 {
                slots[i].threshold = 0.0;
                slots[i].other = heaviest as u32;
            }
        }
        Ok(Self { slots, total })
    }

    /// Number of weights.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Never: a table has at least one weight.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Sum of the weights.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Probability of `index`; 0 outside.
    #[inline]
    pub fn pmf(&self, index: usize) -> f32 {
        self.slots.get(index).map_or(0.0, |s| s.pmf)
    }

    /// An index for `u` in [0, 1) (f32 or f64; take f64 for more than a few thousand weights).
    #[inline]
    pub fn sample(&self, u: impl Into<f64>) -> AliasSample {
        let u = u.into();
        let scaled = if u > 0.0 { u * self.slots.len() as f64 } else { 0.0 };
        // Casts saturate, so any number finds a slot.
        let index = (scaled as usize).min(self.slots.len() - 1);
        let within = scaled - index as f64;
        let slot = self.slots[index];
        let (index, u) = if within < slot.threshold {
            (index, within / slot.threshold)
        } else {
            (slot.other as usize, (within - slot.threshold) / (1.0 - slot.threshold))
        };
        AliasSample { index, pmf: self.pmf(index), u: clamp_unit(u as f32) }
    }
}
