//! Apertures of straight blades.

use etendue_camera::{Camera, CameraError, Perspective};
use etendue_core::{Fingerprint, Transform, UVec2, Vec2, Vec3A};

const RADIUS: f32 = 0.25;

fn lens() -> Perspective {
    Perspective::new(Transform::IDENTITY, 40.0, UVec2::splat(32)).unwrap().with_lens(RADIUS, 3.0).unwrap()
}

/// Where on the lens, in units of its radius.
fn place(camera: &Perspective, u: Vec2) -> Vec2 {
    let o: Vec3A = camera.ray(Vec2::new(3.0, 20.0), u, 0.0).unwrap().ray.o;
    assert_eq!(o.z, 0.0);
    Vec2::new(o.x, o.y) / RADIUS
}

/// Every point lies within the polygon; the mean is the middle, the mean of r² is (2 + cos 2π/n) / 6, and each side's
/// triangle, and the inner quarter of the area, has its share: what a uniform density has and the disc has not.
#[test]
fn points_are_uniform_over_the_polygon() {
    // As many columns for each side.
    const SIDE: u32 = 660;
    for (blades, rotation) in [(3u32, 0.0f32), (4, 0.3), (5, -1.0), (6, 100.0), (11, 0.2)] {
        let camera = lens().with_blades(blades, rotation).unwrap();
        let n = f64::from(blades);
        let step = std::f64::consts::TAU / n;
        let apothem = (0.5 * step).cos();
        let (mut mean, mut squares, mut inner) = ([0.0f64; 2], 0.0f64, 0.0f64);
        let mut shares = vec![0.0f64; blades as usize];
        for i in 0..SIDE * SIDE {
            let u = Vec2::new((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5) / SIDE as f32;
            let p = place(&camera, u);
            let (x, y) = (f64::from(p.x), f64::from(p.y));
            let angle = (y.atan2(x) - f64::from(rotation)).rem_euclid(std::f64::consts::TAU);
            let side = ((angle / step) as usize).min(blades as usize - 1);
            let r = x.hypot(y);
            // Distance along the normal of that side.
            let along = r * (angle - (side as f64 + 0.5) * step).cos();
            assert!(along <= apothem + 1e-5, "{blades} blades: {p}");
            shares[side] += 1.0;
            mean = [mean[0] + x, mean[1] + y];
            squares += r * r;
            inner += f64::from(u8::from(along <= 0.5 * apothem));
        }
        let all = f64::from(SIDE * SIDE);
        assert!((mean[0].abs() + mean[1].abs()) / all < 2e-3, "{blades}: {mean:?}");
        let truth = (2.0 + step.cos()) / 6.0;
        assert!((squares / all / truth - 1.0).abs() < 2e-3, "{blades}: {} for {truth}", squares / all);
        assert!((inner / all - 0.25).abs() < 2e-3, "{blades}: {}", inner / all);
        assert!(shares.iter().all(|s| (s / all * n - 1.0).abs() < 0.01), "{blades}: {shares:?}");
        // The disc's mean of r² is ½: further off than the tolerance.
        assert!((0.5 / truth - 1.0).abs() > 0.04);
    }
}

#[test]
fn no_blades_are_the_disc_to_the_last_bit() {
    let (disc, none) = (lens(), lens().with_blades(7, 0.4).unwrap().with_blades(0, 0.7).unwrap());
    assert_eq!(disc, none);
    for i in 0..4096u32 {
        let u = Vec2::new((i % 64) as f32 / 64.0, (i / 64) as f32 / 64.0);
        let film = Vec2::new(i as f32 % 32.0, 5.0);
        assert_eq!(disc.ray(film, u, 0.1), none.ray(film, u, 0.1));
    }
    let digest = |c: &Perspective| {
        let mut f = Fingerprint::default();
        c.fingerprint(&mut f);
        f.value()
    };
    let five = |r: f32| lens().with_blades(5, r).unwrap();
    let digests =
        [digest(&disc), digest(&five(0.0)), digest(&five(0.1)), digest(&lens().with_blades(6, 0.0).unwrap())];
    assert!((0..4).all(|i| (0..i).all(|j| digests[i] != digests[j])));
    // A pinhole has no aperture to see.
    let pinhole = lens().with_lens(0.0, 1.0).unwrap();
    let ray = |c: &Perspective| c.ray(Vec2::ONE, Vec2::splat(0.3), 0.0);
    assert_eq!(ray(&pinhole), ray(&pinhole.clone().with_blades(6, 0.0).unwrap()));
}

#[test]
fn what_is_no_polygon_is_refused() {
    for (blades, rotation) in [(1, 0.0), (2, 0.0), (5, f32::NAN), (5, f32::INFINITY)] {
        let e = lens().with_blades(blades, rotation).expect_err("no polygon");
        assert!(matches!(e, CameraError::Blades { .. }) && e.to_string().contains("3 blades"), "{e}");
    }
    // So many that the polygon is the disc.
    let camera = lens().with_blades(u32::MAX, 1.0).unwrap();
    for u in [Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON / 2.0), Vec2::new(0.3, 0.9)] {
        assert!(place(&camera, u).length() <= 1.000001);
    }
}
