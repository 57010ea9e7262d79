//! The shapes through their check suite, over random places and sizes.

use etendue_core::Vec3A;
use etendue_geometry::{Cylinder, Disc, Parallelogram, Plane, Shape, Sphere};
use etendue_testkit::{Budget, check_shape, strategies};
use proptest::prelude::*;

const CASES: u32 = 80;

/// A shape that proptest can print.
#[derive(Clone, Copy, Debug)]
enum Any {
    Sphere(Sphere),
    Parallelogram(Parallelogram),
    Plane(Plane),
    Disc(Disc),
    Cylinder(Cylinder),
}

impl Any {
    fn shape(&self) -> &dyn Shape {
        match self {
            Self::Sphere(s) => s,
            Self::Parallelogram(s) => s,
            Self::Plane(s) => s,
            Self::Disc(s) => s,
            Self::Cylinder(s) => s,
        }
    }
}

fn shapes() -> impl Strategy<Value = Any> {
    let size = || (-10i32..10).prop_map(|k| 2f32.powi(k));
    let sphere = (strategies::point(300.0), size()).prop_filter_map("a ball", |(center, r)| {
        // Further from the origin, its own size would be rounding.
        Sphere::new(center * r, r).ok().map(Any::Sphere)
    });
    let edges = (strategies::frame(), 0.05f32..2.0, -1.0f32..1.0);
    let parallelogram = (strategies::point(1.0), edges, size()).prop_filter_map("an area", |(p, e, size)| {
        let (frame, width, lean) = e;
        let (u, v) = (frame.x * width, frame.y + frame.x * lean);
        Parallelogram::new(p * size, u * size, v * size).ok().map(Any::Parallelogram)
    });
    let plane = (strategies::point(0.5), strategies::direction())
        .prop_filter_map("a normal", |(p, n)| Plane::new(p, n).ok().map(Any::Plane));
    let disc = (strategies::point(50.0), strategies::direction(), size())
        .prop_filter_map("a disc", |(c, n, r)| Disc::new(c * r, n, r).ok().map(Any::Disc));
    let cylinder = (strategies::point(50.0), strategies::direction(), 0.1f32..20.0, size(), any::<bool>())
        .prop_filter_map("a tube", |(p, axis, length, r, ends)| {
            if ends {
                Cylinder::new(p * r, (p + axis * length) * r, r).ok().map(Any::Cylinder)
            } else {
                // Lines are drawn around the origin.
                Cylinder::endless(p * 0.01, axis, 0.3).ok().map(Any::Cylinder)
            }
        });
    prop_oneof![sphere, parallelogram, plane, disc, cylinder]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: CASES,
        rng_seed: prop::test_runner::RngSeed::Fixed(12),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn every_shape_keeps_the_contract(shape in shapes(), seed in any::<u64>()) {
        let budget = Budget::default().shared(CASES as usize).seed(seed).effort(0.25);
        let verdict = check_shape(shape.shape(), &budget);
        prop_assert!(verdict.is_ok(), "{shape:?}: {}", verdict.unwrap_err());
    }
}

/// The mutant beside them: a sphere that claims a twentieth too much.
#[test]
fn a_wrong_area_is_rejected() {
    struct Large(Sphere);
    impl Shape for Large {
        fn bounds(&self) -> etendue_core::Aabb {
            self.0.bounds()
        }
        fn intersect(&self, ray: &etendue_core::Ray) -> Option<etendue_geometry::ShapeHit> {
            self.0.intersect(ray)
        }
        fn surface(
            &self,
            ray: &etendue_core::Ray,
            hit: &etendue_geometry::ShapeHit,
        ) -> etendue_geometry::Surface {
            self.0.surface(ray, hit)
        }
        fn area(&self) -> f32 {
            self.0.area() * 1.05
        }
    }
    let ball = Large(Sphere::new(Vec3A::ONE, 2.0).expect("a ball"));
    let failure = check_shape(&ball, &Budget::default()).expect_err("five per cent are within the power");
    assert_eq!(failure.test, "area");
}
