//! Which named number is which dimension of a low-discrepancy sequence.

use crate::{Dim, Slot};

/// Dimensions of the sequence that the named dimensions 0..9 take: BSDF before lens, time after both.
const FIRST_BLOCK: [u32; 9] = [0, 1, 2, 3, 6, 7, 4, 5, 8];
/// Dimension of the sequence for the first choice of a lobe.
pub(crate) const FIRST_LOBE: u32 = 9;
/// Dimension of a later vertex's sequence for the choice of its lobe.
pub(crate) const LATER_LOBE: u32 = 4;

/// Where a named dimension comes from.
pub(crate) enum Source {
    /// Dimension of the first block's sequence.
    First(u32),
    /// Dimension of the sequence of the vertex at a depth.
    Later { depth: u32, dimension: u32 },
    /// A plain hash.
    Hash,
}

impl Source {
    #[inline(always)]
    pub(crate) fn of(dim: Dim) -> Self {
        let d = dim.index();
        if let Some(&dimension) = FIRST_BLOCK.get(d as usize) {
            return Self::First(dimension);
        }
        if d < Dim::FIRST {
            return Self::Hash;
        }
        let (depth, slot) = ((d - Dim::FIRST) / Dim::STRIDE, (d - Dim::FIRST) % Dim::STRIDE);
        match (depth, slot) {
            (0, s) if s == Slot::Lobe as u32 => Self::First(FIRST_LOBE),
            (_, s) if s == Slot::Lobe as u32 => Self::Later { depth, dimension: LATER_LOBE },
            (_, s) if s < Slot::Roulette as u32 => Self::Later { depth, dimension: s },
            _ => Self::Hash,
        }
    }
}
