//! Motion blur: the mean of all moments, and nothing where nothing moves.

mod support;

use etendue::camera::Shutter;
use etendue::core::Motion;
use etendue::geometry::presets;
use etendue::prelude::*;
use etendue_testkit::stats::{MeanTest, sidak, welch_test};
use support::{WAYS, path, wide};

/// Level of each test of this file; every one makes fewer than a hundred comparisons.
const ALPHA: f64 = 1e-6;
const SIDE: u32 = 12;
const BLOCK: u32 = 3;
const RUNS: u64 = 24;
/// Moments of one reference picture, one in each stratum.
const MOMENTS: u64 = 64;
const SPP: u32 = 256;

#[derive(Clone, Copy, PartialEq)]
enum Moves {
    Box,
    Lamp,
    Camera,
    Nothing,
}

fn motion() -> Motion {
    Motion::new(Vec3A::new(0.3, 1.0, 0.2), 2.0, Vec3A::new(-0.5, 0.4, 0.0), Vec3A::new(1.2, 0.3, 0.0))
        .unwrap()
}

/// Around the scene, level, so that the lamp stays out of the picture.
fn drive() -> Motion {
    Motion::new(Vec3A::Y, 1.2, Vec3A::new(-0.5, 0.4, 0.0), Vec3A::new(2.0, 0.5, -0.5)).unwrap()
}

/// Places a group that moves, or, at a moment, stands where it is then: the reference shares no code with motion but its
/// definition.
fn place(b: &mut SceneBuilder, id: etendue::scene::GeomId, moves: bool, at: Option<f32>) {
    let group = b.group(&[id]);
    let start = Transform::rotation(Vec3A::X, 0.3);
    match at {
        _ if !moves => b.instance(group, start),
        None => b.moving_instance(group, start, motion()),
        Some(t) => {
            let [x, y, z, o] = motion().placement(&start, t).columns();
            b.instance(group, Transform::from_columns(x, y, z, o).unwrap())
        }
    };
}

/// A floor, a box and a lamp above it, under a dim sky.
fn scene(moves: Moves, at: Option<f32>) -> Scene {
    let mut b = SceneBuilder::new();
    let gray = b.material(Diffuse::new(Spectrum::gray(0.8)));
    let floor = Parallelogram::new(Vec3A::new(-4.0, -0.5, 4.0), Vec3A::X * 8.0, Vec3A::Z * -8.0).unwrap();
    b.add(floor, gray);
    let dark = b.material(Diffuse::new(Spectrum::gray(0.05)));
    let cuboid = presets::cuboid(Vec3A::new(-0.9, -0.2, -0.3), Vec3A::new(-0.1, 1.0, 0.3));
    let cuboid = b.add_grouped(cuboid, dark);
    place(&mut b, cuboid, moves == Moves::Box, at);
    // Out of the picture, where its edges would be most of the noise, unless it is the lamp that moves.
    let height = if moves == Moves::Lamp { 2.0 } else { 3.6 };
    let lamp = presets::quad(Vec3A::new(-1.2, height, -0.5), Vec3A::X * 1.2, Vec3A::Z);
    let lamp = b.add_grouped(lamp, gray);
    b.emit(lamp, Emission::new(Spectrum::gray(4.0)).two_sided());
    place(&mut b, lamp, moves == Moves::Lamp, at);
    b.light(ConstantEnvironment::new(Spectrum::gray(0.1)));
    b.build().unwrap()
}

fn view() -> Perspective {
    Perspective::look_at(Vec3A::new(0.0, 1.6, 5.0), Vec3A::Y * 0.6, Vec3A::Y, 45.0, UVec2::splat(SIDE))
        .unwrap()
}

fn film(scene: &Scene, camera: &dyn Camera, way: DirectLight, seed: u64, spp: u32) -> Film {
    let mut film = Film::new(camera.resolution(), 1).unwrap();
    let (sampler, options) = (Independent::new(seed, spp), RenderOptions::default());
    let tracer = PathTracer { max_depth: Some(2), ..path(way) };
    let report = render(scene, camera, &tracer, sampler, &mut film, &options).unwrap();
    assert_eq!(report.rejected, 0);
    film
}

/// Means of blocks of pixels.
fn blocks(film: &Film) -> Vec<f64> {
    let across = SIDE / BLOCK;
    let mut sums = vec![0.0; (across * across) as usize];
    for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
        let mean = f64::from(film.mean(UVec2::new(x, y)).mean());
        sums[(y / BLOCK * across + x / BLOCK) as usize] += mean / f64::from(BLOCK * BLOCK);
    }
    sums
}

/// Runs of a picture drawn over all moments.
fn blurred(moves: Moves, way: DirectLight) -> Vec<Vec<f64>> {
    let scene = scene(moves, None);
    let camera: Box<dyn Camera> = match moves {
        Moves::Camera => Box::new(Shutter::new(view(), 0.0, 1.0).unwrap().with_motion(drive())),
        _ => Box::new(view()),
    };
    (0..RUNS).map(|run| blocks(&film(&scene, &camera, way, 1 + run, SPP))).collect()
}

/// How a picture of one moment is made.
#[derive(Clone, Copy, PartialEq)]
enum Moment {
    /// The moving scene through a shutter that stands open at that moment alone.
    Frozen,
    /// A still scene.
    Still,
}

/// Runs of the mean of pictures at stratified random moments, sent through `warp`.
fn averaged(moves: Moves, how: Moment, warp: fn(f64) -> f64) -> Vec<Vec<f64>> {
    let moving = scene(moves, None);
    (0..RUNS)
        .map(|run| {
            let mut sums = vec![0.0; ((SIDE / BLOCK) * (SIDE / BLOCK)) as usize];
            for k in 0..MOMENTS {
                let u = Independent::new(77, 1).start(run, k).get_1d(Dim::TIME);
                let t = warp((k as f64 + f64::from(u)) / MOMENTS as f64) as f32;
                let (seed, spp) = (1_000 + run * MOMENTS + k, SPP / MOMENTS as u32);
                let frozen = Shutter::frozen(view(), t).unwrap();
                let picture = match (how, moves) {
                    (Moment::Frozen, Moves::Camera) => {
                        film(&moving, &frozen.with_motion(drive()), DirectLight::MisPower, seed, spp)
                    }
                    (Moment::Frozen, _) => film(&moving, &frozen, DirectLight::MisPower, seed, spp),
                    (Moment::Still, Moves::Camera) => {
                        film(&moving, &displaced_view(t), DirectLight::MisPower, seed, spp)
                    }
                    (Moment::Still, _) => {
                        film(&scene(moves, Some(t)), &view(), DirectLight::MisPower, seed, spp)
                    }
                };
                for (sum, x) in sums.iter_mut().zip(blocks(&picture)) {
                    *sum += x / MOMENTS as f64;
                }
            }
            sums
        })
        .collect()
}

/// The camera looked at afresh where the motion has brought eye, target and up.
fn displaced_view(t: f32) -> Perspective {
    let m = drive().at(t);
    let (eye, target) = (m.point(Vec3A::new(0.0, 1.6, 5.0)), m.point(Vec3A::Y * 0.6));
    Perspective::look_at(eye, target, m.vector(Vec3A::Y), 45.0, UVec2::splat(SIDE)).unwrap()
}

/// Welch's test of every block.
fn tests(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<MeanTest> {
    let column = |runs: &[Vec<f64>], i: usize| runs.iter().map(|r| r[i]).collect::<Vec<f64>>();
    (0..a[0].len()).map(|i| welch_test(&column(a, i), &column(b, i))).collect()
}

fn rejected(tests: &[MeanTest]) -> bool {
    tests.iter().any(|t| t.rejects(sidak(ALPHA, 100)))
}

/// A bias of this much of the picture's mean in any block would be five standard errors.
fn power(tests: &[MeanTest]) -> f64 {
    let mean = tests.iter().map(|t| t.truth).sum::<f64>() / tests.len() as f64;
    tests.iter().map(|t| 5.0 * t.standard_error / mean).fold(0.0, f64::max)
}

/// The picture agrees with both references, and with neither if time is not uniform.
fn is_the_mean_of_moments(moves: Moves, ways: &[DirectLight], least: f64) {
    let references = [Moment::Frozen, Moment::Still].map(|how| averaged(moves, how, |t| t));
    let middle = averaged(moves, Moment::Still, |_| 0.5);
    let squared = averaged(moves, Moment::Still, |t| t * t);
    for &way in ways {
        let picture = blurred(moves, way);
        for reference in &references {
            let all = tests(&picture, reference);
            println!("{way:?}: {:.1} % of the mean in any block would be seen", 100.0 * power(&all));
            assert!(!rejected(&all), "{way:?}: {all:?}");
            assert!(power(&all) <= least, "{way:?}: {} of the mean", power(&all));
        }
        assert!(rejected(&tests(&picture, &middle)), "{way:?}: the middle alone goes unnoticed");
        assert!(rejected(&tests(&picture, &squared)), "{way:?}: squared time goes unnoticed");
    }
}

#[test]
fn a_moving_and_turning_mesh_is_the_mean_of_its_moments() {
    is_the_mean_of_moments(Moves::Box, &[DirectLight::MisPower], 0.05);
}

#[test]
fn a_moving_camera_is_the_mean_of_its_moments() {
    is_the_mean_of_moments(Moves::Camera, &[DirectLight::MisPower], 0.1);
}

/// By light sampling, BSDF sampling and both.
#[test]
fn a_moving_lamp_is_the_mean_of_its_moments_in_every_way() {
    is_the_mean_of_moments(Moves::Lamp, &WAYS, 0.2);
}

fn counts(scene: &Scene, camera: &dyn Camera) -> (u64, bool) {
    let mut film = Film::new(camera.resolution(), 1).unwrap();
    let (sampler, options) = (Sobol::new(1, 8), RenderOptions::default());
    let report = render(scene, camera, &PathTracer::default(), sampler, &mut film, &options).unwrap();
    assert_eq!(report.samples, u64::from(SIDE * SIDE * 8));
    (report.counts.draws_time, report.needs.contains(Needs::MOTION))
}

#[test]
fn time_is_drawn_once_a_sample_where_something_moves_and_never_else() {
    let all = u64::from(SIDE * SIDE * 8);
    let still = scene(Moves::Nothing, None);
    let moving = scene(Moves::Box, None);
    let lamp = scene(Moves::Lamp, None);
    let part = Shutter::new(view(), 0.25, 0.5).unwrap();
    let frozen = Shutter::frozen(view(), 0.25).unwrap();
    for camera in [&view() as &dyn Camera, &part, &frozen, &frozen.clone().with_motion(motion())] {
        assert_eq!(counts(&still, camera), (0, false));
        assert_eq!(counts(&moving, camera), (all, true));
        assert_eq!(counts(&lamp, camera), (all, true));
    }
    assert_eq!(counts(&still, &part.with_motion(motion())), (all, true));
}

/// A Sobol film with everything moving.
fn busy() -> Film {
    let camera = Shutter::new(view().with_lens(0.05, 5.0).unwrap(), 0.1, 0.9).unwrap();
    let camera = camera.with_motion(Motion::travel(Vec3A::X * 0.3).unwrap());
    let mut film = Film::new(UVec2::splat(SIDE), 1).unwrap();
    let options = RenderOptions { tile: 4, ..RenderOptions::default() };
    let scene = scene(Moves::Lamp, None);
    render(&scene, &camera, &PathTracer::default(), Sobol::new(5, 16), &mut film, &options).unwrap();
    film
}

#[test]
fn threads_do_not_matter() {
    let on = |n: usize| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap().install(busy);
    let one = on(1);
    assert!(one == on(2));
    assert!(one == on(3));
}

/// Instances and cameras with a motion that moves nothing give the bits, and the digest, of those without.
#[test]
fn what_moves_nowhere_changes_no_bit() {
    let nowhere = Motion::new(Vec3A::Y, 0.0, Vec3A::ONE, Vec3A::ZERO).unwrap();
    let build = |moving: bool| {
        let mut b = SceneBuilder::new();
        let gray = b.material(Diffuse::new(Spectrum::gray(0.6)));
        let ball = b.add_grouped(presets::icosphere(2, 1.0), gray);
        let lamp = b.add_grouped(Sphere::new(Vec3A::Y * 2.0, 0.3).unwrap(), gray);
        b.emit(lamp, Emission::new(Spectrum::gray(9.0)));
        let group = b.group(&[ball, lamp]);
        let placed = Transform::rotation(Vec3A::ONE, 0.4);
        if moving {
            b.moving_instance(group, placed, nowhere);
        } else {
            b.instance(group, placed);
        }
        b.build().unwrap()
    };
    let (still, moving) = (build(false), build(true));
    assert_eq!(still.fingerprint(), moving.fingerprint());
    let picture = |scene: &Scene, camera: &dyn Camera| {
        let mut film = Film::new(camera.resolution(), 1).unwrap();
        let options = RenderOptions::default();
        render(scene, camera, &PathTracer::default(), Sobol::new(2, 32), &mut film, &options).unwrap();
        film
    };
    let plain = picture(&still, &view());
    assert!(plain == picture(&moving, &view()));
    let held = Shutter::new(view(), 0.0, 1.0).unwrap().with_motion(nowhere);
    assert!(plain == picture(&moving, &held));
    // A moment of a still scene is the scene.
    assert!(plain == picture(&still, &Shutter::frozen(view(), 0.7).unwrap()));
    assert!(wide(still.bounds().lo) == wide(moving.bounds().lo));
}
