//! Numbers in buffers: kinds, layouts, sparse values, and the primitives made of them.

use etendue::prelude::*;
use serde_json::json;

use crate::doc::{Doc, quad};
use crate::read;

/// A document with one mesh whose primitive is changed.
fn with(change: impl FnOnce(&mut Doc, usize)) -> Doc {
    let mut d = Doc::new();
    let mesh = d.mesh(&quad(), None);
    change(&mut d, mesh);
    d.node(json!({"mesh": mesh}));
    d
}

/// Which of a grid of points, 0.1 apart, are covered.
fn covered(d: &Doc) -> Vec<(i32, i32)> {
    let r = read(d);
    let all = (-12..12).flat_map(|y| (-12..12).map(move |x| (x, y)));
    all.filter(|(x, y)| {
        let o = Vec3A::new(*x as f32 * 0.1 + 0.05, *y as f32 * 0.1 + 0.04, 5.0);
        r.see(o, Vec3A::NEG_Z).is_some()
    })
    .collect()
}

#[test]
fn one_quad_in_every_container() {
    let d = with(|_, _| {});
    let plain = covered(&d);
    assert_eq!(plain.len(), 400);
    let mut b = SceneBuilder::new();
    let options = etendue::io::LoadOptions::default();
    let loaded =
        etendue::io::gltf::read("a.glb", &d.glb(), &etendue::io::NoFiles, &options, &mut b).expect("glb");
    assert_eq!((loaded.report.triangles, loaded.report.meshes), (2, 1));
    let folder = std::env::temp_dir().join(format!("etendue-gltf-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("folder");
    std::fs::write(folder.join("a b.bin"), &d.bin).expect("buffer");
    std::fs::write(folder.join("scene.gltf"), d.gltf_with("a%20b.bin")).expect("scene");
    let loaded = etendue::io::load_scene(&folder.join("scene.gltf"), &options, &mut SceneBuilder::new());
    assert_eq!(loaded.expect("external buffer").report.triangles, 2);
    // A copy of the buffer outside of the folder is not read.
    std::fs::create_dir_all(folder.join("inner")).expect("folder");
    std::fs::write(folder.join("inner/scene.gltf"), d.gltf_with("../a%20b.bin")).expect("scene");
    let error = etendue::io::load_scene(&folder.join("inner/scene.gltf"), &options, &mut SceneBuilder::new());
    let error = error.expect_err("outside").to_string();
    assert!(error.contains("/buffers/0") && error.contains("not a path below"), "{error}");
    std::fs::remove_dir_all(&folder).expect("clean");
}

#[test]
fn strips_and_fans_keep_their_front() {
    for (mode, order) in [(5, [0, 1, 3, 2]), (6, [0, 1, 2, 3])] {
        let d = with(|d, mesh| {
            let indices = d.indices(&order);
            let p = &mut d.json["meshes"][mesh]["primitives"][0];
            p["mode"] = json!(mode);
            p["indices"] = json!(indices);
        });
        assert_eq!(covered(&d).len(), 400, "mode {mode}");
        let r = read(&d);
        for (x, y) in [(0.5, -0.5), (-0.5, 0.5)] {
            assert!(r.at(x, y).ng.z > 0.9, "mode {mode} at {x}, {y}");
        }
    }
}

#[test]
fn primitives_without_indices_take_vertices_in_order() {
    let mut d = Doc::new();
    let positions = d.floats(&[[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let mesh = d.push("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}}]}));
    d.node(json!({"mesh": mesh}));
    let r = read(&d);
    assert_eq!(r.loaded.report.triangles, 1);
    assert!(!r.scene.needs().contains(Needs::SHADING_NORMALS), "flat where there are no normals");
}

#[test]
fn points_and_lines_are_left_out_and_said_so() {
    let d = with(|d, mesh| d.json["meshes"][mesh]["primitives"][0]["mode"] = json!(1));
    let mut b = SceneBuilder::new();
    let options = etendue::io::LoadOptions::default();
    let loaded =
        etendue::io::gltf::read("a", &d.gltf(), &etendue::io::NoFiles, &options, &mut b).expect("valid");
    assert_eq!(loaded.report.triangles, 0);
    assert!(loaded.report.skipped.iter().any(|s| s.contains("points and lines")), "{:?}", loaded.report);
}

#[test]
fn sparse_values_replace_and_zeros_need_no_bytes() {
    // The quad's right half is pulled in to x = 0 by two sparse values.
    let d = with(|d, mesh| {
        let base = d.json["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"].as_u64().expect("index");
        let indices = d.view(&[1, 0, 2, 0]);
        let values = [0.0f32, -1.0, 0.0, 0.0, 1.0, 0.0];
        let values = d.view(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
        d.json["accessors"][base as usize]["max"] = json!([0, 1, 0]);
        d.json["accessors"][base as usize]["sparse"] = json!({"count": 2,
            "indices": {"bufferView": indices, "componentType": 5123}, "values": {"bufferView": values}});
    });
    assert_eq!(covered(&d).len(), 200);
    // Without a buffer view everything is zero but the sparse values: one corner away from the origin is no area.
    let d = with(|d, mesh| {
        let base = d.json["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"].as_u64().expect("index");
        let indices = d.view(&[1, 2]);
        let values = [1.0f32, 0.0, 0.0, 0.0, 1.0, 0.0];
        let values = d.view(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
        d.json["accessors"][base as usize] = json!({"count": 4, "type": "VEC3", "componentType": 5126,
            "min": [0, 0, 0], "max": [1, 1, 0], "sparse": {"count": 2,
            "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}}});
    });
    let r = read(&d);
    assert_eq!(r.scene.report().degenerate_triangles, 1);
    assert!(r.see(Vec3A::new(0.2, 0.2, 5.0), Vec3A::NEG_Z).is_some());
}

#[test]
fn quantised_positions_and_normalised_coordinates() {
    let d = with(|d, mesh| {
        d.uses("KHR_mesh_quantization");
        d.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        // Corners at ±32767 of 16 bits mean ±1; each is padded to eight bytes.
        let corners: [[i16; 4]; 4] =
            [[-32767, -32767, 0, 0], [32767, -32767, 0, 0], [32767, 32767, 0, 0], [-32767, 32767, 0, 0]];
        let view = d.view(&corners.iter().flatten().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
        d.json["bufferViews"][view]["byteStride"] = json!(8);
        d.json["bufferViews"][view]["target"] = json!(34962);
        let p = d.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5122, "normalized": true, "count": 4,
            "type": "VEC3", "min": [-32767, -32767, 0], "max": [32767, 32767, 0]}),
        );
        d.json["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"] = json!(p);
        let uv: [[u8; 4]; 4] = [[0, 255, 0, 0], [255, 255, 0, 0], [255, 0, 0, 0], [0, 0, 0, 0]];
        let view = d.view(&uv.concat());
        d.json["bufferViews"][view]["byteStride"] = json!(4);
        d.json["bufferViews"][view]["target"] = json!(34962);
        let t = d.push("accessors", json!({"bufferView": view, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2"}));
        d.json["meshes"][mesh]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(t);
        let texture = d.texture(
            2,
            &[[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255; 4]],
            json!({"magFilter": 9728}),
        );
        let m = d.push(
            "materials",
            json!({"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": texture}}}),
        );
        d.json["meshes"][mesh]["primitives"][0]["material"] = json!(m);
    });
    assert_eq!(covered(&d).len(), 400);
    let uv = read(&d).at(0.5, 0.5).uv[0];
    assert!((uv - Vec2::new(0.75, 0.25)).length() < 1e-6, "{uv}");
}

#[test]
fn interleaved_attributes() {
    let mut d = Doc::new();
    let q = quad();
    let mut bytes = Vec::new();
    for (p, n) in q.positions.iter().zip(&q.normals) {
        bytes.extend(p.iter().chain(n).flat_map(|v| v.to_le_bytes()));
    }
    let view = d.view(&bytes);
    d.json["bufferViews"][view]["byteStride"] = json!(24);
    d.json["bufferViews"][view]["target"] = json!(34962);
    let p = d.push(
        "accessors",
        json!({"bufferView": view, "componentType": 5126, "count": 4, "type": "VEC3",
        "min": [-1, -1, 0], "max": [1, 1, 0]}),
    );
    let n = d.push(
        "accessors",
        json!({"bufferView": view, "byteOffset": 12, "componentType": 5126, "count": 4, "type": "VEC3"}),
    );
    let i = d.indices(&q.indices);
    let mesh =
        d.push("meshes", json!({"primitives": [{"attributes": {"POSITION": p, "NORMAL": n}, "indices": i}]}));
    d.node(json!({"mesh": mesh}));
    assert_eq!(covered(&d).len(), 400);
    assert_eq!(read(&d).at(0.1, 0.1).shading.z, Vec3A::Z);
}

#[test]
fn morph_targets_and_skins_stand_in_the_pose_of_the_file() {
    // The upper edge is pulled down to y = 0 by half of a target that would take it to −1.
    let morphed = with(|d, mesh| {
        let target = d.floats(&[[0.0f32; 3], [0.0; 3], [0.0, -2.0, 0.0], [0.0, -2.0, 0.0]]);
        d.json["meshes"][mesh]["primitives"][0]["targets"] = json!([{"POSITION": target}]);
        d.json["meshes"][mesh]["weights"] = json!([0.5]);
    });
    assert_eq!(covered(&morphed).len(), 200);
    // The left edge hangs on a joint that stays, the right one on a joint that has moved by −1.
    let mut d = Doc::new();
    let mesh = d.mesh(&quad(), None);
    let joints: [[u8; 4]; 4] = [[0, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0]];
    let view = d.view(&joints.concat());
    let j =
        d.push("accessors", json!({"bufferView": view, "componentType": 5121, "count": 4, "type": "VEC4"}));
    let w = d.floats(&[[1.0f32, 0.0, 0.0, 0.0]; 4]);
    let attributes = &mut d.json["meshes"][mesh]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(j);
    attributes["WEIGHTS_0"] = json!(w);
    let still = d.node(json!({"name": "root", "children": [1]}));
    let moved = d.push("nodes", json!({"translation": [-1, 0, 0]}));
    let skin = d.push("skins", json!({"joints": [still, moved]}));
    // The node's own placement must not count.
    d.node(json!({"mesh": mesh, "skin": skin}));
    assert_eq!(covered(&d).len(), 200);
}
