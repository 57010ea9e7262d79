//! The example's shape through the suite for shapes, and against the sphere that it should be.

#[path = "../examples/implicit/shape.rs"]
mod shape;

use std::sync::atomic::{AtomicU64, Ordering};

use etendue::core::glam::DVec3;
use etendue::core::vector;
use etendue::prelude::*;
use etendue::sampling::warp;
use etendue_testkit::{Budget, check_shape};
use shape::{Implicit, distance};

fn boxed<F: Fn(DVec3) -> f64 + Send + Sync>(half: f32, f: F) -> Implicit<F> {
    Implicit::new(Vec3A::splat(-half), Vec3A::splat(half), 1.0, f)
}

#[test]
fn implicit_surfaces_keep_the_contract() {
    let ball = boxed(1.1, |p| distance::ball(p, DVec3::ZERO, 1.0));
    let ring = boxed(1.1, |p| distance::torus(p, DVec3::ZERO, 0.7, 0.3));
    let melted = boxed(1.1, |p| {
        let ball = distance::ball(p, DVec3::new(0.0, 0.5, 0.1), 0.45);
        distance::blend(distance::torus(p, DVec3::ZERO, 0.7, 0.25), ball, 0.3)
    });
    let walls = boxed(0.7, |p| distance::gyroid(p, 9.0, 0.1).max(distance::ball(p, DVec3::ZERO, 0.65)));
    // A function whose slope is not 1, and differs from place to place.
    let ellipsoid = Implicit::new(Vec3A::splat(-1.1), Vec3A::splat(1.1), 6.7, |p| {
        (p * DVec3::new(1.0, 2.0, 3.0)).length_squared() - 1.0
    });
    let shapes: [(&str, &dyn Shape); 5] =
        [("ball", &ball), ("ring", &ring), ("melted", &melted), ("walls", &walls), ("ellipsoid", &ellipsoid)];
    for (name, shape) in shapes {
        let budget = Budget::default().shared(5).effort(0.05);
        check_shape(shape, &budget).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
    // With no error bound a ray that leaves finds the place again.
    struct NoBound<T>(T);
    impl<T: Shape> Shape for NoBound<T> {
        fn bounds(&self) -> etendue::core::Aabb {
            self.0.bounds()
        }
        fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
            self.0.intersect(ray)
        }
        fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
            let mut s = self.0.surface(ray, hit);
            s.p_err = Vec3A::ZERO;
            s
        }
    }
    let failure = check_shape(&NoBound(ring), &Budget::default().effort(0.05)).expect_err("it is wrong");
    assert_eq!(failure.test, "self-hit");
}

/// Rays at a ball from anywhere, many of them near its outline; how many of the exact sphere's hits a shape has, and
/// the largest error of `t`.
fn compare(shape: &dyn Shape) -> (u32, u32, f32) {
    let ball = Sphere::new(Vec3A::ZERO, 1.0).unwrap();
    let sampler = Independent::new(5, 1);
    let (mut differing, mut hits, mut worst) = (0, 0, 0.0f32);
    for i in 0..20_000 {
        let u = sampler.start(i, 0);
        let o = warp::sphere(u.get_2d(Dim::FILM)) * (1.2 + 3.0 * u.get_2d(Dim::TIME).x);
        // Past the middle at a distance around the radius.
        let frame = Frame::from_normal(vector::normalize(o));
        let (sin, cos) = etendue::core::math::sin_cos_turns(u.get_2d(Dim::LENS).x);
        let aside = 1.0 + 0.5 * (u.get_2d(Dim::LENS).y - 0.5).powi(3);
        let reach = aside / (1.0 - aside * aside / o.dot(o)).sqrt();
        let d = vector::normalize((frame.x * cos + frame.y * sin) * reach - o);
        let ray = Ray::new(o, d);
        match (ball.intersect(&ray), shape.intersect(&ray)) {
            (Some(a), Some(b)) => {
                hits += 1;
                worst = worst.max((a.t - b.t).abs() / a.t.max(1.0));
            }
            (None, None) => {}
            // Thinner than one step, the outline may be missed.
            (a, b) => {
                let aside = vector::length(o - d * o.dot(d));
                differing += u32::from((aside - 1.0).abs() > 1e-8 || b.is_some() && a.is_none());
            }
        }
    }
    (differing, hits, worst)
}

#[test]
fn roots_are_those_of_the_quadratic() {
    let ball = boxed(1.1, |p| distance::ball(p, DVec3::ZERO, 1.0));
    let (differing, hits, worst) = compare(&ball);
    println!("{differing} differ, {hits} hits, t to {worst:e}");
    assert!(differing == 0 && (5_000..15_000).contains(&hits) && worst <= 2.0 * f32::EPSILON);
    // Mutant: a slope three times as large as claimed steps over the near side.
    let steep = boxed(1.1, |p| 3.0 * distance::ball(p, DVec3::ZERO, 1.0));
    let (differing, _, worst) = compare(&steep);
    assert!(differing > 100 || worst > 0.1, "{differing} {worst}");
}

/// Even along a surface, and with a function that is no number, a ray comes to an end.
#[test]
fn no_ray_takes_more_steps_than_promised() {
    static CALLS: AtomicU64 = AtomicU64::new(0);
    let floor = boxed(1.0, |p| {
        CALLS.fetch_add(1, Ordering::Relaxed);
        p.y
    });
    for y in [0.0, 1e-12, -1e-7, 1e-3] {
        CALLS.store(0, Ordering::Relaxed);
        assert!(floor.intersect(&Ray::new(Vec3A::new(-3.0, y, 0.1), Vec3A::X)).is_none());
        let calls = CALLS.load(Ordering::Relaxed);
        assert!(calls <= 65_600, "y {y}: {calls}");
    }
    let nothing = boxed(1.0, |_| f64::NAN);
    assert!(nothing.intersect(&Ray::new(Vec3A::new(-3.0, 0.0, 0.1), Vec3A::X)).is_none());
}
