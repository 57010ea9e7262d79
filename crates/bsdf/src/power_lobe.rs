//! What the two Phong models share: a base, a lobe of a power of a cosine, and the choice between them.

use etendue_core::{Spectrum, Vec2, Vec3A, math};
use etendue_sampling::warp;

use crate::conductor::upper;
use crate::lambert::Lambert;
use crate::{Bsdf, BsdfSample, Lobes, Mode};

/// The largest exponent: a lobe of about 10⁻³ radians, which directions in single precision still resolve.
pub(crate) const MOST: f32 = 1e6;

/// An exponent that can be used: in `[0, 10⁶]`, NaN is 0.
pub(crate) fn sane_exponent(n: f32) -> f32 {
    if n > 0.0 { n.clamp(0.0, MOST) } else { 0.0 }
}

/// A reflectance that can be used: each channel in `[0, most]`, NaN is 0.
pub(crate) fn sane_share(s: Spectrum, most: Spectrum) -> Spectrum {
    let held = |v: f32, most: f32| if v > 0.0 { v.clamp(0.0, most) } else { 0.0 };
    Spectrum::rgb(held(s.r(), most.r()), held(s.g(), most.g()), held(s.b(), most.b()))
}

/// `(1 − x)ⁿ` for `x` in `[0, 1)`, 0 for everything else. By the logarithm of what is missing to 1, so that a narrow
/// lobe keeps its digits.
#[inline]
pub(crate) fn power_of_rest(x: f32, n: f32) -> f32 {
    if (0.0..1.0).contains(&x) { math::exp(n * math::ln_1p(-x)) } else { 0.0 }
}

/// A lobe: what it has per solid angle at a pair of directions above the surface.
pub(crate) trait PowerLobe {
    /// The base's reflectance.
    fn base(&self) -> Spectrum;
    /// The lobe's factor.
    fn factor(&self) -> Spectrum;
    /// The lobe for a factor of 1, times the cosine at `i`, and its density, both sr⁻¹.
    fn lobe(&self, o: Vec3A, i: Vec3A) -> (f32, f32);
    /// A direction with that density, perhaps below the surface, where it is lost.
    fn draw(&self, o: Vec3A, u: Vec2) -> Option<Vec3A>;
}

/// Probability of drawing from the base; `None` where nothing comes back.
#[inline]
fn p_base(b: &impl PowerLobe) -> Option<f32> {
    let (base, lobe) = (b.base().mean(), b.factor().mean());
    let all = base + lobe;
    (all > 0.0).then(|| base / all)
}

pub(crate) fn lobes(b: &impl PowerLobe) -> Lobes {
    let mut out = Lobes::REFLECTION | Lobes::RECIPROCAL;
    out.set(Lobes::DIFFUSE, !b.base().is_black());
    out.set(Lobes::GLOSSY, !b.factor().is_black());
    out
}

/// Base, lobe and density.
#[inline]
pub(crate) fn parts(b: &impl PowerLobe, wo: Vec3A, wi: Vec3A) -> (Spectrum, Spectrum, f32) {
    let dark = (Spectrum::BLACK, Spectrum::BLACK, 0.0);
    if !(wo.z * wi.z > 0.0) {
        return dark;
    }
    let Some(p) = p_base(b) else { return dark };
    let cosine = Lambert::new(b.base()).eval_pdf(wo, wi, Mode::Radiance);
    let (value, density) = b.lobe(upper(wo), upper(wi));
    let (lobe, pdf) = (b.factor() * value, cosine.1 * p + density * (1.0 - p));
    if lobe.is_finite() && pdf.is_finite() { (cosine.0, lobe, pdf) } else { dark }
}

#[inline]
pub(crate) fn sample(b: &impl PowerLobe, wo: Vec3A, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
    // A wo in the surface sees nothing.
    if !(wo.z.abs() > 0.0 && wo.is_finite()) {
        return None;
    }
    let p = p_base(b)?;
    let (i, kind) =
        if u_lobe < p { (warp::cosine(u), Lobes::DIFFUSE) } else { (b.draw(upper(wo), u)?, Lobes::GLOSSY) };
    if !(i.z > 0.0 && i.is_finite()) {
        return None;
    }
    let wi = Vec3A::new(i.x, i.y, i.z.copysign(wo.z));
    let (base, lobe, pdf) = parts(b, wo, wi);
    let weight = (base + lobe) / pdf;
    let lobe = Lobes::REFLECTION | kind;
    (pdf > 0.0 && weight.is_finite()).then_some(BsdfSample { wi, weight, pdf, lobe, eta: 1.0 })
}

/// A [`PowerLobe`] as a [`Bsdf`], held by value in the variant of [`BsdfAt`] that has its name. Everything is out of line:
/// inlined into `BsdfAt`, big frames slow every other model down.
macro_rules! power_lobe_bsdf {
    ($model:ident) => {
        impl Bsdf for $model {
            fn lobes(&self) -> Lobes {
                power_lobe::lobes(self)
            }

            fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
                self.eval_pdf(wo, wi, mode).0
            }

            fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
                self.eval_pdf(wo, wi, mode).1
            }

            #[inline(never)]
            fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, _mode: Mode) -> Option<BsdfSample> {
                power_lobe::sample(self, wo, u_lobe, u)
            }

            #[inline(never)]
            fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> (Spectrum, f32) {
                let (base, lobe, pdf) = power_lobe::parts(self, wo, wi);
                (base + lobe, pdf)
            }

            fn eval_classes(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> [Spectrum; 4] {
                let (base, lobe, _) = power_lobe::parts(self, wo, wi);
                [base, lobe, Spectrum::BLACK, Spectrum::BLACK]
            }

            fn at(&self) -> BsdfAt<'_> {
                BsdfAt::$model(*self)
            }
        }
    };
}
pub(crate) use power_lobe_bsdf;
