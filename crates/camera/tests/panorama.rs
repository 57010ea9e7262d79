//! Panoramas: where directions are, poles, seams, and the way back. (The pixels' solid angles are in the crate.)

use etendue_camera::{Camera, CameraError, Panorama, PanoramaMap};
use etendue_core::{Fingerprint, Needs, Transform, UVec2, Vec2, Vec3A, vector};

const SIZE: UVec2 = UVec2::new(64, 32);
const EYE: Vec3A = Vec3A::new(1.0, 2.0, 3.0);

fn camera(map: PanoramaMap) -> Panorama {
    Panorama::at(EYE, map, SIZE).unwrap()
}

fn direction(camera: &Panorama, x: f32, y: f32) -> Vec3A {
    let s = camera.ray(Vec2::new(x, y), Vec2::ZERO, 0.5).unwrap();
    assert_eq!((s.ray.o, s.weight, s.ray.time), (EYE, 1.0, 0.5));
    s.ray.d
}

fn near(a: Vec3A, b: Vec3A) {
    assert!((a - b).abs().max_element() < 1e-6, "{a} for {b}");
}

#[test]
fn directions_are_where_the_maps_say() {
    let c = camera(PanoramaMap::Equirectangular);
    assert_eq!((c.resolution(), c.needs()), (SIZE, Needs::empty()));
    near(direction(&c, 32.0, 16.0), Vec3A::NEG_Z);
    near(direction(&c, 48.0, 16.0), Vec3A::X);
    near(direction(&c, 16.0, 16.0), Vec3A::NEG_X);
    for y in [0.0, 16.0, 7.5] {
        near(direction(&c, 0.0, y), direction(&c, 64.0, y));
    }
    near(direction(&c, 64.0, 16.0), Vec3A::Z);
    for x in [0.0, 13.0, 50.0] {
        near(direction(&c, x, 0.0), Vec3A::Y);
        near(direction(&c, x, 32.0), Vec3A::NEG_Y);
    }
    near(direction(&c, 32.0, 8.0), Vec3A::new(0.0, 0.5f32.sqrt(), -(0.5f32.sqrt())));

    let c = camera(PanoramaMap::EqualArea);
    near(direction(&c, 32.0, 16.0), Vec3A::Y);
    near(direction(&c, 64.0, 16.0), Vec3A::X);
    near(direction(&c, 0.0, 16.0), Vec3A::NEG_X);
    near(direction(&c, 32.0, 32.0), Vec3A::NEG_Z);
    near(direction(&c, 32.0, 0.0), Vec3A::Z);
    for (x, y) in [(0.0, 0.0), (64.0, 0.0), (0.0, 32.0), (64.0, 32.0)] {
        near(direction(&c, x, y), Vec3A::NEG_Y);
    }
    // Each edge is folded at its middle.
    for k in [0.0, 3.0, 11.0, 29.0] {
        near(direction(&c, 32.0 + k, 0.0), direction(&c, 32.0 - k, 0.0));
        near(direction(&c, 32.0 + k, 32.0), direction(&c, 32.0 - k, 32.0));
    }
    near(direction(&c, 64.0, 20.0), direction(&c, 64.0, 12.0));
    // Beyond an edge it goes on there.
    for (outside, inside) in
        [((-3.0, 20.0), (3.0, 12.0)), ((66.0, 4.0), (62.0, 28.0)), ((40.0, 33.0), (24.0, 31.0))]
    {
        near(direction(&c, outside.0, outside.1), direction(&c, inside.0, inside.1));
    }
}

/// Film to direction to film, everywhere inside to a thousandth of a pixel, and direction to film to direction
/// everywhere, poles and seams included, to the rounding.
#[test]
fn there_and_back() {
    let turned =
        Transform::translation(EYE).after(&Transform::rotation(Vec3A::new(1.0, 2.0, 0.5), 0.7)).unwrap();
    let skew = Transform::from_columns(
        Vec3A::new(2.0, 0.0, 0.5),
        Vec3A::new(1.0, -1.0, 0.0),
        Vec3A::new(0.0, 0.3, 1.0),
        EYE,
    )
    .unwrap();
    let maps = [PanoramaMap::Equirectangular, PanoramaMap::EqualArea];
    for (map, turned) in maps.into_iter().flat_map(|m| [(m, turned), (m, skew)]) {
        let c = Panorama::new(turned, map, SIZE).unwrap();
        let (mut worst, mut off) = (0.0f32, 0.0f32);
        for i in 0..128 * 64 {
            let film = Vec2::new((i % 128) as f32 + 0.37, (i / 128) as f32 + 0.61) * 0.5;
            let d = c.ray(film, Vec2::ZERO, 0.0).unwrap().ray.d;
            let back = c.film_position(d * 3.0).unwrap();
            worst = worst.max((back - film).abs().max_element());
        }
        let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z, Vec3A::NEG_X, Vec3A::NEG_Y, Vec3A::NEG_Z];
        for axis in axes {
            for other in axes {
                for k in [0.0, 1e-7, 1e-4, 0.3, 1.0] {
                    let Some(d) = vector::try_normalize(axis + other * k) else { continue };
                    let d = vector::normalize(turned.vector(d));
                    let film = c.film_position(d).unwrap();
                    assert!(film.cmpge(Vec2::ZERO).all() && film.x <= 64.0 && film.y <= 32.0, "{film}");
                    let again = c.ray(film, Vec2::ZERO, 0.0).unwrap().ray.d;
                    off = off.max((again - d).abs().max_element());
                }
            }
        }
        println!("{map:?}: film off by {worst:e} pixels, directions by {off:e}");
        assert!(worst < 1e-3 && off < 1e-6, "{map:?}: {worst} {off}");
        assert!(c.film_position(Vec3A::ZERO).is_none() && c.film_position(Vec3A::splat(f32::NAN)).is_none());
    }
}

#[test]
fn what_is_no_camera_is_refused() {
    for size in [UVec2::new(0, 4), UVec2::new(4, 0)] {
        let e = Panorama::new(Transform::IDENTITY, PanoramaMap::EqualArea, size).expect_err("no pixels");
        assert!(matches!(e, CameraError::NoPixels(..)));
    }
}

#[test]
fn digests_tell_panoramas_apart() {
    let maps = [PanoramaMap::Equirectangular, PanoramaMap::EqualArea];
    let cameras = maps.into_iter().flat_map(|m| {
        [
            camera(m),
            Panorama::at(EYE * 2.0, m, SIZE).unwrap(),
            Panorama::at(EYE, m, UVec2::splat(32)).unwrap(),
        ]
    });
    let digests: std::collections::BTreeSet<u128> = cameras
        .map(|c| {
            let mut f = Fingerprint::default();
            c.fingerprint(&mut f);
            assert!(!f.is_opaque());
            f.value()
        })
        .collect();
    assert_eq!(digests.len(), 6);
}
