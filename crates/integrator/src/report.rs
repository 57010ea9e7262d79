use etendue_core::{Needs, Spectrum, UVec2};

use crate::Counts;

/// A sample that could not be added: not finite, or beyond the film's limit. It counts as black and still divides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rejected {
    /// The pixel.
    pub pixel: UVec2,
    /// The sample index: `replay` shows it again.
    pub index: u64,
    /// What it was.
    pub value: Spectrum,
}

/// Why a render ended.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Ended {
    /// All samples asked for are in the film.
    #[default]
    Complete,
    /// The time was up.
    Time,
    /// The progress handle said stop.
    Cancelled,
}

/// What a render did.
#[non_exhaustive]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Camera samples added to the film.
    pub samples: u64,
    /// Sample indices that every pixel has. A cancelled render may hold more of some pixels; to go on exactly, keep
    /// a film of whole ranges.
    pub complete: std::ops::Range<u64>,
    /// Work counted by kind.
    pub counts: Counts,
    /// Samples that could not be added.
    pub rejected: u64,
    /// The first of them, by index and then pixel; at most [`Report::REJECTED_KEPT`].
    pub rejected_at: Vec<Rejected>,
    /// Why it ended.
    pub ended: Ended,
    /// The scene's and the camera's needs together.
    pub needs: Needs,
    /// Biased options in force; empty for an unbiased picture.
    pub bias: Vec<String>,
    /// Seconds by the clock of the options; `None` without one.
    pub seconds: Option<f64>,
}

impl Report {
    /// How many rejected samples are located.
    pub const REJECTED_KEPT: usize = 64;
}
