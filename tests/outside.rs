//! A bare crate outside of the workspace builds on the facade and on each crate alone.

use std::path::{Path, PathBuf};
use std::process::Command;

fn build(folder: &Path, name: &str, dependency: &str, code: &str) {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let dir = folder.join(name);
    std::fs::create_dir_all(dir.join("src")).expect("folder");
    let manifest = format!(
        "[package]\nname = \"outside-{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
         [dependencies]\n{dependency}\n"
    );
    std::fs::write(dir.join("Cargo.toml"), manifest).expect("manifest");
    std::fs::write(dir.join("src/lib.rs"), code).expect("source");
    // The same versions as ours, and nothing from the network.
    std::fs::copy(root.join("Cargo.lock"), dir.join("Cargo.lock")).expect("lock file");
    let out = Command::new(env!("CARGO"))
        .args(["check", "--offline", "--quiet"])
        .current_dir(&dir)
        .env("CARGO_TARGET_DIR", root.join("target/outside"))
        .output()
        .expect("cargo runs");
    assert!(out.status.success(), "{name}:\n{}", String::from_utf8_lossy(&out.stderr));
}

#[test]
fn a_bare_crate_builds_on_the_facade_and_on_each_crate_alone() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let folder = std::env::temp_dir().join(format!("etendue-outside-{}", std::process::id()));
    let facade = format!("etendue = {{ path = {root:?} }}");
    build(
        &folder,
        "facade",
        &facade,
        "pub use etendue::prelude::*;\npub fn scene() -> Option<Scene> { SceneBuilder::new().build().ok() }\n",
    );
    for entry in std::fs::read_dir(root.join("crates")).expect("crates") {
        let path = entry.expect("entry").path();
        // A program is nobody's dependency.
        if !path.join("src/lib.rs").exists() {
            continue;
        }
        let name = path.file_name().and_then(|n| n.to_str()).expect("name").to_owned();
        let dependency = format!("etendue-{name} = {{ path = {path:?} }}");
        build(&folder, &name, &dependency, &format!("pub use etendue_{name}::*;\n"));
    }
    std::fs::remove_dir_all(&folder).expect("clean up");
}
