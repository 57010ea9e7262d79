use etendue_core::Vec3A;
use etendue_scene::SceneError;

/// Why there is no reading.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GonioError {
    /// A direction without a direction.
    #[error("the {which} direction is {direction}: it must be finite and not zero")]
    Direction {
        /// `incident` or `exitant`.
        which: &'static str,
        /// What was given.
        direction: Vec3A,
    },
    /// A direction, or a part of its cone, that is not above the sample.
    #[error(
        "the {which} direction {direction} with a half angle of {half_angle} rad reaches the horizon: all of it must \
         be above the sample (z > 0)"
    )]
    Horizon {
        /// `incident` or `exitant`.
        which: &'static str,
        /// What was given.
        direction: Vec3A,
        /// Of the cone, radians.
        half_angle: f32,
    },
    /// A half angle that is no number of the range.
    #[error("the {which} half angle is {half_angle} rad: it must be 0 (collimated) or from 0.001 to π/2")]
    HalfAngle {
        /// `incident` or `exitant`.
        which: &'static str,
        /// What was given, radians.
        half_angle: f32,
    },
    /// Nothing to average.
    #[error("a reading of {runs} runs of {samples} samples is none: both must be at least 1")]
    NoSamples {
        /// Asked for.
        runs: u32,
        /// Asked for.
        samples: u32,
    },
    /// A spot without an area, or without a place.
    #[error("the measuring spot is {what}")]
    Spot {
        /// What is wrong with it.
        what: &'static str,
    },
    /// A sample with lights of its own.
    #[error("the sample brings lights: a reading is of the instrument's light alone, so leave them out")]
    Lit,
    /// The sample's scene could not be built.
    #[error("the sample cannot be built: {0}")]
    Scene(#[from] SceneError),
    /// A material returned what is no number.
    #[error(
        "sample {sample} of run {run} toward {wo} has a radiance that is not finite: some material is at fault"
    )]
    NotFinite {
        /// The run.
        run: u32,
        /// The sample in it.
        sample: u32,
        /// Exitant direction, in the spot's frame.
        wo: Vec3A,
    },
}
