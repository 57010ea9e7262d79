//! Radiometric quantities with their units, and the geometry of light: angles, solid angles, form factors.
//!
//! The quantities are plain `f64` newtypes for the edges of an interface, where a watt taken for a watt per square
//! metre is a bug that no test of the inside can see. The arithmetic between them is the textbook's, and what makes
//! no sense does not compile. Rendering code computes in [`Spectrum`](crate::Spectrum) and `f32`.
//!
//! | quantity | symbol | unit | comes from |
//! |---|---|---|---|
//! | [`RadiantEnergy`] | Q | J | |
//! | [`Power`] | Φ | W | Q / t |
//! | [`Irradiance`] (arriving) | E | W·m⁻² | Φ / A; L · projected solid angle |
//! | [`RadiantExitance`] (leaving) | M | W·m⁻² | [`Power::over`] an area; πL of a diffuse emitter |
//! | [`Radiosity`] (leaving: emitted and reflected) | B | W·m⁻² | M + ρE |
//! | [`Intensity`] | I | W·sr⁻¹ | Φ / ω |
//! | [`Radiance`] | L | W·m⁻²·sr⁻¹ | I / projected area |
//!
//! ```
//! use etendue_core::radiometry::{Area, Power, Radiance, Seconds};
//! use std::f64::consts::PI;
//!
//! // A 100 W source that spreads over a tenth of a square metre.
//! let e = Power(100.0) / Area(0.1);
//! assert_eq!(e.0, 1000.0);
//! assert_eq!(e.to_string(), "1000 W/m²");
//! assert_eq!((Power(100.0) * Seconds(60.0)).0, 6000.0);
//!
//! // What a diffuse emitter of radiance 1 sends out in all: M = πL.
//! assert_eq!(Radiance(1.0).diffuse_exitance().0, PI);
//! ```

mod direction;
mod polygon;
mod quantity;
mod solid_angle;

pub use direction::{Hemispherical, arc_angle};
pub use polygon::{clip_to_horizon, polygon_form_factor, projected_solid_angle};
pub use quantity::{
    Angle, Area, Intensity, Irradiance, Power, ProjectedSolidAngle, Radiance, RadiantEnergy, RadiantExitance,
    Radiosity, Seconds, SolidAngle,
};
pub use solid_angle::{
    cap_solid_angle, one_minus_cos, polygon_solid_angle, spherical_excess, triangle_solid_angle,
};

/// Radiant flux is another word for power.
pub type RadiantFlux = Power;
