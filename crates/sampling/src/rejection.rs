use crate::{Dim, Sampler};

/// Draws from a density that has no inverse distribution function by rejection (von Neumann 1951): a point of
/// [from, to) and a height below the bound M, drawn again until the height is below the density.
///
/// The bound is part of the bargain: with M below the density's maximum the peak is cut off, and what is drawn is
/// min(p, M) (of 4x³ on [0, 1] under M = 1 the mean is 0.722 instead of 0.8). A density above the bound is therefore an
/// error wherever one is met. It can be met only where a point falls, so prove the bound, do not probe it.
///
/// One attempt in M (to − from) / ∫p is accepted; the heights are multiples of 2⁻²⁴ M, so less than 3 · 10⁻⁸ M of the
/// density is rounding. The density need not be normalised. Points where it is zero are never drawn.
///
/// Rejection has a price beside the attempts: stratification is lost. A first attempt is a point of the sampler's set,
/// every later one independent of it, and which attempt counts is random; prefer an inverse where there is one
/// ([`Distribution1d`](crate::Distribution1d), [`LinearDistribution1d`](crate::LinearDistribution1d)).
///
/// ```
/// use etendue_sampling::{Dim, Rejection, RejectionError, Sampler, Sobol};
///
/// let semicircle = Rejection::new(|x: f64| (1.0 - x * x).max(0.0).sqrt(), -1.0, 1.0, 1.0)?;
/// let drawn = semicircle.sample(Sobol::new(1, 16).start(0, 3), Dim::FILM)?;
/// assert!(drawn.x.abs() < 1.0 && drawn.attempts >= 1);
/// # Ok::<(), RejectionError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Rejection<P> {
    density: P,
    from: f64,
    to: f64,
    bound: f64,
    max_attempts: u32,
}

/// A draw of [`Rejection`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accepted {
    /// The point.
    pub x: f64,
    /// The density there, as it was given.
    pub density: f64,
    /// How many points were drawn, this one included.
    pub attempts: u32,
}

/// Why nothing could be drawn by rejection.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RejectionError {
    /// An interval without a finite, positive length.
    #[error("[{from}, {to}) is no interval: both ends must be finite, the second above the first")]
    Interval {
        /// Its beginning.
        from: f64,
        /// Its end.
        to: f64,
    },
    /// A bound that is not finite and positive.
    #[error("the bound {bound} must be finite and positive")]
    Bound {
        /// As given.
        bound: f64,
    },
    /// The density is above its bound.
    #[error("the density {density} at {x} exceeds the bound {bound}: raise the bound to its maximum")]
    Exceeded {
        /// Where.
        x: f64,
        /// The density there.
        density: f64,
        /// As given.
        bound: f64,
    },
    /// The density is negative or NaN.
    #[error("the density at {x} is {density}, which must not be negative or NaN")]
    Density {
        /// Where.
        x: f64,
        /// The density there.
        density: f64,
    },
    /// Nothing was accepted.
    #[error(
        "no point accepted in {attempts} attempts: lower the bound to the maximum, or allow more attempts"
    )]
    Exhausted {
        /// As many as were allowed.
        attempts: u32,
    },
}

impl<P: Fn(f64) -> f64> Rejection<P> {
    /// Attempts allowed for one draw, unless said otherwise.
    pub const MAX_ATTEMPTS: u32 = 10_000;

    /// For `density` on [from, to), which is nowhere above `bound`.
    ///
    /// # Errors
    /// [`RejectionError::Interval`], [`RejectionError::Bound`].
    pub fn new(density: P, from: f64, to: f64, bound: f64) -> Result<Self, RejectionError> {
        // The length too must be finite.
        if !(from < to && (to - from).is_finite()) {
            return Err(RejectionError::Interval { from, to });
        }
        if !(bound > 0.0 && bound.is_finite()) {
            return Err(RejectionError::Bound { bound });
        }
        Ok(Self { density, from, to, bound, max_attempts: Self::MAX_ATTEMPTS })
    }

    /// The same with another limit to the attempts of one draw; 0 counts as 1.
    #[must_use]
    pub fn with_max_attempts(self, attempts: u32) -> Self {
        Self { max_attempts: attempts.max(1), ..self }
    }

    /// Share of the attempts that is accepted if the density integrates to 1: 1 / (M (to − from)).
    pub fn acceptance(&self) -> f64 {
        1.0 / (self.bound * (self.to - self.from))
    }

    /// A point for the numbers that `sampler` has at `dim` and the next, and for those of its forks 1, 2, … .
    ///
    /// # Errors
    /// [`RejectionError`]: the density is above the bound, negative or NaN at a point that was tried, or no attempt of
    /// those allowed succeeded.
    pub fn sample<S: Sampler>(&self, sampler: S, dim: Dim) -> Result<Accepted, RejectionError> {
        const HALF_CELL: f64 = 0.5 / 16_777_216.0;
        for attempt in 0..self.max_attempts {
            let at = if attempt == 0 { sampler } else { sampler.fork(attempt) };
            let u = at.get_2d(dim);
            let x = self.from + (self.to - self.from) * f64::from(u.x);
            // Rounding may reach the end, which is not in the interval.
            let x = if x < self.to { x } else { self.to.next_down() };
            let density = (self.density)(x);
            if density > self.bound {
                return Err(RejectionError::Exceeded { x, density, bound: self.bound });
            }
            if !(density >= 0.0) {
                return Err(RejectionError::Density { x, density });
            }
            // The middle of a cell of heights: rounds without a lean, and is above a density of zero.
            if (f64::from(u.y) + HALF_CELL) * self.bound < density {
                return Ok(Accepted { x, density, attempts: attempt + 1 });
            }
        }
        Err(RejectionError::Exhausted { attempts: self.max_attempts })
    }
}
