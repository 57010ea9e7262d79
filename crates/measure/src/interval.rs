use etendue_sampling::stats::student_t;

/// Probability with which every interval of this crate is to hold the truth.
pub const CONFIDENCE: f64 = 0.95;

/// A measured number with its interval of [`CONFIDENCE`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The estimate.
    pub value: f64,
    /// The interval, in order; `None` where there are too few runs to say.
    pub interval: Option<[f64; 2]>,
}

impl Measured {
    /// A number that nothing is known about the error of.
    pub fn without_interval(value: f64) -> Self {
        Self { value, interval: None }
    }

    /// Whether the interval holds `x`; false without an interval.
    pub fn holds(&self, x: f64) -> bool {
        self.interval.is_some_and(|[low, high]| low <= x && x <= high)
    }

    /// The interval, or everything where there is none.
    pub fn bounds(&self) -> [f64; 2] {
        self.interval.unwrap_or([f64::NEG_INFINITY, f64::INFINITY])
    }

    /// The larger side of the interval over the value; `None` where that says nothing.
    pub fn relative_half_width(&self) -> Option<f64> {
        let [low, high] = self.interval?;
        let half = (high - self.value).max(self.value - low) / self.value.abs();
        half.is_finite().then_some(half)
    }

    /// The number in other units: times a positive factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        self.map_increasing(|x| factor * x)
    }

    pub(crate) fn map_increasing(self, f: impl Fn(f64) -> f64) -> Self {
        Self { value: f(self.value), interval: self.interval.map(|i| i.map(&f)) }
    }
}

/// A statistic of `runs` independent runs and its interval, by leaving out one run at a time (Tukey 1958) and
/// Student's t with one degree of freedom less than there are runs.
///
/// `statistic` is told which runs to use; `None` means that they do not suffice. True for smooth functions of means.
/// Statistics of pairs of runs get too wide an interval (Efron & Stein 1981): one of 95 % holds a variance in 95 to 97 %
/// of cases, and a squared bias of zero in 97 to 99 %.
pub fn jackknife(runs: usize, statistic: impl Fn(&[usize]) -> Option<f64>) -> Option<Measured> {
    let all: Vec<usize> = (0..runs).collect();
    let value = statistic(&all).filter(|v| v.is_finite())?;
    if runs < 2 {
        return Some(Measured::without_interval(value));
    }
    let left_out = |k: usize| -> Option<f64> {
        let kept: Vec<usize> = all.iter().copied().filter(|&i| i != k).collect();
        statistic(&kept).filter(|v| v.is_finite())
    };
    let Some(without): Option<Vec<f64>> = (0..runs).map(left_out).collect() else {
        return Some(Measured::without_interval(value));
    };
    let n = runs as f64;
    let mean = without.iter().sum::<f64>() / n;
    let squares: f64 = without.iter().map(|v| (v - mean).powi(2)).sum();
    let half = student_t(CONFIDENCE, runs as u64 - 1) * ((n - 1.0) / n * squares).sqrt();
    Some(Measured { value, interval: Some([value - half, value + half]) })
}

/// The same for a positive statistic, its interval taken on the logarithm: as wide a factor down as up.
pub fn jackknife_factor(runs: usize, statistic: impl Fn(&[usize]) -> Option<f64>) -> Option<Measured> {
    let log = jackknife(runs, |kept| statistic(kept).filter(|v| *v > 0.0).map(f64::ln))?;
    Some(log.map_increasing(f64::exp))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_mean_it_is_students_interval() {
        let x = [0.9, 1.1, 1.0, 1.0];
        let mean = |k: &[usize]| Some(k.iter().map(|&i| x[i]).sum::<f64>() / k.len() as f64);
        let m = jackknife(4, mean).unwrap();
        let e = etendue_sampling::stats::estimate_from_replicates(x).unwrap();
        assert_eq!(m.value, 1.0);
        let [low, high] = m.interval.unwrap();
        assert!(
            (high - 1.0 - e.half_width(0.95)).abs() < 1e-12 && (1.0 - low - e.half_width(0.95)).abs() < 1e-12
        );
    }

    #[test]
    fn too_few_runs_have_no_interval() {
        assert_eq!(jackknife(0, |k| k.first().map(|_| 1.0)), None);
        assert_eq!(jackknife(1, |_| Some(3.0)), Some(Measured::without_interval(3.0)));
        let needs_two = |k: &[usize]| (k.len() >= 2).then_some(1.0);
        assert_eq!(jackknife(2, needs_two), Some(Measured::without_interval(1.0)));
        assert_eq!(jackknife(3, |_| Some(f64::NAN)), None);
        assert!(!Measured::without_interval(1.0).holds(1.0));
    }

    #[test]
    fn factors_are_symmetric_on_the_logarithm() {
        let x = [1.0, 2.0, 4.0];
        let m = jackknife_factor(3, |k| {
            Some(k.iter().map(|&i| x[i]).product::<f64>().powf(1.0 / k.len() as f64))
        });
        let m = m.unwrap();
        let [low, high] = m.interval.unwrap();
        assert!((m.value - 2.0).abs() < 1e-12 && (low * high - 4.0).abs() < 1e-9 && low > 0.0);
        assert_eq!(jackknife_factor(3, |_| Some(-1.0)), None);
    }
}
