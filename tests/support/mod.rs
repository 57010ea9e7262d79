//! What several test files need.
#![allow(dead_code, unreachable_pub)]

use etendue::core::glam::DVec3;
use etendue::prelude::*;
use etendue_testkit::stats::{MeanTest, mean_test};

/// Every way of finding direct light.
pub const DIRECT: [DirectLight; 5] = [
    DirectLight::None,
    DirectLight::Light,
    DirectLight::Bsdf,
    DirectLight::MisBalance,
    DirectLight::MisPower,
];

/// `n` independent samples of the radiance along rays that `ray` makes, mean of the channels.
pub fn radiance(
    scene: &Scene,
    integrator: &dyn Integrator<Independent>,
    seed: u64,
    n: u64,
    ray: &dyn Fn(&Independent) -> Ray,
) -> Vec<f64> {
    let cx = Context::new(scene);
    let sampler = Independent::new(seed, 1);
    (0..n)
        .map(|i| {
            let u = sampler.start(i, 0);
            let s = CameraSample { ray: ray(&u), weight: 1.0, spread: 0.0 };
            f64::from(integrator.li_plain(&cx, &s, u).l.mean())
        })
        .collect()
}

/// The mean is `truth`, and a bias of `power` (relative) would have been five standard errors.
pub fn assert_mean(samples: &[f64], truth: f64, power: f64, what: &str) {
    let test = mean_test(samples, truth);
    assert!(!test.rejects(1e-6), "{what}: {test:?}");
    assert!(5.0 * test.standard_error <= power * truth, "{what}: too few samples for its power: {test:?}");
}

/// As [`assert_mean`], printing the figures.
pub fn print_mean(test: &MeanTest, what: &str) {
    println!(
        "{what}: {:.5} ± {:.5} (true {:.5}), p = {:.3}",
        test.estimate, test.standard_error, test.truth, test.p
    );
}

/// A picture of a scene with the default integrator and one replicate.
pub fn film_of<S: Sampler>(
    scene: &Scene,
    camera: &dyn Camera,
    sampler: S,
    options: &RenderOptions<'_>,
) -> Film {
    let mut film = Film::new(camera.resolution(), sampler.replicates()).expect("a film");
    render(scene, camera, &PathTracer::default(), sampler, &mut film, options).expect("fits");
    film
}

/// The built-in scene, scaled by a factor, with its camera.
pub fn cornell(size: u32) -> (Scene, Perspective) {
    let p = etendue::scene::presets::cornell_box();
    let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, UVec2::splat(size));
    (p.builder.build().expect("the preset builds"), camera.expect("the preset's view"))
}

/// Every way of finding direct light that finds all of it.
pub const WAYS: [DirectLight; 3] = [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisPower];

/// The default integrator with a way of finding direct light.
pub fn path(direct: DirectLight) -> PathTracer {
    PathTracer { direct, ..PathTracer::default() }
}

/// Something that shines with radiance 1 and reflects nothing.
pub fn lamp(b: &mut SceneBuilder, shape: impl Into<Geometry>) {
    let black = b.material(etendue::material::Absorber);
    let id = b.add(shape, black);
    b.emit(id, Emission::new(Spectrum::ONE));
}

/// Exact.
pub fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}
