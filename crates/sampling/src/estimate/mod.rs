//! Monte Carlo estimates of integrals: any integrand, any density, any sampler, and an error bar that is true.
//!
//! [`Integral`] joins an integrand `f` with a way of drawing points: a map from uniform numbers to the domain, and the
//! density of what it draws. The mean of `f / p` over the points is ∫ f on average (the primary estimator; Veach
//! 1997, eq. 2.14) *if* p > 0 wherever f ≠ 0. Its variance is that of `f / p`, over N for N independent points; a
//! density in the likeness of f lowers it, and p = f / ∫ f leaves none (for an f of one sign).
//!
//! ```
//! use etendue_sampling::estimate::{EstimateError, Integral};
//! use etendue_sampling::{Independent, Sobol};
//!
//! // ∫ 4x³ over [0, 1] is 1. Four densities, each with its inverse distribution function and its variance.
//! let f = |x: f64| 4.0 * x.powi(3);
//! let random = Independent::new(1, 65_536).with_replicates(16);
//! let uniform = Integral::new(|u: f64| u, |_| 1.0, f).run(random, 0, 65_536)?;
//! let linear = Integral::new(f64::sqrt, |x| 2.0 * x, f).run(random, 0, 65_536)?;
//! let square = Integral::new(f64::cbrt, |x| 3.0 * x * x, f).run(random, 0, 65_536)?;
//! let alike = Integral::new(|u: f64| u.sqrt().sqrt(), f, f).run(random, 0, 65_536)?;
//! for (e, variance) in [(uniform, 9.0 / 7.0), (linear, 1.0 / 3.0), (square, 1.0 / 15.0), (alike, 0.0)] {
//!     assert!((e.variance - variance).abs() <= 0.05 * variance);
//!     assert!((e.mean() - 1.0).abs() <= e.half_width(0.999_9));
//! }
//!
//! // Stratified points: the variance of one sample is the same, the error a thousandth.
//! let sobol = Integral::new(|u: f64| u, |_| 1.0, f).run(Sobol::new(1, 65_536).with_replicates(16), 0, 65_536)?;
//! assert!((sobol.variance - uniform.variance).abs() < 0.05);
//! assert!(sobol.standard_error() < 1e-3 * uniform.standard_error());
//! # Ok::<(), EstimateError>(())
//! ```
//!
//! The domain may be anything. The irradiance (W·m⁻²) under a hemisphere of radiance L is π L, whatever the density; in
//! (θ, φ) the area of the sphere enters the integrand as sin θ:
//!
//! ```
//! use std::f32::consts::{FRAC_PI_2, PI, TAU};
//! use etendue_sampling::estimate::{EstimateError, Integral};
//! use etendue_sampling::{Independent, warp};
//! use etendue_core::{Vec2, Vec3A, math};
//!
//! let l = 2.0;
//! let f = |w: Vec3A| f64::from(l * w.z);
//! let solid_angle = Integral::new(warp::hemisphere, |_| warp::HEMISPHERE_PDF.into(), f);
//! let cosine = Integral::new(warp::cosine, |w: Vec3A| warp::cosine_pdf(w.z).into(), f);
//! let angles = Integral::new(
//!     |u: Vec2| Vec2::new(FRAC_PI_2 * u.x, TAU * u.y),
//!     |_| f64::from(1.0 / (PI * PI)),
//!     |a| f64::from(l * math::cos(a.x) * math::sin(a.x)),
//! );
//! let random = Independent::new(1, 65_536).with_replicates(16);
//! let (truth, pi) = (2.0 * std::f64::consts::PI, std::f64::consts::PI);
//! for (e, variance) in [
//!     (solid_angle.run(random, 0, 65_536)?, pi.powi(2) / 3.0),
//!     (cosine.run(random, 0, 65_536)?, 0.0),
//!     (angles.run(random, 0, 65_536)?, pi.powi(4) / 8.0 - pi.powi(2)),
//! ] {
//!     assert!((e.mean() - truth).abs() <= e.half_width(0.999_9) + 1e-6);
//!     assert!((e.variance - 4.0 * variance).abs() <= 0.05 * 4.0 * variance + 1e-9);
//! }
//! # Ok::<(), EstimateError>(())
//! ```

mod integral;
mod result;
mod uniform;

pub use integral::Integral;
pub use result::{EstimateError, Estimation};
pub use uniform::Uniform;
