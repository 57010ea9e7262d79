use etendue_bsdf::{Bsdf, Mode};
use etendue_camera::{CameraSample, Perspective};
use etendue_core::{Segment, Spectrum, UVec2, Vec3A};
use etendue_geometry::{Parallelogram, Sphere, Surface};
use etendue_integrator::{
    Context, Contribution, ContributionKind, Integrator, PathTracer, Recorder, Roulette, Sample,
};
use etendue_light::{ConstantEnvironment, LightId, LitPoint, Sides};
use etendue_material::Diffuse;
use etendue_sampling::{Dim, Sampler, Slot, Sobol, mis};
use etendue_scene::{Emission, Scene, SceneBuilder};
use etendue_testkit::{Passed, Radiance, Truth, check_estimator, check_integrator};

use crate::Case;

#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    Nothing,
    /// Both techniques count fully.
    NoMis,
    /// The sky found by chance counts fully, beside its share by light sampling.
    NoMisForEscapes,
    /// Survivors of roulette do not carry the weight.
    Undivided,
    /// Survivors are divided by the probability of ending.
    DividedByRest,
    /// Survivors are divided by the probability of the vertex before.
    DividedByFormer,
    /// The density of a light sample lacks the probability of its pick.
    NoPick,
    /// Light passes through what stands between.
    NoShadow,
    /// The result times this.
    Factor(f32),
    /// Without a recorder something else.
    Plain,
    /// Records only light samples.
    Recorder,
    Alpha,
    /// Not a number once in a hundred samples.
    Nan,
}

/// A path tracer of at most two scattering events for diffuse surfaces, with roulette after each.
struct Mini {
    wrong: Wrong,
}

/// Probabilities of going on after the first and second scattering event.
const SURVIVAL: [f32; 2] = [0.75, 0.5];

/// Where the last direction came from, and its density.
struct From {
    at: LitPoint,
    pdf: f32,
}

impl Mini {
    fn weight_of_found(
        &self,
        cx: &Context<'_>,
        from: Option<&From>,
        id: LightId,
        wi: Vec3A,
        seen: Option<&Surface>,
    ) -> f32 {
        let skip = self.wrong == Wrong::NoMis || (self.wrong == Wrong::NoMisForEscapes && seen.is_none());
        match from {
            Some(f) if !skip => mis::power(f.pdf, cx.scene.light_pdf(&f.at, id, wi, seen)),
            _ => 1.0,
        }
    }

    fn walk<S: Sampler>(&self, cx: &Context<'_>, s: &CameraSample, u: S, rec: &mut dyn Recorder) -> Sample {
        let factor = if let Wrong::Factor(f) = self.wrong { f } else { 1.0 };
        let (mut ray, mut beta, mut from) = (s.ray, Spectrum::gray(factor), None::<From>);
        let mut out = Sample::default();
        let mut add = |kind, depth, light, value: Spectrum, out: &mut Sample| {
            out.l += value;
            if self.wrong != Wrong::Recorder || kind == ContributionKind::LightSample {
                let (mis_weight, light_pdf, bsdf_pdf) = (1.0, 0.0, 0.0);
                rec.contribution(&Contribution {
                    depth,
                    kind,
                    light,
                    value,
                    mis_weight,
                    light_pdf,
                    bsdf_pdf,
                });
            }
        };
        for depth in 0..=2u32 {
            let Some(hit) = cx.scene.intersect(&ray, 0) else {
                for (id, light) in cx.scene.infinite_lights() {
                    let w = self.weight_of_found(cx, from.as_ref(), id, ray.d, None);
                    add(ContributionKind::Escape, depth, id, beta * light.escaped(&ray) * w, &mut out);
                }
                break;
            };
            out.alpha = 1.0;
            let surface = cx.scene.surface(&ray, &hit, 0.0);
            if let Some(id) = cx.scene.light_at(&surface) {
                let le = cx.scene.emitted(id, &surface, -ray.d);
                let w = self.weight_of_found(cx, from.as_ref(), id, ray.d, Some(&surface));
                add(ContributionKind::Hit, depth, id, beta * le * w, &mut out);
            }
            let Some(material) = cx.scene.material(&surface).filter(|_| depth < 2) else { break };
            let (bsdf, frame) = (material.bsdf(&surface), surface.shading);
            let side = if surface.ng.dot(ray.d) < 0.0 { 1.0 } else { -1.0 };
            let (ng, ns) = (surface.ng * side, frame.z * side);
            let at = LitPoint { p: surface.p, p_err: surface.p_err, ng, ns, sides: Sides::Same, time: 0.0 };
            let wo = frame.to_local(-ray.d);
            if let Some(draw) = cx.scene.sample_light(&at, u.get_2d(Dim::bounce(depth, Slot::Light))) {
                let l = draw.sample;
                let (f, bsdf_pdf) = bsdf.eval_pdf(wo, frame.to_local(l.wi), Mode::Radiance);
                let segment = Segment { from: at.origin(), d: l.wi, to: l.end, time: 0.0 };
                let open = self.wrong == Wrong::NoShadow || !cx.scene.transmittance(&segment, 0).is_black();
                let w = if self.wrong == Wrong::NoMis { 1.0 } else { mis::power(l.pdf, bsdf_pdf) };
                let lights = if self.wrong == Wrong::NoPick { cx.scene.lights().len() as f32 } else { 1.0 };
                if open && l.pdf > 0.0 {
                    let value = beta * f * l.li * (w / (l.pdf * lights));
                    add(ContributionKind::LightSample, depth + 1, draw.id, value, &mut out);
                }
            }
            let (u_lobe, u_bsdf) =
                (u.get_1d(Dim::bounce(depth, Slot::Lobe)), u.get_2d(Dim::bounce(depth, Slot::Bsdf)));
            let Some(sample) = bsdf.sample(wo, u_lobe, u_bsdf, Mode::Radiance) else { break };
            let wi = frame.to_world(sample.wi);
            let (p, former) = (SURVIVAL[depth as usize], if depth == 0 { 1.0 } else { SURVIVAL[0] });
            if u.get_1d(Dim::bounce(depth, Slot::Roulette)) >= p {
                break;
            }
            beta *= sample.weight
                / match self.wrong {
                    Wrong::Undivided => 1.0,
                    Wrong::DividedByRest => 1.0 - p,
                    Wrong::DividedByFormer => former,
                    _ => p,
                };
            from = Some(From { at, pdf: sample.pdf });
            ray = surface.origin().ray(wi, 0.0);
        }
        match self.wrong {
            Wrong::Alpha => out.alpha *= 1.01,
            Wrong::Nan if u.get_1d(Dim::bounce(9, Slot::Roulette)) < 0.01 => out.l = Spectrum::gray(f32::NAN),
            _ => {}
        }
        out
    }
}

impl<S: Sampler> Integrator<S> for Mini {
    fn li(&self, cx: &Context<'_>, s: &CameraSample, u: S, rec: &mut dyn Recorder) -> Sample {
        self.walk(cx, s, u, rec)
    }

    fn li_plain(&self, cx: &Context<'_>, s: &CameraSample, u: S) -> Sample {
        let mut out = self.walk(cx, s, u, &mut ());
        if self.wrong == Wrong::Plain {
            out.l *= 1.0 + f32::EPSILON;
        }
        out
    }
}

/// A ball on a floor under a lamp and a sky.
fn scene() -> Scene {
    let mut b = SceneBuilder::new();
    let clay = b.material(Diffuse::new(Spectrum::gray(0.7)));
    let ball = Sphere::new(Vec3A::new(0.0, 0.0, 0.0), 0.5).expect("a ball");
    let floor =
        Parallelogram::new(Vec3A::new(-2.0, -0.5, 2.0), Vec3A::X * 4.0, Vec3A::Z * -4.0).expect("a floor");
    let lamp = Parallelogram::new(Vec3A::new(-1.0, 1.2, -0.5), Vec3A::X, Vec3A::Z).expect("a lamp");
    b.add(ball, clay);
    b.add(floor, clay);
    let lamp = b.add(lamp, clay);
    b.emit(lamp, Emission::new(Spectrum::gray(3.0)));
    b.light(ConstantEnvironment::new(Spectrum::gray(0.5)));
    b.build().expect("a scene")
}

/// The inside of a ball that emits 1 and reflects a half: 1 + 1/2 + 1/4 after two scattering events.
fn furnace() -> Scene {
    let mut b = SceneBuilder::new();
    let wall = b.material(Diffuse::new(Spectrum::gray(0.5)));
    let id = b.add(Sphere::new(Vec3A::ZERO, 1.0).expect("a ball"), wall);
    b.emit(id, Emission::new(Spectrum::ONE).two_sided());
    b.build().expect("a furnace")
}

fn case(name: &str, wrong: Wrong, closed: bool) -> Case<'static> {
    let scene = if closed { furnace() } else { scene() };
    let eye = if closed { Vec3A::new(0.1, 0.2, 0.3) } else { Vec3A::new(0.0, 1.0, 3.5) };
    let view = Perspective::look_at(eye, Vec3A::ZERO, Vec3A::Y, 40.0, UVec2::new(6, 4)).expect("a view");
    Case::new(name, move |b| {
        let reference = PathTracer { max_depth: Some(2), roulette: Roulette::Off, ..PathTracer::default() };
        let truth = if closed { Radiance::Known(1.75) } else { Radiance::Same(&reference) };
        let test =
            check_integrator(&Mini { wrong }, &|seed| Sobol::new(seed, 64), &scene, &view, &truth, 40, b)?;
        // The power: a bias of this size is 7.5 standard errors.
        let power = if closed { 0.01 } else { 0.02 };
        assert!(test.standard_error * 7.5 < power * test.truth, "{test:?}");
        Ok(Passed { tests: 1, statistical: 1, smallest_p: test.p })
    })
}

pub(crate) fn mutants() -> Vec<Case<'static>> {
    for closed in [false, true] {
        let right = case("", Wrong::Nothing, closed);
        assert!((right.check)(&etendue_testkit::Budget::default()).is_ok(), "the right one is accepted");
    }
    let of = |name: &str, wrong| case(name, wrong, false);
    vec![
        of("both techniques count fully", Wrong::NoMis),
        of("the sky counts fully beside light sampling", Wrong::NoMisForEscapes),
        of("roulette: survivors carry no weight", Wrong::Undivided),
        of("roulette: survivors are divided by 1 - p", Wrong::DividedByRest),
        of("roulette: off by one vertex", Wrong::DividedByFormer),
        case("roulette: off by one vertex, in a furnace", Wrong::DividedByFormer, true),
        of("light samples without the pick's probability", Wrong::NoPick),
        of("no shadows", Wrong::NoShadow),
        of("2 % too bright", Wrong::Factor(1.02)),
        case("1 % too bright, in a furnace", Wrong::Factor(1.01), true),
        case("1 % too dark, in a furnace", Wrong::Factor(0.99), true),
        of("other bits without a recorder", Wrong::Plain),
        of("a recorder that hears a part", Wrong::Recorder),
        of("alpha above 1", Wrong::Alpha),
        of("not a number once in a hundred", Wrong::Nan),
        Case::new("an estimator with 1 % bias, its standard error 0.075 %", |b| {
            // 24 means of 25,000 uniform numbers, each number with a relative deviation of 0.58.
            let estimate = |seed: u64| {
                let s = etendue_sampling::Independent::new(seed, 1);
                (0..25_000).map(|i| f64::from(s.start(i, 0).get_1d(Dim::FILM))).sum::<f64>() / 25_000.0 * 1.01
            };
            let test = check_estimator(&estimate, &Truth::Known(0.5), 24, b)?;
            Ok(Passed { tests: 1, statistical: 1, smallest_p: test.p })
        }),
    ]
}
