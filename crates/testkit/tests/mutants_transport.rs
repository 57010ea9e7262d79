//! Wrong lights, pickers, estimators and integrators are rejected, each by the test meant for it; beside each the true
//! part is accepted. The defects that a suite's docs state as its power are made just that large.

mod support;

use std::sync::Arc;

use etendue_bsdf::{Bsdf, Mode};
use etendue_camera::{CameraSample, Perspective};
use etendue_core::{Ray, Segment, Spectrum, UVec2, Vec2, Vec3A, vector};
use etendue_geometry::{Parallelogram, Shape, Sphere, Surface};
use etendue_integrator::{
    Context, Contribution, ContributionKind, Integrator, PathTracer, Recorder, Sample, Vertex,
};
use etendue_light::{
    ConstantEnvironment, Light, LightBounds, LightId, LightPicker, LightSample, LitPoint, ParallelogramLight,
    Pick, PointLight, PowerPicker, Sides, SphereLight,
};
use etendue_material::{Absorber, Diffuse};
use etendue_sampling::{Dim, Independent, Sampler, Slot, mis};
use etendue_scene::{Emission, Scene, SceneBuilder};
use etendue_testkit::stats::MeanTest;
use etendue_testkit::{
    Budget, Failure, Outcome, Passed, Radiance, Truth, check_estimator, check_integrator, check_light,
    check_picker, lit_point,
};
use support::{Case, MANY, accept, reject};

/// Seeds of the ordinary run.
const FIVE: u64 = 5;

/// A mutant that has to be found by one of the `by` tests: being found by another one would prove nothing.
fn mutant(
    name: &str,
    by: &'static [&'static str],
    check: impl Fn(&Budget) -> Outcome + 'static,
) -> Case<'static> {
    let label = name.to_owned();
    Case::new(name, move |b| match check(b) {
        Err(f) if !by.contains(&f.test) => {
            println!("{label}: not by {by:?} but by {f}");
            Ok(Passed { tests: 0, statistical: 0, smallest_p: 1.0 })
        }
        outcome => outcome,
    })
}

#[derive(Clone, Copy, PartialEq)]
enum LightDefect {
    None,
    DensityOfBoth,
    DensityAsked,
    DensityWithoutCosine,
    BrighterSamples,
    PowerZero,
    PowerOff,
}

/// A light with a defect; `by_area` draws from a parallelogram by area instead of asking the light.
struct WrongLight<L> {
    light: L,
    by_area: Option<Parallelogram>,
    defect: LightDefect,
}

impl<L: Light> WrongLight<L> {
    fn by_area(&self, q: &Parallelogram, at: &LitPoint, p: Vec3A) -> f32 {
        let to = p - at.p;
        let d2 = to.dot(to);
        let cosine = -to.dot(q.normal()) / d2.sqrt();
        let cosine = if self.defect == LightDefect::DensityWithoutCosine { 1.0 } else { cosine };
        d2 / (q.area() * cosine)
    }

    fn factor(&self, sampled: bool) -> f32 {
        match self.defect {
            LightDefect::DensityOfBoth => 1.02,
            LightDefect::DensityAsked if !sampled => 1.02,
            _ => 1.0,
        }
    }
}

impl<L: Light> Light for WrongLight<L> {
    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
        let mut s = self.light.sample(at, part, u)?;
        if let (Some(q), Some(end)) = (&self.by_area, &mut s.end) {
            let p = q.sample(u)?;
            end.p = p.p;
            s.wi = vector::normalize(p.p - at.p);
            s.pdf = self.by_area(q, at, p.p);
            // What is drawn behind the receiver is lost.
            if at.ng.dot(s.wi) < 0.0 {
                return None;
            }
        }
        s.pdf *= self.factor(true);
        if self.defect == LightDefect::BrighterSamples {
            s.li *= 1.02;
        }
        Some(s)
    }
    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        let own = self.light.pdf(at, part, wi, seen);
        let pdf = match (&self.by_area, seen) {
            (Some(q), Some(seen)) if own > 0.0 => self.by_area(q, at, seen.p),
            _ => own,
        };
        pdf * self.factor(false)
    }
    fn power(&self, part: u32, scene_radius: f32) -> Spectrum {
        let power = self.light.power(part, scene_radius);
        match self.defect {
            LightDefect::PowerZero => Spectrum::BLACK,
            LightDefect::PowerOff => power * 0.75,
            _ => power,
        }
    }
    fn bounds(&self, part: u32) -> Option<LightBounds> {
        self.light.bounds(part)
    }
    fn emitted(&self, part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        self.light.emitted(part, at, wo)
    }
    fn escaped(&self, ray: &Ray) -> Spectrum {
        self.light.escaped(ray)
    }
    fn is_infinite(&self) -> bool {
        self.light.is_infinite()
    }
    fn is_delta(&self) -> bool {
        self.light.is_delta()
    }
}

fn found(shape: &dyn Shape, ray: &Ray) -> Option<Surface> {
    shape.intersect(ray).map(|h| shape.surface(ray, &h))
}

/// From below, from aside and in free space.
fn points() -> [LitPoint; 3] {
    [
        lit_point(Vec3A::new(0.1, -1.2, 0.2), Vec3A::Y),
        lit_point(Vec3A::new(1.9, -1.1, 0.4), vector::normalize(Vec3A::new(-1.0, 1.0, 0.0))),
        lit_point(Vec3A::new(-0.7, -1.5, 1.0), Vec3A::ZERO),
    ]
}

fn lamp() -> Parallelogram {
    Parallelogram::new(Vec3A::new(-0.5, 0.0, -0.4), Vec3A::X, Vec3A::Z * 0.8).expect("has an area")
}

fn lamp_check(defect: LightDefect, area: bool, b: &Budget) -> Outcome {
    let (q, radiance) = (lamp(), Spectrum::rgb(1.0, 2.0, 3.0));
    let by_area = area.then_some(q);
    let light = WrongLight { light: ParallelogramLight::new(q, radiance), by_area, defect };
    check_light(&light, 0, &points(), &|ray: &Ray| found(&q, ray), b)
}

fn ball_check(defect: LightDefect, b: &Budget) -> Outcome {
    let ball = Sphere::new(Vec3A::new(0.0, 0.1, 0.0), 0.4).expect("has a radius");
    let light = SphereLight::new(ball, Spectrum::ONE);
    let light = WrongLight { light, by_area: None, defect };
    check_light(&light, 0, &points(), &|ray: &Ray| found(&ball, ray), b)
}

fn sky_check(defect: LightDefect, b: &Budget) -> Outcome {
    let light = ConstantEnvironment::new(Spectrum::ONE);
    check_light(&WrongLight { light, by_area: None, defect }, 0, &points(), &|_: &Ray| None, b)
}

/// Power: 2 % in density or radiance and a quarter in power are what `check_light` says it just sees.
fn light_mutants() -> Vec<Case<'static>> {
    let mut out = Vec::new();
    let kinds: [(&str, LightDefect, &'static [&'static str]); 5] = [
        ("density 2 % too large", LightDefect::DensityOfBoth, &["mass", "density", "irradiance"]),
        ("pdf() 2 % too large", LightDefect::DensityAsked, &["agreement"]),
        ("samples 2 % too bright", LightDefect::BrighterSamples, &["agreement"]),
        ("power zero", LightDefect::PowerZero, &["power"]),
        ("power a quarter too small", LightDefect::PowerOff, &["power"]),
    ];
    for (name, defect, by) in kinds {
        out.push(mutant(&format!("parallelogram: {name}"), by, move |b| lamp_check(defect, false, b)));
        out.push(mutant(&format!("sphere: {name}"), by, move |b| ball_check(defect, b)));
        out.push(mutant(&format!("sky: {name}"), by, move |b| sky_check(defect, b)));
    }
    let by: &[&str] = &["mass", "fine density", "coarse density", "density", "irradiance"];
    out.push(mutant("parallelogram: area density without the cosine", by, |b| {
        lamp_check(LightDefect::DensityWithoutCosine, true, b)
    }));
    out
}

fn true_lights() -> Vec<Case<'static>> {
    vec![
        Case::new("parallelogram", |b: &Budget| lamp_check(LightDefect::None, false, b)),
        Case::new("parallelogram by area", |b: &Budget| lamp_check(LightDefect::None, true, b)),
        Case::new("sphere", |b: &Budget| ball_check(LightDefect::None, b)),
        Case::new("sky", |b: &Budget| sky_check(LightDefect::None, b)),
    ]
}

#[derive(Clone, Copy, PartialEq)]
enum PickerDefect {
    None,
    LargeShare,
    SmallShare,
    ShareAsked,
    NotStretched,
    NeverPicked,
    PickedForAnother,
}

/// Three lights picked with probabilities 0.1, 0.3 and 0.6, and a defect.
struct WrongPicker {
    picker: PowerPicker,
    defect: PickerDefect,
}

impl WrongPicker {
    /// A probability moved from the last two parts to one another, or from the first to the last.
    fn share(&self, id: LightId, p: f32) -> f32 {
        match (self.defect, id.light) {
            // 0.6 · 5 % and 0.1 · 10 %.
            (PickerDefect::LargeShare, 1) => p - 0.03,
            (PickerDefect::LargeShare, 2) => p + 0.03,
            (PickerDefect::SmallShare, 0) => p + 0.01,
            (PickerDefect::SmallShare, 2) => p - 0.01,
            (PickerDefect::NeverPicked, 0) => 0.0,
            (PickerDefect::NeverPicked, 2) => p + 0.1,
            _ => p,
        }
    }
}

impl LightPicker for WrongPicker {
    fn pick(&self, at: &LitPoint, u: f32) -> Option<Pick> {
        let mut pick = self.picker.pick(at, u)?;
        if pick.id.light == 0
            && matches!(self.defect, PickerDefect::NeverPicked | PickerDefect::PickedForAnother)
        {
            pick.id.light = 2;
            pick.pmf = self.picker.pmf(at, pick.id);
        }
        pick.pmf = self.share(pick.id, pick.pmf);
        if self.defect == PickerDefect::NotStretched {
            pick.u = u;
        }
        Some(pick)
    }
    fn pmf(&self, at: &LitPoint, id: LightId) -> f32 {
        let p = self.share(id, self.picker.pmf(at, id));
        // The sum stays 1.
        match (self.defect, id.light) {
            (PickerDefect::ShareAsked, 1) => p * 0.95,
            (PickerDefect::ShareAsked, 2) => p + 0.05 * 0.3,
            _ => p,
        }
    }
}

fn picker_check(defect: PickerDefect, b: &Budget) -> Outcome {
    let lights: Vec<Arc<dyn Light>> = [1.0, 3.0, 6.0]
        .iter()
        .map(|&i| Arc::new(PointLight::new(Vec3A::Y * i, Spectrum::gray(i))) as Arc<dyn Light>)
        .collect();
    let picker = WrongPicker { picker: PowerPicker::new(&lights, 1.0).expect("has power"), defect };
    let ids: Vec<LightId> = (0..3).map(|light| LightId { light, part: 0 }).collect();
    check_picker(&picker, &ids, &points()[..2], &|_, _| true, b)
}

/// Power: a tenth of a share of 0.1 is what `check_picker` says it just sees.
fn picker_mutants() -> Vec<Case<'static>> {
    let kinds: [(&str, PickerDefect, &'static [&'static str]); 6] = [
        ("probability 0.6 is 5 % wrong", PickerDefect::LargeShare, &["frequency"]),
        ("probability 0.1 is 10 % wrong", PickerDefect::SmallShare, &["frequency"]),
        ("pmf() 5 % wrong", PickerDefect::ShareAsked, &["pmf"]),
        ("number not stretched", PickerDefect::NotStretched, &["remap"]),
        ("a lit light is never picked", PickerDefect::NeverPicked, &["impossible"]),
        ("one picked for another", PickerDefect::PickedForAnother, &["frequency"]),
    ];
    kinds
        .map(|(name, defect, by)| mutant(&format!("picker: {name}"), by, move |b| picker_check(defect, b)))
        .into()
}

fn true_pickers() -> Vec<Case<'static>> {
    vec![Case::new("power picker", |b: &Budget| picker_check(PickerDefect::None, b))]
}

/// The verdict of a comparison of means, and that it had the power stated: five standard errors.
fn with_power(test: Result<MeanTest, Failure>, power: f64) -> Outcome {
    let test = test?;
    let seen = 5.0 * test.standard_error / test.truth;
    assert!(seen <= power, "sees {seen} only, {power} is stated: {test:?}");
    Ok(Passed { tests: 1, statistical: 1, smallest_p: test.p })
}

/// The mean of 16384 uniform numbers times `factor`, which should be ½.
fn uniform_mean(factor: f64, seed: u64) -> f64 {
    let s = Independent::new(seed, 1);
    factor * (0..16_384).map(|i| s.start(i, 0).get_1d_f64(Dim::FILM)).sum::<f64>() / 16_384.0
}

/// Power: of 32 estimates each 0.45 % off, five standard errors are 0.4 %, or 0.56 % against another estimator.
fn estimator_check(factor: f64, known: bool, b: &Budget) -> Outcome {
    let own = |seed| uniform_mean(factor, seed);
    let other = |seed| uniform_mean(1.0, seed);
    let truth = if known { Truth::Known(0.5) } else { Truth::Same(&other) };
    with_power(check_estimator(&own, &truth, 32, b), 0.008)
}

fn estimator_mutants() -> Vec<Case<'static>> {
    vec![
        mutant("estimator: 1 % of bias, truth known", &["mean"], |b| estimator_check(1.01, true, b)),
        mutant("estimator: 1 % of bias, against another", &["mean"], |b| estimator_check(0.99, false, b)),
        // From 200 estimates on; the mean itself is the right one.
        mutant("estimator: one of 256 estimates carries the sum", &["variance"], |b| {
            let rare = |seed| if seed % 256 == 3 { 256.0 } else { 1e-3 };
            with_power(check_estimator(&rare, &Truth::Known(1.0), 256, b), f64::INFINITY)
        }),
    ]
}

fn true_estimators() -> Vec<Case<'static>> {
    vec![
        Case::new("estimator, truth known", |b: &Budget| estimator_check(1.0, true, b)),
        Case::new("estimator, against another", |b: &Budget| estimator_check(1.0, false, b)),
    ]
}

#[derive(Clone, Copy, PartialEq)]
enum Slip {
    None,
    /// Not a slip for the mean: the weights still add up to 1.
    BothWeightsSwapped,
    BothInFull,
    LightWeightSwapped,
    BsdfWeightSwapped,
    SurvivorsAsTheyAre,
    SurvivorsByOneMinusP,
    PickForgotten,
}

/// Direct light of opaque rough surfaces by the balance heuristic, with roulette before the BSDF's ray. It tells the
/// recorder nothing, which is allowed.
struct Direct(Slip);

impl Direct {
    fn weight(&self, own: f32, other: f32, of_light: bool) -> f32 {
        let swapped = match self.0 {
            Slip::BothInFull => return 1.0,
            Slip::BothWeightsSwapped => true,
            Slip::LightWeightSwapped => of_light,
            Slip::BsdfWeightSwapped => !of_light,
            _ => false,
        };
        if swapped { mis::balance(other, own) } else { mis::balance(own, other) }
    }

    /// Factor of the paths that roulette leaves; `None` where it ends them.
    fn survive(&self, p: f32, u: f32) -> Option<f32> {
        (u < p).then_some(match self.0 {
            Slip::SurvivorsAsTheyAre => 1.0,
            Slip::SurvivorsByOneMinusP => 1.0 / (1.0 - p),
            _ => 1.0 / p,
        })
    }

    /// The density that a light sample is divided by.
    fn divisor(&self, scene: &Scene, at: &LitPoint, id: LightId, s: &LightSample) -> f32 {
        if self.0 != Slip::PickForgotten {
            return s.pdf;
        }
        let ray = at.origin().ray(s.wi, at.time);
        let seen = scene.intersect(&ray, 0).map(|h| scene.surface(&ray, &h, 0.0));
        scene.lights()[id.light as usize].pdf(at, id.part, s.wi, seen.as_ref())
    }
}

fn emission(scene: &Scene, ray: &Ray) -> Option<(LightId, Surface, Spectrum)> {
    let surface = scene.surface(ray, &scene.intersect(ray, 0)?, 0.0);
    let id = scene.light_at(&surface)?;
    let le = scene.emitted(id, &surface, -ray.d);
    Some((id, surface, le))
}

impl<S: Sampler> Integrator<S> for Direct {
    fn li(&self, cx: &Context<'_>, s: &CameraSample, u: S, _rec: &mut dyn Recorder) -> Sample {
        let scene = cx.scene;
        let mut out = Sample::default();
        let Some(hit) = scene.intersect(&s.ray, 0) else { return out };
        out.alpha = 1.0;
        let surface = scene.surface(&s.ray, &hit, 0.0);
        if let Some((_, _, le)) = emission(scene, &s.ray) {
            out.l += le;
        }
        let Some(material) = scene.material(&surface) else { return out };
        let (bsdf, frame) = (material.bsdf(&surface), surface.shading);
        let wo = frame.to_local(-s.ray.d);
        if wo.z <= 0.0 {
            return out;
        }
        let at = LitPoint {
            p: surface.p,
            p_err: surface.p_err,
            ng: surface.ng,
            ns: frame.z,
            sides: Sides::Same,
            time: s.ray.time,
        };
        if let Some(draw) = scene.sample_light(&at, u.get_2d(Dim::bounce(0, Slot::Light))) {
            let l = &draw.sample;
            let wi = frame.to_local(l.wi);
            let f = bsdf.eval(wo, wi, Mode::Radiance);
            let segment = Segment { from: at.origin(), d: l.wi, to: l.end, time: at.time };
            if !f.is_black() && !scene.transmittance(&segment, 0).is_black() {
                let weight = self.weight(l.pdf, bsdf.pdf(wo, wi, Mode::Radiance), true);
                out.l += f * l.li * (weight / self.divisor(scene, &at, draw.id, l));
            }
        }
        let (u_lobe, u_bsdf) = (u.get_1d(Dim::bounce(0, Slot::Lobe)), u.get_2d(Dim::bounce(0, Slot::Bsdf)));
        let Some(b) = bsdf.sample(wo, u_lobe, u_bsdf, Mode::Radiance) else { return out };
        let survival = b.weight.max_channel().clamp(0.05, 1.0);
        let Some(factor) = self.survive(survival, u.get_1d(Dim::bounce(0, Slot::Roulette))) else {
            return out;
        };
        let ray = at.origin().ray(vector::normalize(frame.to_world(b.wi)), at.time);
        if let Some((id, seen, le)) = emission(scene, &ray) {
            let weight = self.weight(b.pdf, scene.light_pdf(&at, id, ray.d, Some(&seen)), false);
            out.l += b.weight * le * (weight * factor);
        }
        out
    }
}

#[derive(Clone, Copy)]
enum Silence {
    Half,
    Hits,
    LightSamples,
}

/// A path tracer whose recorder hears less than there is.
struct Silent(PathTracer, Silence);

/// Passes on what it hears, with gaps.
struct Muffled<'a>(&'a mut dyn Recorder, Silence);

impl Recorder for Muffled<'_> {
    fn vertex(&mut self, v: &Vertex<'_>) {
        self.0.vertex(v);
    }
    fn contribution(&mut self, c: &Contribution) {
        let mut c = *c;
        match (self.1, c.kind) {
            (Silence::Hits, ContributionKind::Hit) => return,
            (Silence::LightSamples, ContributionKind::LightSample) => return,
            (Silence::Half, _) => c.value *= 0.5,
            _ => {}
        }
        self.0.contribution(&c);
    }
    fn wants_vertices(&self) -> bool {
        self.0.wants_vertices()
    }
}

impl<S: Sampler> Integrator<S> for Silent {
    fn li(&self, cx: &Context<'_>, s: &CameraSample, u: S, rec: &mut dyn Recorder) -> Sample {
        self.0.li(cx, s, u, &mut Muffled(rec, self.1))
    }
    fn li_plain(&self, cx: &Context<'_>, s: &CameraSample, u: S) -> Sample {
        self.0.li_plain(cx, s, u)
    }
}

/// A bright floor under two broad lamps of unequal power that hang low, so that both ways of finding light matter.
fn hall() -> Scene {
    let mut b = SceneBuilder::new();
    let (bright, black) = (b.material(Diffuse::new(Spectrum::gray(0.8))), b.material(Absorber));
    let (x, z) = (Vec3A::X, Vec3A::Z);
    let floor = Parallelogram::new((x + z) * -4.0, z * 8.0, x * 8.0).expect("has an area");
    b.add(floor, bright);
    for (left, radiance) in [(-2.2, 3.0), (0.2, 1.0)] {
        let corner = Vec3A::new(left, 1.0, -1.0);
        let lamp = b.add(Parallelogram::new(corner, x * 2.0, z * 2.0).expect("has an area"), black);
        b.emit(lamp, Emission::new(Spectrum::gray(radiance)));
    }
    b.build().expect("a scene")
}

fn integrator_check(integrator: &dyn Integrator<Independent>, power: f64, b: &Budget) -> Outcome {
    let (eye, size) = (Vec3A::new(0.0, 0.7, 3.0), UVec2::splat(16));
    let camera =
        Perspective::look_at(eye, Vec3A::new(0.0, 0.1, 0.0), Vec3A::Y, 40.0, size).expect("a camera");
    let path = PathTracer { max_depth: Some(1), ..PathTracer::default() };
    let truth = Radiance::Same(&path);
    let make = |seed| Independent::new(seed, 16);
    with_power(check_integrator(integrator, &make, &hall(), &camera, &truth, 16, b), power)
}

/// Power: 16 pictures of 16 × 16 pixels and 16 samples see a bias of 3 % (asserted for all that reach the means).
fn integrator_mutants() -> Vec<Case<'static>> {
    let slips = [
        ("both ways counted in full", Slip::BothInFull),
        ("the light sample's weight swapped", Slip::LightWeightSwapped),
        ("the BSDF sample's weight swapped", Slip::BsdfWeightSwapped),
        ("survivors of roulette as they are", Slip::SurvivorsAsTheyAre),
        ("survivors of roulette divided by 1 − P", Slip::SurvivorsByOneMinusP),
        ("probability of the light's pick forgotten", Slip::PickForgotten),
    ];
    let silences = [
        ("half of it", Silence::Half),
        ("no hits", Silence::Hits),
        ("no light samples", Silence::LightSamples),
    ];
    let slips = slips.map(|(name, slip)| {
        mutant(&format!("integrator: {name}"), &["mean"], move |b| integrator_check(&Direct(slip), 0.03, b))
    });
    let silences = silences.map(|(name, silence)| {
        let path = PathTracer { max_depth: Some(1), ..PathTracer::default() };
        let silent = Silent(path, silence);
        mutant(&format!("integrator: recorder hears {name}"), &["recorder"], move |b| {
            integrator_check(&silent, 0.03, b)
        })
    });
    slips.into_iter().chain(silences).collect()
}

fn true_integrators() -> Vec<Case<'static>> {
    let path = PathTracer { max_depth: Some(1), ..PathTracer::default() };
    vec![
        Case::new("path tracer", move |b: &Budget| integrator_check(&path, 0.03, b)),
        Case::new("direct light", |b: &Budget| integrator_check(&Direct(Slip::None), 0.03, b)),
        // Swapped on both sides the weights still add up to 1: noisier (the power is 5 %), and unbiased.
        Case::new("direct light, both weights swapped", |b: &Budget| {
            integrator_check(&Direct(Slip::BothWeightsSwapped), 0.05, b)
        }),
    ]
}

fn mutants() -> Vec<Case<'static>> {
    [light_mutants(), picker_mutants(), estimator_mutants(), integrator_mutants()]
        .into_iter()
        .flatten()
        .collect()
}

fn true_parts() -> Vec<Case<'static>> {
    [true_lights(), true_pickers(), true_estimators(), true_integrators()].into_iter().flatten().collect()
}

#[test]
fn wrong_parts_are_rejected() {
    reject(&mutants(), FIVE, 1.0);
}

#[test]
fn true_parts_are_accepted() {
    accept(&true_parts(), FIVE, 1.0);
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
