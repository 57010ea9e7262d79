use etendue_core::{Spectrum, Vec2, Vec3A, vector};

use crate::mirror::reflect_about_z;
use crate::{Bsdf, BsdfAt, BsdfSample, Ggx, Lobes, Masking, MetalFresnel, Mode};

/// A metal: microfacets of GGX slopes that reflect and absorb, on either side (Walter et al. 2007), sampled by the
/// normals that reflect upward (Eto & Tokuyoshi 2023). Single scattering.
///
/// Where `ggx` is smooth it is a mirror with the same Fresnel term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// Distribution of microfacet normals.
    pub ggx: Ggx,
    /// Reflectance of one facet.
    pub fresnel: MetalFresnel,
    /// Shadowing between facets.
    pub masking: Masking,
}

impl Conductor {
    /// An isotropic metal with height-correlated masking.
    pub fn new(roughness: f32, fresnel: MetalFresnel) -> Self {
        Self { ggx: Ggx::from_roughness(roughness), fresnel, masking: Masking::default() }
    }

    /// The same metal with another masking.
    #[must_use]
    pub fn with_masking(self, masking: Masking) -> Self {
        Self { masking, ..self }
    }

    /// From indices at 630, 532 and 465 nm.
    fn measured(roughness: f32, eta: [f32; 3], k: [f32; 3]) -> Self {
        Self::new(roughness, MetalFresnel::Index { eta: eta.into(), k: k.into() })
    }

    /// Gold: Johnson & Christy 1972, "Optical constants of the noble metals", interpolated at 630, 532 and 465 nm.
    pub fn gold(roughness: f32) -> Self {
        Self::measured(roughness, [0.1884, 0.5439, 1.3319], [3.4034, 2.2309, 1.8693])
    }

    /// Silver: Johnson & Christy 1972, interpolated at 630, 532 and 465 nm.
    pub fn silver(roughness: f32) -> Self {
        Self::measured(roughness, [0.0569, 0.0540, 0.0469], [4.2543, 3.4290, 2.8028])
    }

    /// Copper: Johnson & Christy 1972, interpolated at 630, 532 and 465 nm.
    pub fn copper(roughness: f32) -> Self {
        Self::measured(roughness, [0.2753, 1.1159, 1.2469], [3.3726, 2.5956, 2.4562])
    }

    /// Aluminium: Rakić 1995, "Algorithm for the determination of intrinsic optical constants of metal films",
    /// interpolated at 630, 532 and 465 nm.
    pub fn aluminium(roughness: f32) -> Self {
        Self::measured(roughness, [1.4303, 0.9388, 0.6860], [7.5081, 6.4195, 5.6351])
    }
}

/// The direction mirrored to the upper side.
#[inline]
pub(crate) fn upper(w: Vec3A) -> Vec3A {
    Vec3A::new(w.x, w.y, w.z.abs())
}

impl Bsdf for Conductor {
    fn lobes(&self) -> Lobes {
        let spread = if self.ggx.is_smooth() { Lobes::DELTA } else { Lobes::GLOSSY };
        Lobes::REFLECTION | Lobes::RECIPROCAL | spread
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.eval_pdf(wo, wi, mode).0
    }

    #[inline]
    fn pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> f32 {
        if !(wo.z * wi.z > 0.0) || self.ggx.is_smooth() {
            return 0.0;
        }
        let (wo, wi) = (upper(wo), upper(wi));
        let Some(m) = vector::try_normalize(wo + wi) else {
            return 0.0;
        };
        let pdf = self.ggx.d(m) * self.ggx.reflecting_term(wo);
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    #[inline]
    fn sample(&self, wo: Vec3A, _u_lobe: f32, u: Vec2, _mode: Mode) -> Option<BsdfSample> {
        if self.ggx.is_smooth() {
            return reflect_about_z(wo, self.fresnel.reflectance(wo.z), 1.0);
        }
        if !(wo.z.abs() > 0.0) {
            return None;
        }
        let o = upper(wo);
        let m = self.ggx.sample_reflecting(o, u);
        let cos = o.dot(m);
        let i = m * (2.0 * cos) - o;
        if !(i.z > 0.0 && cos > 0.0) {
            return None;
        }
        let density = self.ggx.reflecting_term(o);
        let pdf = self.ggx.d(m) * density;
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        // D has cancelled: F G2 / (4 cos θo) over the density's remainder.
        let weight = self.fresnel.reflectance(cos) * (self.ggx.reflection_term(self.masking, o, i) / density);
        let wi = Vec3A::new(i.x, i.y, i.z.copysign(wo.z));
        Some(BsdfSample { wi, weight, pdf, lobe: Lobes::REFLECTION | Lobes::GLOSSY, eta: 1.0 })
    }

    #[inline]
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> (Spectrum, f32) {
        if !(wo.z * wi.z > 0.0) || self.ggx.is_smooth() {
            return (Spectrum::BLACK, 0.0);
        }
        let (wo, wi) = (upper(wo), upper(wi));
        let Some(m) = vector::try_normalize(wo + wi) else {
            return (Spectrum::BLACK, 0.0);
        };
        let d = self.ggx.d(m);
        let f = self.fresnel.reflectance(wo.dot(m)) * (d * self.ggx.reflection_term(self.masking, wo, wi));
        let pdf = d * self.ggx.reflecting_term(wo);
        if f.is_finite() && pdf.is_finite() { (f, pdf) } else { (Spectrum::BLACK, 0.0) }
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Conductor(*self)
    }
}
