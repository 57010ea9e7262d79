//! Property tests for Monte Carlo estimators.
//!
//! Every public trait of Étendue has a check suite here, so that one call tests a part of yours against its own
//! contract: that a sampler's numbers are uniform and independent, that a BSDF's `pdf` is the density of its
//! `sample`, that a light's two ways of being found agree, that an integrator's mean is the right one.
//!
//! ```
//! use etendue_bsdf::Lambert;
//! use etendue_core::Spectrum;
//! use etendue_testkit::{Budget, check_bsdf};
//!
//! let passed = check_bsdf(&Lambert::new(Spectrum::gray(0.8)), &Budget::default())?;
//! assert!(passed.tests > 10);
//! # Ok::<(), etendue_testkit::Failure>(())
//! ```
//!
//! What a verdict means. All tests of one call share one significance level ([`Budget::alpha`], 10⁻⁶ by default)
//! among them: a right part fails once in a million *seeds*, and the same seed always gives the same verdict. The
//! suites are tested themselves by mutants, deliberately wrong parts that they must reject.
//!
//! Limits: a suite samples the contract, it does not prove it. A defect below the stated power goes unseen. This
//! crate uses all trait crates and stands outside of the facade; name it as a dev-dependency.

mod bench_accel;
mod budget;
mod check_bsdf;
mod check_camera;
mod check_estimator;
mod check_light;
mod check_picker;
mod check_sampler;
mod check_shape;
mod cube;
mod partition;
mod rounding;
pub mod stats;
pub mod strategies;

pub use bench_accel::{AccelSpeed, bench_accel};
pub use budget::{Budget, Failure, Outcome, Passed};
pub use check_bsdf::check_bsdf;
pub use check_camera::check_camera;
pub use check_estimator::{Radiance, Truth, check_estimator, check_integrator};
pub use check_light::{Seen, check_light, lit_point};
pub use check_picker::check_picker;
pub use check_sampler::check_sampler;
pub use check_shape::check_shape;
