//! Against the verdicts of the Khronos validator on its own test files, and over other files from outside, where they
//! are at hand: set `ETENDUE_SHARED` to the folder above `corpus`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::super::*;
use super::driver::issues;

fn corpus() -> Option<PathBuf> {
    let shared = std::env::var_os("ETENDUE_SHARED").map(PathBuf::from);
    if shared.is_none() {
        println!("ETENDUE_SHARED is not set: skipped");
    }
    Some(shared?.join("corpus"))
}

fn files(folder: &Path, out: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).expect("the corpus").map(|e| e.expect("an entry").path()) {
        if path.is_dir() {
            files(&path, out);
        } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            out.push(path);
        }
    }
    out.sort();
}

/// Code and place of the issues of a severity.
fn ours(issues: &[Issue], severity: Severity) -> BTreeSet<(String, String)> {
    let place = |i: &Issue| if i.code.starts_with("GLB_") { String::new() } else { i.pointer.clone() };
    issues.iter().filter(|i| i.severity == severity).map(|i| (i.code.to_owned(), place(i))).collect()
}

fn theirs(report: &Value, severity: u64) -> BTreeSet<(String, String)> {
    let messages = report["issues"]["messages"].as_array().expect("a report has messages");
    let place = |m: &Value| match m["pointer"].as_str() {
        // The validator writes the whole document in two ways.
        Some("/") | None => String::new(),
        Some(pointer) => pointer.to_owned(),
    };
    let of = messages.iter().filter(|m| m["severity"].as_u64() == Some(severity));
    of.map(|m| (m["code"].as_str().expect("a code").to_owned(), place(m))).collect()
}

#[test]
fn the_verdicts_are_those_of_the_khronos_validator() {
    let Some(corpus) = corpus() else { return };
    let (mut same, mut alike, mut warnings, mut all) = (0, 0, 0, 0);
    let mut refused = Vec::new();
    let mut found = Vec::new();
    files(&corpus.join("gltf/khronos-validator"), &mut found);
    for path in &found {
        let report = path
            .with_file_name(format!("{}.report.json", path.file_name().expect("a file").to_string_lossy()));
        let report: Value =
            serde_json::from_slice(&std::fs::read(report).expect("each file has a report")).expect("JSON");
        let name = path.strip_prefix(&corpus).expect("in the corpus").display();
        let invalid = report["issues"]["numErrors"].as_u64() != Some(0);
        let issues = issues(path);
        let errors = ours(&issues, Severity::Error);
        all += 1;
        same += u32::from(invalid != errors.is_empty());
        if !invalid && !errors.is_empty() {
            refused.push(name.to_string());
        }
        let expected = theirs(&report, 0);
        alike += u32::from(errors == expected);
        if invalid == errors.is_empty() {
            println!("{name}: ours {errors:?}, theirs {expected:?}");
        } else if errors != expected {
            let missing: Vec<_> = expected.difference(&errors).collect();
            let extra: Vec<_> = errors.difference(&expected).collect();
            println!("{name}: same verdict, other codes: missing {missing:?}, extra {extra:?}");
        }
        let (mine, other) = (ours(&issues, Severity::Warning), theirs(&report, 1));
        warnings += u32::from(mine == other);
        if mine != other {
            println!("{name}: other warnings: ours {mine:?}, theirs {other:?}");
        }
    }
    println!(
        "{all} files: {same} with the same verdict, {alike} with the same codes and places of errors, {warnings} of warnings"
    );
    assert!(all > 300, "only {all} files");
    assert!(refused.is_empty(), "valid files refused: {refused:?}");
    assert!(same * 100 >= all * 97, "{same} of {all} verdicts agree");
}

#[test]
fn no_file_of_the_corpus_takes_long() {
    let Some(corpus) = corpus() else { return };
    for folder in ["crafted/gltf", "gltf/gltf-transform", "gltf/bevy"] {
        let mut found = Vec::new();
        files(&corpus.join(folder), &mut found);
        assert!(found.len() > 5, "{folder} is empty");
        for path in &found {
            let start = Instant::now();
            let issues = issues(path);
            let took = start.elapsed();
            let name = path.strip_prefix(&corpus).expect("in the corpus").display();
            let errors: Vec<String> = issues
                .iter()
                .filter(|i| i.severity == Severity::Error)
                .map(|i| format!("{}{i}", if i.harmless { "(harmless) " } else { "" }))
                .collect();
            println!("{name}: {took:.0?}, {} errors {:?}", errors.len(), &errors[..errors.len().min(4)]);
            assert!(took < Duration::from_secs(1), "{name} took {took:?}");
        }
    }
}
