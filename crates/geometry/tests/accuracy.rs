//! Distances, normals and positions against twice the precision.

mod common;

use common::{Rng, Twice, cross, dot, minus, point};
use etendue_core::{Ray, Vec2, Vec3, Vec3A};
use etendue_geometry::triangle::TriangleRay;
use etendue_geometry::{Parallelogram, Plane, Shape, Sphere, TriangleMesh};

fn distance_to(c: Vec3A, p: Vec3A) -> f64 {
    let v = minus(point(p), point(c));
    dot(v, v).sqrt().hi
}

fn ulps(a: f32, b: f64) -> f64 {
    let step = f64::from(a.abs().next_up() - a.abs());
    (f64::from(a) - b).abs() / step
}

/// Nearest root and the discriminant of the quadratic, in double-double precision.
struct Roots {
    discriminant: Twice,
    near: f64,
    far: f64,
}

fn roots(ray: &Ray, center: Vec3A, radius: f32) -> Roots {
    let (f, d) = (minus(point(ray.o), point(center)), point(ray.d));
    let (a, b) = (dot(d, d), dot(f, d));
    let r = Twice::new(radius);
    let discriminant = b * b - a * (dot(f, f) - r * r);
    let root = discriminant.sqrt();
    let minus_b = Twice::new(0.0) - b;
    Roots { discriminant, near: (minus_b - root).ratio(a), far: (minus_b + root).ratio(a) }
}

/// Rays at a sphere of radius 1 seen from 100 to 10 000 radii away, and from just outside of a large one.
fn sphere_accuracy(rays: usize) {
    let mut rng = Rng(1);
    for (distance, radius) in [(1e2f32, 1.0f32), (1e3, 1.0), (1e4, 1.0), (1.0000001e4, 1e4), (1.5, 1.0)] {
        let (mut wrong, mut worst_t, mut worst_p) = (0, 0.0f64, 0.0f64);
        for _ in 0..rays {
            let center = rng.direction() * rng.unit() * radius;
            let sphere = Sphere::new(center, radius).unwrap();
            let o = center + rng.direction() * distance;
            let target = center + rng.direction() * (radius * rng.range(0.0, 1.1));
            let Some(d) = etendue_core::vector::try_normalize(target - o) else { continue };
            let ray = Ray::new(o, d);
            let Roots { discriminant, near, far } = roots(&ray, center, radius);
            let hit = sphere.intersect(&ray);
            // A tangent to within the precision of double precision may fall either way.
            let tangent = discriminant.hi.abs() < 1e-12 * f64::from(distance * distance);
            let truth = discriminant.hi >= 0.0 && far as f32 > 0.0;
            if hit.is_some() != truth && !tangent {
                wrong += 1;
            }
            let (Some(hit), true) = (hit, truth && !tangent) else { continue };
            let t = if near as f32 > 0.0 { near } else { far };
            worst_t = worst_t.max(ulps(hit.t, t));
            let p = sphere.surface(&ray, &hit).p;
            // In ulp of the largest coordinate at play.
            let ulp = f64::from(f32::EPSILON) * f64::from(radius).max(f64::from(p.abs().max_element()));
            worst_p = worst_p.max((distance_to(center, p) - f64::from(radius)).abs() / ulp);
        }
        println!(
            "distance {distance}, radius {radius}: {wrong} wrong of {rays}, t {worst_t:.2} ulp, radius {worst_p:.2} ulp"
        );
        assert_eq!(wrong, 0);
        assert!(worst_t <= 1.0, "t off by {worst_t} ulp from {distance}");
        assert!(worst_p <= 4.0, "radius off by {worst_p} ulp from {distance}");
    }
}

#[test]
fn spheres_are_right_from_far_away() {
    sphere_accuracy(50_000);
}

#[test]
#[ignore = "a million rays at each distance"]
fn spheres_are_right_from_far_away_at_length() {
    sphere_accuracy(1_000_000);
}

fn plane_t(ray: &Ray, v: [Vec3A; 3]) -> f64 {
    let [a, b, c] = v.map(point);
    let n = cross(minus(b, a), minus(c, a));
    dot(minus(a, point(ray.o)), n).ratio(dot(point(ray.d), n))
}

/// Slivers seen at a glance: the distance is right, and no hit lies outside of the triangle's box.
fn skinny_and_grazing(rays: usize) {
    let mut rng = Rng(2);
    let (mut hits, mut worst) = (0, 0.0f64);
    for _ in 0..rays {
        let aspect = rng.magnitude(-6.0, -2.0);
        let size = rng.magnitude(-3.0, 3.0);
        let along = rng.direction();
        let frame = etendue_core::Frame::from_normal(along);
        let base = rng.direction() * (size * 3.0);
        let v = [base, base + along * size, base + along * (size * 0.4) + frame.x * (size * aspect)];
        let Some(n) =
            etendue_core::vector::try_normalize(etendue_core::vector::cross(v[1] - v[0], v[2] - v[0]))
        else {
            continue;
        };
        let target = (v[0] + v[1] + v[2]) / 3.0;
        let graze = rng.magnitude(-6.0, -1.0);
        let d = etendue_core::vector::normalize(
            frame.to_world(Vec3A::new(rng.range(-1.0, 1.0), 0.0, 1.0)) + n * graze,
        );
        let ray = Ray::new(target - d * (size * rng.range(0.5, 50.0)), d);
        let Some(hit) = TriangleRay::new(&ray).intersect(v) else { continue };
        hits += 1;
        let cos = f64::from(n.dot(d)).abs();
        let truth = plane_t(&ray, v);
        let error = ulps(hit.t, truth) * cos;
        // Where the plane is met outside of the box, the test moved the hit into it.
        let bounds = etendue_core::Aabb::of_points(v);
        let at = |t: f64| {
            Vec3A::from_array(std::array::from_fn(|i| (f64::from(ray.o[i]) + f64::from(ray.d[i]) * t) as f32))
        };
        let slack = Vec3A::splat(size * 53.0 * f32::EPSILON * 4.0);
        let inside = |p: Vec3A| p.cmpge(bounds.lo - slack).all() && p.cmple(bounds.hi + slack).all();
        assert!(inside(at(f64::from(hit.t))), "{ray:?} {v:?} {hit:?}");
        if inside(at(truth)) {
            worst = worst.max(error);
        }
    }
    println!("{hits} hits of {rays} rays, worst |t error| · |cos| = {worst:.2} ulp");
    assert!(hits > rays / 4, "only {hits} hits: the test says little");
    assert!(worst <= 32.0);
}

#[test]
fn skinny_triangles_at_grazing_angles_keep_their_distance() {
    skinny_and_grazing(200_000);
}

#[test]
#[ignore = "ten million rays"]
fn skinny_triangles_at_grazing_angles_keep_their_distance_at_length() {
    skinny_and_grazing(10_000_000);
}

#[test]
fn normals_of_slivers_are_right() {
    let mut rng = Rng(3);
    for aspect in [1e-2f32, 1e-4, 1e-6] {
        let mut worst = 0.0f64;
        for _ in 0..10_000 {
            let along = rng.direction();
            let across = etendue_core::Frame::from_normal(along).x;
            let base = rng.direction();
            let v = [base, base + along, base + along * 0.3 + across * aspect];
            let mesh = TriangleMesh::new(v.map(Vec3::from).to_vec(), vec![[0, 1, 2]]).unwrap();
            let Some(n) = mesh.normal(0) else { continue };
            let [a, b, c] = v.map(point);
            let exact = cross(minus(b, a), minus(c, a));
            let l = dot(exact, exact).sqrt();
            for i in 0..3 {
                worst = worst.max((exact[i].ratio(l) - f64::from(n[i])).abs());
            }
        }
        println!("aspect {aspect}: normal off by {worst:.2e}");
        assert!(worst < 2e-7);
    }
}

#[test]
fn positions_are_within_their_error_bounds() {
    let mut rng = Rng(4);
    for _ in 0..100_000 {
        let scale = rng.magnitude(-8.0, 8.0);
        let corner = |rng: &mut Rng| rng.direction() * scale + Vec3A::X * scale * 10.0;
        let v = [corner(&mut rng), corner(&mut rng), corner(&mut rng)];
        let uv = Vec2::new(rng.unit() * 0.5, rng.unit() * 0.5);
        let mesh = TriangleMesh::new(v.map(Vec3::from).to_vec(), vec![[0, 1, 2]]).unwrap();
        let surface = mesh.surface(0, uv);
        let (u, w) = (Twice::new(uv.x), Twice::new(uv.y));
        let rest = Twice::new(1.0) - u - w;
        let [a, b, c] = v.map(point);
        for i in 0..3 {
            let exact = a[i] * rest + b[i] * u + c[i] * w;
            let error = (Twice::new(surface.p[i]) - exact).hi.abs();
            assert!(error <= f64::from(surface.p_err[i]), "{v:?} {uv:?}: {error} > {}", surface.p_err[i]);
        }
        // And the bound is worth having: little more than half an ulp of the coordinates.
        assert!(surface.p_err.max_element() <= 12.0 * scale * f32::EPSILON);
    }
}

#[test]
fn planes_and_parallelograms_keep_their_points() {
    let mut rng = Rng(5);
    for _ in 0..20_000 {
        let scale = rng.magnitude(-6.0, 6.0);
        let (p, n) = (rng.direction() * scale, rng.direction());
        let ray = Ray::new(p + rng.direction() * (scale * rng.range(0.1, 100.0)), rng.direction());
        let plane = Plane::new(p, n).unwrap();
        if let Some(hit) = plane.intersect(&ray) {
            let s = plane.surface(&ray, &hit);
            let off = dot(minus(point(s.p), point(p)), point(plane.normal())).hi.abs();
            assert!(off <= f64::from(s.p_err.dot(s.ng.abs())) * 1.000001, "{ray:?} {plane:?}");
        }
        let quad = Parallelogram::new(p, rng.direction() * scale, rng.direction() * scale).unwrap();
        if let Some(hit) = quad.intersect(&ray) {
            assert!(hit.uv.min_element() >= 0.0 && hit.uv.max_element() <= 1.0000002, "{hit:?}");
            let s = quad.surface(&ray, &hit);
            let there = s.p - ray.at(hit.t);
            let slack = f64::from((ray.o.abs() + ray.d.abs() * hit.t).max_element()) * 1e-5;
            assert!(f64::from(there.abs().max_element()) <= slack, "{there} off: {ray:?} {quad:?}");
        }
    }
}
