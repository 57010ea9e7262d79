//! Bsdf (skeleton).
mod bsdf;
mod bsdf_at;
pub use bsdf::{Bsdf, BsdfSample, Lobes, Mode, Scatter};
pub use bsdf_at::BsdfAt;
