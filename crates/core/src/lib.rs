//! The words every other crate speaks: rays, boxes, frames, transforms, motions, spectra, rounding-error bounds,
//! portable transcendental functions, radiometric quantities and the census bits.
//!
//! This crate stands at the root of the workspace and uses nothing of it. It does no sampling and knows no shapes.
//!
//! ```
//! use etendue_core::{Origin, Vec3A};
//! // A point on the floor, known to a few ulp, and the ray that leaves it upward.
//! let at = Origin { p: Vec3A::new(1.0, 0.0, 2.0), p_err: Vec3A::splat(1e-6), ng: Vec3A::Y };
//! let ray = at.ray(Vec3A::Y, 0.0);
//! assert!(ray.o.y > 0.0, "the origin is moved out of the error bound, to the side the ray leaves by");
//! ```
//!
//! Limits: single precision positions; scenes far from the origin should be rebased by the caller.

mod aabb;
mod fingerprint;
mod frame;
pub mod math;
mod motion;
mod needs;
mod origin;
mod progress;
pub mod radiometry;
mod ray;
pub mod rounding;
mod spectrum;
mod transform;
pub mod vector;

pub use aabb::Aabb;
pub use fingerprint::Fingerprint;
pub use frame::Frame;
pub use glam;
pub use glam::{UVec2, Vec2, Vec3, Vec3A, Vec4};
pub use motion::{Motion, MotionError};
pub use needs::Needs;
pub use origin::{Origin, Segment};
pub use progress::{CancelFlag, Clock, Progress};
pub use ray::Ray;
pub use spectrum::Spectrum;
pub use transform::{Transform, TransformError};
