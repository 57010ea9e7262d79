//! Property tests for Monte Carlo estimators.
//!
//! A sampler, a BSDF, a light, a camera, a shape or an integrator is a promise about distributions, and a wrong one
//! still makes a picture. Every public trait of Étendue has a check suite here that holds a part of yours to its
//! contract in one call: are these numbers uniform, is `pdf` the density of `sample`, do a light's two ways of being
//! found agree, is this the right mean.
//!
//! ```
//! use etendue_bsdf::Lambert;
//! use etendue_core::Spectrum;
//! use etendue_testkit::{Budget, check_bsdf};
//!
//! let passed = check_bsdf(&Lambert::new(Spectrum::gray(0.8)), &Budget::default())?;
//! assert!(passed.statistical > 50 && passed.p() > 1e-4);
//!
//! // Makes energy: one reflectance of 1.02 is enough.
//! let failure = check_bsdf(&Lambert::new(Spectrum::gray(1.02)), &Budget::default()).unwrap_err();
//! assert_eq!(failure.test, "energy");
//! # Ok::<(), etendue_testkit::Failure>(())
//! ```
//!
//! # The suites
//!
//! What each sees at [`Budget::effort`] 1 on 99 of 100 seeds; the mutants in `tests/` are just that wrong.
//!
//! | suite | looks at | rejects | cannot see |
//! |---|---|---|---|
//! | [`check_sampler`] | purity, range, uniformity, independence, bias, error | a distribution off by 0.04, a correlation of 0.07, half more square error | draws it does not combine; 1 drawn once in a million |
//! | [`check_bsdf`] | density (χ²), mass, weight, mean weight, energy, adjoint and reciprocity, fused calls, odd input | 1 % in density or weight, 15 % rms in a lobe of any width | a factor below 1 on a delta lobe |
//! | [`check_light`] | density (χ²), mass, agreement with rays, irradiance, own shadow, bounds, power | 2 % in density or radiance, 20 % rms over the light, a quarter of the power | a spot that neither samples nor quadrature meet |
//! | [`check_picker`] | probabilities, frequencies (χ²), stretched numbers | a tenth of a probability of 0.1 | what single points of the scene would ask |
//! | [`check_camera`] | validity, declared needs, continuity, the way back | one film position in a thousand | whether the projection is the one meant |
//! | [`check_shape`] | hits, frames, derivatives, self-hits, area (Cauchy–Crofton), samples (χ²) | 5 % of the area, 20 % rms in the samples, 2 % of the normals | area of an unbounded shape |
//! | [`check_integrator`] | same bits from all calls, recorder, mean against a truth or another integrator | 7.5 standard errors, which it returns | bias below that; other scenes |
//! | [`check_estimator`] | the mean of anything that takes a seed | the same | the same |
//!
//! [`stats`] has the tests alone (χ², Kolmogorov–Smirnov, means, binomials), [`strategies`] the inputs for `proptest`:
//! parameters, rays, meshes, scenes, with the awkward ones among them. [`bench_accel`] times ray queries.
//!
//! # What a verdict means
//!
//! All statistical tests of one call share one level ([`Budget::alpha`], 10⁻⁶ by default; Šidák 1967), so a right part
//! fails on one seed in a million; and the same seed always gives the same verdict, so a test that was green stays
//! green. Quadrature and rounding errors are estimated and given to the part, never to the alarm. [`Passed::p`] is
//! uniform over seeds for a right part, or larger: the crate's own tests look at a hundred seeds of every built-in
//! part and at how many have p < 0.01, which finds a lean long before it is a failure.
//!
//! Power grows with the root of [`Budget::effort`]; 0.1 is quick enough for every change, 10 for the night.
//!
//! # Many cases, one level
//!
//! A property test over random parameters makes one call per case. [`Budget::shared`] gives each its part of the level:
//!
//! ```
//! use etendue_testkit::{Budget, check_bsdf, strategies};
//! use proptest::prelude::*;
//!
//! const CASES: u32 = 32;
//!
//! proptest! {
//!     # #![proptest_config(ProptestConfig { rng_seed: prop::test_runner::RngSeed::Fixed(1), failure_persistence: None, cases: CASES, ..ProptestConfig::default() })]
//!     # /*
//!     #![proptest_config(ProptestConfig::with_cases(CASES))]
//!     #[test]
//!     # */
//!     fn my_models_keep_the_contract(bsdf in strategies::bsdf(), seed in any::<u64>()) {
//!         let budget = Budget::default().shared(CASES as usize).seed(seed).effort(0.05);
//!         let verdict = check_bsdf(&bsdf, &budget);
//!         prop_assert!(verdict.is_ok(), "{bsdf:?}: {}", verdict.unwrap_err());
//!     }
//! }
//! # my_models_keep_the_contract();
//! ```
//!
//! Quasi-Monte Carlo samples are not independent: never test their scatter. [`check_estimator`] takes one mean per
//! *seed*, and judges those.
//!
//! # Limits
//!
//! A suite samples the contract, it does not prove it; a defect below the stated power goes unseen, and so does one
//! that sampling, density and value share (a model that is consistently of another material). Lobes narrower than
//! about 10⁻⁴ rad are at the end of single-precision directions: they are tested within what those can say.
//!
//! Place in the workspace: above all trait crates, outside of the facade; a dev-dependency, from `tests/` folders.

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
pub use check_bsdf::{check_bsdf, check_bsdf_up_to};
pub use check_camera::check_camera;
pub use check_estimator::{Radiance, Truth, check_estimator, check_integrator};
pub use check_light::{Seen, check_light, lit_point};
pub use check_picker::check_picker;
pub use check_sampler::check_sampler;
pub use check_shape::check_shape;
