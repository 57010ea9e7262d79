//! Run time against error.
//!
//! * [`compare`]: how far a picture is from a reference: RMSE, relMSE, trimmed.

mod compare;
pub mod report;

pub use compare::{CompareError, Comparison, compare};
