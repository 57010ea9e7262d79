use super::{EstimateError, Estimation, Uniform};
use crate::stats::{Estimate, Moments, estimate_from_replicates};
use crate::{Dim, Sampler};

/// An integrand, and how points of its domain are drawn.
///
/// The domain `X` is what `warp` returns and what `pdf` and `f` take by value: a number, a pair of angles, a direction.
/// `warp` takes one uniform number or two (see [`Uniform`]); say which in its closure.
///
/// Nothing here can see an f ≠ 0 where no point is ever drawn: the estimate then converges to the rest of the integral.
#[derive(Clone, Copy, Debug)]
pub struct Integral<W, P, F> {
    /// From uniform numbers to the domain.
    pub warp: W,
    /// Density of what `warp` draws, in the measure that the integral is over; it integrates to 1.
    pub pdf: P,
    /// The integrand.
    pub f: F,
    /// Which number of the sampler is drawn; [`Dim::FILM`] at first.
    pub dim: Dim,
}

impl<W, P, F> Integral<W, P, F> {
    /// ∫ f over the domain that `warp` draws from with density `pdf`.
    pub fn new<U, X>(warp: W, pdf: P, f: F) -> Self
    where
        U: Uniform,
        X: Copy,
        W: Fn(U) -> X,
        P: Fn(X) -> f64,
        F: Fn(X) -> f64,
    {
        Self { warp, pdf, f, dim: Dim::FILM }
    }

    /// The same with another number of the sampler.
    #[must_use]
    pub fn with_dim(self, dim: Dim) -> Self {
        Self { dim, ..self }
    }

    /// One sample: f/p at the point of `index` in `stream`. 0 where f and p both are: a point of density zero may be
    /// drawn at the border of a domain, with probability zero but for rounding.
    ///
    /// # Errors
    /// [`EstimateError`] where the density is negative, zero under an f that is not, or f/p is not finite.
    #[inline]
    pub fn sample<S, U, X>(&self, sampler: S, stream: u64, index: u64) -> Result<f64, EstimateError>
    where
        S: Sampler,
        U: Uniform,
        X: Copy,
        W: Fn(U) -> X,
        P: Fn(X) -> f64,
        F: Fn(X) -> f64,
    {
        let x = (self.warp)(U::draw(&sampler.start(stream, index), self.dim));
        let (pdf, f) = ((self.pdf)(x), (self.f)(x));
        if !(pdf >= 0.0) {
            return Err(EstimateError::Density { index, pdf });
        }
        if pdf == 0.0 {
            return if f == 0.0 { Ok(0.0) } else { Err(EstimateError::Uncovered { index, f }) };
        }
        let value = f / pdf;
        if value.is_finite() { Ok(value) } else { Err(EstimateError::NotFinite { index, f, pdf }) }
    }

    /// The mean of the first `samples` of `stream`, its error from the scatter of the sampler's replicates.
    ///
    /// # Errors
    /// [`EstimateError`]: the sampler has fewer than two replicates, `samples` is no positive multiple of their number,
    /// or a sample is unfit (see [`Integral::sample`]).
    pub fn run<S, U, X>(&self, sampler: S, stream: u64, samples: u64) -> Result<Estimation, EstimateError>
    where
        S: Sampler,
        U: Uniform,
        X: Copy,
        W: Fn(U) -> X,
        P: Fn(X) -> f64,
        F: Fn(X) -> f64,
    {
        let replicates = sampler.replicates();
        if replicates < 2 {
            return Err(EstimateError::TooFewReplicates { replicates });
        }
        if samples == 0 || !samples.is_multiple_of(replicates.into()) {
            return Err(EstimateError::Uneven { samples, replicates });
        }
        let mut each = vec![Moments::default(); replicates as usize];
        for index in 0..samples {
            let value = self.sample(sampler, stream, index)?;
            each[(index % u64::from(replicates)) as usize].add(value);
        }
        let all = each.iter().copied().fold(Moments::default(), Moments::merged);
        // Two replicates at least, so there is one.
        let estimate = estimate_from_replicates(each.iter().map(Moments::mean)).unwrap_or(Estimate {
            mean: all.mean(),
            standard_error: f64::INFINITY,
            replicates: 0,
        });
        Ok(Estimation { estimate, variance: all.variance(), samples })
    }

    /// The running estimate: the moments of one sample, of two, of three and so on without an end. Stops at the first
    /// that is unfit.
    ///
    /// Of a sampler without replicates it is the estimate as it grows; [`Moments::standard_error`] is its error only
    /// where the points are independent.
    ///
    /// ```
    /// use etendue_sampling::{Independent, estimate::Integral};
    /// let integral = Integral::new(|u: f64| u, |_| 1.0, |x| 4.0 * x.powi(3));
    /// let means: Vec<f64> = integral.running(Independent::new(3, 1), 0).take(2000).map(|m| m.unwrap().mean()).collect();
    /// assert!((means[1999] - 1.0).abs() < 0.1);
    /// ```
    pub fn running<S, U, X>(
        &self,
        sampler: S,
        stream: u64,
    ) -> impl Iterator<Item = Result<Moments, EstimateError>>
    where
        S: Sampler,
        U: Uniform,
        X: Copy,
        W: Fn(U) -> X,
        P: Fn(X) -> f64,
        F: Fn(X) -> f64,
    {
        let mut so_far = Some(Moments::default());
        (0..).map_while(move |index| {
            let mut moments = so_far?;
            let next = self.sample(sampler, stream, index).map(|value| {
                moments.add(value);
                moments
            });
            so_far = next.ok();
            Some(next)
        })
    }
}
