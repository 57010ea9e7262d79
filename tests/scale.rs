//! No epsilon anywhere: a scene scaled by a power of two gives the same film, to the last bit.

mod support;

use etendue::geometry::presets as meshes;
use etendue::prelude::*;
use support::film_of;

/// A scene with every kind of geometry and light, all lengths times `k`, intensities times `k²`.
fn film(k: f32) -> Film {
    let mut b = SceneBuilder::new();
    let gray = b.material(Diffuse::new(Spectrum::gray(0.7)));
    let glass = b.material(Glass::new(1.5));
    let gold = b.material(Metal::gold(0.3));
    let rough = b.material(etendue::material::RoughGlass::new(1.5, 0.4));
    b.add(Plane::new(Vec3A::new(0.0, -k, 0.0), Vec3A::Y).unwrap(), gray);
    b.add(Sphere::new(Vec3A::new(-1.0, -0.3, 0.2) * k, 0.6 * k).unwrap(), glass);
    b.add(Sphere::new(Vec3A::new(0.9, -0.5, 0.4) * k, 0.45 * k).unwrap(), rough);
    let scaled = |m: TriangleMesh| {
        let positions = m.positions().iter().map(|p| *p * k).collect();
        let scaled = TriangleMesh::new(positions, m.indices().to_vec()).unwrap();
        let normals = m.normals().to_vec();
        if normals.is_empty() { scaled } else { scaled.with_normals(normals).unwrap() }
    };
    b.add(Geometry::mesh(scaled(meshes::torus(0.6, 0.22, 32, 16))), gold);
    let lump = b.add_grouped(Geometry::mesh(scaled(meshes::icosphere(2, 0.4))), gray);
    let group = b.group(&[lump]);
    let turned = Transform::translation(Vec3A::new(0.4, 0.9, -0.8) * k)
        .after(&Transform::rotation(Vec3A::new(1.0, 2.0, 0.5), 0.7))
        .unwrap();
    b.instance(group, turned);
    let panel =
        Parallelogram::new(Vec3A::new(-0.6, 2.0, -0.4) * k, Vec3A::X * (1.1 * k), Vec3A::Z * (0.8 * k));
    let panel = b.add(panel.unwrap(), gray);
    b.emit(panel, Emission::new(Spectrum::rgb(6.0, 5.0, 4.0)).two_sided());
    let lamp = b.add(Geometry::mesh(scaled(meshes::cuboid(Vec3A::splat(1.6), Vec3A::splat(1.9)))), gray);
    b.emit(lamp, Emission::new(Spectrum::rgb(2.0, 4.0, 8.0)));
    let ball = b.add(Sphere::new(Vec3A::new(-2.0, 1.5, 1.0) * k, 0.2 * k).unwrap(), gray);
    b.emit(ball, Emission::new(Spectrum::gray(9.0)));
    b.light(PointLight::new(Vec3A::new(1.0, 2.5, 2.5) * k, Spectrum::gray(5.0 * k * k)));
    b.light(ConstantEnvironment::new(Spectrum::gray(0.2)));
    let scene = b.build().unwrap();
    let eye = Vec3A::new(0.3, 0.8, 4.0) * k;
    let camera = Perspective::look_at(eye, Vec3A::ZERO, Vec3A::Y, 45.0, UVec2::new(48, 36))
        .unwrap()
        .with_lens(0.05 * k, 4.0 * k)
        .unwrap();
    film_of(&scene, &camera, Sobol::new(4, 16), &RenderOptions::default())
}

#[test]
fn scaling_by_a_power_of_two_changes_no_bit() {
    let expected = film(1.0);
    assert!(expected.to_rgb().iter().flatten().any(|&v| v > 0.1));
    for exponent in [-20, -10, -1, 1, 10, 20] {
        let scaled = film(2f32.powi(exponent));
        let differing = expected.to_rgb().iter().zip(scaled.to_rgb()).filter(|(a, b)| **a != *b).count();
        assert_eq!(differing, 0, "pixels that differ at 2^{exponent}");
        assert!(scaled == expected, "2^{exponent}");
    }
}
