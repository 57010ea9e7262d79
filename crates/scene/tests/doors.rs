//! The doors: a user's own ray queries and choice of lights.

mod common;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use common::{gray, radiance, square};
use etendue_bvh::{Accel, BruteForce, BuildError, HitFilter, Place};
use etendue_camera::{Camera, Film, Perspective};
use etendue_core::{Aabb, Needs, Ray, Spectrum, UVec2, Vec3A};
use etendue_geometry::Hit;
use etendue_integrator::{DirectLight, PathTracer, RenderOptions, render};
use etendue_light::{Light, LightId, LightPicker, LitPoint, Pick, PointLight, UniformPicker};
use etendue_material::{Cutout, Diffuse};
use etendue_sampling::Sobol;
use etendue_scene::{Emission, Scene, SceneBuilder, SceneError, presets};
use etendue_testkit::stats::{mean_test, welch_test};

fn film(scene: &Scene, camera: &Perspective) -> Film {
    let mut film = Film::new(camera.resolution(), 1).unwrap();
    render(scene, camera, &PathTracer::default(), Sobol::new(1, 4), &mut film, &RenderOptions::default())
        .unwrap();
    film
}

fn camera() -> Perspective {
    let p = presets::cornell_box();
    Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, UVec2::splat(20)).unwrap()
}

/// The built-in scene with a screen full of holes before it.
fn scene_with(change: impl FnOnce(&mut SceneBuilder)) -> Scene {
    let mut b = presets::cornell_box().builder;
    let m = b.material(Cutout::new(Diffuse::new(Spectrum::gray(0.8)), 0.5));
    b.add(square(0.7), m);
    change(&mut b);
    b.build().unwrap()
}

/// Testing everything gives the same film, bit for bit, holes and instances included.
#[test]
fn brute_force_gives_the_same_film() {
    let ours = scene_with(|_| {});
    assert!(ours.needs().contains(Needs::CUTOUTS | Needs::INSTANCES));
    let theirs = scene_with(|b| b.accel_with(|world| Ok(Box::new(BruteForce::build(world)?))));
    assert!(film(&ours, &camera()) == film(&theirs, &camera()));
    assert!(theirs.report().memory.hierarchy > 0);
    assert_eq!(ours.bounds(), theirs.bounds());
}

/// Counts what it is asked and passes it on.
struct Counting {
    inner: BruteForce,
    asked: Arc<AtomicU64>,
}

impl Accel for Counting {
    fn bounds(&self) -> Aabb {
        self.inner.bounds()
    }
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.inner.intersect(ray)
    }
    fn occluded(&self, ray: &Ray) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.inner.occluded(ray)
    }
    fn intersect_filtered(&self, ray: &Ray, ray_index: u32, filter: &dyn HitFilter) -> Option<Hit> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.inner.intersect_filtered(ray, ray_index, filter)
    }
    fn bytes(&self) -> usize {
        12_345
    }
}

/// A structure of the user's own, with only what must be written, is the one that is asked.
#[test]
fn a_user_s_own_structure_answers_every_ray() {
    let asked = Arc::new(AtomicU64::new(0));
    let counter = asked.clone();
    let theirs = scene_with(move |b| {
        b.accel_with(move |world| {
            Ok(Box::new(Counting { inner: BruteForce::build(world)?, asked: counter }))
        });
    });
    assert_eq!(theirs.report().memory.hierarchy, 12_345);
    let camera = camera();
    let mut film = Film::new(camera.resolution(), 1).unwrap();
    let path = PathTracer::default();
    let report =
        render(&theirs, &camera, &path, Sobol::new(1, 4), &mut film, &RenderOptions::default()).unwrap();
    // A shadow ray between coinciding ends asks nothing; there are none here.
    assert_eq!(asked.load(Ordering::Relaxed), report.counts.rays());
    assert!(film == self::film(&scene_with(|_| {}), &camera));
}

#[test]
fn what_goes_wrong_behind_the_door_comes_out_as_an_error() {
    let mut b = SceneBuilder::new();
    b.accel_with(|_| Err(BuildError::UnknownGeometry { place: Place::Direct(0), geom: 4, count: 2 }));
    let e = b.build().map(|_| ()).expect_err("refused");
    assert!(matches!(e, SceneError::Hierarchy(BuildError::UnknownGeometry { geom: 4, .. })), "{e}");
}

/// The first light with probability 0.9, the last with 0.1, whatever they are worth.
struct Stubborn {
    last: u32,
}

impl LightPicker for Stubborn {
    fn pick(&self, _at: &LitPoint, u: f32) -> Option<Pick> {
        Some(if u < 0.9 {
            Pick { id: LightId { light: 0, part: 0 }, pmf: 0.9, u: u / 0.9 }
        } else {
            Pick { id: LightId { light: self.last, part: 0 }, pmf: 0.1, u: ((u - 0.9) / 0.1).min(0.999_999) }
        })
    }
    fn pmf(&self, _at: &LitPoint, id: LightId) -> f32 {
        match id.light {
            0 => 0.9,
            l if l == self.last => 0.1,
            _ => 0.0,
        }
    }
}

fn two_lights(change: impl FnOnce(&mut SceneBuilder)) -> Scene {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    b.add(square(0.0), m);
    b.light(PointLight::new(Vec3A::new(0.0, 0.0, 2.0), Spectrum::gray(1.0)));
    let lamp = b.add(
        etendue_geometry::Parallelogram::new(Vec3A::new(-1.0, 1.0, 3.0), Vec3A::X * 2.0, Vec3A::NEG_Y * 2.0)
            .unwrap(),
        m,
    );
    b.emit(lamp, Emission::new(Spectrum::gray(5.0)));
    change(&mut b);
    b.build().unwrap()
}

/// However the lights are chosen, the mean is the same; a bias of 3 % would be five standard errors.
#[test]
fn any_choice_of_lights_gives_the_same_light() {
    let down = Ray::new(Vec3A::new(0.1, 0.2, 1.0), Vec3A::NEG_Z);
    for direct in [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisPower] {
        let path = PathTracer { direct, ..PathTracer::default() };
        let of = |scene: &Scene, seed| radiance(scene, &path, down, seed, 400_000);
        let by_power = of(&two_lights(|_| {}), 1);
        let stubborn = of(
            &two_lights(|b| {
                b.picker_with(|lights, radius| {
                    assert!(lights.len() == 2 && radius > 1.0);
                    Some(Box::new(Stubborn { last: lights.len() as u32 - 1 }))
                });
            }),
            2,
        );
        let uniform = of(
            &two_lights(|b| {
                b.picker_with(|lights: &[Arc<dyn Light>], _| Some(Box::new(UniformPicker::new(lights)?)));
            }),
            3,
        );
        for (name, other) in [("stubborn", &stubborn), ("uniform", &uniform)] {
            let test = welch_test(other, &by_power);
            assert!(!test.rejects(1e-6), "{name}, {direct:?}: {test:?}");
            assert!(5.0 * test.standard_error < 0.03 * test.truth, "{name}, {direct:?}: {test:?}");
        }
    }
}

/// No picker is a picker that never picks: emitters are still seen, and found by chance.
#[test]
fn without_a_picker_light_is_found_by_chance() {
    let scene = two_lights(|b| b.picker_with(|_, _| None));
    let down = Ray::new(Vec3A::new(0.1, 0.2, 1.0), Vec3A::NEG_Z);
    let with = radiance(
        &two_lights(|_| {}),
        &PathTracer { direct: DirectLight::None, ..PathTracer::default() },
        down,
        5,
        300_000,
    );
    let without = radiance(&scene, &PathTracer::default(), down, 6, 300_000);
    let test = welch_test(&without, &with);
    assert!(!test.rejects(1e-6) && 5.0 * test.standard_error < 0.04 * test.truth, "{test:?}");
    assert!(mean_test(&without, test.truth * 1.05).rejects(1e-6), "5 % off is seen");
    assert!(scene.fingerprint().value() != two_lights(|_| {}).fingerprint().value());
}
