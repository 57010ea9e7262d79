//! One tiny document for each rule: what is put into a valid one, and what is said about it where.

use serde_json::{Value, json};

use super::super::*;

/// A document to which nothing is to say.
pub(super) fn valid() -> Value {
    json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 128}],
        "bufferViews": [{"buffer": 0, "byteLength": 64}, {"buffer": 0, "byteLength": 64, "byteOffset": 64}],
        "accessors": [
            {"componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 1]},
            {"componentType": 5126, "type": "VEC2", "count": 3},
            {"componentType": 5123, "type": "SCALAR", "count": 3},
            {"componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [1]},
            {"componentType": 5126, "type": "VEC4", "count": 3},
            {"componentType": 5123, "type": "VEC4", "count": 3},
            {"componentType": 5126, "type": "MAT4", "count": 2},
            {"componentType": 5126, "type": "VEC3", "count": 2},
        ],
        "images": [{"uri": "a.png"}],
        "samplers": [{}],
        "textures": [{"sampler": 0, "source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]},
            {"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 5, "WEIGHTS_0": 4}}]},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "nodes": [{"mesh": 0, "children": [1]}, {"camera": 0}, {"mesh": 1, "skin": 0}, {"children": [4]}, {}],
        "skins": [{"joints": [3, 4], "inverseBindMatrices": 6}],
        "scenes": [{"nodes": [0, 2, 3]}],
        "scene": 0,
        "animations": [{
            "samplers": [{"input": 3, "output": 7}],
            "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
        }],
    })
}

/// Puts values into the valid document by their pointers; the last step may be new. `null` removes.
pub(super) fn with(changes: &[(&str, Value)]) -> Value {
    let mut root = valid();
    for (pointer, value) in changes {
        let (parent, last) = pointer.rsplit_once('/').expect("a pointer");
        match root.pointer_mut(parent).expect("the parent is there") {
            Value::Array(array) => match array.get_mut(last.parse::<usize>().expect("an index")) {
                Some(slot) => *slot = value.clone(),
                None => array.push(value.clone()),
            },
            Value::Object(object) if value.is_null() => drop(object.remove(last)),
            Value::Object(object) => drop(object.insert(last.into(), value.clone())),
            _ => panic!("{pointer} is nowhere"),
        }
    }
    root
}

pub(super) fn expect(issues: &[Issue], code: &str, pointer: &str, what: &str) {
    let found = issues.iter().any(|i| i.code == code && i.pointer == pointer);
    assert!(
        found,
        "{what}: no {code} at {pointer}, but {:?}",
        issues.iter().map(Issue::to_string).collect::<Vec<_>>()
    );
}

#[test]
fn there_is_nothing_to_say_about_the_valid_document() {
    assert_eq!(structure(&valid()), []);
}

/// Each: a change, the code, and its place; the place of the change if it is empty.
pub(super) fn table(cases: &[(&str, Value, &str, &str)]) {
    for (pointer, value, code, place) in cases {
        let issues = structure(&with(&[(pointer, value.clone())]));
        expect(
            &issues,
            code,
            if place.is_empty() { pointer } else { place },
            &format!("{pointer} = {value}"),
        );
    }
}

#[test]
fn properties_are_of_their_kinds() {
    table(
        &[
            ("/asset", json!(null), "UNDEFINED_PROPERTY", "/x"),
            ("/nodes", json!({}), "TYPE_MISMATCH", ""),
            ("/nodes/4", json!(1), "TYPE_MISMATCH", ""),
            ("/scenes", json!([]), "EMPTY_ENTITY", ""),
            ("/nodes/4", json!({"children": []}), "EMPTY_ENTITY", "/nodes/4/children"),
            ("/nodes/4/name", json!(3), "TYPE_MISMATCH", ""),
            ("/nodes/4/nonsense", json!(3), "UNEXPECTED_PROPERTY", ""),
            ("/nodes/4/a~b", json!(3), "UNEXPECTED_PROPERTY", "/nodes/4/a~0b"),
            ("/nodes/4/translation", json!([1, 2]), "ARRAY_LENGTH_NOT_IN_LIST", ""),
            ("/nodes/4/translation", json!([1, 2, "3"]), "ARRAY_TYPE_MISMATCH", ""),
            ("/nodes/4/rotation", json!([0, 0, 0, 2]), "VALUE_NOT_IN_RANGE", "/nodes/4/rotation/3"),
            ("/nodes/4/camera", json!(-1), "INVALID_INDEX", ""),
            ("/nodes/4/camera", json!(0.5), "TYPE_MISMATCH", ""),
            ("/nodes/4/camera", json!(7), "UNRESOLVED_REFERENCE", ""),
            ("/nodes/4/skin", json!(0), "UNSATISFIED_DEPENDENCY", ""),
            ("/scenes/0/nodes", json!([0, 0]), "DUPLICATE_ELEMENTS", "/scenes/0/nodes/1"),
            ("/meshes/0/primitives/0", json!(1), "ARRAY_TYPE_MISMATCH", "/meshes/0/primitives"),
            ("/meshes/0/primitives/0/mode", json!(8), "VALUE_NOT_IN_LIST", ""),
            ("/meshes/0/primitives/0/attributes", json!({}), "EMPTY_ENTITY", ""),
            ("/accessors/0/type", json!("VEC5"), "VALUE_NOT_IN_LIST", ""),
            ("/accessors/0/count", json!(0), "VALUE_NOT_IN_RANGE", ""),
            ("/accessors/0/count", json!(-3), "VALUE_NOT_IN_RANGE", ""),
            ("/bufferViews/0/byteStride", json!(5), "VALUE_MULTIPLE_OF", ""),
            ("/materials/0/doubleSided", json!(1), "TYPE_MISMATCH", ""),
            ("/materials/0/extensions", json!(1), "TYPE_MISMATCH", ""),
        ][1..],
    );
    expect(&structure(&with(&[("/asset", json!(null))])), "UNDEFINED_PROPERTY", "", "no asset");
    expect(&structure(&json!([])), "TYPE_MISMATCH", "", "no object");
    assert_eq!(structure(&with(&[("/accessors/0/count", json!(3.0))])), [], "3.0 is a whole number");
}

#[test]
fn versions() {
    table(&[
        ("/asset/version", json!("1.0"), "UNKNOWN_ASSET_MAJOR_VERSION", ""),
        ("/asset/version", json!("2.1"), "UNKNOWN_ASSET_MINOR_VERSION", ""),
        ("/asset/version", json!("2"), "PATTERN_MISMATCH", ""),
        ("/asset/version", json!("+2.0"), "PATTERN_MISMATCH", ""),
        ("/asset/minVersion", json!("2.1"), "ASSET_MIN_VERSION_GREATER_THAN_VERSION", ""),
    ]);
}

#[test]
fn extensions_are_declared_and_in_their_places() {
    let unlit = json!({"KHR_materials_unlit": {}});
    table(&[
        ("/extensionsUsed", json!(["a", "a"]), "DUPLICATE_ELEMENTS", "/extensionsUsed/1"),
        ("/extensionsUsed", json!(["lower_case"]), "INVALID_EXTENSION_NAME_FORMAT", "/extensionsUsed/0"),
        ("/extensionsUsed", json!(["KHR_mesh_quantization"]), "NON_REQUIRED_EXTENSION", "/extensionsUsed/0"),
        ("/extensionsRequired", json!(["KHR_a"]), "UNSATISFIED_DEPENDENCY", ""),
        ("/extensionsRequired", json!(["KHR_a"]), "UNUSED_EXTENSION_REQUIRED", "/extensionsRequired/0"),
        (
            "/materials/0/extensions",
            unlit.clone(),
            "UNDECLARED_EXTENSION",
            "/materials/0/extensions/KHR_materials_unlit",
        ),
    ]);
    let used = ("/extensionsUsed", json!(["KHR_materials_unlit", "KHR_unknown"]));
    let issues = structure(&with(&[used.clone(), ("/nodes/0/extensions", unlit.clone())]));
    expect(&issues, "UNEXPECTED_EXTENSION_OBJECT", "/nodes/0/extensions/KHR_materials_unlit", "a node");
    assert_eq!(structure(&with(&[used.clone(), ("/materials/0/extensions", unlit)])), []);
    assert_eq!(
        structure(&with(&[used.clone(), ("/nodes/0/extensions", json!({"KHR_unknown": {"a": 1}}))])),
        []
    );
    let issues = structure(&with(&[used, ("/nodes/0/extensions", json!({"KHR_unknown": 1}))]));
    expect(&issues, "TYPE_MISMATCH", "/nodes/0/extensions/KHR_unknown", "no object");
}

#[test]
fn buffers_views_and_accessors_fit() {
    let uri = |text: &str| json!({"byteLength": 2, "uri": text});
    table(&[
        ("/buffers/0", uri("data:application/octet-stream;base64,AA=="), "BUFFER_BYTE_LENGTH_MISMATCH", ""),
        (
            "/buffers/0",
            uri("data:text/plain;base64,AAAA"),
            "BUFFER_DATA_URI_MIME_TYPE_INVALID",
            "/buffers/0/uri",
        ),
        ("/buffers/0", uri("data:application/octet-stream;;base64,AAAA"), "INVALID_URI", "/buffers/0/uri"),
        ("/buffers/0", uri("data:application/octet-stream;base64,A?AA"), "INVALID_URI", "/buffers/0/uri"),
        ("/buffers/0", uri("data:"), "INVALID_URI", "/buffers/0/uri"),
        ("/buffers/0", uri(":"), "INVALID_URI", "/buffers/0/uri"),
        ("/buffers/0", uri("http://example.com/a"), "NON_RELATIVE_URI", "/buffers/0/uri"),
        ("/bufferViews/0/byteOffset", json!(100), "BUFFER_VIEW_TOO_LONG", "/bufferViews/0/byteLength"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "BUFFER_VIEW_TOO_LONG", ""),
        ("/bufferViews/0/byteStride", json!(68), "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", ""),
        ("/accessors/0/byteOffset", json!(4), "UNSATISFIED_DEPENDENCY", ""),
        ("/accessors/0/normalized", json!(true), "ACCESSOR_NORMALIZED_INVALID", ""),
        ("/accessors/0/min", json!([0, 0]), "ARRAY_LENGTH_NOT_IN_LIST", ""),
        ("/accessors/2/min", json!([0.5]), "ARRAY_TYPE_MISMATCH", ""),
        ("/accessors/2/min", json!([-1]), "INVALID_GL_VALUE", "/accessors/2/min/0"),
    ]);
    let placed = |view: Value, accessor: Value| {
        let mut of = valid();
        of["bufferViews"][0] = view;
        let array = of["accessors"].as_array_mut().expect("an array");
        array.push(accessor);
        structure(&of)
    };
    let view = json!({"buffer": 0, "byteLength": 64});
    let vec3 = |offset: u64, count: u64| json!({"componentType": 5126, "type": "VEC3", "count": count, "bufferView": 0, "byteOffset": offset});
    for (view, accessor, code, place) in [
        (view.clone(), vec3(2, 1), "ACCESSOR_OFFSET_ALIGNMENT", "/accessors/8/byteOffset"),
        (view.clone(), vec3(2, 1), "ACCESSOR_TOTAL_OFFSET_ALIGNMENT", "/accessors/8"),
        (view.clone(), vec3(0, 6), "ACCESSOR_TOO_LONG", "/accessors/8"),
        (view.clone(), vec3(0, u64::MAX), "ACCESSOR_TOO_LONG", "/accessors/8"),
        (view.clone(), vec3(64, 1), "ACCESSOR_TOO_LONG", "/accessors/8/byteOffset"),
        (
            json!({"buffer": 0, "byteLength": 64, "byteStride": 8}),
            vec3(0, 1),
            "ACCESSOR_SMALL_BYTESTRIDE",
            "/accessors/8",
        ),
        (
            json!({"buffer": 0, "byteLength": 64, "byteStride": 4, "target": 34963}),
            vec3(0, 1),
            "BUFFER_VIEW_INVALID_BYTE_STRIDE",
            "/bufferViews/0/byteStride",
        ),
        (
            view.clone(),
            json!({"componentType": 5121, "type": "MAT3", "count": 1, "bufferView": 0, "byteOffset": 2}),
            "ACCESSOR_MATRIX_ALIGNMENT",
            "/accessors/8/byteOffset",
        ),
    ] {
        expect(&placed(view, accessor.clone()), code, place, &accessor.to_string());
    }
    let sparse = |count: u64, offset: u64| {
        json!({"componentType": 5126, "type": "VEC3", "count": 2, "sparse": {"count": count,
            "indices": {"componentType": 5123, "bufferView": 0, "byteOffset": offset}, "values": {"bufferView": 1}}})
    };
    assert_eq!(placed(view.clone(), sparse(1, 0)), []);
    let strided = json!({"buffer": 0, "byteLength": 64, "byteStride": 4});
    for (view, accessor, code, place) in [
        (view.clone(), sparse(3, 0), "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", "/accessors/8/sparse/count"),
        (view.clone(), sparse(1, 64), "ACCESSOR_TOO_LONG", "/accessors/8/sparse/indices/byteOffset"),
        (strided, sparse(1, 0), "BUFFER_VIEW_INVALID_BYTE_STRIDE", "/accessors/8/sparse/indices/bufferView"),
    ] {
        expect(&placed(view, accessor), code, place, code);
    }
}
