use std::f32::consts::PI;

use etendue_core::{Vec2, Vec3A, math, vector};

/// How much of one microfacet others hide from light and viewer together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Masking {
    /// Hiding from either side is independent: G2 = G1(wo) G1(wi). What glTF 2.0 (appendix B) asks for.
    Separable,
    /// A facet high up is hidden from neither side: G2 = 1 / (1 + Λ(wo) + Λ(wi)) (Smith 1967; Heitz 2014, equation 99).
    /// Only between directions on one side; for transmission, where height helps one and hurts the other, the product
    /// is used.
    #[default]
    HeightCorrelated,
}

/// The GGX distribution of microfacet normals (Trowbridge & Reitz 1975; Walter et al. 2007) with Smith masking.
///
/// All directions are local, unit and *above* the surface (`z > 0`); a BSDF mirrors those below. Every quantity is in a
/// form without division by a cosine, so grazing directions need no case of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha_x: f32,
    alpha_y: f32,
}

impl Ggx {
    /// Below this `alpha` the surface counts as smooth: its lobe is narrower than single-precision directions resolve.
    pub const SMOOTH: f32 = 1e-4;

    /// Isotropic, with `alpha = roughness²` as glTF and most authoring tools mean it. Out-of-range values are clamped
    /// to `[0, 1]`; NaN is 0.
    pub fn from_roughness(roughness: f32) -> Self {
        let r = if roughness > 0.0 { roughness.clamp(0.0, 1.0) } else { 0.0 };
        Self { alpha_x: r * r, alpha_y: r * r }
    }

    /// From the slope scales along the local x and y axes. Negative values and NaN become 0, values beyond 10⁴ that.
    /// If only one axis is smooth it is held at [`Ggx::SMOOTH`].
    pub fn anisotropic(alpha_x: f32, alpha_y: f32) -> Self {
        let sane = |a: f32| if a > 0.0 { a.clamp(0.0, 1e4) } else { 0.0 };
        let (x, y) = (sane(alpha_x), sane(alpha_y));
        if x < Self::SMOOTH && y < Self::SMOOTH {
            return Self { alpha_x: x, alpha_y: y };
        }
        Self { alpha_x: x.clamp(Self::SMOOTH, 1e4), alpha_y: y.clamp(Self::SMOOTH, 1e4) }
    }

    /// The same, no smoother than `alpha` along either axis.
    #[must_use]
    #[inline]
    pub fn at_least(self, alpha: f32) -> Self {
        let held = |a: f32| if a > alpha { a } else { alpha };
        Self::anisotropic(held(self.alpha_x), held(self.alpha_y))
    }

    /// Slope scale along local x.
    pub fn alpha_x(&self) -> f32 {
        self.alpha_x
    }

    /// Slope scale along local y.
    pub fn alpha_y(&self) -> f32 {
        self.alpha_y
    }

    /// Whether the surface counts as perfectly smooth.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.alpha_x < Self::SMOOTH && self.alpha_y < Self::SMOOTH
    }

    /// Density of facets facing `m` per area and solid angle, sr⁻¹: `∫ D(m) cos θm dm = 1`. The sum of squared slopes is
    /// never formed as 1 − cos², which cancels at small alpha.
    #[inline]
    pub fn d(&self, m: Vec3A) -> f32 {
        let (x, y) = (m.x / self.alpha_x, m.y / self.alpha_y);
        let q = x * x + y * y + m.z * m.z;
        1.0 / (PI * self.alpha_x * self.alpha_y * q * q)
    }

    /// Length of `w` in the space where the surface is stretched to alpha = 1: `t = z (1 + 2Λ)`.
    #[inline]
    pub(crate) fn stretched_length(&self, w: Vec3A) -> f32 {
        let (x, y) = (w.x * self.alpha_x, w.y * self.alpha_y);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// Fraction of the facets facing `w` that are seen from it.
    #[inline]
    pub fn g1(&self, w: Vec3A) -> f32 {
        2.0 * w.z / (w.z + self.stretched_length(w))
    }

    /// `G2(wo, wi) / (4 cos θo)`: all of the reflection term but D and F, cosine at `wi` included.
    #[inline]
    pub(crate) fn reflection_term(&self, masking: Masking, wo: Vec3A, wi: Vec3A) -> f32 {
        let (to, ti) = (self.stretched_length(wo), self.stretched_length(wi));
        match masking {
            Masking::Separable => wi.z / ((wo.z + to) * (wi.z + ti)),
            Masking::HeightCorrelated => 0.5 * wi.z / (to * wi.z + ti * wo.z),
        }
    }

    /// Density per reflected solid angle of the visible normals, without D: `G1(wo) / (4 cos θo)`.
    #[inline]
    pub(crate) fn visible_term(&self, wo: Vec3A) -> f32 {
        0.5 / (wo.z + self.stretched_length(wo))
    }

    /// The same for normals drawn by [`Ggx::sample_reflecting`] (Eto & Tokuyoshi 2023, equation 8).
    #[inline]
    pub(crate) fn reflecting_term(&self, wo: Vec3A) -> f32 {
        0.5 / (self.bound(wo) * wo.z + self.stretched_length(wo))
    }

    /// How far down the cap of reflected directions has to reach, as a fraction of the whole (Eto & Tokuyoshi 2023,
    /// equation 5).
    #[inline]
    fn bound(&self, wo: Vec3A) -> f32 {
        let least = if self.alpha_x < self.alpha_y { self.alpha_x } else { self.alpha_y };
        let a = if least < 1.0 { least } else { 1.0 };
        let s = 1.0 + (wo.x * wo.x + wo.y * wo.y).sqrt();
        let (a2, s2) = (a * a, s * s);
        (1.0 - a2) * s2 / (s2 + a2 * wo.z * wo.z)
    }

    /// A normal drawn from those visible from `wo`, density `G1 max(0, wo·m) D / cos θo` per solid angle
    /// (Dupuy & Benyoub 2023, listing 3).
    #[inline]
    pub fn sample_visible(&self, wo: Vec3A, u: Vec2) -> Vec3A {
        self.sample_cap(wo, 1.0, u)
    }

    /// A visible normal of which most of those that would reflect below the horizon are left out.
    #[inline]
    pub fn sample_reflecting(&self, wo: Vec3A, u: Vec2) -> Vec3A {
        self.sample_cap(wo, self.bound(wo), u)
    }

    /// In the stretched space facets lie on a hemisphere, and the directions it reflects `wo` to fill a spherical cap
    /// uniformly; `bound` trims the cap from below.
    #[inline]
    fn sample_cap(&self, wo: Vec3A, bound: f32, u: Vec2) -> Vec3A {
        let w = Vec3A::new(wo.x * self.alpha_x, wo.y * self.alpha_y, wo.z);
        let w = w / w.dot(w).sqrt();
        let (sin_phi, cos_phi) = math::sin_cos_turns(u.y);
        let below = bound * w.z;
        // 1 - z and h.z = z + w.z are formed without going through z, which would cancel near either end.
        let one_minus_z = u.x * (1.0 + below);
        let sin_theta = (one_minus_z * (2.0 - one_minus_z)).clamp(0.0, 1.0).sqrt();
        let h = Vec3A::new(
            sin_theta * cos_phi + w.x,
            sin_theta * sin_phi + w.y,
            (1.0 - u.x) * (1.0 + below) + (1.0 - bound) * w.z,
        );
        vector::normalize(Vec3A::new(h.x * self.alpha_x, h.y * self.alpha_y, h.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoint sum over the upper hemisphere with the polar angle warped toward the pole, where D peaks.
    fn hemisphere(f: impl Fn(Vec3A) -> f64) -> f64 {
        let (nt, np) = (1200, 96);
        let mut sum = 0.0;
        for i in 0..nt {
            // θ = π/2 s³ resolves lobes of 1e-2 rad with hundreds of rows.
            let s = (f64::from(i) + 0.5) / f64::from(nt);
            let theta = std::f64::consts::FRAC_PI_2 * s * s * s;
            let dtheta = std::f64::consts::FRAC_PI_2 * 3.0 * s * s / f64::from(nt);
            for j in 0..np {
                let phi = std::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(np);
                let w = Vec3A::new(
                    (theta.sin() * phi.cos()) as f32,
                    (theta.sin() * phi.sin()) as f32,
                    theta.cos() as f32,
                );
                sum += f(w) * theta.sin() * dtheta * std::f64::consts::TAU / f64::from(np);
            }
        }
        sum
    }

    #[test]
    fn projected_area_of_all_facets_is_the_surface() {
        for (ax, ay) in [(0.05, 0.05), (0.3, 0.3), (1.0, 1.0), (0.2, 0.7)] {
            let g = Ggx::anisotropic(ax, ay);
            let area = hemisphere(|m| f64::from(g.d(m)) * f64::from(m.z));
            assert!((area - 1.0).abs() < 2e-4, "alpha {ax} {ay}: {area}");
        }
    }

    #[test]
    fn visible_facets_project_onto_the_surface_seen() {
        for alpha in [0.1, 0.5, 1.0] {
            let g = Ggx::anisotropic(alpha, alpha);
            for theta in [0.0f32, 0.7, 1.3] {
                let w = Vec3A::new(math::sin(theta), 0.0, math::cos(theta));
                let seen = hemisphere(|m| f64::from(g.g1(w) * g.d(m) * w.dot(m).max(0.0)));
                assert!((seen - f64::from(w.z)).abs() < 3e-4, "alpha {alpha} theta {theta}: {seen}");
            }
        }
    }

    /// Against the formula in double precision (hazard: 1 − cos² forms lose everything at small alpha).
    #[test]
    fn d_keeps_its_digits_at_small_alpha() {
        for alpha in [1e-1f32, 1e-2, 1e-3, 1e-4] {
            let g = Ggx::anisotropic(alpha, alpha);
            for i in 1..200 {
                let theta = f64::from(alpha) * f64::from(i) * 0.02;
                let m = Vec3A::new(theta.sin() as f32, 0.0, theta.cos() as f32);
                let (a, x, z) = (f64::from(alpha), f64::from(m.x), f64::from(m.z));
                let q = (x / a) * (x / a) + z * z;
                let exact = 1.0 / (std::f64::consts::PI * a * a * q * q);
                assert!((f64::from(g.d(m)) / exact - 1.0).abs() < 1e-6, "alpha {alpha} theta {theta}");
            }
        }
    }

    #[test]
    fn drawn_normals_are_unit_and_visible_at_every_corner() {
        let ends = [0.0, 1.0 / 16_777_216.0, 0.5, 1.0 - 1.0 / 16_777_216.0];
        for alpha in [1e-4, 1e-2, 0.5, 1.0, 10.0f32] {
            let g = Ggx::anisotropic(alpha, alpha);
            for z in [1e-7f32, 1e-3, 0.5, 1.0] {
                let wo = Vec3A::new((1.0 - z * z).sqrt(), 0.0, z);
                for (a, b) in ends.iter().flat_map(|a| ends.iter().map(move |b| (*a, *b))) {
                    for m in [g.sample_visible(wo, Vec2::new(a, b)), g.sample_reflecting(wo, Vec2::new(a, b))]
                    {
                        assert!((m.dot(m) - 1.0).abs() < 1e-6 && m.z >= 0.0, "alpha {alpha} z {z}: {m}");
                        // At the very rim of the cap h vanishes and its direction is rounding; there the models
                        // look at wo·m themselves.
                        assert!(a > 0.5 || wo.dot(m) > -1e-6, "alpha {alpha} z {z} u {a} {b}: {}", wo.dot(m));
                    }
                }
            }
        }
    }

    #[test]
    fn bad_parameters_are_tamed() {
        assert_eq!(Ggx::from_roughness(f32::NAN).alpha_x(), 0.0);
        assert_eq!(Ggx::from_roughness(-1.0).alpha_x(), 0.0);
        assert_eq!(Ggx::from_roughness(7.0).alpha_y(), 1.0);
        assert_eq!(Ggx::anisotropic(0.0, 0.5).alpha_x(), Ggx::SMOOTH);
        assert!(Ggx::anisotropic(0.0, 0.0).is_smooth());
        assert!(!Ggx::from_roughness(0.01).is_smooth(), "alpha 1e-4 is the first rough one");
    }
}
