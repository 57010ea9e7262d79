//! Geometry (skeleton).
mod shape;
mod surface;
pub use shape::{Shape, ShapeHit, ShapeSample};
pub use surface::{Hit, Surface};
