//! Documents that are nearly valid: no change stops the checks, and what they let pass can be relied on.

use proptest::prelude::*;
use serde_json::{Value, json};

use super::super::*;
use super::structure::valid;

#[path = "../../../../tests/common/mutate.rs"]
mod mutate;

/// The valid document with data behind it, and the extensions.
fn rich() -> Value {
    let mut root = valid();
    for (i, (offset, stride)) in [(0, 12), (0, 12), (40, 8), (64, 4), (0, 16)].into_iter().enumerate() {
        root["accessors"][i]["bufferView"] = json!(i % 2);
        root["accessors"][i]["byteOffset"] = json!(offset % 32 + stride % 4);
    }
    root["accessors"][7]["sparse"] = json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5121},
        "values": {"bufferView": 1, "byteOffset": 4}});
    root["extensionsUsed"] = json!([
        "KHR_lights_punctual",
        "KHR_texture_transform",
        "EXT_mesh_gpu_instancing",
        "KHR_materials_variants",
        "KHR_materials_clearcoat"
    ]);
    root["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": 0.5}}]},
        "KHR_materials_variants": {"variants": [{"name": "a"}]}});
    root["nodes"][4]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
    root["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}});
    root["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 0}]);
    root["meshes"][0]["primitives"][0]["extensions"] =
        json!({"KHR_materials_variants": {"mappings": [{"material": 0, "variants": [0]}]}});
    root["materials"][0]["extensions"] = json!({"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 0,
        "extensions": {"KHR_texture_transform": {"texCoord": 1}}}}});
    root
}

struct Noise<'v>(&'v Value, Vec<u8>);

impl Bytes for Noise<'_> {
    fn view(&self, index: usize) -> Option<&[u8]> {
        let view = values::list(self.0, "bufferViews").get(index)?;
        let offset = values::index_of(view, "byteOffset").unwrap_or(0);
        self.1.get(offset..offset.checked_add(values::index_of(view, "byteLength")?)?)
    }

    fn total(&self) -> u64 {
        self.1.len() as u64
    }
}

/// What a loader relies on, worked out in wide numbers and without the check's own code.
fn relied_on(root: &Value) {
    let none = Vec::new();
    let list = |key: &str| root[key].as_array().unwrap_or(&none);
    let whole = |v: &Value| v.as_f64().map(|x| x as u128);
    for view in list("bufferViews") {
        let buffer = &list("buffers")[whole(&view["buffer"]).expect("a buffer") as usize];
        let end = whole(&view["byteOffset"]).unwrap_or(0) + whole(&view["byteLength"]).expect("a length");
        assert!(end <= whole(&buffer["byteLength"]).expect("a length"), "{view}");
    }
    for accessor in list("accessors") {
        let components = match accessor["type"].as_str() {
            Some("SCALAR") => 1,
            Some("VEC2") => 2,
            Some("VEC3") => 3,
            Some("VEC4") => 4,
            Some("MAT4") => 16,
            _ => continue,
        };
        let size = match whole(&accessor["componentType"]) {
            Some(5120 | 5121) => 1,
            Some(5122 | 5123) => 2,
            Some(5125 | 5126) => 4,
            _ => continue,
        };
        let Some(index) = whole(&accessor["bufferView"]) else { continue };
        let view = &list("bufferViews")[index as usize];
        let stride = whole(&view["byteStride"]).unwrap_or(components * size);
        let count = whole(&accessor["count"]).expect("a count");
        let end = whole(&accessor["byteOffset"]).unwrap_or(0) + (count - 1) * stride + components * size;
        assert!(end <= whole(&view["byteLength"]).expect("a length"), "{accessor} in {view}");
    }
    let mut parents = vec![0; list("nodes").len()];
    for child in list("nodes").iter().flat_map(|n| n["children"].as_array().unwrap_or(&none)) {
        parents[whole(child).expect("an index") as usize] += 1;
    }
    assert!(parents.iter().all(|n| *n <= 1), "a node has two parents");
    for start in 0..parents.len() {
        let mut below = vec![start];
        for _ in 0..=parents.len() {
            let children = |n: &usize| list("nodes")[*n]["children"].as_array().cloned().unwrap_or_default();
            below = below.iter().flat_map(children).map(|c| whole(&c).expect("an index") as usize).collect();
        }
        assert!(below.is_empty(), "node {start} is on a loop or above one");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, rng_seed: proptest::test_runner::RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_passes_can_be_relied_on(seed in prop::collection::vec(any::<u8>(), 3..40)) {
        let mut root = rich();
        mutate::mutate(&mut root, &mut mutate::Dice::new(&seed));
        let issues = structure(&root);
        prop_assert!(issues.len() <= 1001);
        if !issues.iter().any(|i| i.severity == Severity::Error && !i.harmless) {
            relied_on(&root);
        }
        let noise: Vec<u8> = seed.iter().cycle().take(128).copied().collect();
        prop_assert!(data(&root, &Noise(&root, noise)).len() <= 1001);
        image(&root, 0, &seed);
        let again = text(root.to_string().as_bytes(), 1 << 20).map(|t| t.root);
        prop_assert_eq!(again, Ok(root));
    }

    #[test]
    fn any_bytes_are_a_container_or_not(bytes in prop::collection::vec(any::<u8>(), 0..64), length in any::<u32>()) {
        let _ = glb(&bytes);
        let framed = [b"glTF\x02\0\0\0", &length.to_le_bytes()[..], &bytes].concat();
        let _ = glb(&framed);
        let _ = text(&bytes, 100);
    }
}
