//! Proptest strategies for what renderers are made of. Ordinary values and the awkward ones are both drawn.

use std::sync::Arc;

use etendue_bsdf::{
    BlinnPhong, BsdfAt, Conductor, Lambert, Masking, MetalFresnel, Mirror, OrenNayar, Phong, RoughDielectric,
    SmoothDielectric,
};
use etendue_core::{Frame, Ray, Spectrum, Transform, Vec3, Vec3A};
use etendue_geometry::{Geometry, Parallelogram, Sphere, TriangleMesh, presets};
use etendue_light::{ConstantEnvironment, PointLight};
use etendue_material::{Diffuse, Glass, Metal};
use etendue_sampling::warp;
use etendue_scene::{Emission, Scene, SceneBuilder};
use proptest::prelude::*;

/// Numbers in `[0, 1)`, the ends and the middle often.
pub fn unit() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => (0u32..1 << 24).prop_map(|i| i as f32 / 16_777_216.0),
        1 => prop::sample::select(crate::budget::EXTREMES.to_vec()),
    ]
}

/// Pairs in `[0, 1)²`.
pub fn unit_pair() -> impl Strategy<Value = etendue_core::Vec2> {
    (unit(), unit()).prop_map(|(x, y)| etendue_core::Vec2::new(x, y))
}

/// Unit directions, the axes and near-axes often.
pub fn direction() -> impl Strategy<Value = Vec3A> {
    let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z, Vec3A::NEG_X, Vec3A::NEG_Y, Vec3A::NEG_Z];
    prop_oneof![
        4 => unit_pair().prop_map(warp::sphere),
        1 => prop::sample::select(axes.to_vec()),
        1 => (prop::sample::select(axes.to_vec()), unit_pair(), -24i32..-2).prop_map(|(a, u, k)| {
            etendue_core::vector::normalize(a + warp::sphere(u) * 2f32.powi(k))
        }),
    ]
}

/// Unit directions of the upper hemisphere, grazing ones often.
pub fn upper_direction() -> impl Strategy<Value = Vec3A> {
    direction().prop_map(|d| Vec3A::new(d.x, d.y, d.z.abs())).prop_filter("not in the plane", |d| d.z > 0.0)
}

/// Points within a cube of this half width.
pub fn point(half: f32) -> impl Strategy<Value = Vec3A> {
    [-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0].prop_map(move |p| Vec3A::from(p) * half)
}

/// Rays from within a cube in any direction.
pub fn ray(half: f32) -> impl Strategy<Value = Ray> {
    (point(half), direction()).prop_map(|(o, d)| Ray::new(o, d))
}

/// Orthonormal frames.
pub fn frame() -> impl Strategy<Value = Frame> {
    direction().prop_map(Frame::from_normal)
}

/// Placements: rotation, scale of either sign from 1/16 to 16 per axis, translation.
pub fn transform() -> impl Strategy<Value = Transform> {
    let scale = (-4.0f32..4.0, any::<bool>())
        .prop_map(|(e, flip)| 2f32.powi(e as i32) * if flip { -1.0 } else { 1.0 });
    (direction(), -3.2f32..3.2, [scale.clone(), scale.clone(), scale], point(10.0)).prop_map(
        |(axis, angle, s, t)| {
            Transform::scale(Vec3A::from(s))
                .and_then(|s| Transform::rotation(axis, angle).after(&s))
                .and_then(|m| Transform::translation(t).after(&m))
                .unwrap_or(Transform::IDENTITY)
        },
    )
}

/// Colours in `[0, 1]`, black and white often.
pub fn albedo() -> impl Strategy<Value = Spectrum> {
    prop_oneof![
        4 => [0.0f32..=1.0, 0.0f32..=1.0, 0.0f32..=1.0].prop_map(Spectrum::from),
        1 => Just(Spectrum::BLACK),
        1 => Just(Spectrum::ONE),
    ]
}

/// Triangle soups of up to `triangles`, slivers, points and duplicates among them.
pub fn soup(triangles: usize) -> impl Strategy<Value = TriangleMesh> {
    let corner = [-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0].prop_map(Vec3::from);
    let triangle = ([corner.clone(), corner.clone(), corner], 0u32..8).prop_map(|(mut t, kind)| {
        match kind {
            0 => t[2] = t[1],
            1 => t[2] = t[0].lerp(t[1], 0.5),
            2 => t[2] = t[0] + (t[1] - t[0]) * 0.3 + Vec3::splat(1e-6),
            _ => {}
        }
        t
    });
    prop::collection::vec(triangle, 1..=triangles).prop_map(|ts| {
        let indices = (0..ts.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let positions = ts.into_iter().flatten().collect();
        // Every index names one of the corners.
        TriangleMesh::new(positions, indices).unwrap_or_else(|_| TriangleMesh::empty())
    })
}

/// Closed meshes, outward counter-clockwise.
pub fn closed_mesh() -> impl Strategy<Value = TriangleMesh> {
    prop_oneof![
        (0u32..3).prop_map(|n| presets::icosphere(n, 1.0)),
        (3u32..12, 2u32..8).prop_map(|(a, b)| presets::uv_sphere(a, b, 1.0)),
        (3u32..12, 3u32..9).prop_map(|(a, b)| presets::torus(1.0, 0.4, a, b)),
        Just(presets::cuboid(Vec3A::splat(-1.0), Vec3A::ONE)),
    ]
}

/// Densities over up to `n` bins, empty bins and huge contrasts among them; at least one bin is not empty.
pub fn density(n: usize) -> impl Strategy<Value = Vec<f32>> {
    let bin = prop_oneof![2 => 0.0f32..1.0, 1 => Just(0.0f32), 1 => (-30i32..30).prop_map(|k| 2f32.powi(k))];
    prop::collection::vec(bin, 1..=n).prop_map(|mut v| {
        if v.iter().all(|&x| x == 0.0) {
            v[0] = 1.0;
        }
        v
    })
}

/// Exponents of Phong's lobes, from 1 to 10⁴.
fn exponent() -> impl Strategy<Value = f32> {
    (0.0f32..4.0).prop_map(|k| etendue_core::math::pow(10.0, k))
}

/// Built-in BSDFs over their parameters.
pub fn bsdf() -> impl Strategy<Value = BsdfAt<'static>> {
    let roughness = || prop_oneof![4 => 0.05f32..1.0, 1 => Just(0.0f32), 1 => Just(1.0f32)];
    let masking = || prop::sample::select(vec![Masking::Separable, Masking::HeightCorrelated]);
    prop_oneof![
        albedo().prop_map(|a| BsdfAt::Lambert(Lambert::new(a))),
        albedo().prop_map(|a| BsdfAt::Mirror(Mirror::new(a))),
        (1.01f32..2.5).prop_map(|eta| BsdfAt::SmoothDielectric(SmoothDielectric::new(eta))),
        (albedo(), roughness(), masking()).prop_map(|(f0, r, m)| BsdfAt::Conductor(
            Conductor::new(r, MetalFresnel::Schlick { f0 }).with_masking(m)
        )),
        (1.01f32..2.5, roughness(), masking())
            .prop_map(|(eta, r, m)| BsdfAt::RoughDielectric(RoughDielectric::new(r, eta).with_masking(m))),
        (albedo(), roughness()).prop_map(|(a, r)| BsdfAt::OrenNayar(OrenNayar::new(a, r))),
        (albedo(), albedo(), exponent()).prop_map(|(d, s, n)| BsdfAt::Phong(Phong::new(d, s, n))),
        (albedo(), albedo(), exponent()).prop_map(|(d, s, n)| BsdfAt::BlinnPhong(BlinnPhong::new(d, s, n))),
    ]
}

/// Small scenes with light: a few shapes of the built-in materials under a sky, a lamp or a point light.
pub fn tiny_scene() -> impl Strategy<Value = Arc<Scene>> {
    let shape = (point(1.0), 0.1f32..0.5, 0u32..4, albedo(), 0.1f32..0.9);
    (prop::collection::vec(shape, 1..6), 0u32..3).prop_filter_map("builds", |(shapes, light)| {
        let mut b = SceneBuilder::new();
        for (i, (p, r, kind, color, roughness)) in shapes.into_iter().enumerate() {
            let m = match kind {
                0 => b.material(Glass::new(1.0 + roughness)),
                1 => b.material(Metal::schlick(color, roughness)),
                _ => b.material(Diffuse::new(color)),
            };
            if i % 2 == 0 {
                b.add(Sphere::new(p, r).ok()?, m);
            } else {
                b.add(Geometry::mesh(presets::cuboid(p - Vec3A::splat(r), p + Vec3A::splat(r))), m);
            }
        }
        match light {
            0 => b.light(ConstantEnvironment::new(Spectrum::ONE)),
            1 => b.light(PointLight::new(Vec3A::new(0.0, 3.0, 1.0), Spectrum::gray(10.0))),
            _ => {
                let dark = b.material(Diffuse::new(Spectrum::BLACK));
                let lamp = Parallelogram::new(Vec3A::new(-0.5, 3.0, -0.5), Vec3A::X, Vec3A::Z).ok()?;
                let lamp = b.add(lamp, dark);
                b.emit(lamp, Emission::new(Spectrum::gray(8.0)));
            }
        }
        b.build().ok().map(Arc::new)
    })
}
