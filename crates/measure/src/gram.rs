/// Mean products of the deviations of every two runs from the reference: all that mean square error, variance and bias
/// need to know of the pictures.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gram {
    runs: usize,
    products: Vec<f64>,
}

impl Gram {
    pub(crate) fn new(runs: usize) -> Self {
        Self { runs, products: vec![0.0; runs * runs] }
    }

    /// Adds one value's deviations, one per run, with a weight.
    #[inline]
    pub(crate) fn add(&mut self, deviations: &[f64], weight: f64) {
        for (row, &a) in self.products.chunks_exact_mut(self.runs).zip(deviations) {
            for (p, &b) in row.iter_mut().zip(deviations) {
                *p += weight * a * b;
            }
        }
    }

    pub(crate) fn divide(&mut self, by: f64) {
        self.products.iter_mut().for_each(|p| *p /= by);
    }

    fn at(&self, j: usize, k: usize) -> f64 {
        self.products[j * self.runs + k]
    }

    /// Mean square deviation from the reference of the runs `kept`; `None` of no runs.
    pub(crate) fn square(&self, kept: &[usize]) -> Option<f64> {
        (!kept.is_empty()).then(|| kept.iter().map(|&k| self.at(k, k)).sum::<f64>() / kept.len() as f64)
    }

    /// Mean product of two different runs' deviations: the square of what they have in common, which is their bias and
    /// the reference's own error. `None` below two runs.
    pub(crate) fn common(&self, kept: &[usize]) -> Option<f64> {
        let n = kept.len();
        if n < 2 {
            return None;
        }
        let all: f64 =
            kept.iter().flat_map(|&j| kept.iter().map(move |&k| (j, k))).map(|(j, k)| self.at(j, k)).sum();
        let own: f64 = kept.iter().map(|&k| self.at(k, k)).sum();
        Some((all - own) / (n * (n - 1)) as f64)
    }

    /// Variance of one run: half the mean square difference of two runs. The reference drops out. `None` below two.
    pub(crate) fn variance(&self, kept: &[usize]) -> Option<f64> {
        Some(self.square(kept)? - self.common(kept)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_gives_half_its_squared_difference() {
        let mut g = Gram::new(2);
        g.add(&[0.5, -0.1], 1.0);
        g.add(&[1.0, 0.0], 3.0);
        g.divide(4.0);
        let both = [0, 1];
        let want = 0.5 * (0.6f64.powi(2) + 3.0) / 4.0;
        assert!((g.variance(&both).unwrap() - want).abs() < 1e-15);
        assert!((g.square(&both).unwrap() - (0.25 + 0.01 + 3.0) / 8.0).abs() < 1e-15);
        assert!((g.common(&both).unwrap() + 0.05 / 4.0).abs() < 1e-15);
        assert_eq!((g.common(&[0]), g.variance(&[1]), g.square(&[])), (None, None, None));
    }
}
