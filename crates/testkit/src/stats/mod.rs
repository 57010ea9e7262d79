//! Hypothesis tests for Monte Carlo estimators, in double precision (Subr & Arvo 2007).
//!
//! Each test gives a p-value: the probability, if nothing is wrong, of data at least this extreme. A check suite
//! compares it with its share of one significance level, so that a family of tests rarely fails by chance.

mod chi2;
mod ks;
mod mean;

pub use chi2::{Chi2, chi2_test, chi2_test_within};
pub use ks::ks_uniform;
pub use mean::{MeanTest, binomial_test, mean_test, paired_test, welch_test};

/// The level of each of `tests` independent tests that together have the level `alpha` (Šidák 1967).
pub fn sidak(alpha: f64, tests: usize) -> f64 {
    let n = tests.max(1) as f64;
    -(f64::ln_1p(-alpha) / n).exp_m1()
}

/// Two-sided p-value of a standard normal deviate.
pub fn p_of_z(z: f64) -> f64 {
    if z.is_nan() { 0.0 } else { statrs::function::erf::erfc(z.abs() / std::f64::consts::SQRT_2) }
}

/// Two-sided p-value of a deviation `off` with standard error `se`, of which `allowed` needs no explanation: the error of
/// a quadrature, or rounding.
pub fn p_of_z_beyond(off: f64, allowed: f64, se: f64) -> f64 {
    let beyond = off.abs() - allowed;
    if beyond <= 0.0 { 1.0 } else { p_of_z(beyond / se) }
}

/// Two-sided p-value of Student's t with `dof` degrees of freedom.
pub fn p_of_t(t: f64, dof: f64) -> f64 {
    if t.is_nan() || dof.is_nan() || dof <= 0.0 {
        return 0.0;
    }
    if t.is_infinite() {
        return 0.0;
    }
    statrs::function::beta::beta_reg(0.5 * dof, 0.5, dof / (dof + t * t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tabulated_values() {
        assert!((p_of_z(1.959_963_985) - 0.05).abs() < 1e-9);
        assert!((p_of_z(5.0) / 5.733_031_4e-7 - 1.0).abs() < 1e-6);
        // Two-sided 5 % points of Student's t.
        for (dof, t) in [(1.0, 12.706_204_74), (5.0, 2.570_581_836), (30.0, 2.042_272_456)] {
            assert!((p_of_t(t, dof) - 0.05).abs() < 1e-8, "{dof}");
        }
        assert!((sidak(0.01, 5) - (1.0 - 0.99f64.powf(0.2))).abs() < 1e-15);
    }
}
