//! Placed geometry is as good as geometry that was built in its place.

mod common;

use common::{gray, radiance, shared};
use etendue_core::{Needs, Ray, Spectrum, Transform, Vec2, Vec3, Vec3A};
use etendue_geometry::{Disc, Geometry, Parallelogram, Sphere, TriangleMesh, presets};
use etendue_integrator::{DirectLight, PathTracer};
use etendue_light::{LitPoint, Sides};
use etendue_scene::{Emission, Scene, SceneBuilder};
use etendue_testkit::stats::welch_test;

/// Turned, stretched unevenly, moved; with a mirror if asked for.
fn placement(scale: Vec3A) -> Transform {
    let turned =
        Transform::rotation(Vec3A::new(1.0, 2.0, 0.5), 0.8).after(&Transform::scale(scale).unwrap()).unwrap();
    Transform::translation(Vec3A::new(0.3, -0.2, 1.6)).after(&turned).unwrap()
}

fn flattened(mesh: &TriangleMesh, m: &Transform) -> TriangleMesh {
    let positions = mesh.positions().iter().map(|&p| Vec3::from(m.point(Vec3A::from(p)))).collect();
    // A mirror turns counter-clockwise into clockwise.
    let indices =
        mesh.indices().iter().map(|&[a, b, c]| if m.mirrors() { [a, c, b] } else { [a, b, c] }).collect();
    TriangleMesh::new(positions, indices).unwrap()
}

/// A floor under the emitter, which stands there itself or is placed.
fn lit_by(emitter: Geometry, place: Option<Transform>, two_sided: bool) -> Scene {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    let floor = Parallelogram::new(Vec3A::new(-2.0, -2.0, 0.0), Vec3A::X * 4.0, Vec3A::Y * 4.0).unwrap();
    b.add(floor, m);
    let mut emission = Emission::new(Spectrum::gray(3.0));
    if two_sided {
        emission = emission.two_sided();
    }
    match place {
        None => {
            let id = b.add(emitter, m);
            b.emit(id, emission);
        }
        Some(place) => {
            let id = b.add_grouped(emitter, m);
            b.emit(id, emission);
            let group = b.group(&[id]);
            b.instance(group, place);
        }
    }
    b.build().unwrap()
}

const PLACES: [(f32, f32); 3] = [(0.0, 0.0), (0.6, -0.4), (-0.5, 0.5)];

fn assert_same_light(name: &str, placed: &Scene, flat: &Scene) {
    assert!(placed.needs().contains(Needs::INSTANCES) && !flat.needs().contains(Needs::INSTANCES));
    let power = |s: &Scene| {
        let l = &s.lights()[0];
        (0..l.parts()).map(|p| f64::from(l.power(p, 1.0).mean())).sum::<f64>()
    };
    assert!(
        (power(placed) / power(flat) - 1.0).abs() < 2e-3,
        "{name}: {} W for {} W",
        power(placed),
        power(flat)
    );
    for direct in [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisPower] {
        let path = PathTracer { direct, max_depth: Some(1), ..PathTracer::default() };
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for (x, y) in PLACES {
            let down = Ray::new(Vec3A::new(x, y, 0.01), Vec3A::NEG_Z);
            a.extend(radiance(placed, &path, down, 1, 70_000));
            b.extend(radiance(flat, &path, down, 2, 70_000));
        }
        let test = welch_test(&a, &b);
        assert!(!test.rejects(1e-6), "{name}, {direct:?}: {test:?}");
        // 5 % off would be five standard errors.
        assert!(
            test.truth > 0.0 && 5.0 * test.standard_error < 0.05 * test.truth,
            "{name}, {direct:?}: {test:?}"
        );
    }
}

#[test]
fn placed_meshes_shine_like_flattened_ones() {
    let lamp = || presets::cuboid(Vec3A::new(-0.6, -0.5, -0.1), Vec3A::new(0.6, 0.5, 0.1));
    for scale in [Vec3A::ONE, Vec3A::new(1.5, 0.6, 2.0), Vec3A::new(-1.0, 1.0, 0.8)] {
        let m = placement(scale);
        let flat = lit_by(shared(flattened(&lamp(), &m)), None, false);
        assert_same_light("mesh", &lit_by(shared(lamp()), Some(m), false), &flat);
    }
}

#[test]
fn placed_quads_shine_like_flattened_ones() {
    let quad = Parallelogram::new(Vec3A::new(-0.7, 0.7, 0.0), Vec3A::X * 1.4, Vec3A::NEG_Y * 1.4).unwrap();
    for (scale, two_sided) in [(Vec3A::new(1.5, 0.6, 2.0), true), (Vec3A::ONE, false)] {
        let m = placement(scale);
        let at = |p: Vec3A| m.point(p);
        let moved =
            Parallelogram::new(at(quad.origin()), m.vector(quad.edge_u()), m.vector(quad.edge_v())).unwrap();
        let flat = lit_by(moved.into(), None, two_sided);
        assert_same_light("quad", &lit_by(quad.into(), Some(m), two_sided), &flat);
    }
}

#[test]
fn placed_spheres_shine_like_flattened_ones() {
    let m = placement(Vec3A::splat(0.7));
    let flat = Sphere::new(m.point(Vec3A::new(0.1, 0.0, 0.2)), 0.7 * 0.9).unwrap();
    let ball = Sphere::new(Vec3A::new(0.1, 0.0, 0.2), 0.9).unwrap();
    assert_same_light("sphere", &lit_by(ball.into(), Some(m), false), &lit_by(flat.into(), None, false));
}

/// A disc placed by an even scale is drawn by area, one that stands there itself by solid angle; both are one light.
#[test]
fn placed_discs_shine_like_flattened_ones() {
    let m = placement(Vec3A::splat(0.7));
    let (center, normal) = (Vec3A::new(0.1, 0.0, 0.2), m.inverse().vector(Vec3A::new(0.3, -0.2, -1.0)));
    let flat = Disc::new(m.point(center), m.vector(normal), 0.7 * 0.9).unwrap();
    let disc = Disc::new(center, normal, 0.9).unwrap();
    let (placed, flat) = (lit_by(disc.into(), Some(m), true), lit_by(flat.into(), None, true));
    assert_same_light("disc", &placed, &flat);
    // The density over a near disc: even by solid angle, far from it by area.
    let at = LitPoint {
        p: flat.lights()[0].bounds(0).unwrap().bounds.center() + Vec3A::Z * 0.05,
        p_err: Vec3A::ZERO,
        ng: Vec3A::ZERO,
        ns: Vec3A::ZERO,
        sides: Sides::Free,
        time: 0.0,
    };
    let [by_area, by_angle] = [&placed, &flat].map(|scene| {
        let draws = (0..1024u32).filter_map(|i| {
            let u = Vec2::new((i % 32) as f32 + 0.5, (i / 32) as f32 + 0.5) / 32.0;
            scene.sample_light(&at, u).map(|d| d.sample.pdf)
        });
        let (least, most) = draws.fold((f32::INFINITY, 0.0f32), |(a, b), p| (a.min(p), b.max(p)));
        most / least
    });
    assert!(by_angle < 2.0 && by_area > 10.0, "{by_angle} {by_area}");
}

/// Two placements are two lights, and each is found under its own number.
#[test]
fn every_placement_is_a_light_of_its_own() {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    let lamp = b.add_grouped(presets::cuboid(Vec3A::splat(-0.1), Vec3A::splat(0.1)), m);
    let dark = b.add_grouped(Sphere::new(Vec3A::X * 0.5, 0.1).unwrap(), m);
    b.emit(lamp, Emission::new(Spectrum::ONE));
    let both = b.group(&[dark, lamp]);
    let alone = b.group(&[dark]);
    b.instance(both, Transform::IDENTITY);
    b.instance(alone, Transform::translation(Vec3A::Y * 2.0));
    b.instance(both, Transform::translation(Vec3A::Y * 4.0));
    let scene = b.build().unwrap();
    assert_eq!((scene.lights().len(), scene.report().light_parts), (2, 24));
    let seen = |x: f32, y: f32| {
        let ray = Ray::new(Vec3A::new(x, y, 5.0), Vec3A::NEG_Z);
        let hit = scene.intersect(&ray, 0)?;
        scene.light_at(&scene.surface(&ray, &hit, 0.0)).map(|id| id.light)
    };
    assert_eq!([seen(0.0, 0.0), seen(0.0, 4.0)], [Some(0), Some(1)]);
    assert_eq!([seen(0.5, 0.0), seen(0.5, 2.0), seen(0.5, 4.0)], [None; 3]);
}

/// The same triangles, placed or not, are hit in the same places.
#[test]
fn placed_geometry_is_where_flattened_geometry_is() {
    let m = placement(Vec3A::new(1.5, 0.6, -2.0));
    let mesh = presets::torus(0.5, 0.2, 24, 12);
    let scenes = [lit_by(shared(flattened(&mesh, &m)), None, false), lit_by(shared(mesh), Some(m), false)];
    let mut hits = 0;
    for i in 0..4000 {
        let (x, y) = ((i % 64) as f32 / 16.0 - 2.0, (i / 64) as f32 / 16.0 - 2.0);
        let ray = Ray::new(Vec3A::new(x * 0.5, y * 0.5, 6.0), Vec3A::NEG_Z);
        let [a, b] =
            [&scenes[0], &scenes[1]].map(|s| s.intersect(&ray, 0).map(|h| (h, s.surface(&ray, &h, 0.0))));
        let (Some((ha, a)), Some((hb, b))) = (a, b) else { panic!("the floor is everywhere") };
        if ha.prim != hb.prim || ha.geom != hb.geom {
            // Along an edge one rounding decides.
            continue;
        }
        hits += usize::from(ha.geom == 1);
        assert!((a.p - b.p).length() < 1e-5 && (a.ng - b.ng).length() < 1e-4, "{} and {}", a.p, b.p);
    }
    assert!(hits > 300, "{hits}");
}
