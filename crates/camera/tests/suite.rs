//! The cameras through their check suite, over random views, lenses and sizes.

use etendue_camera::{Panorama, PanoramaMap, Perspective};
use etendue_core::{Transform, UVec2, Vec3A};
use etendue_testkit::{Budget, check_camera, strategies};
use proptest::prelude::*;

fn perspective() -> impl Strategy<Value = Perspective> {
    let size = (1u32..200, 1u32..200).prop_map(|(w, h)| UVec2::new(w, h));
    let lens = prop_oneof![Just(0.0f32), 0.001f32..0.5];
    let view = (strategies::point(50.0), strategies::direction(), 1.0f32..150.0, size);
    let aperture = prop_oneof![Just(0u32), 3u32..12];
    (view, lens, 0.5f32..20.0, aperture).prop_filter_map(
        "a view",
        |((from, d, fov, size), radius, focus, blades)| {
            let up = if d.y.abs() < 0.9 { Vec3A::Y } else { Vec3A::X };
            Perspective::look_at(from, from + d * 10.0, up, fov, size)
                .ok()?
                .with_lens(radius, focus)
                .ok()?
                .with_blades(blades, focus)
                .ok()
        },
    )
}

fn panorama() -> impl Strategy<Value = Panorama> {
    let map = prop_oneof![Just(PanoramaMap::Equirectangular), Just(PanoramaMap::EqualArea)];
    (strategies::point(50.0), strategies::direction(), -3.2f32..3.2, map, 1u32..200, 1u32..200)
        .prop_filter_map("a place", |(p, axis, angle, map, w, h)| {
            let to_world = Transform::translation(p).after(&Transform::rotation(axis, angle)).ok()?;
            Panorama::new(to_world, map, UVec2::new(w, h)).ok()
        })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        rng_seed: prop::test_runner::RngSeed::Fixed(13),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn every_view_keeps_the_contract(camera in perspective(), seed in any::<u64>()) {
        let verdict = check_camera(&camera, &Budget::default().seed(seed));
        prop_assert!(verdict.is_ok(), "{camera:?}: {}", verdict.unwrap_err());
    }

    #[test]
    fn every_panorama_keeps_the_contract(camera in panorama(), seed in any::<u64>()) {
        let verdict = check_camera(&camera, &Budget::default().seed(seed));
        prop_assert!(verdict.is_ok(), "{camera:?}: {}", verdict.unwrap_err());
    }
}
