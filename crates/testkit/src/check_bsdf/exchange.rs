use etendue_bsdf::{Bsdf, BsdfSample, Lobes, Mode};
use etendue_core::{Spectrum, Vec2, Vec3A, vector};

use super::MODES;
use crate::budget::{Budget, Failure, Judge, Random};
use crate::rounding::agree;

const PAIRS: usize = 2_000;

/// Exchanging the directions, and the calls that must say the same.
pub(super) fn exchange(
    bsdf: &dyn Bsdf,
    budget: &Budget,
    random: &mut Random,
    judge: &mut Judge,
) -> Result<(), Failure> {
    let spread = bsdf.lobes().intersects(Lobes::DIFFUSE | Lobes::GLOSSY);
    let reciprocal = bsdf.lobes().contains(Lobes::RECIPROCAL);
    let pairs = budget.samples(PAIRS);
    let (mut one_way, mut lopsided) = (Odd::default(), Odd::default());
    for _ in 0..pairs {
        let wo = random.direction();
        let (u_lobe, u) = (random.unit(), random.pair());
        // Half the pairs where the BSDF is large, half anywhere.
        let sample = bsdf.sample(wo, u_lobe, u, Mode::Importance);
        let wi = match sample {
            Some(s) if random.unit() < 0.5 => s.wi,
            _ => random.direction(),
        };
        if let Some(s) = sample.filter(|s| s.lobe.contains(Lobes::DELTA)) {
            delta_exchange(bsdf, wo, &s, random, judge)?;
        }
        // At grazing angles the quotient by the cosine is all rounding.
        if spread && wo.z.abs() > 1e-2 && wi.z.abs() > 1e-2 {
            let back = bsdf.eval(wi, wo, Mode::Radiance) / wo.z.abs();
            let importance = |o: Vec3A, i: Vec3A| bsdf.eval(o, i, Mode::Importance) / i.z.abs();
            one_way.note(back, wo, wi, &importance);
            if reciprocal && wo.z * wi.z > 0.0 {
                lopsided.note(back, wo, wi, &|o, i| bsdf.eval(o, i, Mode::Radiance) / i.z.abs());
            }
        }
        for mode in MODES {
            same_calls(bsdf, wo, wi, u_lobe, u, mode, judge)?;
        }
    }
    one_way.judge(
        pairs,
        "adjoint",
        "f(wo, wi) in importance mode is not f(wi, wo) in radiance mode",
        judge,
    )?;
    lopsided.judge(pairs, "reciprocity", "f(wo, wi) is not f(wi, wo)", judge)
}

/// Pairs of directions that disagree when exchanged.
#[derive(Default)]
struct Odd {
    count: usize,
    first: String,
}

impl Odd {
    fn note(&mut self, back: Spectrum, wo: Vec3A, wi: Vec3A, there: &dyn Fn(Vec3A, Vec3A) -> Spectrum) {
        if !agree(back, wo, wi, 2e-3, there) {
            if self.count == 0 {
                self.first = format!("wo = {wo}, wi = {wi}: {:?} and {back:?}", there(wo, wi));
            }
            self.count += 1;
        }
    }

    /// One pair in 200 may: where nearly all light is reflected, the little that is not is a rounded difference.
    fn judge(&self, pairs: usize, test: &'static str, what: &str, judge: &mut Judge) -> Result<(), Failure> {
        judge.require(self.count <= 3 + pairs / 200, test, || {
            format!("{what} for {} of {pairs} pairs; {}", self.count, self.first)
        })
    }
}

/// A delta lobe carries the same both ways, in étendue: what importance takes along, times eta², is what radiance
/// takes back.
fn delta_exchange(
    bsdf: &dyn Bsdf,
    wo: Vec3A,
    s: &BsdfSample,
    random: &mut Random,
    judge: &mut Judge,
) -> Result<(), Failure> {
    let (e, p) = (bsdf.eval(wo, s.wi, Mode::Importance), bsdf.pdf(wo, s.wi, Mode::Importance));
    let only_delta = !bsdf.lobes().intersects(Lobes::DIFFUSE | Lobes::GLOSSY);
    judge.require(!only_delta || (e.is_black() && p == 0.0), "delta", || {
        format!("eval {e:?} and pdf {p} of a delta lobe must be 0")
    })?;
    // Near grazing and near the critical angle the fraction turns with the last digits of the direction.
    if wo.z.abs() < 0.1 || s.wi.z.abs() < 0.1 {
        return Ok(());
    }
    let back = (0..64).find_map(|_| {
        bsdf.sample(s.wi, random.unit(), random.pair(), Mode::Radiance)
            .filter(|b| b.lobe == s.lobe && vector::length(b.wi - wo) < 1e-4)
    });
    let Some(back) = back else {
        // The way back may be too rare to meet.
        return judge.require(s.pdf < 0.3, "delta", || format!("no way back from {} to {wo}", s.wi));
    };
    let there = s.weight * (s.pdf * s.eta * s.eta);
    let here = back.weight * back.pdf;
    let off = (there - here).map(f32::abs).max_channel();
    judge.require(off <= 5e-3 * here.max_channel() + 1e-6, "adjoint", || {
        format!(
            "a delta lobe from {wo} takes {there:?} of importance times eta², and {here:?} of radiance back"
        )
    })?;
    judge.require((s.eta * back.eta - 1.0).abs() < 1e-5, "eta", || {
        format!("{} there, {} back", s.eta, back.eta)
    })
}

/// The fused and split calls.
fn same_calls(
    bsdf: &dyn Bsdf,
    wo: Vec3A,
    wi: Vec3A,
    u_lobe: f32,
    u: Vec2,
    mode: Mode,
    judge: &mut Judge,
) -> Result<(), Failure> {
    let close = |a: f32, b: f32| (a - b).abs() <= 1e-5 * a.abs().max(b.abs());
    let close_spectra = |a: Spectrum, b: Spectrum| (0..3).all(|c| close(a[c], b[c]));
    let (e, p) = (bsdf.eval(wo, wi, mode), bsdf.pdf(wo, wi, mode));
    let (fe, fp) = bsdf.eval_pdf(wo, wi, mode);
    let s = bsdf.scatter(wo, Some(wi), u_lobe, u, mode);
    let dark = bsdf.scatter(wo, None, u_lobe, u, mode);
    let same = close_spectra(e, fe) && close(p, fp) && close_spectra(e, s.eval) && close(p, s.pdf);
    judge.require(same, "fused", || format!("eval_pdf or scatter differ from eval and pdf at {wo}, {wi}"))?;
    let drawn = bsdf.sample(wo, u_lobe, u, mode);
    judge.require(s.sample == drawn && dark.sample == drawn, "fused", || {
        format!("scatter draws {:?}, without a light {:?}, sample draws {drawn:?}", s.sample, dark.sample)
    })?;
    let classes = bsdf.eval_classes(wo, wi, mode);
    let sum = classes.into_iter().fold(Spectrum::BLACK, |a, b| a + b);
    let crossed = usize::from(wo.z * wi.z < 0.0);
    let other_side = classes[2 - 2 * crossed] + classes[3 - 2 * crossed];
    judge.require(close_spectra(sum, e) && other_side.is_black(), "classes", || {
        format!("classes are {classes:?}, eval is {e:?} at {wo}, {wi}")
    })
}
