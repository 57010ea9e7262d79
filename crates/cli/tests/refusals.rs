//! Words that cannot be followed: said before any work, with the cure.

mod common;

use common::Bench;

#[test]
fn bad_flags_name_their_cure() {
    let b = Bench::new("flags");
    for (words, says) in [
        ("--size 10x0", "WIDTHxHEIGHT"),
        ("--size 10", "WIDTHxHEIGHT"),
        ("--spp 0", "from 1"),
        ("--spp many", "from 1"),
        ("--shard 5/3", "I from 1 to N"),
        ("--shard 0/3", "I from 1 to N"),
        ("--shard 9/20 --spp 2", "at most 2 parts"),
        ("--threads 0", "from 1"),
        ("--filter lanczos", "mitchell"),
        ("--filter box:-1", "radius"),
        ("--time 0s", "10s"),
        ("--time soon", "10s"),
        ("--time 1s --sampler stratified", "--spp"),
        ("--time 1s --shard 1/2", "--spp"),
        ("--sampler magic", "sobol"),
        ("--integrator magic", "path"),
        ("--aov albedo,nothing", "normal"),
        ("--exposure nan", "-64 to 64"),
        ("--camera front", "the scene has none"),
        ("--camera 3", "the scene has none"),
        ("-o a.jpg", ".exr, .png, .hdr or .film"),
        ("-o a", ".exr, .png, .hdr or .film"),
        ("-o nowhere/a.png", "create it first"),
        ("-o a.png -o a.png", "once"),
        ("--json nowhere/a.json", "create it first"),
    ] {
        let e = b.bad(&format!("render a.obj {words}"), 2);
        assert!(e.contains(says), "{words}: {e}");
    }
    assert_eq!(b.names(), ["a.mtl", "a.obj"], "nothing is written");
    std::fs::create_dir(b.path("folder.png")).expect("a folder");
    let e = b.bad("render a.obj -o folder.png", 2);
    assert!(e.contains("folder"), "{e}");
}

#[test]
fn bad_files_are_named() {
    let b = Bench::new("files");
    let e = b.bad("render missing.obj", 1);
    assert!(e.contains("missing.obj"), "{e}");
    b.write("a.xyz", "nothing");
    let e = b.bad("render a.xyz", 1);
    assert!(e.contains("a.xyz") && e.contains(".obj"), "{e}");
    b.write("bad.obj", "v 1 2 3\nf 1 2 99\n");
    let e = b.bad("render bad.obj", 1);
    assert!(e.contains("bad.obj, line 2"), "{e}");
    let e = b.bad("render a.obj --resume a.obj", 1);
    assert!(e.contains("not a film"), "{e}");
    let e = b.bad("merge a.obj -o a.film", 1);
    assert!(e.contains("not a film"), "{e}");
    let e = b.bad("compare a.obj a.obj", 1);
    assert!(e.contains("a.obj"), "{e}");
    b.bad("merge -o a.film", 2);
    b.bad("merge a.film", 2);
    b.bad("", 2);
    b.bad("nonsense", 2);
    let [help, _] = b.good("render --help");
    assert!(help.contains("--max-depth") && help.contains("--shard"), "{help}");
    b.good("--version");
}

#[cfg(unix)]
#[test]
fn a_folder_that_takes_no_files_is_refused_before_rendering() {
    use std::os::unix::fs::PermissionsExt;
    let b = Bench::new("readonly");
    let folder = b.path("locked");
    std::fs::create_dir(&folder).expect("a folder");
    let mode =
        |m| std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(m)).expect("permissions");
    mode(0o555);
    // Root may write anywhere.
    if std::fs::File::create(folder.join("x")).is_err() {
        let e = b.bad("render a.obj -o locked/a.png", 2);
        assert!(e.contains("no file can be written"), "{e}");
    }
    mode(0o755);
}

#[test]
fn a_full_disk_is_an_error_and_no_panic() {
    let b = Bench::new("closed");
    // Standard output that cannot take the result: the exit status says so.
    if let Ok(full) = std::fs::File::options().write(true).open("/dev/full") {
        let out = std::process::Command::new(env!("CARGO_BIN_EXE_etendue"))
            .current_dir(b.folder())
            .args(["render", "a.obj", "--size", "4x4", "--spp", "1"])
            .stdout(full)
            .output()
            .expect("the program runs");
        assert_eq!(out.status.code(), Some(1));
        assert!(!String::from_utf8_lossy(&out.stderr).contains("panicked"));
    }
}
