//! Furnaces: closed rooms whose walls all glow and reflect alike, so that the answer is 1/(1 − ρ) everywhere.

mod support;

use etendue::geometry::presets as meshes;
use etendue::material::{MirrorMaterial, RoughGlass};
use etendue::prelude::*;
use etendue::sampling::warp;
use support::{DIRECT, assert_mean, radiance};

/// A closed room of radius about 1 whose walls emit 1 and reflect `rho`.
fn room(round: bool, rho: f32) -> Scene {
    let mut b = SceneBuilder::new();
    let wall = b.material(Diffuse::new(Spectrum::gray(rho)));
    let id = if round {
        b.add(Sphere::new(Vec3A::new(0.3, -0.2, 0.1), 1.0).unwrap(), wall)
    } else {
        b.add(Geometry::mesh(meshes::cuboid(Vec3A::new(-1.0, -0.7, -1.3), Vec3A::new(1.1, 0.9, 0.8))), wall)
    };
    b.emit(id, Emission::new(Spectrum::ONE).two_sided());
    b.build().unwrap()
}

fn from_inside(u: &Independent) -> Ray {
    let o = warp::sphere(u.get_2d(Dim::LENS)) * (0.5 * u.get_1d(Dim::TIME));
    Ray::new(o, warp::sphere(u.get_2d(Dim::FILM)))
}

#[test]
fn closed_rooms_give_one_over_one_minus_albedo_with_default_options() {
    for round in [true, false] {
        for (rho, n) in [(0.1, 40_000), (0.5, 200_000), (0.8, 400_000), (0.99, 100_000)] {
            let xs = radiance(&room(round, rho), &PathTracer::default(), 11, n, &from_inside);
            let truth = 1.0 / (1.0 - f64::from(rho));
            assert_mean(&xs, truth, 0.02, &format!("round {round}, albedo {rho}"));
        }
    }
}

#[test]
fn every_way_of_finding_light_gives_the_same_furnace() {
    for round in [true, false] {
        let scene = room(round, 0.5);
        for direct in DIRECT {
            let path = PathTracer { direct, ..PathTracer::default() };
            let xs = radiance(&scene, &path, 12, 400_000, &from_inside);
            assert_mean(&xs, 2.0, 0.012, &format!("round {round}, {direct:?}"));
        }
    }
}

/// The same with a power of 0.5 %: tens of millions of rays.
#[test]
#[ignore = "minutes; run before a release"]
fn furnaces_at_half_a_per_cent() {
    for round in [true, false] {
        for rho in [0.1, 0.5, 0.8, 0.99] {
            let scene = room(round, rho);
            for direct in [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisPower] {
                let path = PathTracer { direct, ..PathTracer::default() };
                let n = if rho > 0.9 { 1_500_000 } else { 4_000_000 };
                let xs = radiance(&scene, &path, 13, n, &from_inside);
                let truth = 1.0 / (1.0 - f64::from(rho));
                let test = etendue_testkit::stats::mean_test(&xs, truth);
                support::print_mean(&test, &format!("round {round}, albedo {rho}, {direct:?}"));
                assert_mean(&xs, truth, 0.005, &format!("round {round}, albedo {rho}, {direct:?}"));
            }
        }
    }
}

/// One sphere of a material in an environment of radiance 1; rays at its middle and its rim.
fn in_environment(material: impl Material + 'static) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.material(material);
    b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), m);
    b.light(ConstantEnvironment::new(Spectrum::ONE));
    b.build().unwrap()
}

fn at_the_sphere(u: &Independent) -> Ray {
    let d = warp::disc(u.get_2d(Dim::FILM)) * 0.98;
    Ray::new(Vec3A::new(d.x, d.y, 3.0), Vec3A::NEG_Z)
}

#[test]
fn a_constant_environment_shows_the_albedo() {
    for direct in DIRECT {
        let path = PathTracer { direct, ..PathTracer::default() };
        let xs =
            radiance(&in_environment(Diffuse::new(Spectrum::gray(0.6))), &path, 14, 200_000, &at_the_sphere);
        assert_mean(&xs, 0.6, 0.005, &format!("Lambert, {direct:?}"));
        let xs = radiance(
            &in_environment(MirrorMaterial::new(Spectrum::gray(0.9))),
            &path,
            15,
            1000,
            &at_the_sphere,
        );
        assert_mean(&xs, 0.9, 0.005, &format!("mirror, {direct:?}"));
    }
}

#[test]
fn glass_in_a_constant_environment_is_invisible() {
    for direct in DIRECT {
        let path = PathTracer { direct, ..PathTracer::default() };
        for eta in [1.33, 1.5, 2.4] {
            let xs = radiance(&in_environment(Glass::new(eta)), &path, 16, 60_000, &at_the_sphere);
            assert_mean(&xs, 1.0, 0.01, &format!("eta {eta}, {direct:?}"));
        }
    }
}

#[test]
fn rough_materials_agree_over_all_ways_of_finding_light() {
    let scenes = [
        ("gold", in_environment(Metal::gold(0.4))),
        ("rough glass", in_environment(RoughGlass::new(1.5, 0.5))),
    ];
    for (name, scene) in scenes {
        let of = |direct| {
            let path = PathTracer { direct, ..PathTracer::default() };
            radiance(&scene, &path, 17, 200_000, &at_the_sphere)
        };
        let reference = of(DirectLight::None);
        for direct in [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisBalance, DirectLight::MisPower]
        {
            let test = etendue_testkit::stats::welch_test(&of(direct), &reference);
            assert!(!test.rejects(1e-6), "{name}, {direct:?}: {test:?}");
            // Light sampling alone is noisy on glossy lobes: it sees 12 %, the others 2 %.
            let power = if direct == DirectLight::Light { 0.12 } else { 0.02 };
            assert!(5.0 * test.standard_error < power * test.truth.max(0.6), "{name}, {direct:?}: {test:?}");
        }
        // Nothing is made: a single-scattering model loses a little and never gains.
        let mean = etendue_testkit::stats::mean_test(&reference, 1.0);
        assert!(mean.estimate < 1.0 + 3.0 * mean.standard_error, "{name}: {mean:?}");
    }
}
