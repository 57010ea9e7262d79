//! Lights, emission and cameras.

use etendue::core::{Origin, math};
use etendue::io::View;
use etendue::light::{LightSample, LitPoint, Sides};
use etendue::prelude::*;
use serde_json::{Value, json};

use crate::doc::{Doc, quad};
use crate::{close, read};

/// Lumens in a watt, by which exporters convert.
const LM_PER_W: f32 = 683.0;

fn lit(light: Value, node: Value) -> crate::Read {
    let mut d = Doc::new();
    d.uses("KHR_lights_punctual");
    d.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
    let mut node = node;
    node["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
    d.node(node);
    let mesh = d.mesh(&quad(), None);
    d.node(json!({"mesh": mesh}));
    read(&d)
}

fn sample(r: &crate::Read, p: Vec3A) -> Option<LightSample> {
    let at =
        LitPoint { p, p_err: Vec3A::ZERO, ng: Vec3A::ZERO, ns: Vec3A::ZERO, sides: Sides::Free, time: 0.0 };
    let _: Origin = at.origin();
    r.scene.lights()[0].sample(&at, 0, Vec2::splat(0.5))
}

#[test]
fn a_point_light_of_683_candela_is_one_watt_per_steradian() {
    let r = lit(
        json!({"type": "point", "intensity": LM_PER_W, "color": [1.0, 0.5, 0.25]}),
        json!({"translation": [1, 2, 3]}),
    );
    assert_eq!(r.loaded.report.lights, 1);
    let s = sample(&r, Vec3A::new(1.0, 2.0, 1.0)).expect("light");
    close(s.li, [0.25, 0.125, 0.0625], 1e-6);
    assert!((s.wi - Vec3A::Z).length() < 1e-6);
}

/// Blender writes a lamp of P watts as 683 P / 4π candela.
#[test]
fn blenders_watts_come_back() {
    let watts = 100.0;
    let candela = LM_PER_W * watts / (4.0 * std::f32::consts::PI);
    let r = lit(json!({"type": "point", "intensity": candela}), json!({}));
    close(r.scene.lights()[0].power(0, 1.0), [watts; 3], 1e-3);
}

#[test]
fn a_directional_light_counts_in_lux() {
    // Turned by −90° around x: the light's −z becomes −y.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let r = lit(
        json!({"type": "directional", "intensity": 2.0 * LM_PER_W}),
        json!({"rotation": [-half, 0, 0, half]}),
    );
    let s = sample(&r, Vec3A::ZERO).expect("light");
    close(s.li, [2.0; 3], 1e-5);
    assert!((s.wi - Vec3A::Y).length() < 1e-6 && s.is_delta && s.end.is_none());
}

#[test]
fn a_spot_light_fades_between_its_cones() {
    let (inner, outer) = (0.3f32, 0.6f32);
    let light = json!({"type": "spot", "intensity": LM_PER_W, "spot": {"innerConeAngle": inner, "outerConeAngle": outer}});
    let r = lit(light, json!({}));
    let at = |angle: f32| {
        let p = Vec3A::new(math::sin(angle), 0.0, -math::cos(angle));
        sample(&r, p).map_or(0.0, |s| s.li.r())
    };
    assert!((at(0.0) - 1.0).abs() < 1e-5 && (at(0.29) - 1.0).abs() < 1e-5);
    let middle: f32 = 0.45;
    let linear = (math::cos(middle) - math::cos(outer)) / (math::cos(inner) - math::cos(outer));
    assert!((at(middle) - linear * linear).abs() < 1e-4, "{}", at(middle));
    assert_eq!(at(0.61), 0.0);
}

#[test]
fn emissive_strength_multiplies_radiance_of_the_front() {
    let mut d = Doc::new();
    d.uses("KHR_materials_emissive_strength");
    let m = d.push(
        "materials",
        json!({"emissiveFactor": [1.0, 0.5, 0.25], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8.0}}}),
    );
    let mesh = d.mesh(&quad(), Some(m));
    d.node(json!({"mesh": mesh}));
    let r = read(&d);
    assert!(r.loaded.report.has_light);
    let s = r.at(0.2, 0.3);
    let id = r.scene.light_at(&s).expect("a light");
    close(r.scene.emitted(id, &s, Vec3A::Z), [8.0, 4.0, 2.0], 0.0);
    close(r.scene.emitted(id, &s, Vec3A::NEG_Z), [0.0; 3], 0.0);
}

#[test]
fn a_double_sided_emitter_shines_both_ways_and_its_texture_is_decoded() {
    let mut d = Doc::new();
    let t = d.texture(1, &[[188, 0, 0, 255]], json!({}));
    let m = d.push(
        "materials",
        json!({"doubleSided": true, "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": t}}),
    );
    let mesh = d.mesh(&quad(), Some(m));
    d.node(json!({"mesh": mesh}));
    let r = read(&d);
    let s = r.at(0.0, 0.0);
    let id = r.scene.light_at(&s).expect("a light");
    // ((188/255 + 0.055) / 1.055)^2.4
    close(r.scene.emitted(id, &s, Vec3A::NEG_Z), [0.502_886_5, 0.0, 0.0], 1e-6);
}

#[test]
fn unlit_shows_its_colour_and_reflects_nothing() {
    let mut d = Doc::new();
    d.uses("KHR_materials_unlit");
    let m = d.push(
        "materials",
        json!({"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.6, 1.0]}, "extensions": {"KHR_materials_unlit": {}}}),
    );
    let mesh = d.mesh(&quad(), Some(m));
    d.node(json!({"mesh": mesh}));
    let r = read(&d);
    let s = r.at(0.0, 0.0);
    let id = r.scene.light_at(&s).expect("a light");
    for side in [Vec3A::Z, Vec3A::NEG_Z] {
        close(r.scene.emitted(id, &s, side), [0.2, 0.4, 0.6], 0.0);
    }
    close(r.albedo(0.0, 0.0), [0.0; 3], 0.0);
}

#[test]
fn cameras_keep_their_place_name_and_shape() {
    let mut d = Doc::new();
    let p = d.push(
        "cameras",
        json!({"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 2.0}}),
    );
    let o = d.push(
        "cameras",
        json!({"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0.1, "zfar": 9}}),
    );
    let parent = d.node(json!({"translation": [0, 0, 5], "scale": [2, 2, 2], "children": [1]}));
    d.push("nodes", json!({"camera": p, "name": "front", "translation": [1, 0, 0]}));
    d.node(json!({"camera": o, "name": "flat"}));
    assert_eq!(parent, 0);
    let mesh = d.mesh(&quad(), None);
    d.node(json!({"mesh": mesh}));
    let r = read(&d);
    let names: Vec<&str> = r.loaded.cameras.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["front", "flat"]);
    let front = &r.loaded.cameras[0];
    assert_eq!(front.aspect, Some(2.0));
    let size = UVec2::new(200, 100);
    let ray =
        front.at_size(size).expect("camera").ray(Vec2::new(100.0, 0.0), Vec2::ZERO, 0.0).expect("ray").ray;
    assert!((ray.o - Vec3A::new(2.0, 0.0, 5.0)).length() < 1e-5, "{}", ray.o);
    // Half the vertical field of view is 0.4.
    assert!((ray.d.y - math::sin(0.4)).abs() < 1e-5 && ray.d.x.abs() < 1e-6);
    assert!(matches!(r.loaded.cameras[1].view, View::Orthographic { half_width: 3.0, half_height: 2.0 }));
    let ray = r.loaded.cameras[1].at_size(UVec2::new(30, 20)).expect("camera");
    let ray = ray.ray(Vec2::new(30.0, 0.0), Vec2::ZERO, 0.0).expect("ray").ray;
    assert!((ray.o - Vec3A::new(3.0, 2.0, 0.0)).length() < 1e-5 && (ray.d - Vec3A::NEG_Z).length() < 1e-6);
}

#[test]
fn scale_means_nothing_to_a_camera() {
    for scale in [json!([-1, 1, 1]), json!([1, 1, 0]), json!([0, 3, 2])] {
        let mut d = Doc::new();
        let p = d.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}));
        d.node(json!({"camera": p, "scale": scale, "translation": [0, 0, 4]}));
        let r = read(&d);
        let camera = r.loaded.cameras[0].at_size(UVec2::new(100, 100)).expect("camera");
        let ray = camera.ray(Vec2::new(100.0, 50.0), Vec2::ZERO, 0.0).expect("ray").ray;
        assert!(ray.d.z < 0.0 && (ray.d.x - math::sin(0.4)).abs() < 1e-5, "{scale}: {}", ray.d);
    }
}
