//! Ray queries.
mod accel;
mod brute;
mod build;
mod error;
mod group;
mod instances;
mod kernel;
mod shape_hits;
mod sink;
mod tree_accel;
mod world;

pub use accel::{Accel, HitFilter};
pub use brute::BruteForce;
pub use error::{BuildError, Place};
pub use tree_accel::{BuildOptions, BuildReport, Quality, TreeAccel};
pub use world::{Instance, World};
