//! Documents that are large or odd in every way.

use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::super::*;
use super::structure::{valid, with};

#[test]
fn the_work_grows_with_the_document() {
    let chain: Vec<Value> = (0..100_000).map(|i| json!({"children": [i + 1]})).chain([json!({})]).collect();
    let tangled: Vec<Value> =
        (0..30).map(|i| json!({"children": [i + 1, i + 1]})).chain([json!({})]).collect();
    let ring: Vec<Value> = (0..100_000).map(|i| json!({"children": [(i + 1) % 100_000]})).collect();
    let star: Vec<Value> = (0..100_000).map(|_| json!({"children": [7]})).collect();
    let accessors: Vec<Value> =
        (0..100_000).map(|_| json!({"componentType": 5126, "type": "VEC3", "count": 1, "min": [0, 0, 0], "max": [0, 0, 0]})).collect();
    let primitives: Vec<Value> =
        (0..100_000).map(|_| json!({"attributes": {"POSITION": 0}, "material": 0, "indices": 2})).collect();
    let skinned: Vec<Value> =
        (0..50_000).map(|_| json!({"mesh": 1, "skin": 0})).chain([json!({}), json!({})]).collect();
    let scenes: Vec<Value> = (0..1000).map(|_| json!({"nodes": (0..100).collect::<Vec<_>>()})).collect();
    for (what, root) in [
        ("a chain", with(&[("/nodes", json!(chain))])),
        ("a tangle", with(&[("/nodes", json!(tangled))])),
        ("a ring", with(&[("/nodes", json!(ring))])),
        ("a star", with(&[("/nodes", json!(star))])),
        ("accessors", with(&[("/accessors", json!(accessors))])),
        ("primitives", with(&[("/meshes/0/primitives", json!(primitives))])),
        ("skins", with(&[("/nodes", json!(skinned)), ("/scenes", json!(scenes))])),
    ] {
        let start = Instant::now();
        let issues = structure(&root);
        let took = start.elapsed();
        assert!(took < Duration::from_secs(2), "{what} took {took:?}");
        assert!(issues.len() <= 1001, "{what}: {} issues", issues.len());
        drop(root);
    }
}

#[test]
fn of_many_issues_the_first_are_kept() {
    let nodes: Vec<Value> = (0..5000).map(|_| json!({"camera": 9})).collect();
    let issues = structure(&with(&[("/nodes", json!(nodes))]));
    assert_eq!(issues.len(), 1001);
    let last = issues.last().expect("many");
    assert_eq!((last.code, last.severity, last.harmless), ("MORE_ISSUES", Severity::Error, false));
    let nodes: Vec<Value> = (0..5000).map(|_| json!({"odd": 9})).collect();
    let last = structure(&json!({"asset": {"version": "2.0"}, "nodes": nodes})).pop().expect("many");
    assert_eq!((last.code, last.severity, last.harmless), ("MORE_ISSUES", Severity::Warning, true));
}

/// Every value of a document, one after the other, made into something else.
#[test]
fn no_change_of_any_value_stops_the_check() {
    struct Nothing;
    impl Bytes for Nothing {
        fn view(&self, _: usize) -> Option<&[u8]> {
            Some(&[0xFF; 7])
        }
        fn total(&self) -> u64 {
            7
        }
    }
    fn pointers(value: &Value, at: String, out: &mut Vec<String>) {
        out.push(at.clone());
        match value {
            Value::Array(a) => a.iter().enumerate().for_each(|(i, v)| pointers(v, format!("{at}/{i}"), out)),
            Value::Object(o) => o.iter().for_each(|(k, v)| pointers(v, format!("{at}/{k}"), out)),
            _ => {}
        }
    }
    let mut places = Vec::new();
    pointers(&valid(), String::new(), &mut places);
    let odd = [
        json!(null),
        json!(-1),
        json!(u64::MAX),
        json!(1e300),
        json!(0.5),
        json!([]),
        json!({}),
        json!("x"),
        json!([[0], {}, "y", -1]),
        json!({"extensions": {"KHR_materials_unlit": 1}}),
        json!(true),
    ];
    for place in &places {
        for value in &odd {
            let mut root = valid();
            *root.pointer_mut(place).expect("it is there") = value.clone();
            structure(&root);
            data(&root, &Nothing);
            image(&root, 0, b"\xff\xd8\xff");
            buffer(&root, 0, Some(&[0; 3]), true);
        }
    }
}
