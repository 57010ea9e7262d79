//! Mesh arrays, attributes, presets and sampling.

mod common;

use std::collections::BTreeMap;

use common::Rng;
use etendue_core::{Fingerprint, Ray, Transform, Vec2, Vec3, Vec3A, Vec4};
use etendue_geometry::{
    Geometry, Hit, MeshError, Parallelogram, Plane, Shape, ShapeError, Sphere, TriangleMesh, presets,
};

fn triangle() -> TriangleMesh {
    TriangleMesh::new(vec![Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 4.0], vec![[0, 1, 2]]).unwrap()
}

#[test]
fn wrong_arrays_are_named() {
    let e = TriangleMesh::new(vec![Vec3::ZERO; 3], vec![[0, 1, 2], [0, 7, 1]]).unwrap_err();
    assert_eq!(e, MeshError::IndexOutOfRange { triangle: 1, index: 7, vertices: 3 });
    assert!(e.to_string().contains("triangle 1") && e.to_string().contains("vertex 7"));
    let e = triangle().with_normals(vec![Vec3::Z; 2]).unwrap_err();
    assert!(e.to_string().contains("2 normals for 3 vertices"), "{e}");
    assert!(matches!(triangle().with_uv(2, vec![]), Err(MeshError::NoSuchUvSet { set: 2 })));
    assert!(triangle().with_colors(vec![]).is_err() && triangle().with_tangents(vec![Vec4::X; 4]).is_err());
    assert!(matches!(Sphere::new(Vec3A::ZERO, 0.0), Err(ShapeError::Radius { .. })));
    assert!(matches!(Sphere::new(Vec3A::ZERO, f32::NAN), Err(ShapeError::NotFinite { .. })));
    assert_eq!(Plane::new(Vec3A::ZERO, Vec3A::ZERO), Err(ShapeError::ZeroNormal { shape: "plane" }));
    assert_eq!(Parallelogram::new(Vec3A::ZERO, Vec3A::X, Vec3A::X * 3.0), Err(ShapeError::NoArea));
}

#[test]
fn triangles_that_cannot_be_hit_are_counted() {
    let far = 2e18;
    let p = vec![
        Vec3::ZERO,
        Vec3::X,
        Vec3::Y,
        Vec3::X * 2.0,
        Vec3::NAN,
        Vec3::new(far, 0.0, 0.0),
        Vec3::new(f32::INFINITY, 0.0, 0.0),
    ];
    let t = vec![[0, 1, 2], [0, 1, 3], [0, 0, 2], [0, 1, 4], [0, 1, 5], [0, 6, 1]];
    let mesh = TriangleMesh::new(p, t).unwrap();
    let report = mesh.report();
    assert_eq!((report.triangles, report.degenerate, report.non_finite), (6, 2, 3));
    assert_eq!(report.non_finite_vertices, 2);
    let flawed: Vec<bool> = (0..7).map(|i| mesh.is_degenerate(i)).collect();
    assert_eq!(flawed, [false, true, true, true, true, true, true]);
    assert_eq!(mesh.bounds().hi, Vec3A::new(1.0, 1.0, 0.0));
}

#[test]
fn attributes_are_interpolated() {
    let mesh = triangle()
        .with_uv(0, vec![Vec2::ZERO, Vec2::new(1.0, 0.0), Vec2::new(0.0, 2.0)])
        .unwrap()
        .with_uv(1, vec![Vec2::ONE; 3])
        .unwrap()
        .with_colors(vec![Vec4::ZERO, Vec4::ONE, Vec4::new(0.0, 1.0, 0.0, 1.0)])
        .unwrap()
        .with_normals(vec![Vec3::new(1.0, 0.0, 1.0), Vec3::Z, Vec3::Z])
        .unwrap();
    let at = Vec2::new(0.25, 0.5);
    let s = mesh.surface(0, at);
    assert_eq!(s.p, Vec3A::new(0.5, 2.0, 0.0));
    assert_eq!(s.ng, Vec3A::Z);
    assert_eq!(s.uv, [Vec2::new(0.25, 1.0), Vec2::ONE]);
    assert_eq!(s.color, Vec4::new(0.25, 0.75, 0.25, 0.75));
    assert_eq!((s.dpdu, s.dpdv), (Vec3A::X * 2.0, Vec3A::Y * 2.0));
    assert!(s.shading.z.x > 0.0 && s.shading.z.z > 0.9);
    assert!(s.shading.x.dot(s.shading.z).abs() < 1e-6 && s.shading.x.x > 0.9);
    let a = mesh.alpha_attributes(0, at);
    assert_eq!((a.p, a.uv, a.color), (s.p, s.uv, s.color));
}

#[test]
fn missing_and_bad_attributes_fall_back() {
    let s = triangle().surface(0, Vec2::new(0.2, 0.2));
    assert_eq!((s.dpdu, s.color, s.shading.z), (Vec3A::ZERO, Vec4::ONE, Vec3A::Z));
    // Texture coordinates without area; normals that are zero, not numbers, or on the other side.
    let s = triangle().with_uv(0, vec![Vec2::ONE; 3]).unwrap().surface(0, Vec2::new(0.2, 0.2));
    assert_eq!(s.dpdu, Vec3A::ZERO);
    for n in [Vec3::ZERO, Vec3::NAN, Vec3::NEG_Z, Vec3::INFINITY] {
        let s = triangle().with_normals(vec![n; 3]).unwrap().surface(0, Vec2::new(0.2, 0.2));
        assert_eq!(s.shading.z, Vec3A::Z, "{n}");
    }
    // Tangents without texture coordinates give the derivatives their direction and side.
    for side in [1.0, -1.0] {
        let s = triangle().with_tangents(vec![Vec4::new(0.0, 1.0, 0.0, side); 3]).unwrap();
        let s = s.surface(0, Vec2::new(0.2, 0.2));
        assert_eq!((s.shading.x, s.dpdu, s.dpdv), (Vec3A::Y, Vec3A::Y, Vec3A::NEG_X * side));
    }
    // Mirrored texture coordinates are seen in the derivatives.
    let uv = vec![Vec2::ZERO, Vec2::new(-1.0, 0.0), Vec2::new(0.0, 1.0)];
    let s = triangle().with_uv(0, uv).unwrap().surface(0, Vec2::new(0.2, 0.2));
    assert!(s.dpdu.cross(s.dpdv).z < 0.0);
    // Beyond the last triangle: something, and no panic.
    let s = triangle().surface(9, Vec2::ZERO);
    assert_eq!(s.ng, Vec3A::Z);
    assert!(triangle().sample(9, Vec2::splat(0.5)).is_none());
}

#[test]
fn a_mirror_keeps_the_front() {
    let s = triangle().surface(0, Vec2::new(0.2, 0.2));
    let mirror = Transform::scale(Vec3A::new(-1.0, 1.0, 1.0)).unwrap();
    assert_eq!(s.clone().transformed(&mirror).ng, Vec3A::Z);
    let turned = Transform::scale(Vec3A::new(1.0, 1.0, -3.0)).unwrap();
    let t = s.transformed(&turned);
    assert_eq!(t.ng, Vec3A::NEG_Z);
    assert!(t.shading.z.dot(t.ng) > 0.0);
}

#[test]
fn fingerprints_tell_meshes_apart() {
    let of = |m: &TriangleMesh| {
        let mut f = Fingerprint::default();
        Geometry::from(m.clone()).fingerprint(&mut f);
        assert!(!f.is_opaque());
        f.value()
    };
    let base = triangle();
    assert_eq!(of(&base), of(&base.clone()));
    let others = [
        base.clone().with_normals(vec![Vec3::Z; 3]).unwrap(),
        base.clone().with_uv(0, vec![Vec2::ZERO; 3]).unwrap(),
        base.clone().with_uv(1, vec![Vec2::ZERO; 3]).unwrap(),
        base.clone().with_colors(vec![Vec4::ONE; 3]).unwrap(),
        TriangleMesh::new(base.positions().to_vec(), vec![[0, 2, 1]]).unwrap(),
    ];
    for o in &others {
        assert_ne!(of(&base), of(o));
    }
}

/// Six times the volume enclosed; positive where triangles face outward.
fn volume(mesh: &TriangleMesh) -> f64 {
    (0..mesh.triangle_count() as u32)
        .map(|i| {
            let [a, b, c] = mesh.triangle(i);
            f64::from(a.dot(b.cross(c)))
        })
        .sum()
}

#[test]
fn closed_presets_are_closed_and_face_outward() {
    let presets = [
        ("cuboid", presets::cuboid(Vec3A::splat(-1.0), Vec3A::ONE), 8.0),
        ("icosphere", presets::icosphere(3, 1.0), 4.18879),
        ("uv sphere", presets::uv_sphere(40, 20, 1.0), 4.18879),
        ("torus", presets::torus(1.0, 0.25, 60, 30), 1.2337),
        ("block", presets::block(12, 1), 4.0),
        ("spiky sphere", presets::spiky_sphere(2, 0.5, 1), 8.0),
    ];
    for (name, mesh, expected) in presets {
        assert_eq!(mesh.report().degenerate + mesh.report().non_finite, 0, "{name}");
        let v = volume(&mesh) / 6.0;
        assert!(v > 0.85 * expected && v < 1.15 * expected, "{name}: volume {v}");
        // Every edge, as corners bit by bit, runs once in each direction.
        let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
        for i in 0..mesh.triangle_count() as u32 {
            let key = mesh.triangle(i).map(|v| (v + 0.0).to_array().map(f32::to_bits));
            for k in 0..3 {
                let (a, b) = (key[k], key[(k + 1) % 3]);
                *edges.entry(if a < b { [a, b] } else { [b, a] }).or_default() +=
                    if a < b { 1 } else { 1000 };
            }
        }
        assert!(edges.values().all(|&n| n == 1001), "{name} is not closed");
    }
    assert_eq!(presets::block(12, 1).triangle_count(), 2 * 144 + 12 * 12);
    assert_eq!(presets::icosphere(3, 1.0).triangle_count(), 1280);
    assert_eq!(presets::terrain(10, 1).triangle_count(), 200);
    assert!((0..200).all(|i| presets::terrain(10, 1).normal(i).unwrap().y > 0.0));
    let quad = presets::quad(Vec3A::ZERO, Vec3A::X, Vec3A::Y);
    assert!((0..2).all(|i| quad.normal(i) == Some(Vec3A::Z) && quad.area(i) == 0.5));
}

#[test]
fn images_on_presets_are_not_mirrored() {
    for mesh in [
        presets::quad(Vec3A::ZERO, Vec3A::X, Vec3A::Y),
        presets::cuboid(Vec3A::splat(-1.0), Vec3A::ONE),
        presets::uv_sphere(20, 10, 1.0),
        presets::torus(1.0, 0.25, 20, 10),
        presets::terrain(8, 1),
    ] {
        for i in 0..mesh.triangle_count() as u32 {
            let s = mesh.surface(i, Vec2::splat(0.3));
            assert!(s.dpdu.cross(s.dpdv).dot(s.ng) > 0.0, "triangle {i}: {s:?}");
        }
    }
}

#[test]
fn surfaces_carry_the_ids_of_the_hit() {
    let ray = Ray { time: 0.25, ..Ray::new(Vec3A::new(0.2, 0.2, 1.0), -Vec3A::Z) };
    let hit = Hit { t: 1.0, uv: Vec2::new(0.1, 0.1), inst: 4, geom: 5, prim: 0 };
    for g in [Geometry::from(triangle()), Sphere::new(Vec3A::ZERO, 1.0).unwrap().into()] {
        let s = g.surface(&ray, &hit);
        assert_eq!((s.inst, s.geom, s.prim, s.time), (4, 5, 0, 0.25));
    }
}

/// Largest deviation, in standard errors, of the mean of some functions over samples from what they should be.
///
/// With 40 000 samples, a density that is off by 5 % over half of the surface moves some function by 5 standard
/// errors or more; chance alone does not move any of six by 5 once in 10⁵ runs.
fn deviation(draw: impl Fn(Vec2) -> [f64; 6], expected: [f64; 6]) -> f64 {
    let mut rng = Rng(99);
    let n = 40_000;
    let (mut sum, mut square) = ([0.0; 6], [0.0; 6]);
    for _ in 0..n {
        let f = draw(Vec2::new(rng.unit(), rng.unit()));
        for i in 0..6 {
            sum[i] += f[i];
            square[i] += f[i] * f[i];
        }
    }
    (0..6)
        .map(|i| {
            let mean = sum[i] / n as f64;
            let error = ((square[i] / n as f64 - mean * mean) / n as f64).sqrt();
            (mean - expected[i]).abs() / error.max(1e-12)
        })
        .fold(0.0, f64::max)
}

#[test]
fn samples_are_uniform_over_the_area() {
    // A triangle: moments of the weights are 1/3, 1/6 for squares and 1/12 for products.
    let moments = |b1: f64, b2: f64| [b1, b2, b1 * b1, b2 * b2, b1 * b2, (1.0 - b1 - b2).powi(2)];
    let expected = [1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 12.0, 1.0 / 6.0];
    let mesh = triangle();
    let drawn = |u: Vec2| {
        let s = mesh.sample(0, u).unwrap();
        assert_eq!(s.pdf_area, 1.0 / mesh.area(0));
        assert!(s.uv.min_element() >= 0.0 && s.uv.x + s.uv.y <= 1.0 && s.ng == Vec3A::Z);
        moments(f64::from(s.uv.x), f64::from(s.uv.y))
    };
    assert!(deviation(drawn, expected) < 5.0);
    // The usual mistake: no square root.
    let wrong = |u: Vec2| moments(f64::from(u.x * (1.0 - u.y)), f64::from(u.x * u.y));
    assert!(deviation(wrong, expected) > 20.0);

    let sphere = Sphere::new(Vec3A::new(3.0, 0.0, 0.0), 2.0).unwrap();
    let moments = |n: Vec3A| [n.x, n.y, n.z, n.x * n.x, n.y * n.y, n.x * n.y].map(f64::from);
    let expected = [0.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0, 0.0];
    let drawn = |u: Vec2| {
        let s = sphere.sample(u).unwrap();
        assert!(((s.p - sphere.center()) / 2.0 - s.ng).abs().max_element() < 1e-6);
        assert!((s.pdf_area * sphere.area() - 1.0).abs() < 1e-6);
        moments(s.ng)
    };
    assert!(deviation(drawn, expected) < 5.0);
    // Uniform in the angles crowds at the poles.
    let wrong = |u: Vec2| {
        let (theta, phi) = (u.x * std::f32::consts::PI, u.y * std::f32::consts::TAU);
        let (s, c) = etendue_core::math::sin_cos(theta);
        let (sp, cp) = etendue_core::math::sin_cos(phi);
        moments(Vec3A::new(s * cp, c, s * sp))
    };
    assert!(deviation(wrong, expected) > 20.0);

    let quad = Parallelogram::new(Vec3A::ONE, Vec3A::X * 2.0, Vec3A::new(1.0, 1.0, 0.0)).unwrap();
    assert_eq!(quad.area(), 2.0);
    let s = quad.sample(Vec2::new(0.25, 0.5)).unwrap();
    assert_eq!((s.p, s.pdf_area, s.uv), (Vec3A::new(2.0, 1.5, 1.0), 0.5, Vec2::new(0.25, 0.5)));
    assert!(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap().sample(Vec2::ZERO).is_none());
}

#[test]
fn sphere_parameters_agree_between_hits_samples_and_surfaces() {
    let sphere = Sphere::new(Vec3A::new(0.3, -0.2, 0.1), 1.5).unwrap();
    let mut rng = Rng(6);
    for _ in 0..2000 {
        let s = sphere.sample(Vec2::new(rng.unit(), rng.unit())).unwrap();
        let ray = Ray::new(s.p + s.ng * 2.0, -s.ng);
        let hit = sphere.intersect(&ray).unwrap();
        let near = |a: f32, b: f32| ((a - b).abs() < 1e-5) || (a - b).abs() > 1.0 - 1e-5;
        let seam_free = s.ng.x * s.ng.x + s.ng.z * s.ng.z > 1e-4;
        assert!(!seam_free || (near(hit.uv.x, s.uv.x) && near(hit.uv.y, s.uv.y)), "{hit:?} {s:?}");
        // The derivatives are those of the position by the parameters.
        let at = sphere.surface(&ray, &hit);
        if seam_free {
            assert!(at.dpdu.cross(at.dpdv).dot(at.ng) > 0.0);
            let expected = at.dpdu.length() * at.dpdv.length();
            let sine = (s.ng.x * s.ng.x + s.ng.z * s.ng.z).sqrt();
            let truth = std::f32::consts::TAU * std::f32::consts::PI * 2.25 * sine;
            assert!((expected / truth - 1.0).abs() < 1e-3);
            assert!(at.dpdv.dot(Vec3A::Y) > 0.0, "v grows upward");
        }
    }
}

#[test]
fn triangles_of_the_same_corners_are_kept_once() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::X, Vec3::new(-0.0, 1.0, 0.0)];
    // Turned, mirrored, and by other vertices at the same places; then one that differs in a corner.
    let indices = vec![[0, 1, 2], [1, 2, 0], [2, 1, 0], [0, 4, 5], [0, 1, 3]];
    let mesh = TriangleMesh::new(positions, indices).unwrap();
    assert_eq!(mesh.report().duplicate, 3);
    let dropped: Vec<bool> = (0..5).map(|prim| mesh.is_degenerate(prim)).collect();
    assert_eq!(dropped, [false, true, true, true, false]);
}
