//! Statistics of estimates: running moments, and true error bars from replicates.
//!
//! The sample variance of quasi-Monte Carlo points says nothing about the error of their mean (it is that of
//! independent points, tens of times too large). Independent randomisations do: deal the samples to replicates
//! ([`Sampler::replicates`](crate::Sampler::replicates)) and look at the scatter of their means.

mod moments;
mod replicates;
mod student;

pub use moments::Moments;
pub use replicates::{Estimate, estimate_from_replicates};
pub use student::student_t;
