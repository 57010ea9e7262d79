//! The shape of the workspace: who may use whom.

use std::collections::BTreeMap;
use std::process::Command;

use serde_json::Value;

fn metadata() -> Value {
    let out = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    serde_json::from_slice(&out.stdout).expect("cargo metadata is JSON")
}

/// What each crate may use of the workspace in its normal dependencies: exactly this, no less and no more.
const EDGES: &[(&str, &[&str])] = &[
    ("core", &[]),
    ("sampling", &["core"]),
    ("bsdf", &["core", "sampling"]),
    ("geometry", &["core", "sampling"]),
    ("bvh", &["core", "geometry"]),
    ("texture", &["core", "geometry"]),
    ("material", &["core", "geometry", "bsdf", "texture"]),
    ("light", &["core", "sampling", "geometry", "texture"]),
    ("camera", &["core", "sampling", "geometry"]),
    ("scene", &["core", "geometry", "bvh", "bsdf", "texture", "material", "light"]),
    ("integrator", &["core", "sampling", "geometry", "bsdf", "light", "camera", "scene"]),
    ("measure", &["core", "sampling", "geometry", "material", "light", "camera", "scene", "integrator"]),
];

/// Crates of the registry that only one crate may name.
const OWNERS: &[(&str, &str)] = &[
    ("obvhs", "etendue-bvh"),
    ("tobj", "etendue-io"),
    ("image", "etendue-io"),
    ("exr", "etendue-io"),
    ("gltf", "etendue-io"),
];

#[test]
fn dependency_edges_are_the_ones_of_the_design() {
    let metadata = metadata();
    let mut edges: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut normal: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in metadata["packages"].as_array().expect("packages") {
        let name = package["name"].as_str().expect("name").to_owned();
        for d in package["dependencies"].as_array().expect("dependencies") {
            let on = d["name"].as_str().expect("name").to_owned();
            if d["kind"].is_null() {
                normal.entry(name.clone()).or_default().push(on.clone());
                if let Some(short) = on.strip_prefix("etendue-") {
                    edges.entry(name.clone()).or_default().push(short.to_owned());
                }
                assert!(on != "etendue" || name == "etendue-cli", "{name} uses the facade");
                assert_ne!(on, "etendue-testkit", "{name} uses testkit outside of its tests");
            }
        }
    }
    for (name, allowed) in EDGES {
        let mut found = edges.remove(&format!("etendue-{name}")).unwrap_or_default();
        found.sort();
        let mut allowed: Vec<String> = allowed.iter().map(|s| (*s).to_owned()).collect();
        allowed.sort();
        assert_eq!(found, allowed, "edges of {name}");
    }
    for (dependency, owner) in OWNERS {
        for (name, on) in &normal {
            assert!(name == owner || !on.iter().any(|d| d == dependency), "{name} names {dependency}");
        }
    }
    for (name, on) in &normal {
        assert!(
            !on.iter().any(|d| d == "rayon")
                || ["etendue-bvh", "etendue-cli", "etendue-integrator"].contains(&name.as_str()),
            "{name} names rayon"
        );
    }
}

#[test]
fn one_version_of_glam() {
    let lock =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock")).expect("Cargo.lock");
    assert_eq!(lock.matches("\nname = \"glam\"\n").count(), 1);
}

#[test]
fn every_crate_forbids_unsafe_code() {
    for package in metadata()["packages"].as_array().expect("packages") {
        let manifest = package["manifest_path"].as_str().expect("path");
        let text = std::fs::read_to_string(manifest).expect("manifest");
        assert!(text.contains("[lints]\nworkspace = true"), "{manifest} does not take the workspace's lints");
    }
}

/// The table of topics names tests that are there.
#[test]
fn documented_tests_exist() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("docs/textbook.md")).expect("the document");
    let (mut file, mut seen) = (String::new(), 0);
    for quoted in text.split('`').skip(1).step_by(2) {
        let Some((path, name)) = quoted.split_once("::") else { continue };
        if path.ends_with(".rs") {
            file = path.to_owned();
        } else if !path.is_empty() {
            continue;
        }
        let source = std::fs::read_to_string(root.join(&file)).unwrap_or_else(|e| panic!("{file}: {e}"));
        assert!(source.contains(&format!("fn {name}(")), "{file} has no test {name}");
        seen += 1;
    }
    assert!(seen > 100, "{seen} tests are named");
}
