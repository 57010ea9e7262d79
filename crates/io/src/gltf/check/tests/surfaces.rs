//! One tiny document for each rule of meshes, materials and pictures.

use serde_json::{Value, json};

use super::super::*;
use super::structure::{expect, table, with};

#[test]
fn images_textures_and_materials() {
    const PNG: &str = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1Pe";
    table(&[
        ("/images/0", json!({}), "ONE_OF_MISMATCH", ""),
        ("/images/0", json!({"bufferView": 0}), "UNSATISFIED_DEPENDENCY", "/images/0/bufferView"),
        ("/images/0/mimeType", json!("image/gif"), "VALUE_NOT_IN_LIST", ""),
        ("/images/0/uri", json!(format!("data:image/gif;base64,{PNG}")), "INVALID_URI", ""),
        (
            "/images/0/uri",
            json!("data:image/webp;base64,UklGRhwAAABXRUJQVlA4TA8AAAAv/8AfAAcQ"),
            "TEXTURE_INVALID_IMAGE_MIME_TYPE",
            "/textures/0/source",
        ),
        ("/materials/0/alphaCutoff", json!(0.5), "MATERIAL_ALPHA_CUTOFF_INVALID_MODE", ""),
        (
            "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord",
            json!(1),
            "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
            "/meshes/0/primitives/0/material",
        ),
        (
            "/materials/0/normalTexture",
            json!({"index": 0}),
            "MESH_PRIMITIVE_GENERATED_TANGENT_SPACE",
            "/meshes/0/primitives/0/material",
        ),
    ]);
    assert_eq!(structure(&with(&[("/images/0/uri", json!(format!("data:image/png;base64,{PNG}")))])), []);
    let strided = with(&[
        ("/bufferViews/0/byteStride", json!(4)),
        ("/images/0", json!({"bufferView": 0, "mimeType": "image/png"})),
    ]);
    expect(&structure(&strided), "IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE", "/images/0/bufferView", "stride");
}

#[test]
fn material_extensions() {
    let of = |name: &str, object: Value| {
        structure(&with(&[
            ("/extensionsUsed", json!([name])),
            ("/materials/0/extensions", Value::Object([(name.to_owned(), object)].into_iter().collect())),
        ]))
    };
    let range = "VALUE_NOT_IN_RANGE";
    for (name, object, code, place) in [
        ("KHR_materials_anisotropy", json!({"anisotropyStrength": 2}), range, "/anisotropyStrength"),
        ("KHR_materials_clearcoat", json!({"clearcoatFactor": -1}), range, "/clearcoatFactor"),
        ("KHR_materials_dispersion", json!({"dispersion": -1}), range, "/dispersion"),
        ("KHR_materials_dispersion", json!({}), "KHR_MATERIALS_DISPERSION_NO_VOLUME", ""),
        ("KHR_materials_emissive_strength", json!({"emissiveStrength": -1}), range, "/emissiveStrength"),
        ("KHR_materials_ior", json!({"ior": 0.5}), range, "/ior"),
        ("KHR_materials_iridescence", json!({"iridescenceIor": 0.5}), range, "/iridescenceIor"),
        ("KHR_materials_pbrSpecularGlossiness", json!({"glossinessFactor": 2}), range, "/glossinessFactor"),
        ("KHR_materials_sheen", json!({"sheenColorFactor": [2, 0, 0]}), range, "/sheenColorFactor/0"),
        ("KHR_materials_specular", json!({"specularFactor": 2}), range, "/specularFactor"),
        (
            "KHR_materials_transmission",
            json!({"transmissionTexture": {"index": 9}}),
            "UNRESOLVED_REFERENCE",
            "/transmissionTexture/index",
        ),
        ("KHR_materials_volume", json!({"attenuationDistance": 0}), range, "/attenuationDistance"),
        ("KHR_materials_volume", json!({}), "KHR_MATERIALS_VOLUME_NO_TRANSMISSION", ""),
    ] {
        expect(&of(name, object), code, &format!("/materials/0/extensions/{name}{place}"), name);
    }
    assert_eq!(of("KHR_materials_ior", json!({"ior": 0})), []);
    expect(
        &of("KHR_materials_clearcoat", json!({"clearcoatNormalTexture": {"index": 0}})),
        "MESH_PRIMITIVE_NO_TANGENT_SPACE",
        "/meshes/0/primitives/0/material",
        "a clearcoat's normals",
    );
}

#[test]
fn meshes() {
    let at = |what: &str| format!("/meshes/0/primitives/0{what}");
    let mesh = |primitive: Value| {
        let mut of = with(&[("/meshes/0/primitives/0", primitive)]);
        let array = of["accessors"].as_array_mut().expect("an array");
        array.push(json!({"componentType": 5126, "type": "VEC3", "count": 3}));
        array.push(json!({"componentType": 5125, "type": "VEC3", "count": 3, "bufferView": 0}));
        array.push(
            json!({"componentType": 5123, "type": "VEC3", "count": 3, "bufferView": 0, "byteOffset": 2}),
        );
        structure(&of)
    };
    for (primitive, code, place) in [
        (
            json!({"attributes": {"POSITION": 0, "FOO": 1}}),
            "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
            "/attributes/FOO",
        ),
        (
            json!({"attributes": {"POSITION": 0, "TEXCOORD_01": 1}}),
            "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
            "/attributes/TEXCOORD_01",
        ),
        (
            json!({"attributes": {"POSITION": 0, "TEXCOORD_1": 1}}),
            "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
            "/attributes",
        ),
        (
            json!({"attributes": {"POSITION": 4}}),
            "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
            "/attributes/POSITION",
        ),
        (
            json!({"attributes": {"POSITION": 8}}),
            "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
            "/attributes/POSITION",
        ),
        (
            json!({"attributes": {"POSITION": 0, "NORMAL": 7}}),
            "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
            "/attributes/NORMAL",
        ),
        (
            json!({"attributes": {"POSITION": 0, "_OWN": 9}}),
            "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
            "/attributes/_OWN",
        ),
        (
            json!({"attributes": {"POSITION": 0, "_OWN": 10}}),
            "MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
            "/attributes/_OWN",
        ),
        (
            json!({"attributes": {"POSITION": 0, "_A": 9, "_B": 10}}),
            "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
            "/attributes/_B",
        ),
        (json!({"attributes": {"TEXCOORD_0": 1}}), "MESH_PRIMITIVE_NO_POSITION", "/attributes"),
        (
            json!({"attributes": {"POSITION": 0, "TANGENT": 4}}),
            "MESH_PRIMITIVE_TANGENT_WITHOUT_NORMAL",
            "/attributes/TANGENT",
        ),
        (
            json!({"attributes": {"POSITION": 0, "JOINTS_0": 5}}),
            "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
            "/attributes",
        ),
        (
            json!({"attributes": {"POSITION": 0}, "indices": 1}),
            "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT",
            "/indices",
        ),
        (json!({"attributes": {"POSITION": 0}, "indices": 9}), "ACCESSOR_USAGE_OVERRIDE", "/indices"),
        (json!({"attributes": {"POSITION": 0}, "mode": 1}), "MESH_PRIMITIVE_INCOMPATIBLE_MODE", ""),
        (
            json!({"attributes": {"POSITION": 0}, "targets": [{"NORMAL": 8}]}),
            "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
            "/targets/0/NORMAL",
        ),
        (
            json!({"attributes": {"POSITION": 0}, "targets": [{"POSITION": 7}]}),
            "MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
            "/targets/0/POSITION",
        ),
        (
            json!({"attributes": {"POSITION": 0}, "targets": [{"JOINTS_0": 5}]}),
            "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
            "/targets/0/JOINTS_0",
        ),
    ] {
        if code == "ACCESSOR_USAGE_OVERRIDE" {
            let both = json!({"attributes": {"POSITION": 0, "_OWN": 9}, "indices": 9});
            expect(&mesh(both), code, &at(place), code);
        } else {
            expect(&mesh(primitive), code, &at(place), code);
        }
    }
    let weights = with(&[("/meshes/0/weights", json!([1]))]);
    expect(&structure(&weights), "MESH_INVALID_WEIGHTS_COUNT", "/meshes/0/weights", "weights");
    let second = json!({"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}]});
    let unequal = with(&[("/meshes/0/primitives/1", second)]);
    let place = "/meshes/0/primitives/1/targets";
    expect(&structure(&unequal), "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", place, "targets");
}

#[test]
fn quantized_meshes_need_the_extension() {
    let bytes =
        json!({"componentType": 5121, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 1]});
    let code = "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT";
    let without = with(&[("/accessors/0", bytes.clone())]);
    expect(&structure(&without), code, "/meshes/0/primitives/0/attributes/POSITION", "without");
    let names = json!(["KHR_mesh_quantization"]);
    let changes =
        [("/accessors/0", bytes), ("/extensionsUsed", names.clone()), ("/extensionsRequired", names)];
    assert_eq!(structure(&with(&changes)), []);
}
