use crate::stats::Estimate;

/// An integral estimated from samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimation {
    /// Mean and standard error, from the scatter of the replicates.
    pub estimate: Estimate,
    /// Variance of *one* sample f/p. For N independent samples the mean has an N-th of it; of stratified points it says
    /// only what was there to be stratified away, and the error is never taken from it. Their scatter overstates it by
    /// at most N/(N − 1).
    pub variance: f64,
    /// How many samples, over all replicates.
    pub samples: u64,
}

impl Estimation {
    /// The estimate of the integral.
    pub fn mean(&self) -> f64 {
        self.estimate.mean
    }

    /// Standard error of [`Estimation::mean`].
    pub fn standard_error(&self) -> f64 {
        self.estimate.standard_error
    }

    /// Half the width of the confidence interval; see [`Estimate::half_width`].
    pub fn half_width(&self, confidence: f64) -> f64 {
        self.estimate.half_width(confidence)
    }

    /// The interval that holds the integral with probability `confidence`, its lower end first.
    pub fn interval(&self, confidence: f64) -> [f64; 2] {
        let half = self.half_width(confidence);
        [self.mean() - half, self.mean() + half]
    }
}

/// Why an integral cannot be estimated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EstimateError {
    /// No scatter to take the error from.
    #[error("{replicates} replicates show no scatter: make the sampler with_replicates(16), or 2 at least")]
    TooFewReplicates {
        /// Of the sampler.
        replicates: u32,
    },
    /// Replicates of unequal size, or none.
    #[error("{samples} samples are not dealt evenly to {replicates} replicates: take a positive multiple")]
    Uneven {
        /// Asked for.
        samples: u64,
        /// Of the sampler.
        replicates: u32,
    },
    /// A density that is none.
    #[error("sample {index}: the density is {pdf}, which must not be negative or NaN")]
    Density {
        /// Which sample.
        index: u64,
        /// The density there.
        pdf: f64,
    },
    /// The point was drawn although its density is said to be zero.
    #[error("sample {index}: f = {f} where the density is 0: map and density do not belong together")]
    Uncovered {
        /// Which sample.
        index: u64,
        /// The integrand there.
        f: f64,
    },
    /// f/p is infinite or NaN.
    #[error("sample {index}: f = {f} over a density of {pdf} is not finite")]
    NotFinite {
        /// Which sample.
        index: u64,
        /// The integrand there.
        f: f64,
        /// The density there.
        pdf: f64,
    },
}
