//! Transcendental functions with the same bits on every target.
//!
//! The standard library's `sin`, `exp`, `pow` … call the platform's mathematical library, whose last bits differ
//! between systems. These are built from IEEE + − × ÷ and √ on `f64`, integer operations and polynomials alone, so
//! an image is a function of its inputs on x86-64, AArch64 and WebAssembly alike. Every function evaluates in
//! double precision and rounds once to single precision.
//!
//! Largest errors against the exact value, in units in the last place of the f32 result (0.5 is perfect rounding),
//! asserted by `tests/math.rs`:
//!
//! | function | range | error |
//! |---|---|---|
//! | [`sin`], [`cos`], [`tan`] | every finite argument | 0.51 |
//! | [`sin_cos_turns`], [`sin_cos_pi`] | every finite argument | 0.51 |
//! | [`asin`], [`acos`] | `[-1, 1]` | 0.51 |
//! | [`atan`], [`atan2`] | everything | 0.51 |
//! | [`exp`], [`exp2`], [`exp_m1`] | everything, subnormal results included | 0.51 |
//! | [`ln`], [`log2`], [`ln_1p`] | every positive argument, subnormal ones included | 0.51 |
//! | [`pow`] | everything | 0.51 |
//! | [`cbrt`] | everything | 0.51 |
//!
//! NaN in, NaN out (except `pow(1, NaN)` and `pow(NaN, 0)`, which IEEE 754 fixes at 1). Signed zeros, infinities,
//! overflow and gradual underflow follow IEEE 754, section 9.2. The methods are the classic ones: argument
//! reduction by Cody & Waite (1980) and, for large angles, by Payne & Hanek (1983); minimax-like polynomials from
//! Chebyshev fits. [`wide`] holds the double-precision siblings for set-up work.
//!
//! ```
//! use etendue_core::math;
//! let (s, c) = math::sin_cos_turns(0.125);
//! assert_eq!((s, c), (std::f32::consts::FRAC_1_SQRT_2, std::f32::consts::FRAC_1_SQRT_2));
//! assert_eq!(math::pow(2.0, -3.0), 0.125);
//! ```

mod exponential;
mod inverse;
mod kernel;
mod power;
mod trig;
pub mod wide;

pub use exponential::{exp, exp_m1, exp2, ln, ln_1p, log2};
pub use inverse::{acos, asin, atan, atan2};
pub use power::{cbrt, pow};
pub use trig::{cos, sin, sin_cos, sin_cos_pi, sin_cos_turns, tan};
