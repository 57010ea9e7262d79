use std::f32::consts::FRAC_1_PI;

use etendue_core::{Vec3A, math};

/// c₁ = 1/2 − 2/(3π).
const C1: f32 = 0.287_793_4;
/// c₂ = 2/3 − 28/(15π).
const C2: f32 = 0.072_488_21;

/// Fujii's form of the Oren–Nayar model for white facets, and its albedos (Portsmouth, Kutz & Hill 2025, section 2).
///
/// Directions are unit and above the surface.
#[derive(Clone, Copy)]
pub(super) struct Fujii {
    roughness: f32,
    /// A = 1 / (1 + c₁ r).
    a: f32,
}

impl Fujii {
    #[inline]
    pub(super) fn new(roughness: f32) -> Self {
        Self { roughness, a: 1.0 / (1.0 + C1 * roughness) }
    }

    /// π f.
    #[inline]
    pub(super) fn single(&self, o: Vec3A, i: Vec3A) -> f32 {
        // wi·wo − cos cos without its cancellation.
        let s = (o.x * i.x + o.y * i.y).clamp(-1.0, 1.0);
        let steepest = if o.z > i.z { o.z } else { i.z };
        let s_over_t = if s > 0.0 { s / steepest } else { s };
        self.a * (1.0 + self.roughness * s_over_t)
    }

    /// 1 − E(mu): the fraction of light that does not come back at once. With G of the paper's equation A.4 in the form
    /// `S (acos μ − S μ) + 2/3 (S μ (1 + S + S²) / (1 + S) − S)`, in which nothing is divided by μ.
    #[inline]
    pub(super) fn lost(&self, mu: f32) -> f32 {
        let mu = mu.clamp(0.0, 1.0);
        let s = ((1.0 - mu) * (1.0 + mu)).sqrt();
        let g = s * (math::acos(mu) - s * mu) + (2.0 / 3.0) * (s * mu * (1.0 + s + s * s) / (1.0 + s) - s);
        (self.a * self.roughness * (C1 - g * FRAC_1_PI)).clamp(0.0, 1.0)
    }

    /// Average of E over the hemisphere of directions, weighted by the cosine.
    #[inline]
    pub(super) fn mean_albedo(&self) -> f32 {
        self.a * (1.0 + C2 * self.roughness)
    }

    /// π f of what is lost at `mu_o` and at `mu_i`, given back: `(1 − E) (1 − E) / (1 − mean E)`.
    #[inline]
    pub(super) fn missing(&self, mu_o: f32, mu_i: f32) -> f32 {
        let missing = self.a * self.roughness * (C1 - C2);
        if missing > 0.0 { self.lost(mu_o) * self.lost(mu_i) / missing } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// E(mu) by the quadrature of f itself: over φ in closed form (the mean of max(cos φ, 0) is 1/π, that of
    /// min(cos φ, 0) is −1/π), over θ by Simpson's rule on both sides of the corner at θ = acos μ.
    fn quadrature(mu: f64, r: f64) -> f64 {
        let a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
        let s_o = (1.0 - mu * mu).sqrt();
        let integrand = |theta: f64| {
            let (s, c) = theta.sin_cos();
            let toward = s_o * s / mu.max(c) - s_o * s;
            2.0 * (1.0 + r * toward / PI) * c * s * a
        };
        let simpson = |from: f64, to: f64| {
            let n = 4000;
            let h = (to - from) / f64::from(n);
            let weight = |k: i32| if k == 0 || k == n { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) };
            (0..=n).map(|k| weight(k) * integrand(from + h * f64::from(k))).sum::<f64>() * h / 3.0
        };
        simpson(0.0, mu.acos()) + simpson(mu.acos(), FRAC_PI_2)
    }

    #[test]
    fn constants_are_those_of_the_paper() {
        assert_eq!(C1, (0.5 - 2.0 / (3.0 * PI)) as f32);
        assert_eq!(C2, (2.0 / 3.0 - 28.0 / (15.0 * PI)) as f32);
    }

    /// The closed form against the integral of the model, everywhere to 1e-6.
    #[test]
    fn albedo_is_the_integral() {
        let mut worst = 0.0f64;
        for k in 1..=10 {
            let r = f64::from(k) / 10.0;
            for j in 1..=400 {
                let mu = f64::from(j) / 400.0;
                let (mu, r) = (f64::from(mu as f32), f64::from(r as f32));
                let e = 1.0 - f64::from(Fujii::new(r as f32).lost(mu as f32));
                worst = worst.max((e - quadrature(mu, r)).abs());
            }
        }
        println!("E_FON off by {worst:.1e}");
        assert!(worst < 1e-6, "{worst}");
        // Values computed elsewhere by adaptive quadrature, eight digits.
        for (mu, r, e) in [
            (0.2f32, 1.0f32, 0.947_210_79),
            (0.7, 1.0, 0.817_887_96),
            (0.2, 0.3, 0.981_226_40),
            (0.7, 0.3, 0.935_234_89),
        ] {
            let found = 1.0 - f64::from(Fujii::new(r).lost(mu));
            assert!((found - e).abs() < 1.5e-7, "mu {mu} r {r}: {found} for {e}");
        }
        assert!((f64::from(Fujii::new(1.0).mean_albedo()) - 0.832_810_76).abs() < 1e-7);
    }

    #[test]
    fn the_mean_albedo_is_the_mean() {
        for r in [0.1f32, 0.5, 1.0] {
            let n = 20_000;
            let at = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
            let e = |mu: f64| 1.0 - f64::from(Fujii::new(r).lost(mu as f32));
            let mean = (0..n).map(|k| 2.0 * at(k) * e(at(k))).sum::<f64>() / f64::from(n);
            assert!((mean - f64::from(Fujii::new(r).mean_albedo())).abs() < 2e-7, "r {r}: {mean}");
        }
    }
}
