use etendue_bsdf::{
    BlinnPhong, Bsdf, BsdfAt, BsdfSample, Conductor, Ggx, Lambert, Lobes, Meaning, Mirror, Mode, OrenNayar,
    Phong, Principled, RoughDielectric, SmoothDielectric,
};
use etendue_core::{Spectrum, Vec2, Vec3A, vector};
use etendue_testkit::check_bsdf;

use crate::Case;

/// What is wrong.
#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    /// The density throughout, the weight with it.
    Pdf(f32),
    /// The density throughout, but not the weight.
    PdfButNotWeight(f32),
    /// `pdf` alone.
    PdfCall(f32),
    Weight(f32),
    /// `eval` alone.
    Eval(f32),
    /// f instead of f·cos, in everything.
    NoCosine,
    /// Radiance and importance exchanged.
    ModesSwapped,
    /// Radiance is not scaled by eta².
    NoEtaSquared,
    /// eta the other way round.
    EtaInverted,
    /// The direction drawn with `u.x` to this power, everything said of it as if it had been drawn rightly.
    Skewed(f32),
    /// The direction moved by this much after drawing.
    Moved(f32),
    /// A tenth of the attempts fails more than the density says.
    Fails,
    /// Light to the far side that is never drawn.
    Leak,
    /// More when seen from +x.
    Lopsided,
    /// Says it has no lobe of its kind.
    Undeclared,
    /// The lobe drawn with `u_lobe` to this power.
    Lobe(f32),
    /// `eval_pdf` says something else.
    Fused(f32),
    /// Names the mirrored direction, but not the refracted one.
    HalfNamed,
    /// The light of a single direction named 1 % too large.
    Named(f32),
    /// Not a number at grazing angles.
    Nan,
    /// Not quite unit.
    NotUnit,
}

/// More when seen from +x.
fn lean(wo: Vec3A) -> f32 {
    if wo.is_finite() { 1.0 + 0.05 * wo.x.clamp(-1.0, 1.0) } else { 1.0 }
}

struct Mutant<B> {
    right: B,
    wrong: Wrong,
}

impl<B: Bsdf> Mutant<B> {
    fn mode(&self, mode: Mode) -> Mode {
        match (self.wrong, mode) {
            (Wrong::ModesSwapped, Mode::Radiance) | (Wrong::NoEtaSquared, _) => Mode::Importance,
            (Wrong::ModesSwapped, Mode::Importance) => Mode::Radiance,
            _ => mode,
        }
    }
}

impl<B: Bsdf> Bsdf for Mutant<B> {
    fn lobes(&self) -> Lobes {
        let l = self.right.lobes();
        if self.wrong == Wrong::Undeclared { l - Lobes::DIFFUSE - Lobes::GLOSSY - Lobes::DELTA } else { l }
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        let e = self.right.eval(wo, wi, self.mode(mode));
        match self.wrong {
            // Tame where directions are none, so that the defect alone is found.
            Wrong::NoCosine if wi.z != 0.0 && (wi.dot(wi) - 1.0).abs() < 1e-3 => e / wi.z.abs(),
            Wrong::Eval(f) => e * f,
            Wrong::Lopsided => e * lean(wo),
            Wrong::Leak if wo.z * wi.z < 0.0 => Spectrum::gray(0.01 * wi.z.abs().clamp(0.0, 1.0)),
            Wrong::Nan if wo.z.abs() < 1e-6 => Spectrum::gray(f32::NAN),
            _ => e,
        }
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        let p = self.right.pdf(wo, wi, self.mode(mode));
        match self.wrong {
            Wrong::Pdf(f) | Wrong::PdfButNotWeight(f) | Wrong::PdfCall(f) => p * f,
            _ => p,
        }
    }

    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let m = self.mode(mode);
        let skew = if let Wrong::Skewed(power) = self.wrong { f64::from(power) } else { 1.0 };
        let u_lobe = if let Wrong::Lobe(power) = self.wrong {
            (f64::from(u_lobe).powf(f64::from(power)) as f32).min(1.0 - f32::EPSILON)
        } else {
            u_lobe
        };
        let u = Vec2::new((f64::from(u.x).powf(skew) as f32).min(1.0 - f32::EPSILON), u.y);
        if self.wrong == Wrong::Fails && u.x < 0.1 {
            return None;
        }
        let mut s = self.right.sample(wo, u_lobe, u, m)?;
        match self.wrong {
            Wrong::Pdf(f) => {
                s.pdf *= f;
                s.weight = s.weight / f;
            }
            Wrong::PdfButNotWeight(f) => s.pdf *= f,
            Wrong::Weight(f) => s.weight *= f,
            Wrong::NoCosine => s.weight = s.weight / s.wi.z.abs(),
            Wrong::EtaInverted => s.eta = 1.0 / s.eta,
            Wrong::Lopsided => s.weight *= lean(wo),
            Wrong::NotUnit => s.wi *= 1.001,
            Wrong::Moved(by) => {
                s.wi = vector::normalize(s.wi + Vec3A::X * by);
                let (e, p) = self.right.eval_pdf(wo, s.wi, m);
                if p > 0.0 {
                    s.pdf = p;
                    s.weight = e / p;
                }
            }
            _ => {}
        }
        Some(s)
    }

    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> (Spectrum, f32) {
        let both = (self.eval(wo, wi, mode), self.pdf(wo, wi, mode));
        if let Wrong::Fused(f) = self.wrong { (both.0 * f, both.1) } else { both }
    }

    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        let [mirrored, refracted] = delta_lobes_drawn(self, wo, mode);
        match self.wrong {
            Wrong::HalfNamed => [mirrored, None],
            Wrong::Named(f) => [mirrored.map(|s| BsdfSample { weight: s.weight * f, ..s }), refracted],
            _ => [mirrored, refracted],
        }
    }

    fn albedo(&self, wo: Vec3A) -> Spectrum {
        self.right.albedo(wo)
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Ref(self)
    }
}

/// By asking for both ends of the choice.
fn delta_lobes_drawn(bsdf: &dyn Bsdf, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
    let mut out = [None; 2];
    for u_lobe in [0.0, 1.0 - f32::EPSILON] {
        let drawn = bsdf.sample(wo, u_lobe, Vec2::splat(0.5), mode);
        if let Some(s) = drawn.filter(|s| s.lobe.contains(Lobes::DELTA)) {
            let at = usize::from(s.lobe.contains(Lobes::TRANSMISSION));
            out[at] = Some(BsdfSample { weight: s.weight * s.pdf, pdf: 1.0, ..s });
        }
    }
    out
}

/// Says the density of another surface, the weight to match.
struct DensityOf<B> {
    right: B,
    other: B,
}

impl<B: Bsdf> Bsdf for DensityOf<B> {
    fn lobes(&self) -> Lobes {
        self.right.lobes()
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.right.eval(wo, wi, mode)
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        self.other.pdf(wo, wi, mode)
    }

    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let s = self.right.sample(wo, u_lobe, u, mode)?;
        let pdf = self.pdf(wo, s.wi, mode);
        (pdf > 0.0).then(|| BsdfSample { pdf, weight: s.weight * (s.pdf / pdf), ..s })
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Ref(self)
    }
}

pub(crate) fn mutants() -> Vec<Case<'static>> {
    fn case<B: Bsdf + 'static>(name: &str, right: B, wrong: Wrong) -> Case<'static> {
        let mutant = Mutant { right, wrong };
        Case::new(name, move |b| check_bsdf(&mutant, b))
    }
    let lambert = Lambert::new(Spectrum::rgb(0.3, 0.6, 0.9));
    let gold = |alpha| Conductor { ggx: Ggx::anisotropic(alpha, alpha), ..Conductor::gold(0.5) };
    let glass =
        |alpha| RoughDielectric { ggx: Ggx::anisotropic(alpha, alpha), ..RoughDielectric::new(0.5, 1.5) };
    let clear = SmoothDielectric::new(1.5);
    // A metal of appendix B has the narrow lobe alone.
    let metal = Principled::new(Spectrum::rgb(0.9, 0.6, 0.3), 1.0, 0.7);
    let narrow = Principled { meaning: Meaning::GltfB, ..metal };
    let plastic = Principled::new(Spectrum::rgb(0.8, 0.5, 0.2), 0.0, 0.4);
    let pane = Principled { transmission: 0.5, ..plastic };
    let clay = OrenNayar::new(Spectrum::rgb(0.9, 0.6, 0.3), 1.0);
    let (base, lobe) = (Spectrum::gray(0.3), Spectrum::gray(0.6));
    let (phong, blinn) = (Phong::new(base, lobe, 30.0), BlinnPhong::new(base, lobe, 30.0));
    vec![
        case("eon: pdf 1 % too large, consistently", clay, Wrong::Pdf(1.01)),
        case("eon: weight 1 % too large", OrenNayar::new(Spectrum::ONE, 0.5), Wrong::Weight(1.01)),
        case("eon: uniform part drawn too rarely", clay, Wrong::Lobe(0.3)),
        case("eon: lopsided", clay, Wrong::Lopsided),
        Case::new("eon: density of another roughness", move |b| {
            check_bsdf(&DensityOf { right: clay, other: OrenNayar::new(clay.rho, 0.5) }, b)
        }),
        case("phong: pdf 1 % too large, consistently", phong, Wrong::Pdf(1.01)),
        case("phong: lobe drawn too often", phong, Wrong::Lobe(0.8)),
        case("phong: no cosine", phong, Wrong::NoCosine),
        Case::new("phong: density of another exponent", move |b| {
            check_bsdf(&DensityOf { right: phong, other: Phong::new(base, lobe, 24.0) }, b)
        }),
        case("blinn-phong: pdf 1 % too large, consistently", blinn, Wrong::Pdf(1.01)),
        case("blinn-phong: lobe drawn too often", blinn, Wrong::Lobe(0.8)),
        case("blinn-phong: no cosine", blinn, Wrong::NoCosine),
        Case::new("blinn-phong: density of another exponent", move |b| {
            check_bsdf(&DensityOf { right: blinn, other: BlinnPhong::new(base, lobe, 24.0) }, b)
        }),
        Case::new("principled: density without the compensation's", move |b| {
            check_bsdf(&DensityOf { right: metal, other: narrow }, b)
        }),
        Case::new("principled: density of another base", move |b| {
            let other = Principled { base_color: Spectrum::gray(0.4), ..plastic };
            check_bsdf(&DensityOf { right: plastic, other }, b)
        }),
        case("principled: base and highlight drawn too rarely", plastic, Wrong::Lobe(1.1)),
        case("principled: transmission drawn too often", pane, Wrong::Lobe(1.1)),
        case("principled: no eta²", pane, Wrong::NoEtaSquared),
        case("principled: pdf 1 % too large, consistently", plastic, Wrong::Pdf(1.01)),
        case("principled: weight 1 % too large", metal, Wrong::Weight(1.01)),
        Case::new("principled: appendix B held to conserve energy", |b| {
            let bright = Principled { meaning: Meaning::GltfB, ..Principled::new(Spectrum::ONE, 0.0, 0.3) };
            check_bsdf(&bright, b)
        }),
        case("lambert: pdf 1 % too large, consistently", lambert, Wrong::Pdf(1.01)),
        case("lambert: pdf 1 % too small, consistently", lambert, Wrong::Pdf(0.99)),
        case("gold: pdf 1 % too large, consistently", gold(0.3), Wrong::Pdf(1.01)),
        case("narrow gold: pdf 1 % too large, consistently", gold(0.001), Wrong::Pdf(1.01)),
        case("glass: pdf 1 % too large, consistently", glass(0.3), Wrong::Pdf(1.01)),
        case("lambert: pdf 1 % too large, weight not", lambert, Wrong::PdfButNotWeight(1.01)),
        case("narrow gold: pdf 1 % too large, weight not", gold(0.001), Wrong::PdfButNotWeight(1.01)),
        case("gold: pdf() says 1 % more than sample", gold(0.3), Wrong::PdfCall(1.01)),
        case("gold: eval 1 % too large", gold(0.3), Wrong::Eval(1.01)),
        case("gold: weight 1 % too large", gold(0.3), Wrong::Weight(1.01)),
        case("glass: weight 1 % too small", glass(0.1), Wrong::Weight(0.99)),
        case("white mirror: weight 1 % too large", Mirror::new(Spectrum::ONE), Wrong::Weight(1.01)),
        case("clear glass: weight 1 % too large", clear, Wrong::Weight(1.01)),
        case("clear glass: the refracted direction is not named", clear, Wrong::HalfNamed),
        case("clear glass: a named direction 1 % too bright", clear, Wrong::Named(1.01)),
        case("lambert: no cosine", lambert, Wrong::NoCosine),
        case("gold: no cosine", gold(0.3), Wrong::NoCosine),
        case("clear glass: modes exchanged", clear, Wrong::ModesSwapped),
        case("glass: modes exchanged", glass(0.3), Wrong::ModesSwapped),
        case("clear glass: no eta²", clear, Wrong::NoEtaSquared),
        case("glass: no eta²", glass(0.3), Wrong::NoEtaSquared),
        case("clear glass: eta inverted", clear, Wrong::EtaInverted),
        case("lambert: draws skewed, 15 % rms", lambert, Wrong::Skewed(1.15)),
        case("gold: draws skewed, 15 % rms", gold(0.3), Wrong::Skewed(1.15)),
        case("narrow gold: draws skewed, 15 % rms", gold(0.001), Wrong::Skewed(1.15)),
        case("lambert: draws moved by 0.1", lambert, Wrong::Moved(0.1)),
        case("gold: draws moved by a fifth of alpha", gold(0.3), Wrong::Moved(0.06)),
        case("narrow gold: draws moved by a fifth of alpha", gold(0.001), Wrong::Moved(0.0002)),
        case("lambert: a tenth of the draws fails", lambert, Wrong::Fails),
        case("lambert: scatters where it never draws", lambert, Wrong::Leak),
        case("gold: lopsided", gold(0.3), Wrong::Lopsided),
        case("gold: an undeclared lobe", gold(0.3), Wrong::Undeclared),
        case("gold: eval_pdf is not eval and pdf", gold(0.3), Wrong::Fused(1.001)),
        case("lambert: NaN at grazing angles", lambert, Wrong::Nan),
        case("lambert: not unit", lambert, Wrong::NotUnit),
        Case::new("lambert: albedo 1.02", |b| check_bsdf(&Lambert::new(Spectrum::gray(1.02)), b)),
    ]
}
