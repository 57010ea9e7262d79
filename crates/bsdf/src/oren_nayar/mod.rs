mod fujii;
mod transformed_cosine;

use std::f32::consts::FRAC_1_PI;

use etendue_core::{Spectrum, Vec2, Vec3A};

use crate::conductor::upper;
use crate::{Bsdf, BsdfAt, BsdfSample, Lobes, Mode};
use fujii::Fujii;
use transformed_cosine::TransformedCosine;

/// A rough matte surface, two-sided: EON, the energy-preserving Oren–Nayar model of Portsmouth, Kutz & Hill 2025
/// ("EON: a practical energy-preserving rough diffuse BRDF", Journal of Computer Graphics Techniques 14(1)).
///
/// Single scattering as Fujii's form of Oren & Nayar 1994 has it, and what it loses returned as if scattered again
/// between the facets, so that a white surface returns all light at every angle and roughness; a coloured one becomes
/// more saturated with roughness. Reciprocal. At roughness 0 it is [`Lambert`](crate::Lambert).
///
/// Sampled by clipped linearly transformed cosines and a uniform part (the paper's section 4): weights of a white surface
/// stay below 1.5; drawn by the cosine they reach 8 at μ = 0.1 and 70 at μ = 0.001
/// (`cargo test -p etendue-bsdf eon_weights -- --nocapture`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayar {
    /// Reflectance of one facet, each channel in `[0, 1]`; that of the whole surface where it is 0 or 1.
    pub rho: Spectrum,
    roughness: f32,
}

impl OrenNayar {
    /// Of facets that reflect `rho`, each channel in `[0, 1]`, and a roughness in `[0, 1]` (0 is smooth; what is outside
    /// is brought to the range's end, NaN is 0).
    pub fn new(rho: Spectrum, roughness: f32) -> Self {
        Self { rho, roughness: if roughness > 0.0 { roughness.clamp(0.0, 1.0) } else { 0.0 } }
    }

    /// How rough, in `[0, 1]`.
    pub fn roughness(&self) -> f32 {
        self.roughness
    }

    /// Reflectance of what is scattered more than once (equation 17's factor).
    #[inline]
    fn repeated(&self, fujii: &Fujii) -> Spectrum {
        let mean = fujii.mean_albedo();
        self.rho.map(|rho| rho * rho * mean / (1.0 - rho * (1.0 - mean)))
    }
}

// Everything is out of line: inlined into `BsdfAt`, big frames slow every other model down.
impl Bsdf for OrenNayar {
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION | Lobes::DIFFUSE | Lobes::RECIPROCAL
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.eval_pdf(wo, wi, mode).0
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        self.eval_pdf(wo, wi, mode).1
    }

    #[inline(never)]
    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        // A wo in the surface sees nothing.
        if !(wo.z.abs() > 0.0 && wo.is_finite()) {
            return None;
        }
        let i = TransformedCosine::new(upper(wo), self.roughness).sample(u_lobe, u)?;
        let wi = Vec3A::new(i.x, i.y, i.z.copysign(wo.z));
        let (f, pdf) = self.eval_pdf(wo, wi, mode);
        let weight = f / pdf;
        let lobe = Lobes::REFLECTION | Lobes::DIFFUSE;
        (pdf > 0.0 && weight.is_finite()).then_some(BsdfSample { wi, weight, pdf, lobe, eta: 1.0 })
    }

    #[inline(never)]
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> (Spectrum, f32) {
        if !(wo.z * wi.z > 0.0) {
            return (Spectrum::BLACK, 0.0);
        }
        let (o, i) = (upper(wo), upper(wi));
        let fujii = Fujii::new(self.roughness);
        let f = self.rho * fujii.single(o, i) + self.repeated(&fujii) * fujii.missing(o.z, i.z);
        let f = f * (i.z.clamp(0.0, 1.0) * FRAC_1_PI);
        let pdf = TransformedCosine::new(o, self.roughness).pdf(i);
        if f.is_finite() && pdf.is_finite() { (f, pdf) } else { (Spectrum::BLACK, 0.0) }
    }

    /// Exact (equation 20).
    fn albedo(&self, wo: Vec3A) -> Spectrum {
        let fujii = Fujii::new(self.roughness);
        let lost = fujii.lost(wo.z.abs());
        self.rho * (1.0 - lost) + self.repeated(&fujii) * lost
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::OrenNayar(*self)
    }
}
