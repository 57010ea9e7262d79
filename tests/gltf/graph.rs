//! Nodes, instances, and what is refused.

use etendue::core::math;
use etendue::io::LoadOptions;
use etendue::prelude::*;
use serde_json::json;

use crate::doc::{Doc, quad};
use crate::{read, try_read};

/// A quad under a node.
fn placed(node: serde_json::Value) -> Doc {
    let mut d = Doc::new();
    let mesh = d.mesh(&quad(), None);
    let mut node = node;
    node["mesh"] = json!(mesh);
    d.node(node);
    d
}

fn error(d: &Doc) -> String {
    try_read(d, &LoadOptions::default()).err().expect("refused").to_string()
}

#[test]
fn a_single_placement_is_worked_in_and_a_mirror_keeps_the_front() {
    for scale in [[2.0, 1.0, 1.0], [-2.0, 1.0, 1.0]] {
        let r = read(&placed(json!({"translation": [0, 0, 3], "scale": scale})));
        assert!(!r.scene.needs().contains(Needs::INSTANCES));
        let s = r.at(1.5, 0.5);
        assert!((s.p.z - 3.0).abs() < 1e-6 && s.ng.z > 0.9 && s.shading.z.z > 0.9, "{scale:?}: {}", s.ng);
    }
}

#[test]
fn a_mesh_in_many_places_is_one_mesh() {
    let mut d = placed(json!({"translation": [-3, 0, 0]}));
    d.node(json!({"mesh": 0, "translation": [3, 0, 0], "scale": [-1, 1, 1]}));
    let r = read(&d);
    assert!(r.scene.needs().contains(Needs::INSTANCES));
    assert_eq!((r.loaded.report.instances, r.loaded.report.triangles), (2, 2));
    for x in [-2.5, 3.5] {
        assert!(r.at(x, 0.5).ng.z > 0.9, "the mirrored one too has its front to the front");
    }
}

#[test]
fn gpu_instancing_places_copies() {
    let mut d = Doc::new();
    d.uses("EXT_mesh_gpu_instancing");
    let mesh = d.mesh(&quad(), None);
    let t = d.floats(&[[-4.0f32, 0.0, 0.0], [0.0, 0.0, 1.0], [4.0, 0.0, 2.0]]);
    let s = d.floats(&[[0.5f32, 0.5, 1.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]]);
    d.node(json!({"mesh": mesh, "translation": [0, 0, 1],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": t, "SCALE": s}}}}));
    let r = read(&d);
    assert_eq!(r.loaded.report.instances, 3);
    assert_eq!(r.at(0.5, 0.5).p.z, 2.0);
    assert_eq!(r.at(5.5, 0.5).p.z, 3.0);
    assert!(r.see(Vec3A::new(-4.8, 0.0, 9.0), Vec3A::NEG_Z).is_none());
}

#[test]
fn chains_of_placements_multiply_and_hidden_nodes_stay_hidden() {
    let mut d = Doc::new();
    d.uses("KHR_node_visibility");
    let mesh = d.mesh(&quad(), None);
    d.node(json!({"translation": [0, 0, 1], "children": [1]}));
    d.push("nodes", json!({"matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1], "children": [2]}));
    // A quarter turn of x = 5 is y = 5.
    d.push("nodes", json!({"mesh": mesh, "translation": [5, 0, 0]}));
    d.node(json!({"children": [4], "extensions": {"KHR_node_visibility": {"visible": false}}}));
    d.push("nodes", json!({"mesh": mesh}));
    let r = read(&d);
    assert!((r.at(0.0, 5.0).p - Vec3A::new(0.0, 5.0, 2.0)).length() < 1e-5);
    assert!(r.see(Vec3A::Z * 9.0, Vec3A::NEG_Z).is_none());
}

#[test]
fn cycles_two_parents_and_endless_chains_are_errors() {
    let mut cycle = placed(json!({"children": [1]}));
    cycle.push("nodes", json!({"children": [0]}));
    assert!(error(&cycle).contains("/nodes/"), "{}", error(&cycle));
    let mut twice = placed(json!({"children": [2]}));
    twice.node(json!({"children": [2]}));
    twice.push("nodes", json!({}));
    assert!(error(&twice).contains("/nodes/"), "{}", error(&twice));
    let mut chain = placed(json!({"children": [1]}));
    for i in 1..5000 {
        chain.push("nodes", json!({"children": [i + 1]}));
    }
    chain.push("nodes", json!({}));
    assert!(error(&chain).contains("the limit is 4096"), "{}", error(&chain));
    let deep = LoadOptions::default();
    let deep = LoadOptions { limits: etendue::io::Limits { node_depth: 10_000, ..deep.limits }, ..deep };
    assert!(try_read(&chain, &deep).is_ok());
}

#[test]
fn what_a_file_requires_and_we_lack_is_named_with_its_cure() {
    let mut d = placed(json!({}));
    d.uses("KHR_draco_mesh_compression");
    d.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    let e = error(&d);
    assert!(e.contains("KHR_draco_mesh_compression") && e.contains("Draco compression"), "{e}");
    let mut d = placed(json!({}));
    d.uses("KHR_materials_sheen");
    let warnings = try_read(&d, &LoadOptions::default()).expect("only used").loaded.report.warnings;
    assert!(warnings.iter().any(|w| w.contains("KHR_materials_sheen")), "{warnings:?}");
}

#[test]
fn placements_without_an_inverse() {
    // Flat, but there: worked in, it is a surface still.
    assert!(read(&placed(json!({"scale": [1, 1, 0]}))).see(Vec3A::Z, Vec3A::NEG_Z).is_some());
    // Among instances it cannot be placed, and the others stay.
    let mut d = placed(json!({"scale": [1, 1, 0], "translation": [3, 0, 0]}));
    d.node(json!({"mesh": 0}));
    let r = try_read(&d, &LoadOptions::default()).expect("the other one");
    assert!(
        r.loaded.report.warnings.iter().any(|w| w.contains("/nodes/0")),
        "{:?}",
        r.loaded.report.warnings
    );
    assert!(r.see(Vec3A::Z, Vec3A::NEG_Z).is_some());
}

#[test]
fn a_stopped_load_is_an_error() {
    let stop = etendue::core::CancelFlag::default();
    stop.cancel();
    let options = LoadOptions { progress: &stop, ..LoadOptions::default() };
    assert!(try_read(&placed(json!({})), &options).err().expect("stopped").to_string().contains("cancelled"));
}

#[test]
fn a_fan_beyond_measure_gets_tangents_without_the_generator() {
    // Around one corner MikkTSpace walks by recursion: 20,000 triangles there took it seconds, more took the stack.
    let mut d = Doc::new();
    let texture = d.texture(1, &[[128, 128, 255, 255]], json!({}));
    let m = d.push("materials", json!({"normalTexture": {"index": texture}}));
    let mut fan = quad();
    let rim = 20_000u16;
    fan.positions = vec![[0.0; 3]];
    for i in 0..rim {
        let a = f32::from(i) / f32::from(rim - 1) * 6.0;
        fan.positions.push([math::cos(a), math::sin(a), 0.0]);
    }
    fan.normals = vec![[0.0, 0.0, 1.0]; fan.positions.len()];
    fan.uv = fan.positions.iter().map(|p| [p[0], -p[1]]).collect();
    fan.indices = (1..rim).flat_map(|i| [0, i, i + 1]).collect();
    let mesh = d.mesh(&fan, Some(m));
    d.node(json!({"mesh": mesh}));
    let r = try_read(&d, &LoadOptions::default()).expect("valid");
    assert!(
        r.loaded.report.warnings.iter().any(|w| w.contains("MikkTSpace")),
        "{:?}",
        r.loaded.report.warnings
    );
    assert!((r.at(0.3, 0.3).shading.x - Vec3A::X).length() < 1e-4, "along u");
}

#[test]
fn emitting_instances_are_counted_before_they_are_made() {
    let mut d = Doc::new();
    let m = d.push("materials", json!({"emissiveFactor": [1, 1, 1]}));
    let mesh = d.mesh(&quad(), Some(m));
    for i in 0..10 {
        d.node(json!({"mesh": mesh, "translation": [i, 0, 0]}));
    }
    let limited = |emitters| {
        let options = LoadOptions::default();
        let options = LoadOptions { limits: etendue::io::Limits { emitters, ..options.limits }, ..options };
        try_read(&d, &options).map(|_| ()).map_err(|e| e.to_string())
    };
    assert!(limited(20).is_ok());
    let e = limited(19).expect_err("twenty triangles");
    assert!(e.contains("20 emitting triangles") && e.contains("the limit is 19"), "{e}");
}
