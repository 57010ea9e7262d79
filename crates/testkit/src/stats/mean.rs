use etendue_sampling::Moments;

use super::{p_of_t, p_of_z};

/// The outcome of a test about means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanTest {
    /// What was estimated.
    pub estimate: f64,
    /// What it should be.
    pub truth: f64,
    /// Standard error of the difference.
    pub standard_error: f64,
    /// Two-sided p-value.
    pub p: f64,
    /// Whether one sample carries so much of the sum that the variance cannot be trusted: then `p` means nothing and
    /// the test must not pass.
    pub untrustworthy: bool,
}

impl MeanTest {
    /// Whether the data speak against equality at level `alpha`, or cannot be trusted to speak at all.
    pub fn rejects(&self, alpha: f64) -> bool {
        self.untrustworthy || self.p.is_nan() || self.p < alpha
    }

    fn exact(estimate: f64, truth: f64) -> Self {
        // Without variance only equality up to the rounding of f32 samples can be asked.
        let near = (estimate - truth).abs() <= 1e-5 * truth.abs().max(estimate.abs());
        let p = if near { 1.0 } else { 0.0 };
        Self { estimate, truth, standard_error: 0.0, p, untrustworthy: false }
    }
}

/// Largest share of the sum of magnitudes that one of many samples may carry.
const LARGEST_SHARE: f64 = 0.05;
/// Largest share among a few; one of two or three may well carry most.
const LARGEST_SHARE_OF_FEW: f64 = 0.5;
/// Fewer than this are too few to say that one of them dominates.
const FEW: usize = 8;
/// From this many samples on the normal law stands in for Student's, and one sample must not dominate.
const MANY: usize = 200;

/// Whether one sample carries so much that their variance says nothing.
fn dominated(samples: &[f64]) -> bool {
    let magnitudes = samples.iter().map(|x| x.abs());
    let (largest, total) = magnitudes.fold((0.0f64, 0.0), |(largest, total), x| (largest.max(x), total + x));
    match samples.len() {
        n if n >= MANY => largest > LARGEST_SHARE * total,
        n if n >= FEW => largest > LARGEST_SHARE_OF_FEW * total,
        _ => false,
    }
}

fn moments(samples: &[f64]) -> Moments {
    samples.iter().copied().collect()
}

/// Whether the mean of independent samples is `truth` (z-test; t below 200 samples). At σ equal to the mean and
/// n = 10⁶ a bias of 0.5 % is 5 standard errors.
///
/// ```
/// let dice: Vec<f64> = (0..600).map(|i| f64::from(i * 7 % 6 + 1)).collect();
/// assert!(!etendue_testkit::stats::mean_test(&dice, 3.5).rejects(1e-6));
/// assert!(etendue_testkit::stats::mean_test(&dice, 4.0).rejects(1e-6));
/// ```
pub fn mean_test(samples: &[f64], truth: f64) -> MeanTest {
    let m = moments(samples);
    let (estimate, standard_error) = (m.mean(), m.standard_error());
    if samples.len() < 2 || !estimate.is_finite() {
        return MeanTest { estimate, truth, standard_error, p: f64::NAN, untrustworthy: true };
    }
    // Differences at the level of f32 rounding are not scatter.
    if standard_error <= 1e-7 * estimate.abs() {
        return MeanTest::exact(estimate, truth);
    }
    let z = (estimate - truth) / standard_error;
    let n = samples.len();
    let p = if n < MANY { p_of_t(z, n as f64 - 1.0) } else { p_of_z(z) };
    MeanTest { estimate, truth, standard_error, p, untrustworthy: dominated(samples) }
}

/// Whether two sets of independent samples have one mean, their variances unknown and unequal (Welch 1947).
pub fn welch_test(a: &[f64], b: &[f64]) -> MeanTest {
    let untrustworthy = dominated(a) || dominated(b);
    let (a, b) = (moments(a), moments(b));
    let (va, vb) = (a.standard_error().powi(2), b.standard_error().powi(2));
    let se = (va + vb).sqrt();
    let (estimate, truth) = (a.mean(), b.mean());
    if !(estimate.is_finite() && truth.is_finite()) || a.count() < 2 || b.count() < 2 {
        return MeanTest { estimate, truth, standard_error: se, p: f64::NAN, untrustworthy: true };
    }
    if se <= 1e-7 * estimate.abs().max(truth.abs()) {
        return MeanTest::exact(estimate, truth);
    }
    // Welch–Satterthwaite.
    let dof = (va + vb).powi(2)
        / (va * va / (a.count() as f64 - 1.0) + vb * vb / (b.count() as f64 - 1.0)).max(f64::MIN_POSITIVE);
    let p = p_of_t((estimate - truth) / se, dof);
    MeanTest { estimate, truth, standard_error: se, p, untrustworthy }
}

/// Whether two estimators agree sample by sample in the mean, when the same random numbers drive both. Differences of
/// a millionth, which rounding may make in one direction, count as none.
pub fn paired_test(a: &[f64], b: &[f64]) -> MeanTest {
    let d: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    let size: f64 = a.iter().chain(b).map(|x| x.abs()).sum::<f64>() / (2 * d.len().max(1)) as f64;
    let mean = moments(&d);
    if mean.mean().abs() <= 1e-6 * size {
        let (estimate, standard_error) = (mean.mean(), mean.standard_error());
        return MeanTest { estimate, truth: 0.0, standard_error, p: 1.0, untrustworthy: false };
    }
    mean_test(&d, 0.0)
}

/// Whether `hits` of `n` trials fit a probability: exact, from the binomial law, twice the smaller tail.
pub fn binomial_test(hits: u64, n: u64, probability: f64) -> MeanTest {
    let q = probability.clamp(0.0, 1.0);
    let (k, trials) = (hits.min(n) as f64, n as f64);
    let estimate = k / trials.max(1.0);
    let se = (q * (1.0 - q) / trials.max(1.0)).sqrt();
    // P(X >= k) is the incomplete beta function I_q(k, n - k + 1).
    let at_least = |k: f64| {
        if k <= 0.0 {
            1.0
        } else if k > trials {
            0.0
        } else {
            statrs::function::beta::beta_reg(k, trials - k + 1.0, q)
        }
    };
    let p = if q.is_nan() { 0.0 } else { (2.0 * at_least(k).min(1.0 - at_least(k + 1.0))).clamp(0.0, 1.0) };
    MeanTest { estimate, truth: probability, standard_error: se, p, untrustworthy: false }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Budget;

    fn uniform(n: usize, key: u64) -> Vec<f64> {
        let mut random = Budget::default().random(key);
        (0..n).map(|_| f64::from(random.unit())).collect()
    }

    /// Right means are rejected as often as the level says, and a bias of 7.5 standard errors always: the tests are
    /// neither blind nor jumpy, for few samples and many.
    #[test]
    fn levels_and_power() {
        for n in [20, 1000] {
            let mut rejected = [0; 4];
            for key in 0..2000 {
                let xs = uniform(n, key);
                let ys = uniform(n, key + 10_000);
                let se = (1.0 / 12.0 / n as f64).sqrt();
                rejected[0] += usize::from(mean_test(&xs, 0.5).rejects(0.05));
                rejected[1] += usize::from(mean_test(&xs, 0.5 + 7.5 * se).rejects(1e-4));
                rejected[2] += usize::from(welch_test(&xs, &ys).rejects(0.05));
                let far: Vec<f64> = ys.iter().map(|y| y + 10.0 * se).collect();
                rejected[3] += usize::from(welch_test(&xs, &far).rejects(1e-4));
            }
            // Four standard deviations around a hundred.
            assert!((60..140).contains(&rejected[0]), "{rejected:?}");
            assert!((60..140).contains(&rejected[2]), "{rejected:?}");
            assert!(rejected[1] > 1900 && rejected[3] > 1900, "{rejected:?}");
        }
    }

    #[test]
    fn one_sample_must_not_decide() {
        let mut xs = uniform(1000, 1);
        xs[7] = 1e6;
        assert!(mean_test(&xs, 1000.0).untrustworthy);
        assert!(welch_test(&xs, &uniform(1000, 2)).rejects(1e-6));
        assert!(mean_test(&[f64::NAN, 1.0], 1.0).rejects(1e-6));
        assert!(mean_test(&[1.0; 50], 1.0 + 1e-6).p == 1.0, "rounding is no bias");
        assert!(mean_test(&[1.0; 50], 1.01).rejects(1e-6), "without scatter any bias shows");
    }

    #[test]
    fn pairs_cancel_their_scatter() {
        let a = uniform(1000, 3);
        let same: Vec<f64> = a.iter().map(|x| x * (1.0 + 1e-8)).collect();
        let biased: Vec<f64> = a.iter().map(|x| x * 1.001).collect();
        assert!(!paired_test(&a, &same).rejects(1e-6));
        assert!(paired_test(&a, &biased).rejects(1e-6));
        assert!(!welch_test(&a, &biased).rejects(1e-6), "unpaired it would hide");
    }

    #[test]
    fn binomial_tails() {
        // 3 heads of 3: 2 · 1/8.
        assert!((binomial_test(3, 3, 0.5).p - 0.25).abs() < 1e-12);
        assert!((binomial_test(0, 10, 0.1).p - 2.0 * 0.9f64.powi(10)).abs() < 1e-12);
        assert_eq!(binomial_test(5, 10, 0.5).p, 1.0);
        assert_eq!(binomial_test(10, 10, 1.0).p, 1.0);
        assert_eq!(binomial_test(9, 10, 1.0).p, 0.0, "impossible");
        assert!(binomial_test(5_200, 10_000, 0.5).rejects(1e-3));
    }
}
