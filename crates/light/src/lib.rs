//! Sources of light, and the choice among them: the traits [`Light`] and [`LightPicker`], one file per light.
//!
//! World space throughout. Every light draws directions with a density per solid angle and reports the same density
//! for a direction found otherwise, so that both strategies can be weighed against each other.
//!
//! ```
//! use etendue_core::{Spectrum, Vec2, Vec3A};
//! use etendue_light::{Light, LitPoint, PointLight, Sides};
//!
//! let lamp = PointLight::new(Vec3A::new(0.0, 2.0, 0.0), Spectrum::gray(8.0));
//! let floor = LitPoint {
//!     p: Vec3A::ZERO, p_err: Vec3A::ZERO, ng: Vec3A::Y, ns: Vec3A::Y, sides: Sides::Same, time: 0.0,
//! };
//! let s = lamp.sample(&floor, 0, Vec2::ZERO).expect("above the floor");
//! assert_eq!((s.wi, s.li), (Vec3A::Y, Spectrum::gray(2.0)), "8 W/sr at 2 m");
//! ```
//!
//! | light | parts | sampled by |
//! |---|---|---|
//! | [`PointLight`], [`SpotLight`], [`GoniometricLight`], [`DirectionalLight`] | 1 | nothing to draw |
//! | [`MeshLight`] | its triangles | solid angle, or area where that is very small or nearly a hemisphere |
//! | [`ParallelogramLight`] | 1 | solid angle if it is a rectangle, else area |
//! | [`SphereLight`] | 1 | the cone it fills |
//! | [`DiscLight`] | 1 | nearly by solid angle, or area where it is seen edge-on |
//! | [`ShapeLight`] | 1 | area |
//! | [`ConstantEnvironment`] | 1 | the cosine at the receiver, or uniformly |
//! | [`ImageEnvironment`] | 1 | its radiance |
//! | [`MovingLight`] | those of a light | as that light is, from where the asking point stands relative to it |
//!
//! Where a point uses only one side of its surface ([`Sides::Same`]), lights return no directions from behind it and
//! report zero density for them; that mass is lost, not moved elsewhere.
//!
//! Limits: lights move rigidly ([`MovingLight`]); a picker chooses the same way at every moment.
//!
//! Place in the workspace: above `core`, `sampling`, `geometry` and `texture`; scenes hold lights, integrators ask them.

#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "a NaN has to take the refusing branch")]

mod constant_environment;
mod directional;
mod disc;
mod emitter;
mod error;
mod goniometric;
mod image_environment;
mod intensity_table;
mod light;
mod mesh;
mod moving;
mod parallelogram;
mod part_table;
mod picker;
mod picker_power;
mod picker_single;
mod picker_uniform;
mod point;
mod shape;
mod sphere;
mod spot;
mod unpicked;

pub use constant_environment::ConstantEnvironment;
pub use directional::DirectionalLight;
pub use disc::DiscLight;
pub use error::EnvironmentError;
pub use goniometric::GoniometricLight;
pub use image_environment::ImageEnvironment;
pub use intensity_table::{IntensityTable, IntensityTableError};
pub use light::{Light, LightBounds, LightId, LightSample, LitPoint, Sides};
pub use mesh::MeshLight;
pub use moving::MovingLight;
pub use parallelogram::ParallelogramLight;
pub use picker::{LightPicker, Pick};
pub use picker_power::PowerPicker;
pub use picker_single::SinglePicker;
pub use picker_uniform::UniformPicker;
pub use point::PointLight;
pub use shape::ShapeLight;
pub use sphere::SphereLight;
pub use spot::SpotLight;
pub use unpicked::Unpicked;
