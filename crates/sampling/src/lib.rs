//! Sampling (skeleton).
mod dim;
mod sampler;
pub use dim::{Dim, Slot};
pub use sampler::{BounceDraws, Sampler, unit_f32};
