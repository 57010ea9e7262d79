//! Material (skeleton).
mod material;
pub use material::{AlphaPoint, Material, MediumId};
