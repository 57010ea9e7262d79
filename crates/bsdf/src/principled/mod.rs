mod opaque;

use std::f32::consts::FRAC_1_PI;

use etendue_core::{Spectrum, Vec2, Vec3A};
use etendue_sampling::warp;

use crate::conductor::upper;
use crate::mirror::reflect_about_z;
use crate::{Bsdf, BsdfAt, BsdfSample, Ggx, Lobes, Masking, Mode, RoughDielectric, Scatter, ThinDielectric};
use opaque::{Opaque, Reflected, Toward, amount};

/// Which formulas stand behind glTF's parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Meaning {
    /// Facets that pass light on to each other, over a base that gets what they let through: a white surface returns
    /// all light at every angle and roughness, within 0.5 %. Reciprocal. Height-correlated GGX with the compensation of
    /// Kulla & Conty 2017; the base is coupled as by Ashikhmin & Shirley 2000 and Kelemen & Szirmay-Kalos 2001,
    /// `(1 − ρ(μo)) (1 − ρ(μi)) / (1 − ρ_mean)`.
    #[default]
    EnergyPreserving,
    /// glTF 2.0's appendix B to the letter: single scattering, separable masking, a base weighted by `1 − F(v·h)`, alpha
    /// at least 0.001 (but for a pure metal, which may be a mirror). Reciprocal, but **not energy preserving**: at
    /// grazing angles a bright base and its highlight together return up to twice what arrives, and rough metals lose
    /// up to 70 %.
    GltfB,
}

/// glTF 2.0's metallic-roughness surface with KHR_materials_specular, _ior and _transmission.
///
/// Three things mixed by their shares: a metal (`metallic`); a dielectric over a matte base
/// (`(1 − metallic) (1 − transmission)`); and a dielectric that lets light through
/// (`(1 − metallic) transmission`): a [`RoughDielectric`], or a [`ThinDielectric`] for a wall without thickness, both
/// with the exact Fresnel term of `ior` and what gets through tinted by `base_color`. The others have Schlick's term
/// from `F0 = min(((ior − 1) / (ior + 1))² specular_color, 1) specular` and `F90 = specular`, or from the base colour
/// and 1 for the metal. `specular` and its colour do not act on the share that lets light through. Where
/// `specular_color` is a colour, the base gets what the channel reflected most leaves over, so that it does not take on
/// the complementary colour.
///
/// Colours and shares are in `[0, 1]` (`specular_color` may be more); all reflection is two-sided, and a solid body is on
/// the back. Where `ggx` is smooth, facets are a mirror beside the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    /// Reflectance of the base, or of the metal at normal incidence; tint of what gets through.
    pub base_color: Spectrum,
    /// Colour of the dielectric's reflection at normal incidence.
    pub specular_color: Spectrum,
    /// Isotropic distribution of microfacet normals.
    pub ggx: Ggx,
    /// Share of metal.
    pub metallic: f32,
    /// Refractive index of the inside over that of the outside; 0 stands for one without bound, whose F0 is 1 and which
    /// lets nothing through (KHR_materials_ior).
    pub ior: f32,
    /// Strength of the dielectric's reflection.
    pub specular: f32,
    /// Share of the light entering the dielectric that goes through.
    pub transmission: f32,
    /// Whether it is a wall without thickness rather than the boundary of a body.
    pub thin: bool,
    /// By which formulas.
    pub meaning: Meaning,
}

/// What `wo` settles: where it looks from, and the probability of drawing from each part.
struct Outgoing {
    opaque: Opaque,
    to: Toward,
    /// `wo`, mirrored above the surface.
    o: Vec3A,
    /// Share of the transmitting part.
    clear: f32,
    p_clear: f32,
    p_specular: f32,
    p_repeated: f32,
    p_base: f32,
}

impl Principled {
    /// The least alpha of appendix B, where not all is metal.
    pub const LEAST_ALPHA: f32 = 1e-3;

    /// glTF's defaults for the rest: ior 1.5, full specular reflection, opaque.
    pub fn new(base_color: Spectrum, metallic: f32, roughness: f32) -> Self {
        Self {
            base_color,
            specular_color: Spectrum::ONE,
            ggx: Ggx::from_roughness(roughness),
            metallic,
            ior: 1.5,
            specular: 1.0,
            transmission: 0.0,
            thin: false,
            meaning: Meaning::default(),
        }
    }

    /// F0 and F90 of the dielectric.
    #[inline]
    fn dielectric_facets(&self) -> (Spectrum, f32) {
        let root = (self.ior - 1.0) / (self.ior + 1.0);
        let f0 = self.specular_color * (root * root);
        (f0.map(|c| if c > 0.0 { c.clamp(0.0, 1.0) } else { 0.0 }) * self.specular, self.specular)
    }

    /// Share of all that lets light through: none where all is reflected.
    #[inline]
    fn transmitting(&self) -> f32 {
        if self.ior > 0.0 { self.transmission * (1.0 - self.metallic) } else { 0.0 }
    }

    /// What lets light through.
    #[inline]
    fn clear(&self) -> BsdfAt<'static> {
        let masking = match self.meaning {
            Meaning::EnergyPreserving => Masking::HeightCorrelated,
            Meaning::GltfB => Masking::Separable,
        };
        let (ggx, eta, tint) = (self.ggx, self.ior, self.base_color);
        if self.thin {
            BsdfAt::ThinDielectric(ThinDielectric { ggx, eta, masking, tint })
        } else {
            BsdfAt::RoughDielectric(RoughDielectric { ggx, eta, masking, tint })
        }
    }

    /// Drawing by the cosine, density per solid angle.
    #[inline]
    fn cosine_pdf(i: Vec3A) -> f32 {
        i.z.clamp(0.0, 1.0) * FRAC_1_PI
    }

    /// `None` for a direction in the surface, and where nothing comes back.
    #[inline]
    fn outgoing(&self, wo: Vec3A) -> Option<Outgoing> {
        if !(wo.z.abs() > 0.0 && wo.is_finite()) {
            return None;
        }
        let (opaque, clear) = (Opaque::new(self), self.transmitting());
        let to = opaque.toward(wo.z);
        let rest = 1.0 - clear;
        let specular = rest * amount(opaque.specular_albedo(&to));
        let repeated = rest * amount(opaque.repeated_albedo(&to));
        let base = rest * amount(opaque.base_albedo(&to));
        let all = clear + specular + repeated + base;
        (all > 0.0).then(|| Outgoing {
            opaque,
            to,
            o: upper(wo),
            clear,
            p_clear: clear / all,
            p_specular: specular / all,
            p_repeated: repeated / all,
            p_base: base / all,
        })
    }

    /// Light and density of all that is no delta, by what sends it on: facets, base, and the part that lets through.
    #[inline]
    fn parts(&self, at: &Outgoing, wo: Vec3A, wi: Vec3A, mode: Mode) -> ([Spectrum; 3], f32) {
        let mut out = [Spectrum::BLACK; 3];
        let mut pdf = 0.0;
        if at.p_clear > 0.0 {
            let (f, p) = self.clear().eval_pdf(wo, wi, mode);
            out[2] = f * at.clear;
            pdf = p * at.p_clear;
        }
        if at.p_clear < 1.0 && wo.z * wi.z > 0.0 {
            let i = upper(wi);
            if let Some(Reflected { specular, base, pdf: narrow }) = at.opaque.eval(at.o, i, &at.to) {
                let rest = 1.0 - at.clear;
                out[0] = specular * rest;
                out[1] = base * rest;
                pdf += narrow * at.p_specular
                    + at.opaque.repeated_pdf(i.z) * at.p_repeated
                    + Self::cosine_pdf(i) * at.p_base;
            }
        }
        let finite = out.iter().all(|f| f.is_finite()) && pdf.is_finite();
        if finite { (out, pdf) } else { ([Spectrum::BLACK; 3], 0.0) }
    }

    #[inline]
    fn eval_from(&self, at: &Outgoing, wo: Vec3A, wi: Vec3A, mode: Mode) -> (Spectrum, f32) {
        let ([a, b, c], pdf) = self.parts(at, wo, wi, mode);
        (a + b + c, pdf)
    }

    /// The mirrored direction, which the transmitting part and smooth facets may share.
    fn mirrored(&self, at: &Outgoing, wo: Vec3A, mode: Mode) -> Option<BsdfSample> {
        let (mut light, mut chosen) = (Spectrum::BLACK, 0.0);
        if at.p_clear > 0.0
            && let Some(s) = self.clear().sample(wo, 0.0, Vec2::ZERO, mode)
            && s.lobe == Lobes::REFLECTION | Lobes::DELTA
        {
            light = s.weight * (s.pdf * at.clear);
            chosen = s.pdf * at.p_clear;
        }
        if at.p_specular > 0.0 && at.opaque.ggx.is_smooth() {
            light += at.opaque.mirror(wo.z) * (1.0 - at.clear);
            chosen += at.p_specular;
        }
        reflect_about_z(wo, light / chosen, chosen)
    }

    #[inline]
    fn sample_from(&self, at: &Outgoing, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let before_base = at.p_clear + at.p_specular + at.p_repeated;
        let (i, spread) = if u_lobe < at.p_clear {
            let s = self.clear().sample(wo, (u_lobe / at.p_clear).clamp(0.0, BELOW_ONE), u, mode)?;
            if at.p_clear < 1.0 && s.lobe == Lobes::REFLECTION | Lobes::DELTA {
                return self.mirrored(at, wo, mode);
            }
            if at.p_clear >= 1.0 || s.lobe.contains(Lobes::TRANSMISSION) {
                let weight = s.weight * (at.clear / at.p_clear);
                return Some(BsdfSample { weight, pdf: s.pdf * at.p_clear, ..s });
            }
            (upper(s.wi), Lobes::GLOSSY)
        } else if u_lobe < at.p_clear + at.p_specular {
            if at.opaque.ggx.is_smooth() {
                return self.mirrored(at, wo, mode);
            }
            let m = at.opaque.ggx.sample_reflecting(at.o, u);
            let cos = at.o.dot(m);
            let i = m * (2.0 * cos) - at.o;
            if !(i.z > 0.0 && cos > 0.0) {
                return None;
            }
            (i, Lobes::GLOSSY)
        } else if u_lobe < before_base {
            (at.opaque.sample_repeated(u), Lobes::DIFFUSE)
        } else {
            (warp::cosine(u), Lobes::DIFFUSE)
        };
        let wi = Vec3A::new(i.x, i.y, i.z.copysign(wo.z));
        let (f, pdf) = self.eval_from(at, wo, wi, mode);
        let weight = f / pdf;
        (pdf > 0.0 && weight.is_finite()).then_some(BsdfSample {
            wi,
            weight,
            pdf,
            lobe: Lobes::REFLECTION | spread,
            eta: 1.0,
        })
    }
}

/// The number before 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

impl Bsdf for Principled {
    #[inline(never)]
    fn lobes(&self) -> Lobes {
        let clear = self.transmitting();
        let mut lobes = Lobes::REFLECTION | Lobes::RECIPROCAL;
        if clear > 0.0 {
            lobes |= self.clear().lobes();
        }
        if clear < 1.0 {
            lobes |= Opaque::lobes(self);
        }
        lobes
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.eval_pdf(wo, wi, mode).0
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        self.eval_pdf(wo, wi, mode).1
    }

    // Out of line: inlined into `BsdfAt`, its frame slows every other model down.
    #[inline(never)]
    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        self.sample_from(&self.outgoing(wo)?, wo, u_lobe, u, mode)
    }

    #[inline(never)]
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> (Spectrum, f32) {
        let at = self.outgoing(wo);
        at.map_or((Spectrum::BLACK, 0.0), |at| self.eval_from(&at, wo, wi, mode))
    }

    #[inline(never)]
    fn scatter(&self, wo: Vec3A, toward_light: Option<Vec3A>, u_lobe: f32, u: Vec2, mode: Mode) -> Scatter {
        let Some(at) = self.outgoing(wo) else {
            return Scatter { eval: Spectrum::BLACK, pdf: 0.0, sample: None };
        };
        let (eval, pdf) = toward_light.map_or((Spectrum::BLACK, 0.0), |wi| self.eval_from(&at, wo, wi, mode));
        Scatter { eval, pdf, sample: self.sample_from(&at, wo, u_lobe, u, mode) }
    }

    /// By the tables; held at 1 where appendix B makes light.
    fn albedo(&self, wo: Vec3A) -> Spectrum {
        let Some(at) = self.outgoing(wo) else { return Spectrum::BLACK };
        let opaque = at.opaque.specular_albedo(&at.to)
            + at.opaque.repeated_albedo(&at.to)
            + at.opaque.base_albedo(&at.to);
        let clear = if at.clear > 0.0 { self.clear().albedo(wo) * at.clear } else { Spectrum::BLACK };
        (opaque * (1.0 - at.clear) + clear).map(|c| c.clamp(0.0, 1.0))
    }

    fn eval_classes(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> [Spectrum; 4] {
        let mut out = [Spectrum::BLACK; 4];
        if let Some(at) = self.outgoing(wo) {
            let ([facets, base, clear], _) = self.parts(&at, wo, wi, mode);
            if wo.z * wi.z < 0.0 {
                out[3] = clear;
            } else {
                out[0] = base;
                out[1] = facets + clear;
            }
        }
        out
    }

    /// Both said outright: what is let through may be drawn too rarely to be found by asking.
    #[inline(never)]
    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        let Some(at) = self.outgoing(wo) else { return [None; 2] };
        let through = if at.p_clear > 0.0 { self.clear().delta_lobes(wo, mode)[1] } else { None };
        let mirrors = self.mirrored(&at, wo, mode).filter(|s| s.pdf > 0.0 && s.weight.is_finite());
        [
            mirrors.map(|s| BsdfSample { weight: s.weight * s.pdf, pdf: 1.0, ..s }),
            through.map(|s| BsdfSample { weight: s.weight * at.clear, ..s }),
        ]
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Principled(*self)
    }
}
