//! Different ways to the same light agree; each tells what it leaves out.

use etendue::integrator::{AreaForm, Branching, Whitted};
use etendue::material::{Absorber, Cutout, Metal, MirrorMaterial};
use etendue::prelude::*;
use etendue_testkit::stats::{sidak, welch_test};

/// Probability that any pair of a family is found to differ where all agree.
const ALPHA: f64 = 1e-3;
/// A difference of so many standard errors is found with a probability of 95 % or more (the level of one pair among 66
/// and Student's t with 38 degrees of freedom).
const SEEN: f64 = 7.0;

type Way<'a> = (&'a str, &'a dyn Integrator<Sobol>, u32);

/// Means of a picture over independent seeds.
fn means(scene: &Scene, camera: &Perspective, (name, integrator, spp): Way<'_>, seeds: u64) -> Vec<f64> {
    let size = camera.resolution();
    (0..seeds)
        .map(|i| {
            let seed = name.bytes().fold(i, |h, b| h.wrapping_mul(1_000_003) ^ u64::from(b));
            let mut film = Film::new(size, 1).unwrap();
            let sampler = Sobol::new(seed, spp);
            let report =
                render(scene, camera, integrator, sampler, &mut film, &RenderOptions::default()).unwrap();
            assert_eq!(report.rejected, 0);
            let pixels = film.to_rgb();
            let sum: f64 = pixels.iter().flatten().map(|&v| f64::from(v)).sum();
            sum / (3 * pixels.len()) as f64
        })
        .collect()
}

/// Every two of them agree, and would not if one were off by `power` of the whole.
fn assert_agreement(scene: &Scene, camera: &Perspective, ways: &[Way<'_>], seeds: u64, power: f64) {
    let all: Vec<Vec<f64>> = ways.iter().map(|&way| means(scene, camera, way, seeds)).collect();
    let pairs = ways.len() * (ways.len() - 1) / 2;
    let level = sidak(ALPHA, pairs);
    let mut wrong = Vec::new();
    for (i, a) in all.iter().enumerate() {
        for (j, b) in all.iter().enumerate().skip(i + 1) {
            let test = welch_test(a, b);
            let seen = SEEN * test.standard_error / test.truth;
            println!(
                "{:>24} {:.5}  {:>24} {:.5}  p {:.3}, {:.2} % would be seen",
                ways[i].0,
                test.estimate,
                ways[j].0,
                test.truth,
                test.p,
                100.0 * seen
            );
            assert!(seen <= power, "{} and {}: too few samples for the power: {seen}", ways[i].0, ways[j].0);
            if test.rejects(level) {
                wrong.push(format!("{} and {}: {test:?}", ways[i].0, ways[j].0));
            }
            // The mutant: off by the power, in one direction or the other.
            let off = |factor: f64| b.iter().map(|v| v * factor).collect::<Vec<f64>>();
            let found = |factor: f64| welch_test(a, &off(factor)).rejects(level);
            assert!(found(1.0 + power) || found(1.0 - power));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Two plates that face each other, a lamp beside them, a mirror and a glass ball: every kind of way on, and nothing
/// touches anything, so that areas can be integrated over.
fn room(b: &mut SceneBuilder) -> Perspective {
    let gray = b.material(Diffuse::new(Spectrum::rgb(0.7, 0.5, 0.4)));
    let metal = b.material(Metal::gold(0.5));
    let mirror = b.material(MirrorMaterial::new(Spectrum::gray(0.9)));
    let glass = b.material(Glass::new(1.5));
    let quad = |o: Vec3A, u: Vec3A, v: Vec3A| Parallelogram::new(o, u, v).unwrap();
    b.add(quad(Vec3A::new(-1.0, 0.0, 1.0), Vec3A::X * 2.0, Vec3A::Z * -2.0), gray);
    b.add(quad(Vec3A::new(-1.0, 2.0, -1.0), Vec3A::X * 2.0, Vec3A::Z * 2.0), gray);
    b.add(quad(Vec3A::new(-1.0, 0.2, -1.3), Vec3A::X * 2.0, Vec3A::Y * 1.6), metal);
    b.add(quad(Vec3A::new(-1.3, 0.2, 0.8), Vec3A::Y * 1.6, Vec3A::Z * -1.6), mirror);
    b.add(Sphere::new(Vec3A::new(0.3, 0.6, 0.1), 0.35).unwrap(), glass);
    let lamp = b.add(quad(Vec3A::new(1.3, 0.2, 0.8), Vec3A::Z * -1.6, Vec3A::Y * 1.6), gray);
    b.emit(lamp, Emission::new(Spectrum::rgb(3.0, 2.5, 2.0)).two_sided());
    Perspective::look_at(Vec3A::new(0.0, 1.0, 4.5), Vec3A::Y, Vec3A::Y, 40.0, UVec2::new(6, 5)).unwrap()
}

/// The same with what has no area or no place: a lamp without extent, a sky, holes and bodies that absorb.
fn crowded_room(b: &mut SceneBuilder) -> Perspective {
    let camera = room(b);
    let ink = b.material(Glass { absorption: Spectrum::rgb(0.5, 2.0, 4.0), ..Glass::new(1.3) });
    b.add(Sphere::new(Vec3A::new(-0.5, 0.5, 0.5), 0.3).unwrap(), ink);
    let lace = b.material(Cutout::new(Diffuse::new(Spectrum::gray(0.6)), 0.4));
    b.add(Disc::new(Vec3A::new(0.0, 1.4, 0.0), Vec3A::Y, 0.6).unwrap(), lace);
    b.light(PointLight::new(Vec3A::new(0.2, 1.7, 0.3), Spectrum::gray(1.5)));
    b.light(ConstantEnvironment::new(Spectrum::rgb(0.2, 0.3, 0.5)));
    camera
}

const DEPTH: Option<u32> = Some(4);

/// All the ways to light that scatters four times at most, with samples in proportion to their noise.
fn compare_all(seeds: u64, unit: u32, power: f64, crowded: bool) {
    let mut b = SceneBuilder::new();
    let camera = if crowded { crowded_room(&mut b) } else { room(&mut b) };
    let scene = b.build().unwrap();
    let path = PathTracer { max_depth: DEPTH, ..PathTracer::default() };
    let roulette = |roulette| PathTracer { roulette, ..path };
    let off = roulette(Roulette::Off);
    let fixed = roulette(Roulette::Fixed { p: 0.7, from: 1 });
    let albedo = roulette(Roulette::Albedo { from: 1 });
    let early = roulette(Roulette::Throughput { from: 1 });
    let split = PathTracer { max_depth: DEPTH, ..PathTracer::split_form() };
    let hemisphere = PathTracer { max_depth: DEPTH, ..PathTracer::hemisphere_form() };
    let bsdf = PathTracer { direct: DirectLight::Bsdf, ..path };
    let branching = PathTracer { branching: Branching { factor: 4, levels: 2 }, ..path };
    let mut area = AreaForm::new(&scene).unwrap();
    area.max_depth = DEPTH;
    let mut ways: Vec<Way<'_>> = vec![
        ("path", &path, unit),
        ("no roulette", &off, unit),
        ("roulette: fixed", &fixed, 2 * unit),
        ("roulette: albedo", &albedo, unit),
        ("roulette: throughput", &early, 2 * unit),
        ("split", &split, unit),
        ("by BSDF", &bsdf, 4 * unit),
        ("branching", &branching, unit),
        ("area", &area, 32 * unit),
    ];
    // By chance alone a lamp without extent is never found, and that is said.
    if crowded {
        assert!(Integrator::<Sobol>::bias(&hemisphere).iter().any(|b| b.contains("point lights")));
    } else {
        ways.push(("hemisphere", &hemisphere, 4 * unit));
    }
    assert_agreement(&scene, &camera, &ways, seeds, power);
}

#[test]
fn all_ways_lead_to_the_same_light() {
    compare_all(20, 128, 0.05, false);
}

#[test]
fn all_ways_lead_to_the_same_light_of_lamps_skies_holes_and_ink() {
    compare_all(20, 128, 0.05, true);
}

#[test]
#[ignore = "minutes; run before a release"]
fn all_ways_lead_to_the_same_light_within_half_a_percent() {
    compare_all(20, 8192, 0.005, false);
    compare_all(20, 8192, 0.005, true);
    compare_whitted(8192, 0.005);
}

/// Where everything is mirror and clear glass, Whitted's tree holds all light; where nothing is, it holds direct light.
fn compare_whitted(unit: u32, power: f64) {
    let sky = || {
        let pixels = (0..8 * 4 * 3).map(|i| 0.2 + (i * 7 % 11) as f32 * 0.1).collect();
        ImageEnvironment::new(ImageTexture::from_f32(8, 4, 3, pixels).unwrap(), 1.0, 0.0).unwrap()
    };
    let view =
        |size| Perspective::look_at(Vec3A::new(0.0, 0.3, 4.0), Vec3A::ZERO, Vec3A::Y, 40.0, size).unwrap();
    let camera = view(UVec2::new(6, 4));
    let mut b = SceneBuilder::new();
    let mirror = b.material(MirrorMaterial::new(Spectrum::rgb(0.9, 0.8, 0.7)));
    let glass = b.material(Glass::new(1.5));
    let ink = b.material(Glass { absorption: Spectrum::rgb(0.2, 0.6, 1.0), ..Glass::new(1.4) });
    let pane = b.material(Principled {
        transmission: 1.0.into(),
        thin: true,
        ..Principled::new(Spectrum::rgb(0.7, 0.9, 0.8), 0.0, 0.0)
    });
    b.add(Sphere::new(Vec3A::new(-0.8, 0.0, 0.0), 0.7).unwrap(), glass);
    b.add(Sphere::new(Vec3A::new(0.8, 0.0, 0.3), 0.6).unwrap(), ink);
    b.add(Sphere::new(Vec3A::new(0.0, -100.7, 0.0), 100.0).unwrap(), mirror);
    b.add(Parallelogram::new(Vec3A::new(-1.0, 0.2, 1.2), Vec3A::X * 1.5, Vec3A::Y).unwrap(), pane);
    let black = b.material(Absorber);
    let lamp = b.add(Disc::new(Vec3A::new(0.0, 2.0, -1.0), Vec3A::NEG_Y, 1.0).unwrap(), black);
    b.emit(lamp, Emission::new(Spectrum::gray(4.0)));
    b.light(sky());
    let scene = b.build().unwrap();
    let (whitted, path) = (Whitted::default(), PathTracer::default());
    assert_agreement(
        &scene,
        &camera,
        &[("whitted", &whitted, unit / 4), ("path", &path, 2 * unit)],
        20,
        power,
    );

    let mut b = SceneBuilder::new();
    let clay = b.material(Diffuse::new(Spectrum::gray(0.6)));
    let brass = b.material(Metal::gold(0.4));
    b.add(Sphere::new(Vec3A::new(-0.8, 0.0, 0.0), 0.7).unwrap(), clay);
    b.add(Sphere::new(Vec3A::new(0.8, 0.0, 0.3), 0.6).unwrap(), brass);
    b.add(Plane::new(Vec3A::Y * -0.7, Vec3A::Y).unwrap(), clay);
    let black = b.material(Absorber);
    let lamp = b.add(Disc::new(Vec3A::new(0.0, 2.0, -1.0), Vec3A::NEG_Y, 1.0).unwrap(), black);
    b.emit(lamp, Emission::new(Spectrum::gray(4.0)));
    b.light(PointLight::new(Vec3A::new(2.0, 2.0, 2.0), Spectrum::gray(10.0)));
    b.light(sky());
    let scene = b.build().unwrap();
    let cast = etendue::integrator::RayCaster::default();
    let one = Whitted { each_light: 0, ..whitted };
    let direct = PathTracer::direct_only();
    let ways: [Way<'_>; 4] = [
        ("whitted", &whitted, unit),
        ("one light", &one, 8 * unit),
        ("raycast", &cast, unit),
        ("direct", &direct, 4 * unit),
    ];
    assert_agreement(&scene, &camera, &ways, 20, power);
}

#[test]
fn whitted_has_all_the_light_of_mirrors_and_all_direct_light() {
    compare_whitted(256, 0.03);
}

/// A picker may leave a sky to rays: whoever does not look for it by rays draws it all the same.
#[test]
fn a_sky_that_nobody_picks_is_there() {
    let mut b = SceneBuilder::new();
    let camera = room(&mut b);
    b.light(ConstantEnvironment::new(Spectrum::gray(2.0)));
    b.picker_with(|_, _| None);
    let scene = b.build().unwrap();
    let path = PathTracer { max_depth: Some(2), ..PathTracer::default() };
    let mut area = AreaForm::new(&scene).unwrap();
    area.max_depth = Some(2);
    assert_agreement(&scene, &camera, &[("path", &path, 128), ("area", &area, 512)], 20, 0.03);
}

/// A mirror of a user's whose weight may be no number.
struct Broken(f32);

impl Bsdf for Broken {
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION | Lobes::DELTA
    }
    fn eval(&self, _: Vec3A, _: Vec3A, _: Mode) -> Spectrum {
        Spectrum::BLACK
    }
    fn pdf(&self, _: Vec3A, _: Vec3A, _: Mode) -> f32 {
        0.0
    }
    fn sample(&self, wo: Vec3A, _: f32, _: Vec2, _: Mode) -> Option<BsdfSample> {
        let wi = Vec3A::new(-wo.x, -wo.y, wo.z);
        Some(BsdfSample { wi, weight: Spectrum::gray(self.0), pdf: 1.0, lobe: self.lobes(), eta: 1.0 })
    }
    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Ref(self)
    }
}

impl Material for Broken {
    fn bsdf<'a>(&'a self, _: &Surface) -> BsdfAt<'a> {
        BsdfAt::Ref(self)
    }
    fn needs(&self) -> Needs {
        Needs::DELTA
    }
}

/// A weight that is no number reaches the film, which refuses it and says where; it does not turn black in silence.
#[test]
fn what_is_no_number_is_reported() {
    let mut b = SceneBuilder::new();
    let broken = b.material(Broken(f32::NAN));
    b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), broken);
    b.light(PointLight::new(Vec3A::new(0.0, 5.0, 0.0), Spectrum::ONE));
    let scene = b.build().unwrap();
    let camera = Perspective::look_at(Vec3A::Z * 4.0, Vec3A::ZERO, Vec3A::Y, 20.0, UVec2::splat(4)).unwrap();
    let area = AreaForm::new(&scene).unwrap();
    let ways: [&dyn Integrator<Sobol>; 3] = [&PathTracer::default(), &Whitted::default(), &area];
    for way in ways {
        let mut film = Film::new(UVec2::splat(4), 1).unwrap();
        let r = render(&scene, &camera, way, Sobol::new(1, 4), &mut film, &RenderOptions::default()).unwrap();
        assert_eq!(r.rejected, 64);
    }
}

#[test]
fn what_has_no_area_is_refused_by_name() {
    let mut b = SceneBuilder::new();
    let m = b.material(Absorber);
    b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), m);
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    let error = AreaForm::new(&b.build().unwrap()).err().unwrap();
    assert!(error.to_string().contains("geometry 1"), "{error}");
    assert!(AreaForm::new(&SceneBuilder::new().build().unwrap()).is_ok(), "an empty scene has no areas");
}
