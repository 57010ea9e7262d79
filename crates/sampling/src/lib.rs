//! Sampling (skeleton).
mod dim;
pub mod mis;
pub mod remap;
mod sampler;
pub mod warp;
pub use dim::{Dim, Slot};
pub use sampler::{BounceDraws, Sampler, unit_f32};
