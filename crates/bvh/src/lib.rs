//! Bvh (skeleton).
mod accel;
pub use accel::{Accel, HitFilter};
