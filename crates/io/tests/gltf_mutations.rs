//! Damaged glTF: whatever is wrong with a document, it is a scene that builds or an error that names its file.
#![cfg(feature = "gltf")]

#[path = "common/documents.rs"]
mod documents;
#[path = "common/mutate.rs"]
mod mutate;

use std::cell::Cell;
use std::time::{Duration, Instant};

use documents::Document;
use etendue_io::gltf::{GltfError, read};
use etendue_io::{Limits, LoadOptions, NoFiles};
use etendue_scene::SceneBuilder;
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

/// What a file of a hundred kilobytes has a right to.
const LIMITS: Limits = Limits {
    file_bytes: 1 << 24,
    line_bytes: 1 << 16,
    image_side: 1 << 10,
    image_bytes: 4 << 20,
    all_image_bytes: 16 << 20,
    image_ratio: 1000,
    json_values: 1 << 16,
    node_depth: 256,
    instances: 1 << 10,
    vertices: 1 << 18,
    emitters: 1 << 12,
};

/// Far more than any of them takes.
const PATIENCE: Duration = Duration::from_secs(20);

fn options(lenient: bool, variant: bool) -> LoadOptions<'static> {
    LoadOptions {
        limits: LIMITS,
        lenient,
        variant: variant.then(|| "night".into()),
        ..LoadOptions::default()
    }
}

/// Loads and builds; whether both went well.
#[allow(clippy::disallowed_methods)] // A test may ask the clock.
fn load(bytes: &[u8], lenient: bool, variant: bool) -> Result<bool, TestCaseError> {
    let start = Instant::now();
    let mut b = SceneBuilder::new();
    let loaded = match read("fuzzed.gltf", bytes, &NoFiles, &options(lenient, variant), &mut b) {
        Ok(loaded) => {
            for camera in &loaded.cameras {
                // A camera may be out of range; it must say so.
                let _ = camera.at_size(etendue_core::UVec2::new(8, 8));
            }
            let built = b.build();
            prop_assert!(built.is_ok(), "what loads builds: {:?}", built.err());
            true
        }
        Err(e) => {
            prop_assert!(e.to_string().contains("fuzzed.gltf"), "the error does not name the file: {e}");
            false
        }
    };
    prop_assert!(start.elapsed() < PATIENCE, "it took {:?}", start.elapsed());
    Ok(loaded)
}

/// Damage to the document's values.
fn values(cases: u32) {
    let all = documents::all();
    // Little damage more often than much, most of which the first check already refuses.
    let bytes = |range| prop::collection::vec(any::<u8>(), range);
    let dice = prop_oneof![3 => bytes(4..10), 1 => bytes(10..40)];
    let whole = Cell::new(0);
    let some = (any::<prop::sample::Index>(), dice, any::<[bool; 3]>());
    check(cases, some, |(which, dice, [lenient, glb, variant])| {
        let document = which.get(&all).damaged(&dice);
        let loaded = load(&if glb { document.glb() } else { document.gltf() }, lenient, variant)?;
        whole.set(whole.get() + u32::from(loaded));
        Ok(())
    });
    // Without those that load the damage would say nothing of what lies behind the checks.
    println!("{} of {cases} damaged documents load", whole.get());
    assert!(whole.get() > cases / 10);
}

/// What damage does to the bytes of a `.glb`.
#[derive(Clone, Debug)]
enum Damage {
    Flip(u8),
    Truncate,
    Remove(usize),
    Insert(u8),
    /// The length of the file, of the first chunk or of the second becomes another.
    Lie(usize, u32),
}

fn damage() -> impl Strategy<Value = Damage> {
    let length = prop_oneof![Just(0), Just(u32::MAX), Just(i32::MAX as u32), 0u32..4096];
    prop_oneof![
        4 => (0u8..8).prop_map(|bit| Damage::Flip(1 << bit)),
        1 => Just(Damage::Truncate),
        1 => (1usize..40).prop_map(Damage::Remove),
        1 => any::<u8>().prop_map(Damage::Insert),
        2 => (0usize..3, length).prop_map(|(which, length)| Damage::Lie(which, length)),
    ]
}

fn damage_bytes(bytes: &mut Vec<u8>, at: prop::sample::Index, damage: &Damage) {
    if bytes.is_empty() {
        return;
    }
    let at = at.index(bytes.len());
    match *damage {
        Damage::Flip(bits) => bytes[at] ^= bits,
        Damage::Truncate => bytes.truncate(at),
        Damage::Remove(n) => drop(bytes.drain(at..(at + n).min(bytes.len()))),
        Damage::Insert(b) => bytes.insert(at, b),
        Damage::Lie(which, length) => {
            let first =
                bytes.get(12..16).map_or(0, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
            let at = [8, 12, first.saturating_add(20)][which];
            if let Some(word) = bytes.get_mut(at..at.saturating_add(4)) {
                word.copy_from_slice(&length.to_le_bytes());
            }
        }
    }
}

/// Damage to the container's bytes.
fn bytes(cases: u32) {
    let all: Vec<Vec<u8>> = documents::all().iter().map(Document::glb).collect();
    let some = prop::collection::vec((any::<prop::sample::Index>(), damage()), 1..6);
    check(cases, (any::<prop::sample::Index>(), some, any::<bool>()), |(which, some, lenient)| {
        let mut bytes = which.get(&all).clone();
        some.iter().for_each(|(at, damage)| damage_bytes(&mut bytes, *at, damage));
        load(&bytes, lenient, false).map(drop)
    });
}

fn check<S: Strategy>(cases: u32, strategy: S, test: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    let config = ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    TestRunner::new(config).run(&strategy, test).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_undamaged_documents_load() {
    for (i, document) in documents::all().iter().enumerate() {
        for bytes in [document.gltf(), document.glb()] {
            let mut b = SceneBuilder::new();
            let loaded = read("fuzzed.gltf", &bytes, &NoFiles, &options(false, false), &mut b);
            let loaded = loaded.unwrap_or_else(|e| panic!("document {i}: {e}"));
            assert!(loaded.report.triangles > 0, "document {i}");
            b.build().unwrap_or_else(|e| panic!("document {i}: {e}"));
        }
    }
    let night = read(
        "fuzzed.gltf",
        &documents::all()[4].gltf(),
        &NoFiles,
        &options(false, true),
        &mut SceneBuilder::new(),
    );
    assert!(night.is_ok());
    let none = read(
        "fuzzed.gltf",
        &documents::all()[1].gltf(),
        &NoFiles,
        &options(false, true),
        &mut SceneBuilder::new(),
    );
    assert!(matches!(none, Err(GltfError::Variant { .. })));
}

/// Loads the document with a texture in every slot, one value of it another.
fn with(pointer: &str, value: serde_json::Value, lenient: bool) -> Vec<String> {
    let mut json: serde_json::Value = serde_json::from_slice(&documents::all()[4].gltf()).unwrap();
    *json.pointer_mut(pointer).expect(pointer) = value;
    let mut b = SceneBuilder::new();
    let bytes = serde_json::to_vec(&json).unwrap();
    let loaded = read("fuzzed.gltf", &bytes, &NoFiles, &options(lenient, false), &mut b).unwrap();
    b.build().unwrap();
    loaded.report.warnings
}

#[test]
fn light_beyond_what_numbers_hold_is_left_out() {
    let pointer = "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";
    let warnings = with(pointer, 1e300.into(), false);
    assert!(warnings.iter().any(|w| w.contains("'/materials/0': its light is beyond")));
    // Less than none is none.
    with(pointer, (-1.0).into(), true);
}

#[test]
fn colours_out_of_range_are_clamped() {
    with(
        "/materials/2/pbrMetallicRoughness",
        serde_json::json!({"baseColorFactor": [-1, 1e300, 0.5, 1]}),
        true,
    );
}

#[test]
fn damaged_values_never_panic() {
    values(64);
}

#[test]
fn damaged_bytes_never_panic() {
    bytes(64);
}

#[test]
#[ignore = "a long run"]
fn damaged_values_never_panic_at_length() {
    values(20_000);
}

#[test]
#[ignore = "a long run"]
fn damaged_bytes_never_panic_at_length() {
    bytes(20_000);
}
