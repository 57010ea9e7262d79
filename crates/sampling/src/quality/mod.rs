//! How evenly a point set fills the unit cube: discrepancies, and the strength of nets.
//!
//! Points are slices of arrays, coordinates in [0, 1). Every discrepancy is the discrepancy itself, a *root*
//! mean square where it is a norm in L2, never its square; all sums are in double precision and in a fixed order.
//!
//! | measure | worst or mean | boxes | cost |
//! |---|---|---|---|
//! | [`star_discrepancy_1d`] | worst | from the origin | O(N log N) |
//! | [`star_discrepancy_2d`], [`star_discrepancy`] | worst | from the origin | O(N²), O(N^D) |
//! | [`star_discrepancy_bounds`] | worst, from both sides | from the origin | of a grid |
//! | [`l2_star`] | mean | from the origin | O(D N²) |
//! | [`centred_l2`] | mean | from the nearest corner, in all faces | O(D N²) |
//! | [`wrap_around_l2`] | mean | anywhere on the torus, in all faces | O(D N²) |
//! | [`mixture`] | mean | a mixture of those two | O(D N²) |
//! | [`net_t_by_counting`], [`net_t_by_rank`] | worst | dyadic, of 2^t points each | see there |
//!
//! ```
//! use etendue_sampling::{Dim, Independent, Sampler, Sobol, quality};
//!
//! fn film(sampler: impl Sampler) -> Vec<[f64; 2]> {
//!     let point = |index| sampler.start(7, index).get_2d(Dim::FILM);
//!     (0..256).map(point).map(|p| [f64::from(p.x), f64::from(p.y)]).collect()
//! }
//! let sobol = quality::star_discrepancy_2d(&film(Sobol::new(1, 256)))?;
//! let random = quality::star_discrepancy_2d(&film(Independent::new(1, 256)))?;
//! assert!(sobol < 0.02 && random > 0.05);
//! # Ok::<(), quality::QualityError>(())
//! ```

mod bounds;
mod error;
mod l2;
mod net;
mod rank;
mod star;

pub use bounds::{StarBounds, star_discrepancy_bounds};
pub use error::QualityError;
pub use l2::{centred_l2, l2_star, mixture, wrap_around_l2};
pub use net::net_t_by_counting;
pub use rank::net_t_by_rank;
pub use star::{star_discrepancy, star_discrepancy_1d, star_discrepancy_2d};
