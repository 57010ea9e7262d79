//! Radiometric quantities.

mod solid_angle;
pub use solid_angle::*;
/// Solid angle in steradian.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct SolidAngle(pub f64);
