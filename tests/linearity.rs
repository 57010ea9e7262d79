//! What must not change a picture, and what must change it in proportion.

mod support;

use etendue::geometry::presets as meshes;
use etendue::prelude::*;
use etendue_testkit::stats::welch_test;
use support::{WAYS, cornell, film_of, path, radiance};

/// A room with the lights asked for.
fn room(quad: bool, sphere: bool, sky: bool) -> Scene {
    let mut b = etendue::scene::presets::empty_cornell_box().builder;
    // The preset's own lamp is there in all of them.
    let m = b.material(Diffuse::new(Spectrum::rgb(0.5, 0.6, 0.2)));
    if quad {
        let id = b
            .add(Parallelogram::new(Vec3A::new(-0.4, 0.2, -0.4), Vec3A::X * 0.2, Vec3A::Y * 0.3).unwrap(), m);
        b.emit(id, Emission::new(Spectrum::rgb(1.0, 2.0, 8.0)));
    } else {
        b.add(Parallelogram::new(Vec3A::new(-0.4, 0.2, -0.4), Vec3A::X * 0.2, Vec3A::Y * 0.3).unwrap(), m);
    }
    let id = b.add(Sphere::new(Vec3A::new(0.2, 0.3, 0.0), 0.1).unwrap(), m);
    if sphere {
        b.emit(id, Emission::new(Spectrum::rgb(6.0, 1.0, 1.0)));
    }
    if sky {
        b.light(ConstantEnvironment::new(Spectrum::gray(0.4)));
    }
    b.build().unwrap()
}

/// Light adds: with A and B it is what A and B give alone, the preset's lamp counted once. A term of 5 % would be seen.
#[test]
fn lights_add_up() {
    let camera = cornell(1).1;
    let look = |u: &Independent| camera.ray(u.get_2d(Dim::FILM), Vec2::ZERO, 0.0).unwrap().ray;
    for direct in WAYS {
        let path = PathTracer { max_depth: Some(2), ..path(direct) };
        let of = |scene: Scene, seed| radiance(&scene, &path, seed, 200_000, &look);
        let lamp = of(room(false, false, false), 1);
        for (name, a, b, both) in [
            ("quad and sphere", room(true, false, false), room(false, true, false), room(true, true, false)),
            ("sphere and sky", room(false, true, false), room(false, false, true), room(false, true, true)),
        ] {
            let (a, b, both) = (of(a, 2), of(b, 3), of(both, 4));
            let sum: Vec<f64> = a.iter().zip(&b).zip(&lamp).map(|((a, b), l)| a + b - l).collect();
            let test = welch_test(&both, &sum);
            assert!(!test.rejects(1e-6), "{name}, {direct:?}: {test:?}");
            let power = if direct == DirectLight::Bsdf { 0.12 } else { 0.05 };
            assert!(5.0 * test.standard_error < power * test.truth, "{name}, {direct:?}: {test:?}");
        }
    }
}

/// The order in which things are added decides their numbers and nothing else.
#[test]
fn the_order_of_objects_does_not_matter() {
    let build = |order: &[usize]| {
        let mut b = SceneBuilder::new();
        for &i in order {
            let m = b.material(Diffuse::new(Spectrum::rgb(0.2 + 0.1 * i as f32, 0.7, 0.4)));
            match i {
                0 => drop(b.add(
                    Parallelogram::new(Vec3A::new(-2.0, 0.0, -2.0), Vec3A::Z * 4.0, Vec3A::X * 4.0).unwrap(),
                    m,
                )),
                1 => drop(b.add(Sphere::new(Vec3A::new(-0.6, 0.5, 0.1), 0.5).unwrap(), m)),
                2 => drop(b.add(meshes::cuboid(Vec3A::new(0.3, 0.01, -0.4), Vec3A::new(0.9, 0.8, 0.3)), m)),
                3 => {
                    let id = b.add(meshes::quad(Vec3A::new(-0.5, 2.0, -0.5), Vec3A::X, Vec3A::Z), m);
                    b.emit(id, Emission::new(Spectrum::gray(6.0)));
                }
                _ => {
                    let glass = b.material(Glass::new(1.5));
                    let id = b.add_grouped(meshes::icosphere(2, 0.3), glass);
                    let group = b.group(&[id]);
                    b.instance(group, Transform::translation(Vec3A::new(0.0, 0.4, 0.9)));
                }
            }
        }
        b.build().unwrap()
    };
    let camera =
        Perspective::look_at(Vec3A::new(0.5, 1.5, 4.0), Vec3A::Y * 0.5, Vec3A::Y, 40.0, UVec2::splat(32))
            .unwrap();
    let film = |order: &[usize]| film_of(&build(order), &camera, Sobol::new(2, 8), &RenderOptions::default());
    let first = film(&[0, 1, 2, 3, 4]);
    assert!(first.to_rgb().iter().flatten().any(|&c| c > 0.1), "there is something to see");
    for order in [[4, 3, 2, 1, 0], [2, 0, 4, 1, 3], [3, 1, 0, 4, 2]] {
        assert!(film(&order) == first, "{order:?}");
    }
}

/// Twice the light is twice the picture, bit by bit: a factor of two is exact in every number on the way.
#[test]
fn doubled_emission_doubles_every_bit() {
    let scene = |factor: f32| {
        let mut b = SceneBuilder::new();
        let m = b.material(Diffuse::new(Spectrum::rgb(0.7, 0.5, 0.3)));
        let glass = b.material(Glass::new(1.5));
        b.add(Parallelogram::new(Vec3A::new(-2.0, 0.0, -2.0), Vec3A::Z * 4.0, Vec3A::X * 4.0).unwrap(), m);
        b.add(Sphere::new(Vec3A::new(0.0, 0.5, 0.5), 0.4).unwrap(), glass);
        let id = b.add(Sphere::new(Vec3A::new(-0.8, 1.2, 0.0), 0.2).unwrap(), m);
        b.emit(id, Emission::new(Spectrum::rgb(9.0, 5.0, 3.0) * factor));
        let id = b.add(meshes::cuboid(Vec3A::new(0.6, 0.2, -0.5), Vec3A::new(0.9, 0.5, -0.2)), m);
        b.emit(id, Emission::new(Spectrum::rgb(1.0, 2.0, 4.0) * factor));
        b.light(PointLight::new(Vec3A::new(0.1, 1.5, 0.4), Spectrum::gray(0.2 * factor)));
        b.light(ConstantEnvironment::new(Spectrum::gray(0.3 * factor)));
        b.build().unwrap()
    };
    let camera =
        Perspective::look_at(Vec3A::new(0.5, 1.5, 4.0), Vec3A::Y * 0.5, Vec3A::Y, 40.0, UVec2::splat(24))
            .unwrap();
    let film =
        |factor| film_of(&scene(factor), &camera, Sobol::new(2, 16), &RenderOptions::default()).to_rgb();
    let (one, two) = (film(1.0), film(2.0));
    assert!(one.iter().flatten().all(|&c| c > 0.0));
    for (i, (a, b)) in one.iter().zip(&two).enumerate() {
        assert_eq!(a.map(|c| 2.0 * c), *b, "pixel {i}");
    }
}
