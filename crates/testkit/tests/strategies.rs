//! The strategies draw what they say.

use etendue_camera::CameraSample;
use etendue_core::vector;
use etendue_integrator::{Context, Integrator, PathTracer};
use etendue_sampling::{Distribution1d, Independent, Sampler};
use etendue_testkit::strategies;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 256,
        rng_seed: prop::test_runner::RngSeed::Fixed(21),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn numbers_and_directions(u in strategies::unit(), d in strategies::direction(), up in strategies::upper_direction()) {
        prop_assert!((0.0..1.0).contains(&u));
        prop_assert!((vector::length(d) - 1.0).abs() < 1e-6 && up.z > 0.0);
    }

    #[test]
    fn frames_and_placements(f in strategies::frame(), m in strategies::transform(), p in strategies::point(3.0)) {
        prop_assert!(f.x.dot(f.y).abs() < 1e-6 && f.y.dot(f.z).abs() < 1e-6 && f.z.dot(f.x).abs() < 1e-6);
        let back = m.inverse().point(m.point(p));
        prop_assert!(vector::length(back - p) < 1e-2, "{p} came back as {back}");
    }

    #[test]
    fn meshes(soup in strategies::soup(30), closed in strategies::closed_mesh()) {
        prop_assert!((1..=30).contains(&soup.triangle_count()));
        // Every edge of a closed mesh is run through once in each direction, by corners at one place.
        let positions = closed.positions();
        let mut edges = std::collections::BTreeMap::new();
        for t in closed.indices() {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let at = |i: u32| positions[i as usize].to_array().map(|x| (x * 1e5).round() as i64);
                if at(a) != at(b) {
                    *edges.entry((at(a).min(at(b)), at(a).max(at(b)))).or_insert(0) += if at(a) < at(b) { 1 } else { -1 };
                }
            }
        }
        prop_assert!(edges.values().all(|&n| n == 0), "an open edge");
    }

    #[test]
    fn densities_can_be_drawn_from(density in strategies::density(40)) {
        prop_assert!(Distribution1d::new(density.iter().copied()).is_ok(), "{density:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 48,
        rng_seed: prop::test_runner::RngSeed::Fixed(22),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn scenes_can_be_rendered(scene in strategies::tiny_scene(), ray in strategies::ray(2.0)) {
        let cx = Context::new(&scene);
        let path = PathTracer::default();
        let mut light = 0.0;
        for i in 0..64 {
            let u = Independent::new(1, 64).start(0, i);
            let s = path.li_plain(&cx, &CameraSample { ray, weight: 1.0, spread: 0.0 }, u);
            prop_assert!(s.l.is_finite() && s.l.to_array().iter().all(|&c| c >= 0.0));
            light += s.l.mean();
        }
        prop_assert!(light.is_finite());
        prop_assert!(!scene.lights().is_empty());
    }
}
