use crate::compare::{EPSILON, finite, trimmed_mean};
use crate::gram::Gram;
use crate::interval::{Measured, jackknife, jackknife_factor};
use crate::{Axis, CompareError, Costs, Metric, Reference, Residual};

/// Error and cost of several independent runs of one estimator at one number of samples.
///
/// An error against a reference is the sum of three parts: the variance of a run, the square of its bias
/// (textbook Eq. 14.5), and the error of the reference itself. The first is known from pairs of runs alone, the last
/// from the reference; what remains is bias. All intervals are over runs, see [`jackknife`].
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Samples per pixel.
    pub spp: u64,
    /// What each run has cost.
    pub costs: Vec<Costs>,
    /// Pixels that were left out because the reference or one of the runs was no number there.
    pub not_finite: u64,
    /// Pixels that were not.
    compared: usize,
    relative: Gram,
    absolute: Gram,
    /// Trimmed relMSE of each run.
    trimmed: Vec<f64>,
    /// Trimmed variance of all runs, and then with each of them left out.
    trimmed_variance: Vec<Option<f64>>,
    /// `None` without a reference: then only variance is known.
    residual: Option<Residual>,
}

impl Point {
    /// What the pictures of independent runs tell, linear radiance row by row. Without a reference their mean takes its
    /// place in the weights, and only variance is known.
    ///
    /// # Errors
    /// No pictures; pictures, reference and costs that do not fit together.
    pub fn new(
        spp: u64,
        costs: Vec<Costs>,
        pictures: &[Vec<[f32; 3]>],
        reference: Option<&Reference>,
    ) -> Result<Self, CompareError> {
        let Some(first) = pictures.first().filter(|_| costs.len() == pictures.len()) else {
            return Err(CompareError::Runs { pictures: pictures.len(), costs: costs.len() });
        };
        let pixels = reference.map_or(first.len(), |r| r.rgb.len());
        if let Some(other) = pictures.iter().find(|p| p.len() != pixels) {
            return Err(CompareError::Size(other.len(), pixels));
        }
        Ok(Self::of_equal(spp, costs, pictures, reference))
    }

    /// The same for parts of one length, at least one picture among them.
    fn of_equal(
        spp: u64,
        costs: Vec<Costs>,
        pictures: &[Vec<[f32; 3]>],
        reference: Option<&Reference>,
    ) -> Self {
        let runs = pictures.len();
        let pixels = pictures.first().map_or(0, Vec::len);
        let (mut relative, mut absolute) = (Gram::new(runs), Gram::new(runs));
        let mut errors = vec![Vec::with_capacity(pixels); runs];
        let mut variances = vec![Vec::with_capacity(pixels); runs + 1];
        let mut not_finite = 0;
        let mut deviations = vec![0.0; runs];
        for pixel in 0..pixels {
            let given = reference.map(|r| r.rgb[pixel]);
            if !pictures.iter().all(|p| finite(&p[pixel])) || !given.is_none_or(|r| finite(&r)) {
                not_finite += 1;
                continue;
            }
            let mut error = vec![0.0; runs];
            let mut variance = vec![0.0; runs + 1];
            for c in 0..3 {
                let r = match given {
                    Some(r) => f64::from(r[c]),
                    None => pictures.iter().map(|p| f64::from(p[pixel][c])).sum::<f64>() / runs as f64,
                };
                for (d, p) in deviations.iter_mut().zip(pictures) {
                    *d = f64::from(p[pixel][c]) - r;
                }
                let weight = 1.0 / (r * r + EPSILON);
                relative.add(&deviations, weight);
                absolute.add(&deviations, 1.0);
                for (e, d) in error.iter_mut().zip(&deviations) {
                    *e += d * d * weight / 3.0;
                }
                for (left_out, v) in variance.iter_mut().enumerate() {
                    *v += sample_variance(&deviations, left_out.checked_sub(1)) * weight / 3.0;
                }
            }
            errors.iter_mut().zip(error).for_each(|(all, e)| all.push(e));
            variances.iter_mut().zip(variance).for_each(|(all, v)| all.push(v));
        }
        let compared = errors.first().map_or(0, Vec::len);
        let values = 3.0 * compared.max(1) as f64;
        relative.divide(values);
        absolute.divide(values);
        let trimmed = errors.iter_mut().map(|e| trimmed_mean(e)).collect();
        let enough = |left_out: usize| runs - usize::from(left_out > 0) >= 2;
        let trimmed_variance =
            variances.iter_mut().enumerate().map(|(i, v)| enough(i).then(|| trimmed_mean(v))).collect();
        let residual = reference.map(|r| r.residual);
        Self { spp, costs, not_finite, compared, relative, absolute, trimmed, trimmed_variance, residual }
    }

    /// Independent runs.
    pub fn runs(&self) -> usize {
        self.costs.len()
    }

    fn raw(&self, metric: Metric, kept: &[usize]) -> Option<f64> {
        self.residual.filter(|_| self.compared > 0)?;
        match metric {
            Metric::Relative => self.relative.square(kept),
            Metric::Absolute => self.absolute.square(kept),
            Metric::Trimmed => (!kept.is_empty())
                .then(|| kept.iter().map(|&k| self.trimmed[k]).sum::<f64>() / kept.len() as f64),
        }
    }

    fn variance_of(&self, metric: Metric, kept: &[usize]) -> Option<f64> {
        if self.compared == 0 {
            return None;
        }
        match metric {
            Metric::Relative => self.relative.variance(kept),
            Metric::Absolute => self.absolute.variance(kept),
            Metric::Trimmed => {
                // Known of all runs, and with one of them left out.
                let mut left_out = (0..self.runs()).filter(|k| !kept.contains(k));
                let place = left_out.next().map_or(0, |k| k + 1);
                left_out.next().is_none().then(|| self.trimmed_variance.get(place).copied().flatten())?
            }
        }
    }

    fn residual(&self, metric: Metric) -> Option<f64> {
        self.residual.map(|r| match metric {
            Metric::Relative => r.relative,
            Metric::Trimmed => r.trimmed,
            Metric::Absolute => r.absolute,
        })
    }

    /// Error without the reference's part; the variance where there is no reference.
    pub(crate) fn error_of(&self, metric: Metric, kept: &[usize]) -> Option<f64> {
        match self.residual(metric) {
            Some(residual) => Some(self.raw(metric, kept)? - residual),
            None => self.variance_of(metric, kept),
        }
        .filter(|e| *e > 0.0)
    }

    pub(crate) fn cost_of(&self, axis: Axis, kept: &[usize]) -> Option<f64> {
        let costs: Option<Vec<f64>> = kept.iter().map(|&k| self.costs[k].on(axis)).collect();
        costs.filter(|c| !c.is_empty()).map(|c| c.iter().sum::<f64>() / c.len() as f64)
    }

    /// The mean error of one run, as it is measured against the reference; `None` without one.
    pub fn error(&self, metric: Metric) -> Option<Measured> {
        jackknife(self.runs(), |kept| self.raw(metric, kept))
    }

    /// The error of each run, as it is measured against the reference; empty without one.
    pub fn errors_of_runs(&self, metric: Metric) -> Vec<f64> {
        (0..self.runs()).filter_map(|k| self.raw(metric, &[k])).collect()
    }

    /// The mean error of one run against the truth: without the reference's own part. Without a reference it is the
    /// variance. `None` where the reference is worse than the picture, or a single run has no reference.
    pub fn corrected(&self, metric: Metric) -> Option<Measured> {
        jackknife(self.runs(), |kept| self.error_of(metric, kept))
    }

    /// Whether more than half of the error is the reference's own, so that the number says little about the picture.
    pub fn is_limited_by_reference(&self, metric: Metric) -> bool {
        let all: Vec<usize> = (0..self.runs()).collect();
        match (self.raw(metric, &all), self.residual(metric)) {
            (Some(error), Some(residual)) => residual > 0.5 * error,
            _ => false,
        }
    }

    /// Variance of one run, from the differences of runs: no reference is needed. `None` below two runs.
    pub fn variance(&self, metric: Metric) -> Option<Measured> {
        jackknife(self.runs(), |kept| self.variance_of(metric, kept))
    }

    /// Square of the bias: the part of the error that neither variance nor the reference's own error explains. Zero
    /// within its interval for an unbiased estimator; scatters around zero, so that it can be negative. `None` without
    /// a reference or below two runs, and trimmed: the pixels where a run is worst are others than those where runs
    /// differ most, and an error without the ones is not the sum of parts without the others.
    pub fn bias_squared(&self, metric: Metric) -> Option<Measured> {
        let residual = self.residual(metric).filter(|_| self.compared > 0)?;
        let gram = match metric {
            Metric::Relative => &self.relative,
            Metric::Absolute => &self.absolute,
            Metric::Trimmed => return None,
        };
        jackknife(self.runs(), |kept| Some(gram.common(kept)? - residual))
    }

    /// Mean cost of one run; `None` where it was not measured.
    pub fn cost(&self, axis: Axis) -> Option<Measured> {
        jackknife(self.runs(), |kept| self.cost_of(axis, kept))
    }

    /// Median cost of one run; `None` where it was not measured.
    pub fn median_cost(&self, axis: Axis) -> Option<f64> {
        let mut costs: Vec<f64> = self.costs.iter().map(|c| c.on(axis)).collect::<Option<_>>()?;
        costs.sort_unstable_by(f64::total_cmp);
        let n = costs.len();
        if n == 0 { None } else { Some(0.5 * (costs[(n - 1) / 2] + costs[n / 2])) }
    }

    pub(crate) fn efficiency_of(&self, metric: Metric, axis: Axis, kept: &[usize]) -> Option<f64> {
        Some(1.0 / (self.error_of(metric, kept)? * self.cost_of(axis, kept)?))
    }

    /// Efficiency: 1 / (error × cost), the error corrected for the reference's own. Twice the efficiency needs half the
    /// time to the same error, as long as the error falls as one over the samples.
    pub fn efficiency(&self, metric: Metric, axis: Axis) -> Option<Measured> {
        jackknife_factor(self.runs(), |kept| self.efficiency_of(metric, axis, kept))
    }

    /// How many times as efficient as `other` this is. Run by run the two are taken as neighbours in time, so that a
    /// machine that is slow for a while is slow for both.
    pub fn efficiency_over(&self, other: &Self, metric: Metric, axis: Axis) -> Option<Measured> {
        jackknife_factor(self.runs().min(other.runs()), |kept| {
            Some(self.efficiency_of(metric, axis, kept)? / other.efficiency_of(metric, axis, kept)?)
        })
    }

    /// How many times as much as `other` this costs.
    pub fn cost_over(&self, other: &Self, axis: Axis) -> Option<Measured> {
        jackknife_factor(self.runs().min(other.runs()), |kept| {
            Some(self.cost_of(axis, kept)? / other.cost_of(axis, kept)?)
        })
    }
}

/// Unbiased variance of the values, one of them left out or none; 0 below two.
fn sample_variance(values: &[f64], left_out: Option<usize>) -> f64 {
    let kept = || values.iter().enumerate().filter(|(k, _)| Some(*k) != left_out).map(|(_, v)| *v);
    let n = values.len() - usize::from(left_out.is_some());
    if n < 2 {
        return 0.0;
    }
    let mean = kept().sum::<f64>() / n as f64;
    kept().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1) as f64
}
