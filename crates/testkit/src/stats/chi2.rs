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
///
/// ```
/// let fair = etendue_testkit::stats::chi2_test(&[26, 25, 24, 25], &[25.0; 4]);
/// assert!(fair.p > 0.9);
/// let loaded = etendue_testkit::stats::chi2_test(&[60, 13, 14, 13], &[25.0; 4]);
/// assert!(loaded.p < 1e-10);
/// ```
pub fn chi2_test(observed: &[u64], expected: &[f64]) -> Chi2 {
    chi2_test_within(observed, expected, &[])
}

/// The same where expectations are known only within `errors` (0 where there are fewer of them than cells): each
/// deviation counts less its error, so that an inaccurate quadrature costs power and never a false alarm.
pub fn chi2_test_within(observed: &[u64], expected: &[f64], errors: &[f64]) -> Chi2 {
    let mut cells: Vec<Counted> = expected
        .iter()
        .zip(observed)
        .enumerate()
        .map(|(i, (&expected, &seen))| Counted {
            expected,
            seen: seen as f64,
            error: errors.get(i).copied().unwrap_or(0.0),
        })
        .collect();
    cells.sort_by(|a, b| a.expected.total_cmp(&b.expected));
    let mut impossible = 0;
    let mut pooled: Vec<Counted> = Vec::new();
    let mut pool = Counted::default();
    for cell in cells {
        if cell.expected <= 0.0 || cell.expected.is_nan() {
            impossible += cell.seen as u64;
            continue;
        }
        pool = pool.plus(cell);
        if pool.expected >= POOL {
            pooled.push(pool);
            pool = Counted::default();
        }
    }
    match pooled.last_mut() {
        Some(last) => *last = last.plus(pool),
        None if pool.expected > 0.0 => pooled.push(pool),
        None => {}
    }
    let statistic: f64 = pooled.iter().map(Counted::term).sum();
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

/// A cell, or several pooled.
#[derive(Clone, Copy, Default)]
struct Counted {
    expected: f64,
    seen: f64,
    error: f64,
}

impl Counted {
    fn plus(self, o: Self) -> Self {
        Self { expected: self.expected + o.expected, seen: self.seen + o.seen, error: self.error + o.error }
    }

    fn term(&self) -> f64 {
        let off = ((self.seen - self.expected).abs() - self.error).max(0.0);
        off * off / self.expected
    }
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
        let c = chi2_test_within(&[34, 16, 25, 25], &e, &[9.0, 8.0]);
        assert!((c.statistic - 0.04).abs() < 1e-12, "what the error covers does not count");
    }
}
