//! Cameras, lenses, glass and mirrors against their closed forms.

mod support;

use std::f64::consts::{FRAC_1_PI, PI};

use etendue::geometry::presets as meshes;
use etendue::material::{Absorber, MirrorMaterial};
use etendue::prelude::*;
use etendue_testkit::stats::mean_test;
use support::{WAYS, assert_mean, film_of, lamp, path, radiance, wide};

/// Independent estimates of how many pixels of a picture an emitter of radiance 1 covers.
fn covered_pixels(scene: &Scene, camera: &Perspective) -> Vec<f64> {
    let sampler = Independent::new(51, 64);
    // Every sample index is one estimate of the whole picture.
    (0..64)
        .map(|i| {
            let options =
                RenderOptions { samples: Some(i..i + 1), filter: Filter::BOX, ..RenderOptions::default() };
            film_of(scene, camera, sampler, &options).to_rgb().iter().map(|c| f64::from(c[1])).sum()
        })
        .collect()
}

/// What faces the film covers size² / distance² over a pixel's area at distance 1, wherever it stands; a sphere's
/// image is the ellipse in which its cone cuts the film, of area π sin²α cos α / (cos²θ − sin²α)^(3/2): off the axis
/// it grows by the cubed cosine, which with that of the receiving area makes the law of the fourth power.
#[test]
fn emitters_cover_the_pixels_of_their_perspective_image() {
    let camera = Perspective::look_at(Vec3A::ZERO, Vec3A::NEG_Z, Vec3A::Y, 60.0, UVec2::new(96, 64)).unwrap();
    let pixel = 2.0 * f64::tan(30f64.to_radians()) / 64.0;
    for (x, y) in [(-0.25, -0.25), (2.0, 0.6), (-2.4, -1.7)] {
        let mut b = SceneBuilder::new();
        lamp(&mut b, Parallelogram::new(Vec3A::new(x, y, -4.0), Vec3A::X * 0.5, Vec3A::Y * 0.5).unwrap());
        let xs = covered_pixels(&b.build().unwrap(), &camera);
        assert_mean(&xs, (0.5 / 4.0 / pixel).powi(2), 0.05, &format!("quad at {x}, {y}"));
    }
    for center in [Vec3A::new(0.0, 0.0, -3.0), Vec3A::new(1.9, -0.9, -3.0), Vec3A::new(-2.0, 1.2, -3.0)] {
        let mut b = SceneBuilder::new();
        lamp(&mut b, Sphere::new(center, 0.3).unwrap());
        let xs = covered_pixels(&b.build().unwrap(), &camera);
        let d = wide(center).length();
        let (sin2, cos2) = ((0.3f64 / d).powi(2), (3.0 / d).powi(2));
        let area = PI * sin2 * (1.0 - sin2).sqrt() / (cos2 - sin2).powf(1.5);
        assert_mean(&xs, area / (pixel * pixel), 0.05, &format!("sphere at {center}"));
        // On the axis' formula the outer ones would be far too small.
        if center.x != 0.0 {
            let flat = PI * sin2 / (pixel * pixel);
            assert!(mean_test(&xs, flat).rejects(1e-6));
        }
    }
}

/// A bright half-plane at distance d behind a lens of radius r focused at f: its edge is blurred by a circle of
/// diameter 2r |d − f| / (d f) at distance 1, so a point of the film at a distance of t radii from the edge's image sees
/// the light through 1/2 + (t √(1 − t²) + asin t) / π of the lens. In focus the edge is sharp.
#[test]
fn lenses_blur_by_the_circle_of_confusion() {
    let (r, f) = (0.1f64, 3.0f64);
    let pinhole =
        Perspective::look_at(Vec3A::ZERO, Vec3A::NEG_Z, Vec3A::Y, 40.0, UVec2::new(100, 100)).unwrap();
    let camera = pinhole.with_lens(r as f32, f as f32).unwrap();
    let pixel = 2.0 * f64::tan(20f64.to_radians()) / 100.0;
    for d in [1.5, 3.0, 9.0] {
        let mut b = SceneBuilder::new();
        // Bright where x > 0.
        let corner = Vec3A::new(0.0, -20.0, -d as f32);
        lamp(&mut b, Parallelogram::new(corner, Vec3A::X * 40.0, Vec3A::Y * 40.0).unwrap());
        let scene = b.build().unwrap();
        let blur = r * (d - f).abs() / (d * f) / pixel;
        let share = |film_x: f64, n: u64| {
            let through = |u: &Independent| {
                camera.ray(Vec2::new(film_x as f32, 47.0), u.get_2d(Dim::LENS), 0.0).unwrap().ray
            };
            radiance(&scene, &PathTracer::default(), 61, n, &through)
        };
        if d == f {
            // A fiftieth of a pixel beside the edge the whole lens is on one side.
            assert!(
                share(50.02, 2000).iter().all(|&x| x == 1.0) && share(49.98, 2000).iter().all(|&x| x == 0.0)
            );
            continue;
        }
        assert!(blur > 1.5, "wide enough to be seen: {blur} pixels");
        for t in [-0.9, -0.5, 0.0, 0.3, 0.8] {
            let truth = 0.5 + (t * f64::sqrt(1.0 - t * t) + f64::asin(t)) * FRAC_1_PI;
            assert_mean(&share(50.0 + t * blur, 150_000), truth, 0.12, &format!("distance {d}, {t} radii"));
        }
        // Just outside of the circle nothing is blurred, just inside something is.
        assert!(share(50.0 + 1.01 * blur, 5000).iter().all(|&x| x == 1.0), "distance {d}");
        assert!(share(50.0 - 1.01 * blur, 5000).iter().all(|&x| x == 0.0), "distance {d}");
        assert!(share(50.0 - 0.9 * blur, 5000).contains(&1.0), "distance {d}");
    }
}

/// Fresnel's reflectance of an interface from index 1 to `eta`, and the cosine behind it.
fn fresnel(cos_i: f64, eta: f64) -> f64 {
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (eta * eta)).sqrt();
    let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    0.5 * (s * s + p * p)
}

/// A wall of light across `z`, facing `toward` (±1).
fn wall(b: &mut SceneBuilder, z: f32, toward: f32) {
    let (u, v) = (Vec3A::X * 200.0, Vec3A::Y * 200.0 * toward);
    lamp(b, Parallelogram::new(Vec3A::new(-100.0, -100.0 * toward, z), u, v).unwrap());
}

/// Light bounces between the two faces of a pane: (1 − F)/(1 + F) gets through, 2F/(1 + F) comes back.
#[test]
fn a_pane_of_glass_lets_through_what_it_should() {
    for cos in [1.0f64, 0.6, 0.2] {
        let sin = (1.0 - cos * cos).sqrt();
        let look = |_: &Independent| {
            let d = Vec3A::new(sin as f32, 0.0, -cos as f32);
            Ray::new(Vec3A::Z - d, d)
        };
        let f = fresnel(cos, 1.5);
        for (what, z, toward, truth) in
            [("through", -5.0, 1.0, (1.0 - f) / (1.0 + f)), ("back", 8.0, -1.0, 2.0 * f / (1.0 + f))]
        {
            let mut b = SceneBuilder::new();
            let glass = b.material(Glass::new(1.5));
            b.add(meshes::cuboid(Vec3A::new(-90.0, -90.0, 0.0), Vec3A::new(90.0, 90.0, 1.0)), glass);
            wall(&mut b, z, toward);
            let scene = b.build().unwrap();
            for direct in WAYS {
                let n = if truth < 0.2 { 250_000 } else { 50_000 };
                let xs = radiance(&scene, &path(direct), 71, n, &look);
                assert_mean(&xs, truth, 0.04, &format!("cos {cos}, {what}, {direct:?}"));
            }
        }
    }
}

/// From inside of glass: past the critical angle everything comes back; before it n² (1 − F) of what is outside gets in
/// (radiance is compressed into a narrower cone) and F comes back.
#[test]
fn total_reflection_and_the_square_of_the_index() {
    let look = |deg: f64| {
        move |_: &Independent| {
            let d = Vec3A::new(deg.to_radians().sin() as f32, 0.0, deg.to_radians().cos() as f32);
            Ray::new(Vec3A::new(0.0, 0.0, -1.0), d)
        }
    };
    let scene = |z: f32, toward: f32| {
        let mut b = SceneBuilder::new();
        let glass = b.material(Glass::new(1.5));
        // The outside is above.
        b.add(
            Parallelogram::new(Vec3A::new(-90.0, -90.0, 0.0), Vec3A::X * 180.0, Vec3A::Y * 180.0).unwrap(),
            glass,
        );
        wall(&mut b, z, toward);
        b.build().unwrap()
    };
    let (outside, inside) = (scene(3.0, -1.0), scene(-3.0, 1.0));
    for direct in WAYS {
        for deg in [42.0, 50.0, 80.0] {
            let of = |s: &Scene| radiance(s, &path(direct), 72, 2000, &look(deg));
            assert!(of(&inside).iter().all(|&x| x == 1.0), "{deg}: all of it");
            assert!(of(&outside).iter().all(|&x| x == 0.0), "{deg}: nothing");
        }
        for deg in [0.0f64, 30.0, 41.0] {
            // Reciprocity: the reflectance is that of the refracted angle from outside.
            let cos_outside = (1.0 - (1.5 * deg.to_radians().sin()).powi(2)).sqrt();
            let f = fresnel(cos_outside, 1.5);
            let of = |s: &Scene, n| radiance(s, &path(direct), 73, n, &look(deg));
            assert_mean(
                &of(&outside, 100_000),
                2.25 * (1.0 - f),
                0.03,
                &format!("{deg}, outside, {direct:?}"),
            );
            assert_mean(&of(&inside, 200_000), f, 0.07, &format!("{deg}, inside, {direct:?}"));
        }
    }
}

/// A mirror shows a light behind the viewer exactly: every sample, on both sides of the light's edge.
#[test]
fn a_mirror_shows_a_light_exactly() {
    let mut b = SceneBuilder::new();
    let mirror = b.material(MirrorMaterial::new(Spectrum::gray(0.75)));
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Z).unwrap(), mirror);
    let black = b.material(Absorber);
    let lamp =
        b.add(Parallelogram::new(Vec3A::new(1.0, -1.0, 2.0), Vec3A::Y * 2.0, Vec3A::X).unwrap(), black);
    b.emit(lamp, Emission::new(Spectrum::gray(3.0)));
    let scene = b.build().unwrap();
    for direct in WAYS {
        // Seen from (−x, 0, 2) in the mirror's middle, the light reaches from x = 1 to 2.
        for (x, seen) in [(0.99f32, false), (1.01, true), (1.5, true), (1.99, true), (2.01, false)] {
            let d = etendue::core::vector::normalize(Vec3A::new(x, 0.0, -2.0));
            let ray = move |_: &Independent| Ray::new(Vec3A::new(-x, 0.0, 2.0), d);
            let expected = if seen { 2.25 } else { 0.0 };
            assert!(
                radiance(&scene, &path(direct), 81, 50, &ray).iter().all(|&l| l == expected),
                "{x}, {direct:?}"
            );
        }
    }
}

/// An orthographic picture covers pixels by area alone: a quad and a sphere are as large at any distance and place.
#[test]
fn parallel_rays_show_true_sizes() {
    let camera =
        etendue::camera::Orthographic::look_at(Vec3A::ZERO, Vec3A::NEG_Z, Vec3A::Y, 2.0, UVec2::new(60, 40));
    let camera = camera.unwrap();
    let pixel = 4.0 / 40.0;
    for z in [-1.0f32, -50.0] {
        let shapes: [(Geometry, f64); 2] = [
            (
                Parallelogram::new(Vec3A::new(1.1, -1.3, z), Vec3A::X * 0.7, Vec3A::Y * 0.5).unwrap().into(),
                0.35,
            ),
            (Sphere::new(Vec3A::new(-1.2, 0.6, z), 0.6).unwrap().into(), PI * 0.36),
        ];
        for (shape, area) in shapes {
            let mut b = SceneBuilder::new();
            lamp(&mut b, shape);
            let options = RenderOptions { filter: Filter::BOX, ..RenderOptions::default() };
            let film = film_of(&b.build().unwrap(), &camera, Sobol::new(2, 256), &options);
            let covered: f64 = film.to_rgb().iter().map(|c| f64::from(c[1])).sum();
            let truth = area / (pixel * pixel);
            assert!((covered / truth - 1.0).abs() < 2e-3, "z {z}: {covered} for {truth}");
        }
    }
}
