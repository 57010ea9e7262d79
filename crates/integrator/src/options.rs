use std::ops::Range;

use etendue_camera::Filter;
use etendue_core::{Clock, Progress, UVec2};

/// How a film is filled. All defaults are unbiased.
pub struct RenderOptions<'a> {
    /// Sample indices to draw for every pixel; `None` for all of the sampler's.
    pub samples: Option<Range<u64>>,
    /// Side of a tile in pixels, between 4 and 256; any value gives the same picture.
    pub tile: u32,
    /// Where samples lie around a pixel's centre.
    pub filter: Filter,
    /// Hears of progress in samples, and may stop the render.
    pub progress: &'a dyn Progress,
    /// Stops after this many seconds of `clock`, at the end of a pass; the first budget reached wins.
    pub seconds: Option<f64>,
    /// The clock that measures `seconds` and the report's time; without one there is no time budget.
    pub clock: Option<&'a dyn Clock>,
}

impl Default for RenderOptions<'_> {
    fn default() -> Self {
        Self { samples: None, tile: 16, filter: Filter::default(), progress: &(), seconds: None, clock: None }
    }
}

/// Why a render cannot start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// Film and camera differ in size.
    #[error("the film has {}x{} pixels and the camera {}x{}; make both alike", .film.x, .film.y, .camera.x, .camera.y)]
    Size {
        /// Pixels of the film.
        film: UVec2,
        /// Pixels of the camera.
        camera: UVec2,
    },
    /// Film and sampler differ in replicates.
    #[error("the film keeps {film} replicates and the sampler deals {sampler}; make both alike")]
    Replicates {
        /// Replicates of the film.
        film: u32,
        /// Replicates of the sampler.
        sampler: u32,
    },
    /// Not even one tile fits in memory any more.
    #[error("out of memory while rendering; use fewer auxiliary planes or replicates")]
    OutOfMemory,
    /// A time budget without a clock.
    #[error("a time budget needs a clock: set RenderOptions::clock")]
    NoClock,
}
