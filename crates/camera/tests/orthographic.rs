//! Orthographic cameras against geometry.

use etendue_camera::{Camera, CameraError, Orthographic};
use etendue_core::{Needs, Transform, UVec2, Vec2, Vec3A};

const SIZE: UVec2 = UVec2::new(64, 48);

/// A film position sees along a line that is as far from the axis as it is from the middle, in half extents.
#[test]
fn film_positions_are_places_in_the_world() {
    let turn = Transform::rotation(Vec3A::new(0.3, 1.0, 0.2), 0.9);
    // The scale in the placement is no part of the extent.
    let scaled = turn.after(&Transform::scale(Vec3A::splat(3.0)).unwrap()).unwrap();
    let place = Transform::translation(Vec3A::new(1.0, 2.0, 3.0)).after(&scaled).unwrap();
    let square = Orthographic::new(place, 1.5, SIZE).unwrap();
    let stretched = Orthographic::stretched(place, 0.5, 4.0, SIZE).unwrap();
    for (camera, (w, h)) in [(square, (2.0, 1.5)), (stretched, (0.5, 4.0))] {
        assert_eq!((camera.resolution(), camera.needs()), (SIZE, Needs::empty()));
        for (film, (x, y)) in [
            (Vec2::new(0.0, 0.0), (-1.0, 1.0)),
            (Vec2::new(64.0, 48.0), (1.0, -1.0)),
            (Vec2::new(32.0, 24.0), (0.0, 0.0)),
            (Vec2::new(48.0, 12.0), (0.5, 0.5)),
        ] {
            let s = camera.ray(film, Vec2::new(0.9, 0.1), 0.25).unwrap();
            let truth = Vec3A::new(1.0, 2.0, 3.0) + turn.vector(Vec3A::new(x * w, y * h, 0.0));
            assert!((s.ray.o - truth).length() < 1e-5, "{film}: {} for {truth}", s.ray.o);
            assert!((s.ray.d - turn.vector(Vec3A::NEG_Z)).length() < 1e-6);
            assert_eq!((s.weight, s.spread, s.ray.time), (1.0, 0.0, 0.25));
        }
    }
}

/// All pixels see the same area across the view: 4 w h / (columns × rows), and together the whole picture.
#[test]
fn pixels_have_equal_areas() {
    let wide = |v: Vec3A| [f64::from(v.x), f64::from(v.y), f64::from(v.z)];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let place = Transform::translation(Vec3A::new(1.0, 2.0, 3.0))
        .after(&Transform::rotation(Vec3A::new(0.3, 1.0, 0.2), 0.9))
        .unwrap();
    let camera = Orthographic::stretched(place, 0.5, 4.0, SIZE).unwrap();
    let at = |x: u32, y: u32| camera.ray(Vec2::new(x as f32, y as f32), Vec2::ZERO, 0.0).unwrap().ray;
    let (pixel, mut sum) = (4.0 * 0.5 * 4.0 / f64::from(SIZE.x * SIZE.y), 0.0);
    for (x, y) in (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y))) {
        let (corner, d) = (at(x, y), wide(at(x, y).d));
        let side = |ray: etendue_core::Ray| {
            let (a, b) = (wide(ray.o), wide(corner.o));
            [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
        };
        let n = cross(side(at(x + 1, y)), side(at(x, y + 1)));
        // The part of the parallelogram that faces the view.
        let area = (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]).abs();
        // Corners are rounded to 2e-7 m, pixels are 0.016 m wide.
        assert!((area / pixel - 1.0).abs() < 1e-4, "{x} {y}: {area} for {pixel}");
        sum += area;
    }
    assert!((sum / (4.0 * 0.5 * 4.0) - 1.0).abs() < 1e-6, "{sum}");
}

#[test]
fn looking_at_puts_the_target_in_the_middle() {
    let (from, to) = (Vec3A::new(3.0, 4.0, 5.0), Vec3A::new(0.0, 1.0, -1.0));
    let camera = Orthographic::look_at(from, to, Vec3A::Y, 2.0, SIZE).unwrap();
    let ray = camera.ray(Vec2::new(32.0, 24.0), Vec2::ZERO, 0.0).unwrap().ray;
    assert!(ray.d.cross(to - ray.o).length() < 1e-5);
    assert!(camera.ray(Vec2::new(32.0, 0.0), Vec2::ZERO, 0.0).unwrap().ray.o.y > ray.o.y, "up is up");
}

/// Scaled by a power of two, its rays are scaled exactly.
#[test]
fn scale_is_exact() {
    let at = |s: f32| {
        let camera =
            Orthographic::look_at(Vec3A::new(3.0, 4.0, 5.0) * s, Vec3A::X * s, Vec3A::Y, 2.0 * s, SIZE);
        camera.unwrap().ray(Vec2::new(10.3, 40.7), Vec2::ZERO, 0.0).unwrap().ray
    };
    for k in [-20, 20] {
        let s = 2f32.powi(k);
        assert_eq!((at(s).o, at(s).d), (at(1.0).o * s, at(1.0).d));
    }
}

#[test]
fn what_is_no_camera_is_refused() {
    for h in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let e = Orthographic::new(Transform::IDENTITY, h, SIZE).expect_err("no extent");
        assert!(matches!(e, CameraError::Extent { .. }), "{e}");
        assert!(Orthographic::stretched(Transform::IDENTITY, h, 1.0, SIZE).is_err());
    }
    let e = Orthographic::new(Transform::IDENTITY, 1.0, UVec2::new(0, 4)).expect_err("no pixels");
    assert_eq!(e, CameraError::NoPixels(0, 4));
    assert!(Orthographic::look_at(Vec3A::ONE, Vec3A::ONE, Vec3A::Y, 1.0, SIZE).is_err());
    let view = Orthographic::look_at(Vec3A::Y, Vec3A::ZERO, Vec3A::Y, 1.0, SIZE);
    assert_eq!(view.expect_err("up along the view"), CameraError::Orientation);
}
