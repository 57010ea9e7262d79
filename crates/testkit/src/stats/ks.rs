/// p-value of the Kolmogorov–Smirnov test of `samples` against the uniform law on `[0, 1]`. Sorts the samples.
pub fn ks_uniform(samples: &mut [f64]) -> f64 {
    let n = samples.len() as f64;
    if samples.is_empty() || samples.iter().any(|x| x.is_nan()) {
        return 0.0;
    }
    samples.sort_by(f64::total_cmp);
    let d = samples
        .iter()
        .enumerate()
        .map(|(i, &x)| (x - i as f64 / n).abs().max(((i + 1) as f64 / n - x).abs()))
        .fold(0.0, f64::max);
    // Stephens (1970): the asymptotic law at an effective argument that is good from n = 5 on.
    let t = d * (n.sqrt() + 0.12 + 0.11 / n.sqrt());
    if t < 0.2 {
        return 1.0;
    }
    let mut p = 0.0;
    for k in 1..=100i32 {
        let term = (-2.0 * f64::from(k * k) * t * t).exp();
        p += if k % 2 == 1 { term } else { -term };
        if term < 1e-18 {
            break;
        }
    }
    (2.0 * p).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_samples_pass_and_squeezed_ones_do_not() {
        let mut even: Vec<f64> = (0..1000).map(|i| (f64::from(i) + 0.5) / 1000.0).collect();
        assert!(ks_uniform(&mut even) > 0.99);
        let mut squeezed: Vec<f64> = even.iter().map(|x| x * 0.9).collect();
        assert!(ks_uniform(&mut squeezed) < 1e-6);
        // The 1 % point of the asymptotic law is 1.628.
        let mut shifted: Vec<f64> =
            (0..10_000).map(|i| ((f64::from(i) + 0.5) / 10_000.0 + 0.016_28).min(1.0)).collect();
        assert!((ks_uniform(&mut shifted) - 0.01).abs() < 2e-3);
    }
}
