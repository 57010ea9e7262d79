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

/// Whether the mean of independent samples is `truth` (z-test; t below 200 samples). At σ equal to the mean and
/// n = 10⁶ a bias of 0.5 % is 5 standard errors.
pub fn mean_test(samples: &[f64], truth: f64) -> MeanTest {
    let mut m = Moments::default();
    let (mut largest, mut total) = (0.0f64, 0.0);
    for &x in samples {
        m.add(x);
        largest = largest.max(x.abs());
        total += x.abs();
    }
    let se = m.standard_error();
    if samples.len() < 2 || !m.mean().is_finite() {
        return MeanTest { estimate: m.mean(), truth, standard_error: se, p: f64::NAN, untrustworthy: true };
    }
    // Differences at the level of f32 rounding are not scatter.
    if se <= 1e-7 * m.mean().abs() {
        return MeanTest::exact(m.mean(), truth);
    }
    let z = (m.mean() - truth) / se;
    let n = samples.len();
    let p = if n < 200 { p_of_t(z, n as f64 - 1.0) } else { p_of_z(z) };
    let untrustworthy = n >= 200 && largest > LARGEST_SHARE * total;
    MeanTest { estimate: m.mean(), truth, standard_error: se, p, untrustworthy }
}

/// Whether two sets of independent samples have one mean, their variances unknown and unequal (Welch 1947).
pub fn welch_test(a: &[f64], b: &[f64]) -> MeanTest {
    let of = |xs: &[f64]| {
        let mut m = Moments::default();
        xs.iter().for_each(|&x| m.add(x));
        m
    };
    let (a, b) = (of(a), of(b));
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
    MeanTest { estimate, truth, standard_error: se, p, untrustworthy: false }
}

/// Whether two estimators agree sample by sample in the mean, when the same random numbers drive both.
pub fn paired_test(a: &[f64], b: &[f64]) -> MeanTest {
    let d: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    if d.iter().all(|&d| d == 0.0) {
        return MeanTest { estimate: 0.0, truth: 0.0, standard_error: 0.0, p: 1.0, untrustworthy: false };
    }
    mean_test(&d, 0.0)
}

/// Whether `hits` of `n` trials fit a probability.
pub fn binomial_test(hits: u64, n: u64, probability: f64) -> MeanTest {
    let n_f = n.max(1) as f64;
    let estimate = hits as f64 / n_f;
    let q = probability.clamp(0.0, 1.0);
    let se = (q * (1.0 - q) / n_f).sqrt();
    // A half for continuity: few hits are not normal.
    let off = ((estimate - q).abs() - 0.5 / n_f).max(0.0);
    let p = if off == 0.0 {
        1.0
    } else if se == 0.0 {
        0.0
    } else {
        p_of_z(off / se)
    };
    MeanTest { estimate, truth: probability, standard_error: se, p, untrustworthy: false }
}
