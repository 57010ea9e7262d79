//! One tiny document for each rule of nodes, skins, animations, cameras and lights.

use serde_json::{Value, json};

use super::super::*;
use super::structure::{expect, table, with};

#[test]
fn nodes_scenes_and_skins() {
    table(&[
        ("/nodes/4/rotation", json!([0, 0, 0, 0.5]), "ROTATION_NON_UNIT", ""),
        (
            "/nodes/4/matrix",
            json!([1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
            "NODE_MATRIX_NON_TRS",
            "",
        ),
        ("/nodes/4/children", json!([4]), "NODE_LOOP", "/nodes/4"),
        ("/nodes/4/children", json!([3]), "NODE_LOOP", "/nodes/3"),
        ("/nodes/4/children", json!([1]), "NODE_PARENT_OVERRIDE", "/nodes/4/children/0"),
        ("/scenes/0/nodes", json!([1]), "SCENE_NON_ROOT_NODE", "/scenes/0/nodes/0"),
        ("/nodes/0/weights", json!([1]), "NODE_WEIGHTS_INVALID", ""),
        ("/nodes/0/skin", json!(0), "NODE_SKIN_WITH_NON_SKINNED_MESH", "/nodes/0"),
        ("/nodes/4/mesh", json!(1), "NODE_SKINNED_MESH_WITHOUT_SKIN", "/nodes/4"),
        ("/scenes/0/nodes", json!([2]), "NODE_SKIN_NO_SCENE", "/nodes/2"),
        ("/skins/0/joints", json!([3, 0]), "SKIN_NO_COMMON_ROOT", "/skins/0/joints"),
        ("/skins/0/skeleton", json!(4), "SKIN_SKELETON_INVALID", ""),
        ("/skins/0/inverseBindMatrices", json!(4), "SKIN_IBM_INVALID_FORMAT", ""),
        ("/skins/0/joints", json!([3, 4, 0]), "INVALID_IBM_ACCESSOR_COUNT", "/skins/0/inverseBindMatrices"),
    ]);
    let both = with(&[
        ("/nodes/4/matrix", json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])),
        ("/nodes/4/scale", json!([1, 1, 1])),
    ]);
    expect(&structure(&both), "NODE_MATRIX_TRS", "/nodes/4/matrix", "both");
    assert_eq!(structure(&with(&[("/skins/0/skeleton", json!(3))])), []);
}

#[test]
fn doubled_children_are_not_harmless() {
    for (pointer, value) in [("/nodes/3/children", json!([4, 4])), ("/scenes/0/nodes", json!([0, 2, 3, 3]))] {
        let issues = structure(&with(&[(pointer, value)]));
        let doubled = issues.iter().find(|i| i.code == "DUPLICATE_ELEMENTS").expect(pointer);
        assert!(!doubled.harmless, "thirty such nodes in a row are a billion: {doubled}");
    }
}

#[test]
fn animations() {
    let sampler = "/animations/0/samplers/0";
    let channel = "/animations/0/channels/0";
    for (change, code, place) in [
        (
            (format!("{sampler}/input"), json!(0)),
            "ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT",
            format!("{sampler}/input"),
        ),
        (
            (format!("{sampler}/interpolation"), json!("CUBICSPLINE")),
            "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
            format!("{channel}/sampler"),
        ),
        (
            ("/accessors/3/min".into(), json!(null)),
            "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS",
            format!("{sampler}/input"),
        ),
        ((format!("{channel}/sampler"), json!(1)), "UNRESOLVED_REFERENCE", format!("{channel}/sampler")),
        (
            (format!("{channel}/target/path"), json!("rotation")),
            "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
            format!("{channel}/sampler"),
        ),
        (
            (format!("{channel}/target/path"), json!("weights")),
            "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS",
            format!("{channel}/target"),
        ),
        (
            ("/nodes/1/matrix".into(), json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])),
            "ANIMATION_CHANNEL_TARGET_NODE_MATRIX",
            format!("{channel}/target"),
        ),
        (
            (
                "/animations/0/channels/1".into(),
                json!({"sampler": 0, "target": {"node": 1, "path": "translation"}}),
            ),
            "ANIMATION_DUPLICATE_TARGETS",
            format!("{channel}/target"),
        ),
    ] {
        let issues = structure(&with(&[(&change.0, change.1.clone())]));
        expect(&issues, code, &place, code);
        assert!(issues.iter().filter(|i| i.severity == Severity::Error).all(|i| i.harmless), "{issues:?}");
    }
}

#[test]
fn cameras() {
    table(&[
        (
            "/cameras/0/orthographic",
            json!({"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}),
            "ONE_OF_MISMATCH",
            "/cameras/0",
        ),
        ("/cameras/0", json!({"type": "perspective"}), "UNDEFINED_PROPERTY", ""),
        ("/cameras/0/perspective/zfar", json!(0.05), "CAMERA_ZFAR_LEQUAL_ZNEAR", "/cameras/0/perspective"),
        ("/cameras/0/perspective/yfov", json!(4), "CAMERA_YFOV_GEQUAL_PI", "/cameras/0/perspective"),
        (
            "/cameras/0",
            json!({"type": "orthographic", "orthographic": {"xmag": 0, "ymag": 1, "znear": 0, "zfar": 1}}),
            "CAMERA_XMAG_YMAG_ZERO",
            "/cameras/0/orthographic/xmag",
        ),
    ]);
}

#[test]
fn lights_variants_and_instances() {
    let of = |name: &str, changes: &[(&str, Value)]| {
        let mut all = vec![("/extensionsUsed", json!([name]))];
        all.extend_from_slice(changes);
        structure(&with(&all))
    };
    let lights = |light: Value| ("/extensions", json!({"KHR_lights_punctual": {"lights": [light]}}));
    let place = "/extensions/KHR_lights_punctual/lights/0";
    let issues = of("KHR_lights_punctual", &[lights(json!({"type": "spot"}))]);
    expect(&issues, "UNDEFINED_PROPERTY", place, "a spot without angles");
    let spot = json!({"type": "spot", "spot": {"innerConeAngle": 1, "outerConeAngle": 0.5}});
    let issues = of("KHR_lights_punctual", &[lights(spot)]);
    let code = "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES";
    expect(&issues, code, &format!("{place}/spot/outerConeAngle"), "angles");
    let node = |light: u64| ("/nodes/0/extensions", json!({"KHR_lights_punctual": {"light": light}}));
    let issues = of("KHR_lights_punctual", &[node(0)]);
    expect(&issues, "UNSATISFIED_DEPENDENCY", "/nodes/0/extensions/KHR_lights_punctual", "no lights");
    let issues = of("KHR_lights_punctual", &[lights(json!({"type": "point"})), node(1)]);
    expect(&issues, "UNRESOLVED_REFERENCE", "/nodes/0/extensions/KHR_lights_punctual/light", "no such light");
    assert_eq!(of("KHR_lights_punctual", &[lights(json!({"type": "point"})), node(0)]), []);

    let variants = ("/extensions", json!({"KHR_materials_variants": {"variants": [{"name": "a"}]}}));
    let twice = json!([{"material": 0, "variants": [0]}, {"material": 0, "variants": [0]}]);
    let primitive =
        ("/meshes/0/primitives/0/extensions", json!({"KHR_materials_variants": {"mappings": twice}}));
    let issues = of("KHR_materials_variants", &[variants, primitive]);
    let place = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/1/variants/0";
    expect(&issues, "KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT", place, "twice");

    let instances = |attributes: Value| {
        ("/nodes/0/extensions", json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}}))
    };
    let place = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    assert_eq!(of("EXT_mesh_gpu_instancing", &[instances(json!({"TRANSLATION": 0, "ROTATION": 4}))]), []);
    let issues = of("EXT_mesh_gpu_instancing", &[instances(json!({"TRANSLATION": 4}))]);
    let code = "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT";
    expect(&issues, code, &format!("{place}/TRANSLATION"), "a format");
    let issues = of("EXT_mesh_gpu_instancing", &[instances(json!({"SCALE": 0, "TRANSLATION": 7}))]);
    expect(&issues, "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", &format!("{place}/TRANSLATION"), "counts");
}
