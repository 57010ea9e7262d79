/// The outcome of Pearson's test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chi2 {
    /// Σ (observed − expected)² / expected over the cells left after pooling.
    pub statistic: f64,
    /// Degrees of freedom: cells − 1.
    pub dof: usize,
    /// Upper tail probability.
    pub p: f64,
    /// Samples that fell where none can.
    pub impossible: u64,
}

/// Least expected count of a cell; smaller ones are pooled.
const POOL: f64 = 5.0;

/// Whether observed counts fit expected ones (Pearson 1900).
///
/// Cells are sorted by expectation and pooled to at least 5; a tail that stays below is merged into the last cell.
/// Cells of expectation 0 that were hit are counted in `impossible`. The total is not assumed to agree: a deficit
/// shows in the statistic.
pub fn chi2_test(observed: &[u64], expected: &[f64]) -> Chi2 {
    let mut cells: Vec<(f64, u64)> = expected.iter().copied().zip(observed.iter().copied()).collect();
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut impossible = 0;
    let mut pooled: Vec<(f64, f64)> = Vec::new();
    let (mut e, mut o) = (0.0, 0.0);
    for (expect, seen) in cells {
        if expect <= 0.0 || expect.is_nan() {
            impossible += seen;
            continue;
        }
        e += expect;
        o += seen as f64;
        if e >= POOL {
            pooled.push((e, o));
            (e, o) = (0.0, 0.0);
        }
    }
    match pooled.last_mut() {
        Some(last) => *last = (last.0 + e, last.1 + o),
        None if e > 0.0 => pooled.push((e, o)),
        None => {}
    }
    let statistic: f64 = pooled.iter().map(|(e, o)| (o - e) * (o - e) / e).sum();
    let dof = pooled.len().saturating_sub(1);
    let p = if dof == 0 {
        1.0
    } else if !statistic.is_finite() {
        0.0
    } else if statistic <= 0.0 {
        1.0
    } else {
        statrs::function::gamma::gamma_ur(0.5 * dof as f64, 0.5 * statistic)
    };
    Chi2 { statistic, dof, p, impossible }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tabulated_value_and_pooling() {
        // 95 % point with 3 degrees of freedom: 7.8147.
        let e = [25.0; 4];
        let c = chi2_test(&[25, 25, 25, 25], &e);
        assert_eq!((c.statistic, c.dof, c.p), (0.0, 3, 1.0));
        let c = chi2_test(&[34, 16, 25, 25], &e);
        assert!((c.statistic - 6.48).abs() < 1e-12);
        assert!((c.p - 0.0904).abs() < 1e-3, "{}", c.p);
        let c = chi2_test(&[1, 0, 2, 100, 3], &[1.0, 1.0, 2.0, 99.0, 0.0]);
        assert_eq!((c.dof, c.impossible), (0, 3), "the small cells are pooled into the large one");
    }
}
