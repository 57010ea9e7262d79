//! Run time against error: what an estimator costs and how wrong it still is.
//!
//! * [`convergence`], [`race`]: error against samples, rays, seconds and CPU-seconds of one estimator, or of several in
//!   turns. A [`Curve`] knows its slope, the time to an error and its efficiency; a [`Point`] splits the error into
//!   variance, bias and the reference's own part. Everything has an interval.
//! * [`compare`]: how far one picture is from a reference: RMSE, relMSE, trimmed.
//! * [`flip`]: how different the two look to a viewer, pixel by pixel. [`colour_map`]: colours for such maps.
//! * [`gonio`]: the BRDF of a material or of micro-geometry, measured.
//! * [`report`]: plots, tables and pictures as one page.
//!
//! ```
//! use std::{error::Error, ops::Range};
//! use etendue_core::Clock;
//! use etendue_measure::{Axis, Budget, Clocks, Contender, Drawn, Estimator, Metric, Reference, convergence};
//! use etendue_sampling::{Dim, Independent, Sampler};
//!
//! /// Σ 2u over random u in 16 pixels: mean 1, variance 1/3 a sample.
//! struct Line { sampler: Independent, sums: [f64; 16], count: u64 }
//!
//! impl Estimator for Line {
//!     fn draw(&mut self, indices: Range<u64>) -> Result<Drawn, Box<dyn Error + Send + Sync>> {
//!         for index in indices.clone() {
//!             for (pixel, sum) in self.sums.iter_mut().enumerate() {
//!                 *sum += 2.0 * f64::from(self.sampler.start(pixel as u64, index).get_1d(Dim::TIME));
//!             }
//!             self.count += 1;
//!         }
//!         Ok(Drawn { samples: 16 * (indices.end - indices.start), ..Drawn::default() })
//!     }
//!     fn reset(&mut self) {
//!         (self.sums, self.count) = ([0.0; 16], 0);
//!     }
//!     fn picture(&self) -> Vec<[f32; 3]> {
//!         self.sums.iter().map(|s| [(s / self.count as f64) as f32; 3]).collect()
//!     }
//! }
//!
//! struct NoClock;
//! impl Clock for NoClock {
//!     fn seconds(&self) -> f64 { 0.0 }
//! }
//!
//! let run = |seed| -> Box<dyn Estimator> {
//!     Box::new(Line { sampler: Independent::new(seed, 1), sums: [0.0; 16], count: 0 })
//! };
//! let line = Contender { name: "2u".into(), runs: (1..=8).map(run).collect() };
//! let truth = Reference::exact([4, 4], vec![[1.0; 3]; 16]);
//! let clocks = Clocks { wall: &NoClock, cpu: None };
//! let curve = convergence(line, Some(&truth), &Budget { spp: 256, seconds: None }, clocks)?;
//!
//! let last = curve.points.last().unwrap();
//! assert!(last.variance(Metric::Absolute).unwrap().holds(1.0 / 3.0 / 256.0));
//! assert!(last.bias_squared(Metric::Absolute).unwrap().holds(0.0));
//! assert!(curve.slope(Metric::Absolute, Axis::Samples).unwrap().holds(-1.0));
//! # Ok::<(), Box<dyn Error>>(())
//! ```
//!
//! Limits: intervals rest on the scatter of a few runs; five are few, two say little. Uses core, sampling, geometry,
//! material, light, camera, scene and integrator.

mod axes;
pub mod colour_map;
mod compare;
mod contender;
mod convergence;
mod curve;
pub mod flip;
pub mod gonio;
mod gram;
mod interval;
mod point;
mod reference;
pub mod report;

pub use axes::{Axis, Costs, Metric};
pub use compare::{CompareError, Comparison, compare};
pub use contender::{Contender, Drawn, Estimator, RenderRun};
pub use convergence::{Budget, Clocks, MeasureError, convergence, race};
pub use curve::{Curve, Known, ToError};
pub use interval::{CONFIDENCE, Measured, jackknife, jackknife_factor};
pub use point::Point;
pub use reference::{Reference, Residual};
