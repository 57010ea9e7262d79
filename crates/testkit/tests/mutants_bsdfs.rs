//! BSDFs with one deliberate slip each, and the true ones they come from.

mod support;

use etendue_bsdf::{
    Bsdf, BsdfAt, BsdfSample, Conductor, Lambert, Lobes, Mode, RoughDielectric, SmoothDielectric,
};
use etendue_core::{Spectrum, Vec2, Vec3A, vector};
use etendue_testkit::check_bsdf;
use support::{Case, MANY, accept, reject};

/// What is wrong. Power: 1 % in a density or weight is what `check_bsdf` says it just sees.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Slip {
    Nothing,
    /// The density 1 % too large everywhere, the weight following it.
    PdfTooLargeThroughout,
    /// The density 1 % too large in `pdf` alone.
    PdfTooLargeWhenAsked,
    /// The weight 1 % too large.
    Weight,
    /// The value without the cosine, the weight following it.
    MissingCosine,
    /// Radiance and importance exchanged.
    ModesExchanged,
    /// Transmitted radiance not scaled by eta² at all.
    MissingEtaSquared,
    /// Directions pulled toward the normal, density as before.
    Leaning,
    /// More light out than in: the value and weight 5 % too large.
    Gain,
    /// A value that is not the same when the directions are exchanged.
    OneWay,
    /// Samples that fail now and then, although the density says they are there.
    LostSamples,
}

struct Mutant<B> {
    truth: B,
    slip: Slip,
}

impl<B: Bsdf> Mutant<B> {
    fn mode(&self, mode: Mode) -> Mode {
        match (self.slip, mode) {
            (Slip::ModesExchanged, Mode::Radiance) | (Slip::MissingEtaSquared, _) => Mode::Importance,
            (Slip::ModesExchanged, Mode::Importance) => Mode::Radiance,
            _ => mode,
        }
    }

    /// Factor on the value.
    fn value(&self, wo: Vec3A, wi: Vec3A) -> f32 {
        match self.slip {
            Slip::MissingCosine => 1.0 / wi.z.abs().max(1e-3),
            Slip::Gain => 1.05,
            Slip::OneWay => 1.0 - 0.2 * wo.z.abs(),
            _ => 1.0,
        }
    }
}

impl<B: Bsdf> Bsdf for Mutant<B> {
    fn lobes(&self) -> Lobes {
        self.truth.lobes()
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.truth.eval(wo, wi, self.mode(mode)) * self.value(wo, wi)
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        let wrong = matches!(self.slip, Slip::PdfTooLargeThroughout | Slip::PdfTooLargeWhenAsked);
        self.truth.pdf(wo, wi, self.mode(mode)) * if wrong { 1.01 } else { 1.0 }
    }

    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        if self.slip == Slip::LostSamples && u.x < 0.02 {
            return None;
        }
        let mut s = self.truth.sample(wo, u_lobe, u, self.mode(mode))?;
        let delta = s.lobe.contains(Lobes::DELTA);
        if !delta {
            s.weight *= self.value(wo, s.wi);
        } else if self.slip == Slip::Gain {
            s.weight *= 1.05;
        }
        match self.slip {
            Slip::PdfTooLargeThroughout if !delta => {
                s.pdf *= 1.01;
                s.weight = s.weight / 1.01;
            }
            Slip::Weight => s.weight *= 1.01,
            Slip::Leaning if !delta => {
                let up = Vec3A::new(0.0, 0.0, 0.1f32.copysign(s.wi.z));
                s.wi = vector::normalize(s.wi + up);
                // The slip is in the direction alone: density and weight are those of where it ended.
                s.pdf = self.truth.pdf(wo, s.wi, mode);
                s.weight = self.truth.eval(wo, s.wi, mode) / s.pdf;
            }
            _ => {}
        }
        Some(s)
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Ref(self)
    }
}

fn case<B: Bsdf + Clone + 'static>(name: &str, truth: &B, slip: Slip) -> Case<'static> {
    let mutant = Mutant { truth: truth.clone(), slip };
    Case::new(format!("{name}: {slip:?}"), move |b| check_bsdf(&mutant, b))
}

fn lambert() -> Lambert {
    Lambert::new(Spectrum::rgb(0.9, 0.5, 0.2))
}

fn mutants() -> Vec<Case<'static>> {
    let mut out = Vec::new();
    let spread = [
        Slip::PdfTooLargeThroughout,
        Slip::PdfTooLargeWhenAsked,
        Slip::Weight,
        Slip::MissingCosine,
        Slip::Leaning,
        Slip::OneWay,
        Slip::LostSamples,
    ];
    for slip in spread {
        out.push(case("lambert", &lambert(), slip));
        out.push(case("gold", &Conductor::gold(0.5), slip));
        out.push(case("rough glass", &RoughDielectric::new(0.5, 1.5), slip));
    }
    out.push(case("white", &Lambert::new(Spectrum::ONE), Slip::Gain));
    out.push(case("smooth glass", &SmoothDielectric::new(1.5), Slip::Gain));
    for slip in [Slip::ModesExchanged, Slip::MissingEtaSquared] {
        out.push(case("rough glass", &RoughDielectric::new(0.5, 1.5), slip));
    }
    out.push(case("smooth glass", &SmoothDielectric::new(1.5), Slip::ModesExchanged));
    out
}

fn true_parts() -> Vec<Case<'static>> {
    vec![
        case("lambert", &lambert(), Slip::Nothing),
        case("gold", &Conductor::gold(0.5), Slip::Nothing),
        case("rough glass", &RoughDielectric::new(0.5, 1.5), Slip::Nothing),
        case("smooth glass", &SmoothDielectric::new(1.5), Slip::Nothing),
    ]
}

#[test]
fn wrong_parts_are_rejected() {
    reject(&mutants(), 3, 1.0);
}

#[test]
fn true_parts_are_accepted() {
    accept(&true_parts(), 3, 1.0);
}

#[test]
#[ignore = "minutes"]
fn wrong_parts_over_a_hundred_seeds() {
    reject(&mutants(), MANY, 1.0);
}

#[test]
#[ignore = "minutes"]
fn true_parts_over_a_hundred_seeds() {
    accept(&true_parts(), MANY, 1.0);
}
