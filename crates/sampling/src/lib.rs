//! Random numbers as functions, and what turns them into directions, points and choices.
//!
//! * [`Sampler`]: one point of an infinite-dimensional point set. [`Sobol`] is the default, [`Stratified`] and
//!   [`Independent`] are the classics beside it; a user's own enters by the same trait.
//! * [`Halton`]: a sequence for sample counts that are no powers of two, scrambled by digit permutations or nested.
//! * [`Hammersley`]: the point set for a number of points known beforehand, for studies; no sampler.
//! * [`LatinHypercube`]: every dimension stratified by itself, any number of them; for sums of functions of one number.
//! * [`CorrelatedMultiJittered`]: pairs stratified in cells, columns and rows at once.
//! * [`warp`]: from the unit square to discs, triangles, hemispheres, cones and solid angles, with densities.
//! * [`Distribution1d`], [`Distribution2d`], [`AliasTable`], [`remap`]: discrete choices; [`LinearDistribution1d`]:
//!   lines; [`Rejection`]: densities without an inverse.
//! * [`estimate`]: integrals of anything, with any density and sampler.
//! * [`mis`]: weights of multiple importance sampling. [`stats`]: moments, and error bars that are true.
//! * [`quality`]: how evenly points lie: discrepancies, and the strength of nets.
//!
//! ```
//! use etendue_sampling::{Dim, Sampler, Slot, Sobol, stats, warp};
//!
//! // The irradiance under a sky of radiance 1 is π. Uniform directions: every sample is cos θ / (1/2π).
//! let sampler = Sobol::new(42, 256).with_replicates(16);
//! let mut means = [0.0; 16];
//! for index in 0..256 {
//!     let u = sampler.start(0, index).get_2d(Dim::bounce(0, Slot::Bsdf));
//!     let w = warp::hemisphere(u);
//!     means[index as usize % 16] += f64::from(w.z / warp::HEMISPHERE_PDF) / 16.0;
//! }
//! let estimate = stats::estimate_from_replicates(means).unwrap();
//! assert!((estimate.mean - std::f64::consts::PI).abs() < estimate.half_width(0.999));
//! assert!(estimate.standard_error < 0.02, "256 independent samples have 0.11");
//! ```
//!
//! Limits: [`Sobol`] and [`Halton`] stratify the first vertex jointly, later vertices each by itself; samples are 24 bits
//! (32 where `f64` is asked for). Nothing here knows rays or surfaces: the crate stands on `etendue-core` alone.

mod block;
mod dim;
mod distribution;
pub mod estimate;
mod halton;
mod hash;
mod independent;
mod latin;
pub mod mis;
mod multi_jittered;
mod permutation;
pub mod quality;
mod rejection;
pub mod remap;
mod rng;
mod sampler;
mod sobol;
pub mod stats;
mod strata;
mod stratified;
mod stream;
pub mod warp;

pub use dim::{Dim, Slot};
pub use distribution::{
    AliasSample, AliasTable, Distribution1d, Distribution2d, DistributionError, LinearDistribution1d,
    LinearSample1d, Sample1d, Sample2d,
};
pub use halton::{Halton, Hammersley, Scrambling, radical_inverse};
pub use hash::{mix, mix2};
pub use independent::Independent;
pub use latin::LatinHypercube;
pub use multi_jittered::CorrelatedMultiJittered;
pub use rejection::{Accepted, Rejection, RejectionError};
pub use rng::pcg32;
pub use sampler::{BounceDraws, Sampler, unit_f32};
pub use sobol::Sobol;
pub use stats::Moments;
pub use stratified::Stratified;
