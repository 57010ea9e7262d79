use etendue_core::{Spectrum, Vec2, Vec3A, vector};

use crate::bsdf::delta_lobes_among;
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

    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        if self.ggx.is_smooth() { delta_lobes_among(self, wo, mode, [0.0]) } else { [None; 2] }
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Conductor(*self)
    }
}
