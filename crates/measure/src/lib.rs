//! Run time against error.
//!
//! * [`compare`]: how far a picture is from a reference: RMSE, relMSE, trimmed.
//! * [`flip`]: how different the two look to a viewer, pixel by pixel.
//! * [`colour_map`]: colours for such maps.

pub mod colour_map;
mod compare;
pub mod flip;

pub use compare::{CompareError, Comparison, compare};
