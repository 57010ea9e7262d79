use etendue_core::{Spectrum, Vec2, Vec3A, vector};

use crate::bsdf::{ENDS, delta_lobes_among};
use crate::conductor::upper;
use crate::fresnel::{Interface, relative_eta};
use crate::{Bsdf, BsdfAt, BsdfSample, Ggx, Lobes, Masking, Mode, SmoothDielectric};

/// Frosted glass: microfacets of GGX slopes, each a smooth dielectric boundary (Walter et al. 2007). Single scattering.
///
/// `u` draws the facet among the visible ones, `u_lobe` whether it reflects or transmits. Where the lobes are too narrow
/// for single-precision directions it is a [`SmoothDielectric`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric {
    /// Distribution of microfacet normals.
    pub ggx: Ggx,
    /// Refractive index of the interior over that of the exterior. A value that is not positive counts as 1.
    pub eta: f32,
    /// Shadowing between facets, for reflection; see [`Masking`] for transmission.
    pub masking: Masking,
    /// Factor on what gets through, each channel in `[0, 1]`; [`Spectrum::ONE`] for clear glass.
    pub tint: Spectrum,
}

/// One facet met by `wo`: what both lobes share.
struct Facet {
    /// Facet normal, above the surface.
    m: Vec3A,
    /// `wo·m`, positive.
    cos_o: f32,
    /// Probability of reflection.
    reflectance: f32,
    /// Cosine of the refracted direction against `-m`.
    cos_t: f32,
    /// ηt/ηi seen from `wo`.
    eta: f32,
}

impl RoughDielectric {
    /// An isotropic rough boundary with height-correlated masking.
    pub fn new(roughness: f32, eta: f32) -> Self {
        Self { ggx: Ggx::from_roughness(roughness), eta, masking: Masking::default(), tint: Spectrum::ONE }
    }

    /// The same boundary with another masking.
    #[must_use]
    pub fn with_masking(self, masking: Masking) -> Self {
        Self { masking, ..self }
    }

    /// Whether it behaves as its smooth twin: no roughness to speak of, or no interface. Facets bend transmitted light
    /// by about `alpha |eta - 1|`, and the facet is found again from the directions only where that is well above
    /// their rounding.
    #[inline]
    fn is_delta(&self) -> bool {
        let widest =
            if self.ggx.alpha_x() > self.ggx.alpha_y() { self.ggx.alpha_x() } else { self.ggx.alpha_y() };
        self.ggx.is_smooth() || widest * (relative_eta(self.eta, 1.0) - 1.0).abs() < 1e-5
    }

    fn smooth(&self) -> SmoothDielectric {
        SmoothDielectric { eta: self.eta, tint: self.tint }
    }

    #[inline]
    fn facet(m: Vec3A, wo: Vec3A, eta: f32) -> Option<Facet> {
        let cos_o = wo.dot(m);
        if !(cos_o > 0.0 && m.z > 0.0) {
            return None;
        }
        let interface = Interface::from_cos(cos_o, eta);
        let (reflectance, cos_t) = (interface.reflectance as f32, interface.cos_t as f32);
        Some(Facet { m, cos_o, reflectance, cos_t, eta })
    }

    /// Density of the transmitted direction of a facet, per solid angle, without the choice of lobe: that of the
    /// visible normal, `4 cos θom` times that of a reflection, times `|wi·m| / (wi·m + wo·m / eta)²` (equation 17).
    #[inline]
    fn transmitted_density(&self, wo: Vec3A, facet: &Facet) -> f32 {
        let bend = facet.cos_o / facet.eta - facet.cos_t;
        4.0 * facet.cos_o * self.ggx.d(facet.m) * self.ggx.visible_term(wo) * facet.cos_t / (bend * bend)
    }

    /// What radiance loses on its way through.
    #[inline]
    fn carried(mode: Mode, eta: f32) -> f32 {
        match mode {
            Mode::Radiance => 1.0 / (eta * eta),
            Mode::Importance => 1.0,
        }
    }

    /// `wo` above the surface, `wi` anywhere: value and density.
    #[inline]
    fn eval_above(&self, wo: Vec3A, wi: Vec3A, eta: f32, mode: Mode) -> Option<(f32, f32)> {
        if wi.z > 0.0 {
            let facet = Self::facet(vector::try_normalize(wo + wi)?, wo, eta)?;
            let d = facet.reflectance * self.ggx.d(facet.m);
            return Some((d * self.ggx.reflection_term(self.masking, wo, wi), d * self.ggx.visible_term(wo)));
        }
        let h = vector::try_normalize(wo + wi * eta)?;
        let mut facet = Self::facet(if h.z < 0.0 { -h } else { h }, wo, eta)?;
        // The pair of directions fixes the refracted cosine; Snell at the rounded facet would only add noise.
        facet.cos_t = -wi.dot(facet.m);
        if !(facet.cos_t > 0.0) {
            return None;
        }
        let pdf = (1.0 - facet.reflectance) * self.transmitted_density(wo, &facet);
        Some((pdf * self.ggx.g1(upper(wi)) * Self::carried(mode, eta), pdf))
    }
}

impl Bsdf for RoughDielectric {
    fn lobes(&self) -> Lobes {
        let spread = if self.is_delta() { Lobes::DELTA } else { Lobes::GLOSSY };
        Lobes::REFLECTION | Lobes::TRANSMISSION | Lobes::RECIPROCAL | spread
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.eval_pdf(wo, wi, mode).0
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        self.eval_pdf(wo, wi, mode).1
    }

    #[inline]
    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        if self.is_delta() {
            return self.smooth().sample(wo, u_lobe, u, mode);
        }
        if !(wo.z.abs() > 0.0) {
            return None;
        }
        let eta = relative_eta(self.eta, wo.z);
        let o = upper(wo);
        let facet = Self::facet(self.ggx.sample_visible(o, u), o, eta)?;
        let (i, weight, pdf, side) = if u_lobe < facet.reflectance {
            let i = facet.m * (2.0 * facet.cos_o) - o;
            if !(i.z > 0.0) {
                return None;
            }
            let density = self.ggx.visible_term(o);
            let weight = self.ggx.reflection_term(self.masking, o, i) / density;
            (i, weight, facet.reflectance * self.ggx.d(facet.m) * density, Lobes::REFLECTION)
        } else {
            let i = facet.m * (facet.cos_o / eta - facet.cos_t) - o / eta;
            if !(i.z < 0.0) {
                return None;
            }
            let weight = self.ggx.g1(upper(i)) * Self::carried(mode, eta);
            let pdf = (1.0 - facet.reflectance) * self.transmitted_density(o, &facet);
            (i, weight, pdf, Lobes::TRANSMISSION)
        };
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        let wi = if wo.z < 0.0 { Vec3A::new(i.x, i.y, -i.z) } else { i };
        let crossed = if side == Lobes::TRANSMISSION { eta } else { 1.0 };
        let weight = if side == Lobes::TRANSMISSION { self.tint * weight } else { Spectrum::gray(weight) };
        Some(BsdfSample { wi, weight, pdf, lobe: side | Lobes::GLOSSY, eta: crossed })
    }

    #[inline]
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> (Spectrum, f32) {
        if self.is_delta() || !(wo.z.abs() > 0.0 && wi.z.abs() > 0.0) {
            return (Spectrum::BLACK, 0.0);
        }
        let eta = relative_eta(self.eta, wo.z);
        let i = if wo.z < 0.0 { Vec3A::new(wi.x, wi.y, -wi.z) } else { wi };
        match self.eval_above(upper(wo), i, eta, mode) {
            Some((f, pdf)) if f.is_finite() && pdf.is_finite() => {
                (if i.z < 0.0 { self.tint * f } else { Spectrum::gray(f) }, pdf)
            }
            _ => (Spectrum::BLACK, 0.0),
        }
    }

    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        if self.is_delta() { delta_lobes_among(self, wo, mode, ENDS) } else { [None; 2] }
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::RoughDielectric(*self)
    }
}
