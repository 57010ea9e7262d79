//! What is in the accessors.

use serde_json::{Value, json};

use super::super::*;
use super::structure::expect;

struct Bytes8(Vec<Vec<u8>>);

impl Bytes for Bytes8 {
    fn view(&self, index: usize) -> Option<&[u8]> {
        Some(self.0.get(index)?)
    }

    fn total(&self) -> u64 {
        self.0.iter().map(|b| b.len() as u64).sum()
    }
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// The issues of a document with one view for each accessor.
fn found(mut root: Value, views: Vec<Vec<u8>>) -> Vec<Issue> {
    root["bufferViews"] = views.iter().map(|b| json!({"buffer": 0, "byteLength": b.len()})).collect();
    data(&root, &Bytes8(views))
}

fn accessor(view: usize, component: u64, ty: &str, count: usize) -> Value {
    json!({"bufferView": view, "componentType": component, "type": ty, "count": count})
}

#[test]
fn numbers_and_bounds() {
    let of = |values: &[f32], extra: Value| {
        let mut a = accessor(0, 5126, "SCALAR", values.len());
        for (key, value) in extra.as_object().expect("an object") {
            a[key] = value.clone();
        }
        found(json!({"accessors": [a]}), vec![floats(values)])
    };
    assert_eq!(of(&[0.0, 1.0], json!({"min": [0], "max": [1]})), []);
    assert_eq!(of(&[0.1, 1.0], json!({"min": [0.1], "max": [1.0]})), [], "0.1 as a float");
    expect(&of(&[f32::NAN], json!({})), "ACCESSOR_INVALID_FLOAT", "/accessors/0", "NaN");
    expect(&of(&[f32::INFINITY], json!({})), "ACCESSOR_INVALID_FLOAT", "/accessors/0", "infinity");
    expect(&of(&[0.0], json!({"min": [-1]})), "ACCESSOR_MIN_MISMATCH", "/accessors/0/min/0", "lower");
    expect(
        &of(&[0.0], json!({"min": [1]})),
        "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND",
        "/accessors/0/min/0",
        "higher",
    );
    expect(&of(&[0.0], json!({"max": [1]})), "ACCESSOR_MAX_MISMATCH", "/accessors/0/max/0", "higher");
    expect(
        &of(&[2.0], json!({"max": [1]})),
        "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND",
        "/accessors/0/max/0",
        "lower",
    );
}

#[test]
fn sparse_elements() {
    let of = |base: Option<usize>, numbers: &[u8], max: f64| {
        let mut a = json!({"componentType": 5126, "type": "SCALAR", "count": 3, "max": [max], "sparse": {
            "count": numbers.len(), "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}}});
        if let Some(view) = base {
            a["bufferView"] = json!(view);
        }
        let views = vec![floats(&[1.0, 2.0, 3.0]), numbers.to_vec(), floats(&[7.0, 8.0])];
        found(json!({"accessors": [a]}), views)
    };
    assert_eq!(of(Some(0), &[0, 2], 8.0), []);
    assert_eq!(of(Some(0), &[0], 7.0), []);
    assert_eq!(of(None, &[1], 7.0), []);
    expect(&of(None, &[1], 6.0), "ACCESSOR_MAX_MISMATCH", "/accessors/0/max/0", "max");
    let place = "/accessors/0/sparse/indices";
    expect(&of(None, &[1, 1], 8.0), "ACCESSOR_SPARSE_INDICES_NON_INCREASING", place, "order");
    expect(&of(None, &[1, 3], 8.0), "ACCESSOR_SPARSE_INDEX_OOB", place, "outside");
}

#[test]
fn indices() {
    let of = |values: &[u8]| {
        let root = json!({
            "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3}, accessor(0, 5121, "SCALAR", values.len())],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        });
        found(root, vec![values.to_vec()])
    };
    let place = "/meshes/0/primitives/0/indices";
    assert_eq!(of(&[0, 1, 2]), []);
    expect(&of(&[0, 1, 3]), "ACCESSOR_INDEX_OOB", place, "outside");
    expect(&of(&[0, 1, 255]), "ACCESSOR_INDEX_PRIMITIVE_RESTART", place, "restart");
}

#[test]
fn attributes() {
    let of = |name: &str, ty: &str, values: &[f32]| {
        let count = values.len() / if ty == "VEC4" { 4 } else { 3 };
        let root = json!({
            "accessors": [accessor(0, 5126, ty, count)],
            "meshes": [{"primitives": [{"attributes": {name: 0}}]}],
        });
        found(root, vec![floats(values)])
    };
    let place = |name: &str| format!("/meshes/0/primitives/0/attributes/{name}");
    assert_eq!(of("NORMAL", "VEC3", &[0.6, 0.0, 0.8]), []);
    assert_eq!(of("TANGENT", "VEC4", &[0.6, 0.0, 0.8, -1.0]), []);
    expect(&of("NORMAL", "VEC3", &[1.0, 1.0, 0.0]), "ACCESSOR_VECTOR3_NON_UNIT", &place("NORMAL"), "length");
    expect(&of("TANGENT", "VEC4", &[1.0, 0.0, 0.0, 0.5]), "ACCESSOR_INVALID_SIGN", &place("TANGENT"), "sign");
    expect(&of("COLOR_0", "VEC3", &[1.0, 1.5, 0.0]), "ACCESSOR_NON_CLAMPED", &place("COLOR_0"), "range");
}

#[test]
fn joints_and_weights() {
    let of = |joints: [u8; 4], weights: [f32; 4]| {
        let root = json!({
            "accessors": [accessor(0, 5121, "VEC4", 1), accessor(1, 5126, "VEC4", 1)],
            "meshes": [{"primitives": [{"attributes": {"JOINTS_0": 0, "WEIGHTS_0": 1}}]}],
            "skins": [{"joints": [0, 1, 2]}],
            "nodes": [{"mesh": 0, "skin": 0}],
        });
        found(root, vec![joints.to_vec(), floats(&weights)])
    };
    let place = |name: &str| format!("/meshes/0/primitives/0/attributes/{name}");
    assert_eq!(of([0, 1, 2, 0], [0.2, 0.3, 0.5, 0.0]), []);
    let one = [1.0, 0.0, 0.0, 0.0];
    expect(&of([3, 0, 0, 0], one), "ACCESSOR_JOINTS_INDEX_OOB", &place("JOINTS_0"), "outside");
    expect(&of([0, 1, 0, 0], one), "ACCESSOR_JOINTS_USED_ZERO_WEIGHT", &place("JOINTS_0"), "idle");
    let halves = [0.5, 0.5, 0.0, 0.0];
    expect(&of([1, 1, 0, 0], halves), "ACCESSOR_JOINTS_INDEX_DUPLICATE", &place("JOINTS_0"), "twice");
    expect(
        &of([0, 1, 0, 0], [1.5, -0.5, 0.0, 0.0]),
        "ACCESSOR_WEIGHTS_NEGATIVE",
        &place("WEIGHTS_0"),
        "sign",
    );
    expect(
        &of([0, 1, 0, 0], [0.5, 0.1, 0.0, 0.0]),
        "ACCESSOR_WEIGHTS_NON_NORMALIZED",
        &place("WEIGHTS_0"),
        "sum",
    );
}

#[test]
fn matrices_and_animations() {
    let mut matrix = [0.0f32; 16];
    for i in [0, 5, 10, 15] {
        matrix[i] = 1.0;
    }
    let skin = |m: &[f32]| {
        let root =
            json!({"accessors": [accessor(0, 5126, "MAT4", 1)], "skins": [{"inverseBindMatrices": 0}]});
        found(root, vec![floats(m)])
    };
    assert_eq!(skin(&matrix), []);
    matrix[3] = 1.0;
    expect(&skin(&matrix), "ACCESSOR_INVALID_IBM", "/skins/0/inverseBindMatrices", "row");

    let animation = |times: &[f32], q: &[f32]| {
        let root = json!({
            "accessors": [accessor(0, 5126, "SCALAR", times.len()), accessor(1, 5126, "VEC4", q.len() / 4)],
            "animations": [{"samplers": [{"input": 0, "output": 1}],
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}],
        });
        found(root, vec![floats(times), floats(q)])
    };
    let unit = [0.0, 0.0, 0.6, 0.8];
    let place = "/animations/0/samplers/0/input";
    assert_eq!(animation(&[0.0, 1.0], &unit), []);
    expect(&animation(&[-1.0], &unit), "ACCESSOR_ANIMATION_INPUT_NEGATIVE", place, "before 0");
    expect(&animation(&[1.0, 1.0], &unit), "ACCESSOR_ANIMATION_INPUT_NON_INCREASING", place, "twice");
    let code = "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION";
    expect(&animation(&[0.0], &[0.0, 0.0, 0.0, 0.5]), code, "/animations/0/channels/0/sampler", "length");
}

#[test]
fn what_cannot_be_read_is_passed_over() {
    let root = json!({
        "accessors": [
            accessor(0, 5126, "VEC3", usize::MAX), accessor(7, 5126, "VEC3", 1),
            {"bufferView": 0, "byteOffset": u64::MAX, "componentType": 5126, "type": "VEC3", "count": 1},
            {"componentType": 5126, "type": "VEC3", "count": u64::MAX},
            accessor(0, 99, "VEC9", 1),
        ],
    });
    assert_eq!(found(root, vec![floats(&[1.0; 4])]), []);
}

#[test]
fn accessors_that_overlap_do_not_multiply_the_work() {
    let all: Vec<Value> = (0..20_000).map(|_| accessor(0, 5121, "SCALAR", 1 << 20)).collect();
    let start = std::time::Instant::now();
    let issues = found(json!({"accessors": all}), vec![vec![0; 1 << 20]]);
    assert!(start.elapsed().as_secs() < 5, "{:?}", start.elapsed());
    expect(&issues, "DATA_NOT_CHECKED", "", "20,000 MiB of one");
}
