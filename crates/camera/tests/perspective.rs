//! Perspective cameras against geometry.

use etendue_camera::{Camera, CameraError, Perspective};
use etendue_core::glam::DVec3;
use etendue_core::radiometry::polygon_solid_angle;
use etendue_core::{Fingerprint, Needs, Transform, UVec2, Vec2, Vec3A, vector};
use etendue_testkit::{Budget, check_camera};
use proptest::prelude::*;

const SIZE: UVec2 = UVec2::new(64, 48);
const EYE: Vec3A = Vec3A::new(1.0, 2.0, 3.0);
const TARGET: Vec3A = Vec3A::new(-0.5, 1.0, -4.0);

fn pinhole() -> Perspective {
    Perspective::look_at(EYE, TARGET, Vec3A::Y, 40.0, SIZE).unwrap()
}

fn direction(camera: &dyn Camera, x: f32, y: f32) -> Vec3A {
    camera.ray(Vec2::new(x, y), Vec2::ZERO, 0.0).unwrap().ray.d
}

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

#[test]
fn the_suite_passes() {
    let moved = Transform::translation(EYE).after(&Transform::rotation(Vec3A::X, 0.7)).unwrap();
    for (name, camera) in [
        ("pinhole", pinhole()),
        ("lens", pinhole().with_lens(0.05, 3.0).unwrap()),
        ("wide", Perspective::new(moved, 150.0, UVec2::new(200, 40)).unwrap()),
        ("one pixel", Perspective::new(Transform::IDENTITY, 1.0, UVec2::ONE).unwrap()),
    ] {
        check_camera(&camera, &Budget::default()).unwrap_or_else(|e| panic!("{name}: {e:?}"));
    }
}

/// Where a film position points, from the definition: half the height at distance 1 is tan(fov/2).
#[test]
fn rays_go_where_the_definition_says() {
    let camera = pinhole();
    let back = (wide(EYE) - wide(TARGET)).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let half = f64::tan(20f64.to_radians());
    for (x, y) in
        [(32.0, 24.0), (0.0, 0.0), (64.0, 0.0), (0.0, 48.0), (64.0, 48.0), (10.25, 40.5), (-3.0, 60.0)]
    {
        let s = camera.ray(Vec2::new(x, y), Vec2::new(0.3, 0.9), 0.25).unwrap();
        let (px, py) = ((f64::from(x) - 32.0) / 24.0 * half, (24.0 - f64::from(y)) / 24.0 * half);
        let expected = (right * px + up * py - back).normalize();
        assert!((wide(s.ray.d) - expected).length() < 5e-7, "({x}, {y}): {} for {expected}", s.ray.d);
        assert_eq!((s.ray.o, s.ray.time, s.weight), (EYE, 0.25, 1.0));
        assert!((f64::from(s.spread) - half / 24.0).abs() < 1e-7);
    }
    assert_eq!(camera.needs(), Needs::empty());
}

/// The pixels' solid angles add up to that of the whole view, 4 asin(sin(a/2) sin(b/2)) for full angles a and b; one
/// pixel's is its area times cos³ (the film's plane is slanted, and further away, at the border).
#[test]
fn solid_angles_of_pixels() {
    let camera = pinhole();
    let corner = |x: u32, y: u32| wide(direction(&camera, x as f32, y as f32));
    let half = f64::tan(20f64.to_radians());
    let area = (half / 24.0).powi(2);
    let mut sum = 0.0;
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let w = polygon_solid_angle(&[
                corner(x, y),
                corner(x, y + 1),
                corner(x + 1, y + 1),
                corner(x + 1, y),
            ])
            .0;
            let middle = wide(direction(&camera, x as f32 + 0.5, y as f32 + 0.5));
            let cos = middle.dot((wide(TARGET) - wide(EYE)).normalize());
            assert!((w / (area * cos.powi(3)) - 1.0).abs() < 1e-3, "pixel {x}, {y}");
            sum += w;
        }
    }
    let (sin_a, sin_b) = {
        let sin = |half: f64| half / (1.0 + half * half).sqrt();
        (sin(half * 64.0 / 48.0), sin(half))
    };
    assert!((sum / (4.0 * (sin_a * sin_b).asin()) - 1.0).abs() < 1e-5, "{sum}");
}

#[test]
fn a_lens_is_a_disc_and_sharp_at_its_focus() {
    let (radius, focus) = (0.2f32, 3.5f32);
    let camera = pinhole().with_lens(radius, focus).unwrap();
    assert_eq!(camera.needs(), Needs::LENS);
    let axis = vector::normalize(TARGET - EYE);
    let mut furthest = 0.0f32;
    for (x, y) in [(32.0, 24.0), (3.0, 41.0)] {
        let through = pinhole().ray(Vec2::new(x, y), Vec2::ZERO, 0.0).unwrap().ray;
        let sharp = through.at(focus / through.d.dot(axis));
        for i in 0..256 {
            let lens = Vec2::new((i % 16) as f32 / 15.999, (i / 16) as f32 / 15.999);
            let ray = camera.ray(Vec2::new(x, y), lens, 0.0).unwrap().ray;
            let offset = ray.o - EYE;
            assert!(offset.dot(axis).abs() < 1e-6, "the lens is flat");
            let r = vector::length(offset);
            assert!(r <= radius * (1.0 + 1e-5), "{r}");
            furthest = furthest.max(r);
            let miss = vector::length((sharp - ray.o).cross(ray.d));
            assert!(miss < 3e-6, "through lens {lens} it misses the sharp point by {miss}");
            // Twice as far away the circle of confusion is as wide as the lens: similar triangles.
            let beyond = ray.at(2.0 * focus / ray.d.dot(axis));
            let spread = vector::length(beyond - through.at(2.0 * focus / through.d.dot(axis)));
            assert!((spread - r).abs() < 1e-5, "{spread} for {r}");
        }
    }
    assert!(furthest > 0.99 * radius, "{furthest}");
    // A lens without width is a pinhole.
    let closed = pinhole().with_lens(0.0, 1.0).unwrap();
    assert_eq!(
        (closed.needs(), direction(&closed, 5.0, 5.0)),
        (Needs::empty(), direction(&pinhole(), 5.0, 5.0))
    );
}

#[test]
fn the_placements_scale_is_ignored() {
    let placed = |s: f32| {
        let scale = Transform::scale(Vec3A::new(s, s, s)).unwrap();
        let turned = Transform::rotation(Vec3A::Y, 0.5).after(&scale).unwrap();
        let to_world = Transform::translation(EYE).after(&turned).unwrap();
        Perspective::new(to_world, 40.0, SIZE).unwrap().with_lens(0.1, 2.0).unwrap()
    };
    for s in [0.01, 2.0, 37.0] {
        for lens in [Vec2::splat(0.2), Vec2::new(0.9, 0.4)] {
            let (a, b) = (placed(1.0), placed(s));
            let ray = |c: &Perspective| c.ray(Vec2::new(10.0, 40.0), lens, 0.0).unwrap().ray;
            assert!(
                (ray(&a).o - ray(&b).o).length() < 1e-6 && (ray(&a).d - ray(&b).d).length() < 1e-6,
                "{s}"
            );
        }
    }
}

#[test]
fn another_resolution_keeps_the_vertical_view() {
    let camera = pinhole().with_resolution(UVec2::new(20, 96)).unwrap();
    assert_eq!(camera.resolution(), UVec2::new(20, 96));
    assert!((direction(&camera, 10.0, 0.0) - direction(&pinhole(), 32.0, 0.0)).length() < 1e-6);
    assert!(matches!(pinhole().with_resolution(UVec2::new(0, 4)), Err(CameraError::NoPixels(0, 4))));
}

#[test]
fn what_is_no_camera_is_refused() {
    let at = |from, to, up| Perspective::look_at(from, to, up, 40.0, SIZE);
    let nan = Vec3A::splat(f32::NAN);
    for (what, e) in [
        ("same place", at(EYE, EYE, Vec3A::Y)),
        ("up along the view", at(EYE, EYE + Vec3A::Y, Vec3A::Y)),
        ("no up", at(EYE, TARGET, Vec3A::ZERO)),
        ("no number", at(nan, TARGET, Vec3A::Y)),
        ("no number", at(EYE, nan, Vec3A::Y)),
        ("no number", at(EYE, TARGET, nan)),
        ("infinite", at(EYE, Vec3A::INFINITY, Vec3A::Y)),
    ] {
        assert!(matches!(e, Err(CameraError::Orientation)), "{what}: {e:?}");
    }
    for fov in [0.0, -40.0, 180.0, 400.0, f32::NAN, f32::INFINITY] {
        let e = Perspective::look_at(EYE, TARGET, Vec3A::Y, fov, SIZE).expect_err("no field of view");
        assert!(matches!(e, CameraError::FieldOfView(_)) && e.to_string().contains("180"), "{e}");
    }
    for size in [UVec2::new(0, 5), UVec2::new(5, 0)] {
        let e = Perspective::new(Transform::IDENTITY, 40.0, size);
        assert!(matches!(e, Err(CameraError::NoPixels(..))));
    }
    let lenses = [
        (-1.0, 1.0),
        (f32::NAN, 1.0),
        (f32::INFINITY, 1.0),
        (1.0, 0.0),
        (1.0, -2.0),
        (1.0, f32::NAN),
        (1.0, f32::INFINITY),
    ];
    for (radius, focus) in lenses {
        let e = pinhole().with_lens(radius, focus).expect_err("no lens");
        assert!(matches!(e, CameraError::Lens { .. }) && e.to_string().contains("radius >= 0"), "{e}");
    }
}

#[test]
fn digests_tell_cameras_apart() {
    let cameras = [
        pinhole(),
        Perspective::look_at(EYE, TARGET, Vec3A::X, 40.0, SIZE).unwrap(),
        Perspective::look_at(EYE, TARGET, Vec3A::Y, 41.0, SIZE).unwrap(),
        pinhole().with_resolution(UVec2::new(48, 64)).unwrap(),
        pinhole().with_lens(0.1, 1.0).unwrap(),
        pinhole().with_lens(0.1, 2.0).unwrap(),
    ];
    let mut seen: Vec<u128> = cameras
        .iter()
        .map(|c| {
            let mut f = Fingerprint::default();
            c.fingerprint(&mut f);
            assert!(!f.is_opaque());
            f.value()
        })
        .collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), cameras.len());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, rng_seed: proptest::test_runner::RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default() })]

    /// Any numbers make a camera whose rays are valid, or a typed error.
    #[test]
    fn any_numbers_make_a_camera_or_an_error(
        from in prop::array::uniform3(prop::num::f32::ANY),
        to in prop::array::uniform3(prop::num::f32::ANY),
        up in prop::array::uniform3(-1f32..1.0),
        fov in prop_oneof![0f32..180.0, prop::num::f32::ANY],
        lens in (prop::num::f32::ANY, prop::num::f32::ANY),
    ) {
        let Ok(camera) = Perspective::look_at(from.into(), to.into(), up.into(), fov, SIZE) else { return Ok(()) };
        let camera = camera.clone().with_lens(lens.0, lens.1).unwrap_or(camera);
        for film in [Vec2::ZERO, Vec2::new(32.0, 24.0), Vec2::new(64.0, 48.0)] {
            if let Some(s) = camera.ray(film, Vec2::new(0.3, 0.8), 0.0) {
                prop_assert!(s.ray.is_valid(), "{s:?}");
                prop_assert!((vector::length(s.ray.d) - 1.0).abs() < 1e-5);
            }
        }
    }

    /// Moving and focusing in units of a power of two changes no direction.
    #[test]
    fn scaling_by_a_power_of_two_changes_no_bit(k in -30i32..30, x in 0f32..64.0, y in 0f32..48.0, u in 0f32..1.0, v in 0f32..1.0) {
        let s = 2f32.powi(k);
        let camera = |s: f32| Perspective::look_at(EYE * s, TARGET * s, Vec3A::Y, 40.0, SIZE).unwrap().with_lens(0.1 * s, 2.0 * s).unwrap();
        let ray = |s: f32| camera(s).ray(Vec2::new(x, y), Vec2::new(u, v), 0.0).unwrap().ray;
        prop_assert_eq!(ray(s).d, ray(1.0).d);
        prop_assert_eq!(ray(s).o, ray(1.0).o * s);
    }
}
