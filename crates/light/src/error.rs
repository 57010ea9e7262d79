use etendue_sampling::DistributionError;

/// Why an image does not make an environment.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The factor on the radiance is negative or not finite.
    #[error("the environment's scale is {scale}: it must be a finite number, zero or more")]
    Scale {
        /// The factor.
        scale: f32,
    },
    /// The rotation is not a finite number.
    #[error("the environment's rotation is {rotation} radians: it must be a finite number")]
    Rotation {
        /// The angle.
        rotation: f32,
    },
    /// The table of where the light comes from could not be made.
    #[error("the environment's image cannot be sampled")]
    Table(#[from] DistributionError),
}
