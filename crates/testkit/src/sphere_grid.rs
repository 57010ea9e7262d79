use std::f64::consts::TAU;

use etendue_core::Vec3A;

use crate::stats::{Chi2, chi2_test};

/// Cells of equal solid angle on the sphere: rows in cos θ, columns in φ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SphereGrid {
    pub(crate) rows: usize,
    pub(crate) cols: usize,
}

/// Deepest subdivision of a cell while a density is integrated over it.
const DEPTH: u32 = 7;

impl SphereGrid {
    pub(crate) fn cells(&self) -> usize {
        self.rows * self.cols
    }

    /// The cell of a unit direction.
    pub(crate) fn cell(&self, d: Vec3A) -> usize {
        let row = ((f64::from(d.z) + 1.0) * 0.5 * self.rows as f64) as usize;
        let phi = f64::from(d.y).atan2(f64::from(d.x));
        let phi = if phi < 0.0 { phi + TAU } else { phi };
        let col = (phi / TAU * self.cols as f64) as usize;
        row.min(self.rows - 1) * self.cols + col.min(self.cols - 1)
    }

    /// The integral of `f` over every cell. Cells that samples fell into are subdivided at least thrice, so that a
    /// peak between the nodes is not overlooked.
    pub(crate) fn integrate(&self, observed: &[u64], f: &dyn Fn(Vec3A) -> f64) -> Vec<f64> {
        let total: u64 = observed.iter().sum();
        (0..self.cells())
            .map(|i| {
                let (row, col) = (i / self.cols, i % self.cols);
                let z = [row, row + 1].map(|r| 2.0 * r as f64 / self.rows as f64 - 1.0);
                let phi = [col, col + 1].map(|c| TAU * c as f64 / self.cols as f64);
                let forced = if observed[i] > 0 { 3 } else { 1 };
                // Errors count against the whole: a cell that few samples reach need not be known well.
                let share = observed[i].max(1) as f64 / total.max(1) as f64;
                Patch { z, phi }.integrate(f, forced, DEPTH, 2e-4 * share.max(1e-4))
            })
            .collect()
    }

    /// Pearson's test of the directions seen among `n` samples against a density. Returns the test and the
    /// density's integral over the sphere.
    pub(crate) fn test(&self, observed: &[u64], n: u64, pdf: &dyn Fn(Vec3A) -> f64) -> (Chi2, f64) {
        let mut expected = self.integrate(observed, pdf);
        let mass: f64 = expected.iter().sum();
        for e in &mut expected {
            *e *= n as f64;
        }
        // Rounding may carry a sample over the border of the support: a sliver of expectation, not impossibility.
        (chi2_test(observed, &expected), mass)
    }
}

/// A rectangle in (cos θ, φ).
#[derive(Clone, Copy)]
struct Patch {
    z: [f64; 2],
    phi: [f64; 2],
}

impl Patch {
    fn area(&self) -> f64 {
        (self.z[1] - self.z[0]) * (self.phi[1] - self.phi[0])
    }

    /// 3 × 3 Gauss–Legendre.
    fn gauss(&self, f: &dyn Fn(Vec3A) -> f64) -> f64 {
        const NODES: [(f64, f64); 3] =
            [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
        let mut sum = 0.0;
        for (x, wx) in NODES {
            let z = self.z[0] + (self.z[1] - self.z[0]) * x;
            let r = (1.0 - z * z).max(0.0).sqrt();
            for (y, wy) in NODES {
                let (s, c) = (self.phi[0] + (self.phi[1] - self.phi[0]) * y).sin_cos();
                sum += wx * wy * f(Vec3A::new((r * c) as f32, (r * s) as f32, z as f32));
            }
        }
        sum * self.area()
    }

    fn quarters(&self) -> [Self; 4] {
        let z = 0.5 * (self.z[0] + self.z[1]);
        let phi = 0.5 * (self.phi[0] + self.phi[1]);
        [
            Self { z: [self.z[0], z], phi: [self.phi[0], phi] },
            Self { z: [self.z[0], z], phi: [phi, self.phi[1]] },
            Self { z: [z, self.z[1]], phi: [self.phi[0], phi] },
            Self { z: [z, self.z[1]], phi: [phi, self.phi[1]] },
        ]
    }

    fn integrate(&self, f: &dyn Fn(Vec3A) -> f64, forced: u32, depth: u32, tolerance: f64) -> f64 {
        let coarse = self.gauss(f);
        let quarters = self.quarters();
        let fine: f64 = quarters.iter().map(|q| q.gauss(f)).sum();
        if depth == 0 || (forced == 0 && (fine - coarse).abs() <= tolerance) {
            return fine;
        }
        quarters
            .iter()
            .map(|q| q.integrate(f, forced.saturating_sub(1), depth - 1, tolerance * 0.5))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_smooth_clipped_and_peaked_densities() {
        let grid = SphereGrid { rows: 20, cols: 20 };
        let observed = vec![1; grid.cells()];
        let whole = |f: &dyn Fn(Vec3A) -> f64| grid.integrate(&observed, f).iter().sum::<f64>();
        assert!((whole(&|_| 1.0) - 2.0 * TAU).abs() < 1e-9);
        assert!((whole(&|d| f64::from(d.z.max(0.0))) / (TAU / 2.0) - 1.0).abs() < 1e-5);
        // A lobe cos^n around a slanted axis: 2π/(n + 1).
        let axis = Vec3A::new(0.6, 0.0, 0.8);
        let lobe = |d: Vec3A| f64::from(d.dot(axis).max(0.0)).powi(2000);
        assert!((whole(&lobe) * 2001.0 / TAU - 1.0).abs() < 2e-3);
    }
}
