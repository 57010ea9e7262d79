//! Scenes whose radiance is known in closed form, or by quadrature in double precision.

mod support;

use std::f64::consts::{FRAC_1_PI, PI};

use etendue::core::glam::DVec3;
use etendue::core::radiometry::{Intensity, projected_solid_angle};
use etendue::geometry::presets as meshes;
use etendue::material::{Absorber, MirrorMaterial};
use etendue::prelude::*;
use etendue_testkit::stats::{mean_test, welch_test};
use support::{assert_mean, cornell, film_of, radiance};

/// Every way of finding direct light that finds all of it.
const WAYS: [DirectLight; 3] = [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisPower];

const ALBEDO: f32 = 0.6;

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

fn path(direct: DirectLight) -> PathTracer {
    PathTracer { direct, ..PathTracer::default() }
}

/// A small diffuse patch around the origin that faces +z, and what is added to it.
fn patch(add: impl FnOnce(&mut SceneBuilder)) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.material(Diffuse::new(Spectrum::gray(ALBEDO)));
    b.add(Parallelogram::new(Vec3A::new(-0.05, -0.05, 0.0), Vec3A::X * 0.1, Vec3A::Y * 0.1).unwrap(), m);
    add(&mut b);
    b.build().unwrap()
}

/// Something that shines with radiance 1 and reflects nothing.
fn lamp(b: &mut SceneBuilder, shape: impl Into<Geometry>) {
    let black = b.material(Absorber);
    let id = b.add(shape, black);
    b.emit(id, Emission::new(Spectrum::ONE));
}

/// Looks at the middle of the patch from close by.
fn at_the_patch(_: &Independent) -> Ray {
    Ray::new(Vec3A::new(0.0, -0.006, 0.008), Vec3A::new(0.0, 0.6, -0.8))
}

/// The patch shows albedo · E / π. Light samples alone and MIS see a bias of 1 % as five standard errors, 2.5 % where
/// much of the light lies below the horizon; BSDF samples (which hit it with a probability of E / πL) one of 5 %.
fn assert_irradiance(scene: &Scene, e: f64, cut: bool, what: &str) {
    for direct in WAYS {
        let truth = f64::from(ALBEDO) * FRAC_1_PI * e;
        let (n, power) = match (direct, cut) {
            (DirectLight::Bsdf, _) => (300_000, 0.05),
            (_, false) => (60_000, 0.01),
            (_, true) => (300_000, 0.025),
        };
        let xs = radiance(scene, &path(direct), 31, n, &at_the_patch);
        assert_mean(&xs, truth, power, &format!("{what}, {direct:?}"));
    }
}

/// E = I cos θ / d²; every sample is the answer.
#[test]
fn point_lights_obey_the_inverse_square() {
    for p in [Vec3A::new(0.0, 0.0, 2.0), Vec3A::new(3.0, -1.0, 0.5), Vec3A::new(-20.0, 5.0, 30.0)] {
        let scene = patch(|b| b.light(PointLight::new(p, Spectrum::gray(7.0))));
        let d = wide(p).length();
        let e = Intensity(7.0).irradiance_at(d, wide(p).z / d).0;
        for direct in WAYS {
            let xs = radiance(&scene, &path(direct), 1, 100, &at_the_patch);
            assert_mean(&xs, f64::from(ALBEDO) * FRAC_1_PI * e, 0.001, &format!("{p}, {direct:?}"));
        }
    }
    // From below nothing arrives.
    let scene = patch(|b| b.light(PointLight::new(Vec3A::new(0.0, 1.0, -1.0), Spectrum::gray(7.0))));
    for direct in WAYS {
        assert!(radiance(&scene, &path(direct), 1, 100, &at_the_patch).iter().all(|&x| x == 0.0));
    }
}

/// Lambert's formula for quads (as exact shapes and as two triangles) and triangles, over the horizon and cut by it.
#[test]
fn polygon_lights_obey_lamberts_formula() {
    let quads = [
        ("overhead", Vec3A::new(-1.0, 1.0, 1.5), Vec3A::X * 2.0, Vec3A::NEG_Y * 2.0),
        ("slanted", Vec3A::new(0.3, 1.6, 0.4), Vec3A::new(1.5, -0.4, 0.2), Vec3A::new(0.3, -0.7, 1.6)),
        ("cut by the horizon", Vec3A::new(1.0, -1.5, -1.2), Vec3A::Y * 3.0, Vec3A::new(-0.3, 0.0, 3.0)),
        ("mostly below", Vec3A::new(1.2, -1.5, -4.0), Vec3A::Y * 3.0, Vec3A::new(0.0, 0.0, 5.0)),
    ];
    for (name, o, u, v) in quads {
        let cut = o.z < 0.0;
        // The front has to face the patch.
        let (u, v) = if u.cross(v).dot(-(o + (u + v) * 0.5)) > 0.0 { (u, v) } else { (v, u) };
        let corners = [o, o + u, o + u + v, o + v].map(wide);
        let e = projected_solid_angle(&corners, DVec3::Z).0;
        let quad = patch(|b| lamp(b, Parallelogram::new(o, u, v).unwrap()));
        assert_irradiance(&quad, e, cut, &format!("quad {name}"));
        let mesh = patch(|b| lamp(b, meshes::quad(o, u, v)));
        assert_irradiance(&mesh, e, cut, &format!("mesh {name}"));
        let e = projected_solid_angle(&corners[1..], DVec3::Z).0;
        let triangle = [o + u, o + u + v, o + v].map(Vec3::from).to_vec();
        let triangle = TriangleMesh::new(triangle, vec![[0, 1, 2]]).unwrap();
        assert_irradiance(&patch(|b| lamp(b, triangle)), e, cut, &format!("triangle {name}"));
        // What faces away is dark.
        let away = patch(|b| lamp(b, Parallelogram::new(o, v, u).unwrap()));
        for direct in WAYS {
            assert!(
                radiance(&away, &path(direct), 2, 500, &at_the_patch).iter().all(|&x| x == 0.0),
                "{name}"
            );
        }
    }
}

/// E = π (R/d)² cos θ for a sphere of radiance 1 above the horizon.
#[test]
fn sphere_lights_obey_the_closed_form() {
    for (center, radius) in [(Vec3A::new(0.0, 0.0, 2.0), 1.0), (Vec3A::new(1.0, 0.5, 1.5), 0.8)] {
        let scene = patch(|b| lamp(b, Sphere::new(center, radius).unwrap()));
        let (d, r) = (wide(center).length(), f64::from(radius));
        assert!(wide(center).z > r, "above the horizon");
        assert_irradiance(
            &scene,
            PI * (r / d).powi(2) * wide(center).z / d,
            false,
            &format!("sphere at {center}"),
        );
    }
}

/// ∫ max(0, n·ω) over the cone that a sphere fills, by the midpoint rule in the cosine from the axis and around it.
fn irradiance_of_sphere(center: DVec3, radius: f64) -> f64 {
    const STEPS: u32 = 2000;
    let d = center.length();
    let axis = center / d;
    let across = axis.any_orthonormal_vector();
    let (sin_max, step) = (radius / d, 1.0 / f64::from(STEPS));
    let cos_max = (1.0 - sin_max * sin_max).sqrt();
    let mut sum = 0.0;
    for i in 0..STEPS {
        let cos = cos_max + (1.0 - cos_max) * (f64::from(i) + 0.5) * step;
        let sin = (1.0 - cos * cos).sqrt();
        for j in 0..STEPS {
            let phi = 2.0 * PI * (f64::from(j) + 0.5) * step;
            let w = axis * cos + (across * phi.cos() + axis.cross(across) * phi.sin()) * sin;
            sum += w.z.max(0.0);
        }
    }
    sum * step * step * 2.0 * PI * (1.0 - cos_max)
}

#[test]
fn spheres_across_the_horizon_agree_with_quadrature() {
    let above = irradiance_of_sphere(DVec3::new(1.0, 0.5, 1.5), 0.8);
    let d = DVec3::new(1.0, 0.5, 1.5).length();
    assert!(
        (above / (PI * (0.8 / d).powi(2) * 1.5 / d) - 1.0).abs() < 1e-5,
        "the quadrature knows the closed form"
    );
    for (center, radius) in [(Vec3A::new(1.2, 0.0, 0.3), 1.0), (Vec3A::new(0.0, -1.3, -0.2), 1.1)] {
        let scene = patch(|b| lamp(b, Sphere::new(center, radius).unwrap()));
        assert_irradiance(
            &scene,
            irradiance_of_sphere(wide(center), f64::from(radius)),
            true,
            &format!("sphere at {center}"),
        );
    }
}

/// Unit squares: the mean radiance of one lit by the other is albedo times the form factor. (Parallel at distance 1 and
/// with a common edge at a right angle; both in closed form, e.g. Howell's catalogue, C-11 and C-14.)
#[test]
fn squares_exchange_their_form_factors() {
    let unit = |o: Vec3A, u: Vec3A, v: Vec3A| (Parallelogram::new(o, u, v).unwrap(), meshes::quad(o, u, v));
    let cases = [
        ("parallel", 0.199_824_895_698_387, unit(Vec3A::Z, Vec3A::Y, Vec3A::X)),
        ("perpendicular", 0.200_043_776_075_403_2, unit(Vec3A::ZERO, Vec3A::Y, Vec3A::Z)),
    ];
    let anywhere = |u: &Independent| {
        let p = u.get_2d(Dim::LENS);
        Ray::new(Vec3A::new(p.x, p.y, 1e-3), Vec3A::NEG_Z)
    };
    for (name, form_factor, (quad, mesh)) in cases {
        for (kind, shape) in [("quad", Geometry::from(quad)), ("mesh", Geometry::from(mesh))] {
            let mut b = SceneBuilder::new();
            let m = b.material(Diffuse::new(Spectrum::gray(ALBEDO)));
            b.add(Parallelogram::new(Vec3A::ZERO, Vec3A::X, Vec3A::Y).unwrap(), m);
            lamp(&mut b, shape);
            let scene = b.build().unwrap();
            for direct in WAYS {
                let power = if direct == DirectLight::Bsdf { 0.025 } else { 0.015 };
                let xs = radiance(&scene, &path(direct), 41, 250_000, &anywhere);
                let what = format!("{name} {kind}, {direct:?}");
                assert_mean(&xs, f64::from(ALBEDO) * form_factor, power, &what);
            }
        }
    }
}

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
        assert!(share(50.0 - 0.9 * blur, 5000).iter().any(|&x| x == 1.0), "distance {d}");
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
