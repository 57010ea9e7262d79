//! Every file of the shared corpus in a process of its own: 512 MiB of address space and 5 seconds. Whatever the file is,
//! there is an answer or an error, never a panic, an abort or a hang. Runs where `ETENDUE_SHARED` names the folder.

#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn corpus() -> Option<PathBuf> {
    let Some(shared) = std::env::var_os("ETENDUE_SHARED") else {
        eprintln!("skipped: ETENDUE_SHARED is not set");
        return None;
    };
    Some(PathBuf::from(shared).join("corpus"))
}

fn files(folder: &Path, endings: &[&str], out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("folder") {
        let path = entry.expect("entry").path();
        if path.is_dir() {
            files(&path, endings, out);
        } else if path
            .extension()
            .is_some_and(|e| endings.contains(&e.to_string_lossy().to_lowercase().as_str()))
        {
            out.push(path);
        }
    }
    out.sort();
}

/// `etendue info` under the limits.
fn info(path: &Path) -> Output {
    let limited = "ulimit -v 524288; exec timeout -s KILL 5 \"$0\" info \"$1\"";
    Command::new("sh")
        .args(["-c", limited, env!("CARGO_BIN_EXE_etendue")])
        .arg(path)
        .env("RAYON_NUM_THREADS", "2")
        .output()
        .expect("sh runs")
}

/// Whether the file was taken; panics where the program did not end by itself.
#[track_caller]
fn accepted(path: &Path, out: &Output) -> bool {
    let error = String::from_utf8_lossy(&out.stderr);
    match out.status.code() {
        Some(0) => true,
        Some(1) => {
            let named = path.file_name().is_some_and(|n| error.contains(&*n.to_string_lossy()));
            assert!(
                named && !error.contains("panicked"),
                "{}: '{error}' does not name the file",
                path.display()
            );
            false
        }
        code => panic!("{}: ended with {code:?}\n{error}", path.display()),
    }
}

#[test]
fn every_file_is_answered_within_its_limits() {
    let Some(corpus) = corpus() else { return };
    let endings = ["gltf", "glb", "obj", "ply", "exr", "hdr", "png", "jpg", "jpeg"];
    let mut all = Vec::new();
    files(&corpus, &endings, &mut all);
    assert!(all.len() > 900, "only {} files", all.len());
    let taken = all.iter().filter(|path| accepted(path, &info(path))).count();
    println!("{} files: {taken} taken, {} refused", all.len(), all.len() - taken);
}

#[test]
fn verdicts_are_the_validators() {
    let Some(corpus) = corpus() else { return };
    let mut all = Vec::new();
    files(&corpus.join("gltf/khronos-validator"), &["gltf", "glb"], &mut all);
    let (mut agree, mut total) = (0, 0);
    for path in &all {
        let report = PathBuf::from(format!("{}.report.json", path.display()));
        let Ok(text) = std::fs::read_to_string(&report) else { continue };
        let report: serde_json::Value = serde_json::from_str(&text).expect("report");
        let valid = report["issues"]["numErrors"].as_u64() == Some(0);
        let out = info(path);
        total += 1;
        if accepted(path, &out) == valid {
            agree += 1;
        } else {
            println!("{} (valid: {valid}): {}", path.display(), String::from_utf8_lossy(&out.stderr));
        }
    }
    println!("{agree} of {total} verdicts agree");
    assert!(total > 300 && agree * 100 >= total * 95, "{agree} of {total}");
}
