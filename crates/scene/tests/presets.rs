//! The built-in scenes are what their descriptions say.

use etendue_core::{Needs, Ray, Vec3A, vector};
use etendue_light::{LightId, LightPicker, PowerPicker};
use etendue_scene::presets::{Preset, cornell_box, empty_cornell_box, veach_mis};

/// Where the lamps over the plates stand, by height and depth.
const LAMPS: Vec3A = Vec3A::new(0.0, 1.5, 0.0);

#[test]
fn every_preset_builds_and_its_view_sees_it() {
    for make in [empty_cornell_box, cornell_box, veach_mis] {
        let p: Preset = make();
        let scene = p.builder.build().unwrap();
        assert!(scene.needs().contains(Needs::LIGHTS) && !scene.needs().intersects(Needs::OPEN_SHAPES));
        let ray = Ray::new(p.eye, vector::normalize(p.target - p.eye));
        assert!(scene.intersect(&ray, 0).is_some());
        assert!(p.vertical_fov_deg > 0.0 && p.vertical_fov_deg < 90.0);
        let before = make().builder.build().unwrap().fingerprint();
        assert_eq!(scene.fingerprint(), before, "the same each time");
    }
}

/// From the eye to a plate, mirrored, the way leads to the lamps; a plate that lies flat would miss them.
#[test]
fn plates_mirror_the_lamps_to_the_eye() {
    let p = veach_mis();
    let scene = p.builder.build().unwrap();
    for center in
        [(0.70, -0.05), (0.47, 0.30), (0.31, 0.70), (0.20, 1.12)].map(|(y, z)| Vec3A::new(0.0, y, z))
    {
        for lamp in [-1.05f32, -0.35, 0.35, 1.05].map(|x| LAMPS + Vec3A::X * x) {
            // A mirror shows the lamp where the ways' lengths have it.
            let (near, far) = (vector::length(p.eye - center), vector::length(LAMPS - center));
            let seen = center + Vec3A::X * (lamp.x * near / (near + far));
            let ray = Ray::new(p.eye, vector::normalize(seen - p.eye));
            let hit = scene.intersect(&ray, 0).unwrap();
            let surface = scene.surface(&ray, &hit, 0.0);
            assert!(vector::length(surface.p - seen) < 1e-4, "the plate is in plain view: {}", surface.p);
            assert!(surface.ng.y > 0.5, "{}", surface.ng);
            let off = |n: Vec3A| {
                let mirrored = ray.d - n * (2.0 * ray.d.dot(n));
                vector::length(vector::cross(mirrored, lamp - surface.p))
            };
            assert!(off(surface.ng) < 1e-4, "passes {} m from the lamp", off(surface.ng));
            assert!(off(Vec3A::Y) > 0.3, "a flat plate passes {} m from it", off(Vec3A::Y));
            // And nothing stands in between.
            let on = surface.origin().ray(vector::normalize(lamp - surface.p), 0.0);
            let met = scene.intersect(&on, 0).unwrap();
            assert!(scene.light_at(&scene.surface(&on, &met, 0.0)).is_some());
        }
    }
}

#[test]
fn lamps_over_the_plates_have_one_power() {
    let scene = veach_mis().builder.build().unwrap();
    let lights = scene.lights();
    assert_eq!(lights.len(), 4);
    let powers: Vec<f32> = lights.iter().map(|l| l.power(0, scene.radius()).mean()).collect();
    assert!(powers.iter().all(|w| (w / powers[0] - 1.0).abs() < 1e-5), "{powers:?}");
    let picker = PowerPicker::new(lights, scene.radius()).unwrap();
    let at = etendue_light::LitPoint {
        p: Vec3A::ZERO,
        p_err: Vec3A::ZERO,
        ng: Vec3A::Y,
        ns: Vec3A::Y,
        sides: etendue_light::Sides::Same,
        time: 0.0,
    };
    for light in 0..4 {
        let pmf = picker.pmf(&at, LightId { light, part: 0 });
        assert!((pmf - 0.25).abs() < 1e-5, "{light}: {pmf}");
    }
}
