//! Fresnel reflectance of dielectrics and metals, Schlick's approximation, and Snell's law.
//!
//! `eta` is always ηt/ηi: the index on the far side over the index on the side the light comes from.

use etendue_core::{Spectrum, Vec3A};

/// Reflectance and refraction angle at a plane interface, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interface {
    /// Fraction of unpolarised power reflected, in `[0, 1]`.
    pub(crate) reflectance: f64,
    /// Cosine of the refracted direction against the far normal; 0 under total reflection.
    pub(crate) cos_t: f64,
}

impl Interface {
    /// `cos_i >= 0` and `sin2_i` belong to the same direction; they come apart so that neither is cancelled out of the
    /// other at grazing incidence or at the critical angle.
    #[inline]
    pub(crate) fn new(cos_i: f64, sin2_i: f64, eta: f64) -> Self {
        if eta == 1.0 {
            return Self { reflectance: 0.0, cos_t: cos_i };
        }
        let cos2_t = 1.0 - sin2_i / (eta * eta);
        // Total reflection; a NaN ends here too.
        if !(cos2_t > 0.0) {
            return Self { reflectance: 1.0, cos_t: 0.0 };
        }
        let cos_t = cos2_t.sqrt();
        let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
        let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
        Self { reflectance: 0.5 * (s * s + p * p), cos_t }
    }

    /// With the sine from the cosine, for directions against a microfacet.
    #[inline]
    pub(crate) fn from_cos(cos_i: f32, eta: f32) -> Self {
        let c = f64::from(cos_i.abs()).clamp(0.0, 1.0);
        Self::new(c, 1.0 - c * c, f64::from(eta))
    }
}

/// The index over the surface that a ray on the side of `cos_o` meets, from the interior index over the exterior one.
/// An index that is not a positive number is no interface.
#[inline]
pub(crate) fn relative_eta(eta: f32, cos_o: f32) -> f32 {
    if !(eta > 0.0 && eta.is_finite()) {
        return 1.0;
    }
    if cos_o >= 0.0 { eta } else { 1.0 / eta }
}

/// Reflectance of a dielectric for unpolarised light (Born & Wolf 1999, section 1.5.2). `cos_i` in `[0, 1]` (its sign is
/// ignored); 1 under total reflection, 0 where `eta` is 1.
#[inline]
pub fn dielectric(cos_i: f32, eta: f32) -> f32 {
    Interface::from_cos(cos_i, eta).reflectance as f32
}

/// Reflectance of a metal of complex index `eta + i k` in one channel, for unpolarised light (Born & Wolf 1999,
/// section 14.2, with real and imaginary parts separated). In `[0, 1]` for `eta > 0`, `k >= 0`.
#[inline]
pub fn conductor(cos_i: f32, eta: f32, k: f32) -> f32 {
    let c = f64::from(cos_i.abs()).clamp(0.0, 1.0);
    let (c2, eta, k) = (c * c, f64::from(eta), f64::from(k));
    let s2 = 1.0 - c2;
    let t0 = eta * eta - k * k - s2;
    let a2b2 = (t0 * t0 + 4.0 * eta * eta * k * k).sqrt();
    // The sum cancels to a rounding error below zero where k is far larger than eta.
    let a2 = 0.5 * (a2b2 + t0);
    let a = if a2 > 0.0 { a2.sqrt() } else { 0.0 };
    let (t1, t2) = (a2b2 + c2, 2.0 * a * c);
    let (t3, t4) = (c2 * a2b2 + s2 * s2, t2 * s2);
    // (Rs + Rp) / 2 with Rp = Rs (t3 - t4) / (t3 + t4), over one denominator.
    let r = (t1 - t2) * t3 / ((t1 + t2) * (t3 + t4));
    r.clamp(0.0, 1.0) as f32
}

/// Schlick's (1994) approximation from the reflectance `f0` at normal incidence.
#[inline]
pub fn schlick(cos_i: f32, f0: Spectrum) -> Spectrum {
    let m = (1.0 - cos_i.abs()).clamp(0.0, 1.0);
    let m2 = m * m;
    f0 + (Spectrum::ONE - f0) * (m2 * m2 * m)
}

/// Snell's law: the direction into the far side for `wo` above the unit normal `n`, both pointing away from the
/// interface; `None` under total reflection. The result is unit and points away from the interface.
#[inline]
pub fn refract(wo: Vec3A, n: Vec3A, eta: f32) -> Option<Vec3A> {
    let cos_i = wo.dot(n);
    let interface = Interface::from_cos(cos_i, eta);
    if interface.cos_t <= 0.0 {
        return None;
    }
    Some(wo / -eta + n * (cos_i / eta - interface.cos_t as f32))
}

/// How a metal's reflectance is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MetalFresnel {
    /// Complex refractive index `eta + i k` per channel, relative to the outside.
    Index {
        /// Real part.
        eta: Spectrum,
        /// Imaginary part (extinction), not negative.
        k: Spectrum,
    },
    /// Schlick's approximation from the reflectance at normal incidence, each channel in `[0, 1]`.
    Schlick {
        /// Reflectance at normal incidence.
        f0: Spectrum,
    },
}

impl MetalFresnel {
    /// Reflectance at an angle of incidence.
    #[inline]
    pub fn reflectance(&self, cos_i: f32) -> Spectrum {
        match *self {
            Self::Index { eta, k } => Spectrum::rgb(
                conductor(cos_i, eta.r(), k.r()),
                conductor(cos_i, eta.g(), k.g()),
                conductor(cos_i, eta.b(), k.b()),
            ),
            Self::Schlick { f0 } => schlick(cos_i, f0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cos_deg(deg: f64) -> f32 {
        deg.to_radians().cos() as f32
    }

    fn close(a: f32, b: f64, tolerance: f64) {
        assert!((f64::from(a) - b).abs() <= tolerance, "{a} against {b}");
    }

    #[test]
    fn dielectric_has_the_known_values() {
        let outside = [
            (0.0, 0.04),
            (30.0, 0.041_522_625_976),
            (45.0, 0.050_239_911_012),
            (56.309_932_474, 0.073_964_497_041),
            (60.0, 0.089_186_712_802),
            (75.0, 0.253_060_562_990),
            (80.0, 0.387_704_354_691),
            (85.0, 0.612_799_645_265),
            (89.0, 0.904_184_949_780),
        ];
        for (deg, f) in outside {
            close(dielectric(cos_deg(deg), 1.5), f, 1e-6);
        }
        close(dielectric(cos_deg(30.0), 1.0 / 1.5), 0.055_190_167_295, 1e-6);
        close(dielectric(cos_deg(40.0), 1.0 / 1.5), 0.245_291_204_287, 2e-6);
        assert_eq!(dielectric(cos_deg(41.9), 1.0 / 1.5), 1.0);
        // The mutant with the index inverted is far off.
        assert!((dielectric(cos_deg(60.0), 1.0 / 1.5) - 0.089_186_71).abs() > 0.1);
    }

    #[test]
    fn dielectric_is_robust() {
        for eta in [1e-3f32, 0.2, 1.0 / 1.5, 0.999_999_9, 1.0, 1.000_000_1, 1.5, 2.4, 1e3] {
            for i in 0..=1000 {
                let f = dielectric(i as f32 / 1000.0, eta);
                assert!((0.0..=1.0).contains(&f), "eta {eta} cos {i}: {f}");
            }
        }
        assert_eq!(dielectric(0.0, 1.5), 1.0);
        assert_eq!(dielectric(0.0, 1.0), 0.0);
        assert_eq!(dielectric(0.5, 1.0), 0.0);
        // Over the critical angle ulp by ulp: total reflection below it, and above it 1 − F = O(√distance), falling.
        let eta = 1.0 / 1.5f32;
        let critical = (1.0 - f64::from(eta) * f64::from(eta)).sqrt();
        let mut c = critical as f32 - 8.0 * f32::EPSILON;
        let mut last = 1.0;
        for _ in 0..64 {
            let (f, beyond) = (dielectric(c, eta), f64::from(c) - critical);
            let least = 1.0 - 10.7 * beyond.max(0.0).sqrt();
            assert!(f <= last && f64::from(f) >= least - 1e-7, "{beyond:e}: {f}");
            last = f;
            c = c.next_up();
        }
        assert!(last < 0.99, "the descent has been seen");
    }

    /// 2 ∫ F μ dμ by the midpoint rule in θ, outside and inside; and 1 − F_in = (1 − F_out) / n².
    #[test]
    fn dielectric_has_the_known_hemispherical_means() {
        let mean = |eta: f32| {
            let n = 200_000;
            let h = std::f64::consts::FRAC_PI_2 / f64::from(n);
            (0..n)
                .map(|i| (f64::from(i) + 0.5) * h)
                .map(|t| 2.0 * f64::from(dielectric(t.cos() as f32, eta)) * t.cos() * t.sin() * h)
                .sum::<f64>()
        };
        for (eta, outside, inside) in [
            (1.2f32, 0.044_280_266_235, 0.336_305_740_441),
            (1.5, 0.091_777_959_342, 0.596_345_759_708),
            (2.4, 0.210_181_302_010, 0.862_878_698_266),
        ] {
            let (o, i) = (mean(eta), mean(1.0 / eta));
            assert!((o - outside).abs() < 2e-6, "{eta}: {o}");
            assert!((i - inside).abs() < 2e-6, "{eta}: {i}");
            let n2 = f64::from(eta) * f64::from(eta);
            assert!((1.0 - i - (1.0 - o) / n2).abs() < 3e-6);
        }
    }

    #[test]
    fn conductor_has_the_known_values() {
        for (deg, f) in [
            (0.0, 0.923_371_647_510),
            (45.0, 0.921_319_620_693),
            (60.0, 0.918_411_084_659),
            (80.0, 0.938_558_369_711),
            (89.0, 0.992_126_321_413),
        ] {
            close(conductor(cos_deg(deg), 0.2, 3.0), f, 1e-6);
        }
        for (deg, f) in [(0.0, 0.730_337_078_652), (45.0, 0.723_616_011_120), (80.0, 0.715_332_455_285)] {
            close(conductor(cos_deg(deg), 1.5, 4.0), f, 1e-6);
        }
        // Without extinction a metal is a dielectric.
        for i in 1..100 {
            let c = i as f32 / 100.0;
            close(conductor(c, 1.5, 0.0), f64::from(dielectric(c, 1.5)), 1e-6);
        }
        assert_eq!(conductor(0.0, 0.2, 3.0), 1.0);
    }

    #[test]
    fn schlick_has_the_known_mean() {
        let f0 = 0.04f64;
        let n = 100_000;
        let mean: f64 = (0..n)
            .map(|i| (f64::from(i) + 0.5) / f64::from(n))
            .map(|mu| 2.0 * mu * f64::from(schlick(mu as f32, Spectrum::gray(0.04)).r()) / f64::from(n))
            .sum();
        assert!((mean - (f0 + (1.0 - f0) / 21.0)).abs() < 1e-6);
    }

    #[test]
    fn refraction_obeys_snell() {
        for eta in [1.0 / 1.5, 1.0, 1.33, 2.4f32] {
            for i in 0..90 {
                let t = f64::from(i).to_radians();
                let wo = Vec3A::new(t.sin() as f32, 0.0, t.cos() as f32);
                match refract(wo, Vec3A::Z, eta) {
                    Some(wt) => {
                        close(wt.x * eta, -t.sin(), 1e-6);
                        assert!(wt.z <= 0.0);
                        close(wt.dot(wt), 1.0, 4e-6);
                    }
                    None => assert!(t.sin() > f64::from(eta) * (1.0 - 1e-6)),
                }
            }
        }
    }
}
