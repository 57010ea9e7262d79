use etendue_core::{Spectrum, Vec2, Vec3A, vector};

use crate::bsdf::{ENDS, delta_lobes_among};
use crate::conductor::upper;
use crate::fresnel::{Interface, relative_eta};
use crate::mirror::reflect_about_z;
use crate::{Bsdf, BsdfAt, BsdfSample, Ggx, Lobes, Masking, Mode};

/// A wall of glass without thickness, as glTF's KHR_materials_transmission means it: what is not reflected goes on
/// undeflected, blurred by the lobe that reflection has, mirrored to the far side.
///
/// One interface reflects, by the exact Fresnel term at the facet; light between the two faces of a real pane is not
/// followed. Both sides are outside: `eta` is met from either. Where the lobe is too narrow for single-precision
/// directions, it is a mirror and a straight way through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric {
    /// Distribution of microfacet normals.
    pub ggx: Ggx,
    /// Refractive index of the wall over that around it. A value that is not positive counts as 1.
    pub eta: f32,
    /// Shadowing between facets, for both lobes.
    pub masking: Masking,
    /// Factor on what gets through, each channel in `[0, 1]`.
    pub tint: Spectrum,
}

impl ThinDielectric {
    /// A clear, isotropic wall with height-correlated masking.
    pub fn new(roughness: f32, eta: f32) -> Self {
        Self { ggx: Ggx::from_roughness(roughness), eta, masking: Masking::default(), tint: Spectrum::ONE }
    }

    #[inline]
    fn reflectance(&self, cos: f32) -> f32 {
        Interface::from_cos(cos, relative_eta(self.eta, 1.0)).reflectance as f32
    }

    /// Share of a facet's light that leaves by a side, and the probability of that side.
    #[inline]
    fn share(&self, cos: f32, through: bool) -> (Spectrum, f32) {
        let r = self.reflectance(cos);
        if through { (self.tint * (1.0 - r), 1.0 - r) } else { (Spectrum::gray(r), r) }
    }

    fn straight(&self, wo: Vec3A, u_lobe: f32) -> Option<BsdfSample> {
        let r = self.reflectance(wo.z);
        if u_lobe < r {
            return reflect_about_z(wo, Spectrum::ONE, r);
        }
        (wo.z.abs() > 0.0 && wo.is_finite()).then(|| BsdfSample {
            wi: -wo,
            weight: self.tint,
            pdf: 1.0 - r,
            lobe: Lobes::TRANSMISSION | Lobes::DELTA,
            eta: 1.0,
        })
    }
}

impl Bsdf for ThinDielectric {
    fn lobes(&self) -> Lobes {
        let spread = if self.ggx.is_smooth() { Lobes::DELTA } else { Lobes::GLOSSY };
        Lobes::REFLECTION | Lobes::TRANSMISSION | Lobes::RECIPROCAL | spread
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.eval_pdf(wo, wi, mode).0
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        self.eval_pdf(wo, wi, mode).1
    }

    #[inline]
    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, _mode: Mode) -> Option<BsdfSample> {
        if self.ggx.is_smooth() {
            return self.straight(wo, u_lobe);
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
        let through = u_lobe >= self.reflectance(cos);
        let (_, chosen) = self.share(cos, through);
        let density = self.ggx.reflecting_term(o);
        let pdf = chosen * self.ggx.d(m) * density;
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        // The facet's share has cancelled but for the tint, and D.
        let kept = self.ggx.reflection_term(self.masking, o, i) / density;
        let (weight, side) = if through {
            (self.tint * kept, Lobes::TRANSMISSION)
        } else {
            (Spectrum::gray(kept), Lobes::REFLECTION)
        };
        let z = if through { i.z.copysign(-wo.z) } else { i.z.copysign(wo.z) };
        let wi = Vec3A::new(i.x, i.y, z);
        Some(BsdfSample { wi, weight, pdf, lobe: side | Lobes::GLOSSY, eta: 1.0 })
    }

    #[inline]
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> (Spectrum, f32) {
        if !(wo.z.abs() > 0.0 && wi.z.abs() > 0.0) || self.ggx.is_smooth() {
            return (Spectrum::BLACK, 0.0);
        }
        let (o, i) = (upper(wo), upper(wi));
        let Some(m) = vector::try_normalize(o + i) else {
            return (Spectrum::BLACK, 0.0);
        };
        let (share, chosen) = self.share(o.dot(m), wo.z * wi.z < 0.0);
        let d = self.ggx.d(m);
        let f = share * (d * self.ggx.reflection_term(self.masking, o, i));
        let pdf = chosen * d * self.ggx.reflecting_term(o);
        if f.is_finite() && pdf.is_finite() { (f, pdf) } else { (Spectrum::BLACK, 0.0) }
    }

    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        if self.ggx.is_smooth() { delta_lobes_among(self, wo, mode, ENDS) } else { [None; 2] }
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::ThinDielectric(*self)
    }
}
