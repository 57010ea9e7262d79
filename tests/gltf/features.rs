//! The sheet of features: one scene with a cell for each thing that the loader builds, row by row as
//! `docs/gltf.md` lists them.

use etendue::core::math;
use serde_json::{Value, json};

use crate::doc::{Doc, ball, quad};

/// Distance between cells, metres.
const CELL: f32 = 2.4;
const COLUMNS: usize = 6;
const ROWS: usize = 5;

/// A sheet in the making.
struct Sheet {
    doc: Doc,
    ball: Value,
    quad: Value,
    next: usize,
}

impl Sheet {
    /// Where the next cell is.
    fn place(&mut self) -> [f32; 3] {
        let (row, column) = (self.next / COLUMNS, self.next % COLUMNS);
        self.next += 1;
        let x = (column as f32 - 0.5 * (COLUMNS as f32 - 1.0)) * CELL;
        [x, (0.5 * (ROWS as f32 - 1.0) - row as f32) * CELL, 0.0]
    }

    fn mesh(&mut self, primitive: &Value, material: Value) -> usize {
        if let Some(extensions) = material["extensions"].as_object() {
            for name in extensions.keys() {
                self.doc.uses(name);
            }
        }
        let m = self.doc.push("materials", material);
        let mut primitive = primitive.clone();
        primitive["material"] = json!(m);
        self.doc.push("meshes", json!({"primitives": [primitive]}))
    }

    fn ball(&mut self, name: &str, material: Value) {
        let (mesh, at) = (self.mesh(&self.ball.clone(), material), self.place());
        self.doc.node(json!({"name": name, "mesh": mesh, "translation": at}));
    }

    fn quad(&mut self, name: &str, material: Value) {
        let (mesh, at) = (self.mesh(&self.quad.clone(), material), self.place());
        self.doc.node(json!({"name": name, "mesh": mesh, "translation": at, "scale": [0.95, 0.95, 1]}));
    }
}

fn pbr(base: [f32; 3], metallic: f32, roughness: f32) -> Value {
    let [r, g, b] = base;
    json!({"pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1], "metallicFactor": metallic, "roughnessFactor": roughness}})
}

fn with(mut material: Value, extension: &str, value: Value) -> Value {
    material["extensions"][extension] = value;
    material
}

fn checker(n: u32, a: [u8; 4], b: [u8; 4]) -> Vec<[u8; 4]> {
    (0..n * n).map(|i| if (i % n + i / n).is_multiple_of(2) { a } else { b }).collect()
}

/// Round bumps, as a normal map.
fn bumps(n: u32) -> Vec<[u8; 4]> {
    let byte = |v: f32| (v * 127.0 + 128.0).round() as u8;
    let texel = |i: u32| {
        let at = |k: u32| (k as f32 + 0.5) / n as f32 * 2.0 - 1.0;
        let (x, y) = (at(i % n), -at(i / n));
        let r2 = x * x + y * y;
        let (nx, ny) = if r2 < 0.64 { (x * 0.9, y * 0.9) } else { (0.0, 0.0) };
        [byte(nx), byte(ny), byte((1.0 - nx * nx - ny * ny).max(0.0).sqrt()), 255]
    };
    (0..n * n).map(texel).collect()
}

/// A disc that is solid inside.
fn disc(n: u32, soft: bool) -> Vec<[u8; 4]> {
    let texel = |i: u32| {
        let at = |k: u32| (k as f32 + 0.5) / n as f32 * 2.0 - 1.0;
        let r = (at(i % n).powi(2) + at(i / n).powi(2)).sqrt();
        let alpha = if soft {
            1.2 - 1.2 * r
        } else if r < 0.9 && r > 0.4 {
            1.0
        } else {
            0.0
        };
        [240, 160, 40, (alpha.clamp(0.0, 1.0) * 255.0) as u8]
    };
    (0..n * n).map(texel).collect()
}

pub(crate) fn sheet() -> Doc {
    let mut doc = Doc::new();
    doc.json["asset"]["generator"] = json!("tests/gltf/features.rs");
    let round = doc.mesh(&ball(48, 24), None);
    let flat = doc.mesh(&quad(), None);
    let taken = |d: &Doc, i: usize| d.json["meshes"][i]["primitives"][0].clone();
    let (ball, quad) = (taken(&doc, round), taken(&doc, flat));
    doc.json["meshes"] = json!([]);
    let mut s = Sheet { doc, ball, quad, next: 0 };
    plain(&mut s);
    textured(&mut s);
    clear(&mut s);
    special(&mut s);
    assert_eq!(s.next, COLUMNS * ROWS);
    around(&mut s);
    s.doc
}

/// Rows one and two: dielectrics and metals from smooth to rough.
fn plain(s: &mut Sheet) {
    for i in 0..6 {
        s.ball("dielectric", pbr([0.5, 0.05, 0.04], 0.0, i as f32 * 0.2));
    }
    for i in 0..6 {
        s.ball("metal", pbr([1.0, 0.77, 0.34], 1.0, i as f32 * 0.2));
    }
}

/// Row three: textures.
fn textured(s: &mut Sheet) {
    let nearest = json!({"magFilter": 9728, "minFilter": 9728});
    let board = s.doc.texture(8, &checker(8, [230, 230, 230, 255], [30, 60, 130, 255]), nearest.clone());
    let mut m = pbr([1.0; 3], 0.0, 0.6);
    m["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": board});
    s.ball("base colour texture", m.clone());
    s.doc.uses("KHR_texture_transform");
    m["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({"KHR_texture_transform": {"rotation": 0.6, "scale": [2, 1], "offset": [0.1, 0.2]}});
    s.ball("texture transform", m);
    let map = s.doc.texture(32, &bumps(32), json!({"magFilter": 9729}));
    let mut m = pbr([0.6, 0.6, 0.6], 0.0, 0.35);
    m["normalTexture"] = json!({"index": map, "extensions": {"KHR_texture_transform": {"scale": [16, 8]}}});
    s.ball("normal map", m);
    let mut colored = s.quad.clone();
    let colors = s.doc.floats(&[[1.0f32, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]]);
    colored["attributes"]["COLOR_0"] = json!(colors);
    let (mesh, at) = (s.mesh(&colored, pbr([0.9; 3], 0.0, 1.0)), s.place());
    s.doc.node(json!({"name": "vertex colours", "mesh": mesh, "translation": at}));
    // Green is roughness, blue is metal.
    let surface = s.doc.texture(4, &checker(4, [0, 40, 255, 255], [0, 200, 0, 255]), nearest.clone());
    let mut m = pbr([0.95, 0.6, 0.5], 1.0, 1.0);
    m["pbrMetallicRoughness"]["metallicRoughnessTexture"] =
        json!({"index": surface, "extensions": {"KHR_texture_transform": {"scale": [4, 2]}}});
    s.ball("metallic-roughness texture", m);
    let m = pbr([0.02, 0.02, 0.02], 0.0, 0.1);
    let blue = json!({"specularFactor": 1.0, "specularColorFactor": [0.3, 0.6, 3.0]});
    s.ball(
        "specular colour",
        with(with(m, "KHR_materials_specular", blue), "KHR_materials_ior", json!({"ior": 2.0})),
    );
}

/// Row four: what light goes through.
fn clear(s: &mut Sheet) {
    let glass = |base: [f32; 3], roughness: f32, ior: f32| {
        let m =
            with(pbr(base, 0.0, roughness), "KHR_materials_transmission", json!({"transmissionFactor": 1}));
        with(m, "KHR_materials_ior", json!({"ior": ior}))
    };
    let body = json!({"thicknessFactor": 1});
    s.ball("thin wall", glass([0.6, 0.85, 1.0], 0.0, 1.5));
    s.ball("thin rough wall", glass([0.6, 0.85, 1.0], 0.4, 1.5));
    s.ball("glass", with(glass([1.0; 3], 0.0, 1.5), "KHR_materials_volume", body.clone()));
    s.ball("frosted glass", with(glass([1.0; 3], 0.3, 1.5), "KHR_materials_volume", body.clone()));
    let green =
        json!({"thicknessFactor": 1, "attenuationDistance": 0.8, "attenuationColor": [0.2, 0.8, 0.3]});
    s.ball("absorbing glass", with(glass([1.0; 3], 0.0, 1.5), "KHR_materials_volume", green));
    s.ball("diamond", with(glass([1.0; 3], 0.0, 2.4), "KHR_materials_volume", body));
}

/// Row five: holes, light, instances.
fn special(s: &mut Sheet) {
    for (mode, soft) in [("MASK", false), ("BLEND", true)] {
        let t = s.doc.texture(64, &disc(64, soft), json!({}));
        let mut m = pbr([1.0; 3], 0.0, 0.8);
        m["alphaMode"] = json!(mode);
        m["doubleSided"] = json!(true);
        m["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": t});
        s.quad(mode, m);
    }
    let mut m = pbr([0.1; 3], 0.0, 0.5);
    m["emissiveFactor"] = json!([1.0, 0.35, 0.1]);
    s.ball("emission", with(m, "KHR_materials_emissive_strength", json!({"emissiveStrength": 2.0})));
    s.quad("unlit", with(pbr([0.15, 0.45, 0.75], 0.0, 1.0), "KHR_materials_unlit", json!({})));
    s.doc.uses("EXT_mesh_gpu_instancing");
    let around: Vec<[f32; 3]> = (0..8)
        .map(|i| {
            let a = i as f32 / 8.0 * std::f32::consts::TAU;
            [0.75 * math::cos(a), 0.75 * math::sin(a), 0.0]
        })
        .collect();
    let t = s.doc.floats(&around);
    let sizes: Vec<[f32; 3]> = (0..8).map(|i| [0.1 + 0.025 * i as f32; 3]).collect();
    let sizes = s.doc.floats(&sizes);
    let (mesh, at) = (s.mesh(&s.ball.clone(), pbr([0.3, 0.6, 0.2], 0.0, 0.5)), s.place());
    s.doc.node(json!({"name": "instances", "mesh": mesh, "translation": at,
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": t, "SCALE": sizes}}}}));
    // A target that pulls the ball in half way, and a mirror that turns it around.
    let mut morphed = s.ball.clone();
    let shape = ball(48, 24);
    let pull: Vec<[f32; 3]> =
        shape.positions.iter().map(|p| [-0.8 * p[0] * (1.0 - p[1].abs()), 0.0, 0.0]).collect();
    let pull = s.doc.floats(&pull);
    morphed["targets"] = json!([{"POSITION": pull}]);
    let (mesh, at) = (s.mesh(&morphed, pbr([0.7, 0.4, 0.6], 0.0, 0.3)), s.place());
    s.doc.json["meshes"][mesh]["weights"] = json!([0.75]);
    s.doc.node(json!({"name": "morphed, mirrored", "mesh": mesh, "translation": at, "scale": [-1, 1, 1]}));
}

/// The wall behind, the lights and the camera.
fn around(s: &mut Sheet) {
    let tiles =
        s.doc.texture(2, &checker(2, [150, 150, 150, 255], [120, 120, 120, 255]), json!({"magFilter": 9728}));
    let mut m = with(pbr([1.0; 3], 0.0, 1.0), "KHR_materials_specular", json!({"specularFactor": 0}));
    m["pbrMetallicRoughness"]["baseColorTexture"] =
        json!({"index": tiles, "extensions": {"KHR_texture_transform": {"scale": [24, 24]}}});
    let wall = s.mesh(&s.quad.clone(), m);
    s.doc.node(json!({"name": "wall", "mesh": wall, "translation": [0, 0, -1.6], "scale": [16, 16, 1]}));
    let mut m = pbr([0.0; 3], 0.0, 1.0);
    m["emissiveFactor"] = json!([1.0, 0.95, 0.9]);
    let lamp = s
        .mesh(&s.quad.clone(), with(m, "KHR_materials_emissive_strength", json!({"emissiveStrength": 14.0})));
    // Above and in front, looking down and back: turned about x by 180° − 50°.
    let half = 65f32.to_radians();
    s.doc.node(json!({"name": "lamp", "mesh": lamp, "translation": [-3, 11, 10], "scale": [4, 3, 1],
        "rotation": [math::sin(half), 0.0, 0.0, math::cos(half)]}));
    s.doc.uses("KHR_lights_punctual");
    let candela = 683.0;
    s.doc.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "name": "bulb", "color": [0.6, 0.75, 1.0], "intensity": 9.0 * candela},
        {"type": "spot", "name": "spot", "color": [1.0, 0.85, 0.7], "intensity": 160.0 * candela,
            "spot": {"innerConeAngle": 0.16, "outerConeAngle": 0.24}},
        {"type": "directional", "name": "sun", "intensity": 0.25 * candela}]}});
    let lit = |i: usize| json!({"KHR_lights_punctual": {"light": i}});
    s.doc.node(json!({"translation": [7.5, -2, 3], "extensions": lit(0)}));
    s.doc.node(json!({"translation": [0, 0, 14], "extensions": lit(1)}));
    s.doc.node(json!({"rotation": [-0.38, 0.2, 0.0, 0.903], "extensions": lit(2)}));
    let camera = s.doc.push(
        "cameras",
        json!({"type": "perspective", "perspective": {"yfov": 0.52, "aspectRatio": 1.2, "znear": 0.1}}),
    );
    s.doc.node(json!({"name": "view", "camera": camera, "translation": [0, 0, 24]}));
}

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/data/features.gltf");

#[test]
#[ignore = "writes examples/data/features.gltf"]
fn write() {
    std::fs::write(FILE, sheet().gltf()).expect("written");
}

#[test]
fn the_sheet_in_the_repository_is_sound_and_the_one_made_here() {
    let bytes = std::fs::read(FILE).expect("the file is in the repository");
    let mut there: Value = serde_json::from_slice(&bytes).expect("JSON");
    let mut made: Value = serde_json::from_slice(&sheet().gltf()).expect("JSON");
    // The pictures' bytes belong to the encoder.
    for v in [&mut there, &mut made] {
        v["buffers"] = json!([]);
        v["bufferViews"] = json!([]);
    }
    assert_eq!(there, made, "run `cargo test --test gltf -- --ignored write`");
    let mut b = etendue::prelude::SceneBuilder::new();
    let loaded = etendue::io::load_scene(FILE.as_ref(), &etendue::io::LoadOptions::default(), &mut b);
    let report = loaded.expect("sound").report;
    assert_eq!(report.warnings, Vec::<String>::new());
    assert_eq!((report.lights, report.instances), (3, 8));
    assert!(b.build().is_ok());
}
