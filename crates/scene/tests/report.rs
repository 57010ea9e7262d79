//! What building a scene finds, drops and refuses.

mod common;

use common::{gray, shared, square};
use etendue_bvh::BuildError;
use etendue_core::{CancelFlag, Needs, Ray, Segment, Spectrum, Transform, Vec2, Vec3, Vec3A};
use etendue_core::{Origin, Progress};
use etendue_geometry::{Plane, Shape, ShapeHit, Sphere, Surface, TriangleMesh, presets};
use etendue_light::{ConstantEnvironment, LightId, LitPoint, PointLight, Sides};
use etendue_material::{Cutout, Diffuse};
use etendue_scene::{Emission, Scene, SceneBuilder, SceneError};
use etendue_texture::{ImageTexture, Tex};

fn free() -> LitPoint {
    let zero = Vec3A::ZERO;
    LitPoint { p: zero, p_err: zero, ng: zero, ns: zero, sides: Sides::Free, time: 0.0 }
}

#[test]
fn an_empty_scene_is_valid() {
    let scene = SceneBuilder::new().build().unwrap();
    let ray = Ray::new(Vec3A::ZERO, Vec3A::X);
    assert_eq!(scene.needs(), Needs::empty());
    assert!(scene.intersect(&ray, 0).is_none() && scene.bounds().is_empty() && scene.radius() == 0.0);
    assert!(scene.sample_light(&free(), Vec2::splat(0.5)).is_none() && scene.lights().is_empty());
    let segment = Segment { from: Origin::free(Vec3A::ZERO), d: Vec3A::X, to: None, time: 0.0 };
    assert_eq!(scene.transmittance(&segment, 0), Spectrum::ONE);
    let nothing = Surface::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::X);
    assert!(scene.material(&nothing).is_none() && scene.light_at(&nothing).is_none());
    assert_eq!(scene.emitted(LightId { light: 3, part: 0 }, &nothing, Vec3A::X), Spectrum::BLACK);
    assert_eq!(scene.light_pdf(&free(), LightId { light: 3, part: 0 }, Vec3A::X, None), 0.0);
    assert!(SceneBuilder::new().has_no_light() && SceneBuilder::new().bounds().is_empty());
}

/// A surface of another scene is no reason to fail.
#[test]
fn foreign_surfaces_and_lights_are_nobody_s() {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    let id = b.add(square(0.0), m);
    b.emit(id, Emission::new(Spectrum::ONE));
    let scene = b.build().unwrap();
    let foreign = Surface { geom: 9, inst: 5, prim: 77, ..Surface::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::X) };
    assert!(scene.material(&foreign).is_none() && scene.light_at(&foreign).is_none());
    let id = LightId { light: 0, part: 99 };
    assert!(scene.light_pdf(&free(), id, Vec3A::X, Some(&foreign)).is_finite());
}

#[test]
fn what_cannot_be_hit_is_counted() {
    let nan = f32::NAN;
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [nan, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 0.0, 1e30],
    ];
    let positions = positions.map(Vec3::from_array).to_vec();
    // One good triangle; two without area (a repeated corner, three on a line); two with corners that are no places.
    let indices = vec![[0, 1, 2], [0, 1, 1], [0, 1, 4], [0, 1, 3], [0, 1, 5]];
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    let mesh = shared(TriangleMesh::new(positions, indices).unwrap());
    b.add(mesh.clone(), m);
    let grouped = b.add_grouped(mesh.clone(), m);
    let group = b.group(&[grouped]);
    for x in [3.0, 6.0] {
        b.instance(group, Transform::translation(Vec3A::X * x));
    }
    // Never placed: not in the scene, so not in the counts.
    b.add_grouped(mesh, m);
    b.add(Sphere::new(Vec3A::Y * 5.0, 1.0).unwrap(), m);
    let scene = b.build().unwrap();
    let r = scene.report();
    assert_eq!(
        (r.triangles, r.degenerate_triangles, r.non_finite_triangles),
        (2, 4, 4),
        "each placed mesh once"
    );
    assert_eq!((r.shapes, r.instances, r.lights, r.light_parts), (1, 2, 0, 0));
    let text = r.to_string();
    assert!(text.contains("2 triangles") && text.contains("4 triangles without area dropped"), "{text}");
    assert!(text.contains("4 triangles with unusable vertices dropped"), "{text}");
    assert!(!text.contains("lights that emit nothing"), "{text}");
    let down = |x: f32| Ray::new(Vec3A::new(x, 0.25, 1.0), Vec3A::NEG_Z);
    for x in [0.25, 3.25, 6.25] {
        assert_eq!(scene.intersect(&down(x), 0).map(|h| h.prim), Some(0), "{x}");
    }
    assert!(scene.bounds().is_finite());
}

#[test]
fn lights_that_emit_nothing_are_dropped_and_counted() {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    b.light(PointLight::new(Vec3A::Y, Spectrum::BLACK));
    b.light(PointLight::new(Vec3A::Y, Spectrum::rgb(-1.0, f32::NAN, 0.0)));
    b.light(ConstantEnvironment::new(Spectrum::BLACK));
    let dark = b.add(square(0.0), m);
    b.emit(dark, Emission::new(Spectrum::BLACK));
    let flat = TriangleMesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::X], vec![[0, 1, 2]]).unwrap();
    let flat = b.add(flat, m);
    b.emit(flat, Emission::new(Spectrum::ONE));
    assert!(!b.has_no_light());
    let lit = b.add(presets::cuboid(Vec3A::ZERO, Vec3A::ONE), m);
    b.emit(lit, Emission::new(Spectrum::ONE));
    b.light(PointLight::new(Vec3A::Y * 3.0, Spectrum::rgb(0.0, 0.0, 1e-30)));
    let scene = b.build().unwrap();
    let r = scene.report();
    assert_eq!((r.zero_power_lights, r.lights, r.light_parts), (5, 2, 13));
    assert!(r.to_string().contains("5 lights that emit nothing dropped"), "{r}");
    assert!(scene.needs().contains(Needs::LIGHTS | Needs::MANY_LIGHTS | Needs::AREA_LIGHTS));
    assert!(!scene.needs().contains(Needs::ENVIRONMENT));
    // Numbers of the lights that are left follow each other.
    assert_eq!(scene.lights().len(), 2);
}

#[test]
fn a_scene_with_only_dark_lights_needs_no_light() {
    let mut b = SceneBuilder::new();
    b.light(PointLight::new(Vec3A::Y, Spectrum::BLACK));
    let scene = b.build().unwrap();
    assert_eq!((scene.needs(), scene.report().zero_power_lights), (Needs::empty(), 1));
}

/// A plane has no bounds and its sky no radius to be measured by: the sky must be found all the same.
#[test]
fn a_sky_over_an_endless_plane_is_sampled() {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    b.light(ConstantEnvironment::new(Spectrum::ONE));
    let scene = b.build().unwrap();
    let at = LitPoint { ng: Vec3A::Y, ns: Vec3A::Y, sides: Sides::Same, ..free() };
    let draw = scene.sample_light(&at, Vec2::new(0.3, 0.6)).expect("the sky");
    let cos = draw.sample.wi.y;
    assert!((draw.sample.pdf - cos / std::f32::consts::PI).abs() < 1e-6);
}

#[test]
fn memory_is_reported() {
    let mut b = SceneBuilder::new();
    let image = ImageTexture::from_f32(8, 8, 3, vec![0.5; 192]).unwrap();
    let m = b.material(Diffuse::new(Tex::image(std::sync::Arc::new(image))));
    let id = b.add(presets::icosphere(2, 1.0), m);
    b.emit(id, Emission::new(Spectrum::ONE));
    let memory = b.build().unwrap().report().memory;
    // 162 vertices and normals of 12 bytes, 320 triangles of 12 bytes; 192 floats.
    assert!(memory.geometry >= 162 * 24 + 320 * 12, "{memory:?}");
    assert!(
        memory.materials >= 192 * 4 && memory.lights >= 320 * 16 && memory.hierarchy >= 320 * 16,
        "{memory:?}"
    );
    assert_eq!(memory.total(), memory.geometry + memory.materials + memory.lights + memory.hierarchy);
}

/// The id of something in a builder that has more than this one.
fn far_id<T>(make: impl Fn(&mut SceneBuilder) -> T) -> T {
    let mut other = SceneBuilder::new();
    for _ in 0..5 {
        make(&mut other);
    }
    make(&mut other)
}

fn error(b: SceneBuilder) -> SceneError {
    b.build().map(|s| format!("{s:?}")).expect_err("refused")
}

#[test]
fn ids_of_another_builder_are_refused_by_name() {
    let material = far_id(gray);
    let geometry = far_id(|b| {
        let m = gray(b);
        b.add_grouped(square(0.0), m)
    });
    let group = far_id(|b| b.group(&[]));

    let mut b = SceneBuilder::new();
    b.add(square(0.0), material);
    assert!(matches!(error(b), SceneError::UnknownMaterial { geom: 0, material: 5, count: 0 }));

    type Use<'a> = (&'a str, &'a dyn Fn(&mut SceneBuilder));
    let uses: [Use<'_>; 4] = [
        ("geometry", &|b| b.emit(geometry, Emission::new(Spectrum::ONE))),
        ("geometry", &|b| b.visible_to(geometry, 1)),
        ("geometry", &|b| assert_eq!(format!("{:?}", b.group(&[geometry])), "GroupId(0)")),
        ("group", &|b| assert_eq!(b.instance(group, Transform::IDENTITY).index(), u32::MAX)),
    ];
    for (kind, wrong) in uses {
        let mut b = SceneBuilder::new();
        wrong(&mut b);
        // The first mistake is the one reported.
        b.add(square(0.0), material);
        match error(b) {
            SceneError::UnknownId { what, id: 5, count: 0 } => assert_eq!(what, kind),
            e => panic!("{kind}: {e}"),
        }
    }
}

/// A shape whose points cannot be drawn.
struct NoArea;

impl Shape for NoArea {
    fn bounds(&self) -> etendue_core::Aabb {
        etendue_core::Aabb { lo: Vec3A::ZERO, hi: Vec3A::ONE }
    }
    fn intersect(&self, _ray: &Ray) -> Option<ShapeHit> {
        None
    }
    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        Surface::new(ray.at(hit.t), Vec3A::ZERO, -ray.d)
    }
}

#[test]
fn what_cannot_emit_is_refused_with_its_cure() {
    let one = || Emission::new(Spectrum::ONE);
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    let plane = b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    b.emit(plane, one());
    let e = error(b);
    assert!(
        matches!(e, SceneError::CannotEmit { geom: 0, .. }) && e.to_string().contains("parallelogram"),
        "{e}"
    );

    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    b.add(square(3.0), m);
    let open = b.add(etendue_geometry::Geometry::open(NoArea), m);
    b.emit(open, one());
    let e = error(b);
    assert!(matches!(e, SceneError::CannotEmit { geom: 1, .. }) && e.to_string().contains("area"), "{e}");

    let mut b = SceneBuilder::new();
    let m = b.material(Cutout::new(Diffuse::new(Spectrum::ONE), 0.5));
    let holed = b.add(square(0.0), m);
    b.emit(holed, one());
    b.visible_to(holed, 0);
    let e = error(b);
    assert!(matches!(e, SceneError::CannotEmit { geom: 0, .. }) && e.to_string().contains("no ray"), "{e}");

    for radiance in [f32::NAN, f32::INFINITY, -1.0] {
        let mut b = SceneBuilder::new();
        let m = gray(&mut b);
        let id = b.add(square(0.0), m);
        b.emit(id, Emission::new(Spectrum::rgb(1.0, radiance, 1.0)));
        assert!(matches!(error(b), SceneError::BadEmission { geom: 0 }), "{radiance}");
    }
}

#[test]
fn endless_things_cannot_be_instanced() {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    let ball = b.add_grouped(square(0.0), m);
    let plane = b.add_grouped(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    b.group(&[ball]);
    let group = b.group(&[ball, plane]);
    b.instance(group, Transform::IDENTITY);
    let e = error(b);
    assert!(matches!(e, SceneError::InfiniteInstance { group: 1, geom: 1 }), "{e}");
    assert!(e.to_string().contains("add it to the world"), "{e}");
}

#[test]
fn a_cancelled_build_is_an_error() {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    b.add(presets::terrain(64, 1), m);
    let flag = CancelFlag::default();
    flag.cancel();
    let e = b.build_with_progress(&flag).map(|_| ()).expect_err("cancelled");
    assert!(matches!(e, SceneError::Hierarchy(BuildError::Cancelled)), "{e}");
    assert!(Progress::cancelled(&flag));
}

#[test]
fn bounds_follow_what_is_placed() {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    let grouped = b.add_grouped(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), m);
    assert!(b.bounds().is_empty(), "nothing bounded is placed yet");
    let group = b.group(&[grouped]);
    b.instance(group, Transform::translation(Vec3A::X * 10.0));
    let bounds = b.bounds();
    assert!(
        (bounds.center() - Vec3A::X * 10.0).length() < 1e-5
            && (bounds.extent() - Vec3A::splat(2.0)).length() < 1e-5
    );
    let scene = b.build().unwrap();
    assert!((scene.bounds().center() - Vec3A::X * 10.0).length() < 1e-5);
    assert!((scene.radius() - 3f32.sqrt()).abs() < 1e-5);
}

#[test]
fn masks_hide_geometry_from_rays_that_share_no_bit() {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    let front = b.add(square(1.0), m);
    let back = b.add(square(0.0), m);
    let grouped = b.add_grouped(square(2.0), m);
    let group = b.group(&[grouped]);
    b.instance(group, Transform::IDENTITY);
    b.visible_to(front, 0b01);
    b.visible_to(grouped, 0b100);
    let scene = b.build().unwrap();
    let seen = |mask| {
        let ray = Ray { mask, ..Ray::new(Vec3A::Z * 9.0, Vec3A::NEG_Z) };
        scene.intersect(&ray, 0).map(|h| h.geom)
    };
    assert_eq!(seen(u32::MAX), Some(grouped.index()));
    assert_eq!(seen(0b011), Some(front.index()));
    assert_eq!(seen(0b010), Some(back.index()));
    assert_eq!(seen(0), None);
}

#[test]
fn scenes_can_be_shared_between_threads() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Scene>();
}
