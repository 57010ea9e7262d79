//! What a scene may read: regular files below its folder, and nothing else.

mod common;

use std::path::Path;

use common::Folder;
use etendue_io::{FolderResolver, NoFiles, ResolveError, Resolver};

fn folder() -> Folder {
    let folder = Folder::new("resolver");
    folder.write("secret.txt", "outside");
    folder.write("scene/a.txt", "inside");
    folder.write("scene/sub/b.txt", "deeper");
    folder
}

#[test]
fn files_below_the_folder_are_read() {
    let folder = folder();
    let r = FolderResolver::new(folder.path().join("scene"));
    for (name, text) in
        [("a.txt", "inside"), ("./a.txt", "inside"), ("sub/b.txt", "deeper"), ("sub\\b.txt", "deeper")]
    {
        assert_eq!(r.read(name, 100).unwrap(), text.as_bytes(), "{name}");
    }
    let beside = FolderResolver::beside(&folder.path().join("scene/some.obj"));
    assert_eq!(beside.read("a.txt", 100).unwrap(), b"inside");
}

#[test]
fn names_that_lead_out_are_refused_and_named() {
    let folder = folder();
    let r = FolderResolver::new(folder.path().join("scene"));
    let absolute = folder.path().join("scene/a.txt").display().to_string();
    for name in [
        "../secret.txt",
        "..\\secret.txt",
        "sub/../../secret.txt",
        "sub/../a.txt",
        "/etc/passwd",
        "\\etc\\passwd",
        "\\\\server\\share\\a",
        &absolute,
        "C:\\a.txt",
        "c:a.txt",
        "file:///etc/passwd",
        "http://example.org/a",
        "a.txt\0.png",
        "\0",
        "",
    ] {
        match r.read(name, 100) {
            Err(ResolveError::Outside(said)) => assert_eq!(said, name),
            other => panic!("{name:?}: {other:?}"),
        }
    }
}

#[test]
fn what_is_missing_or_no_file_is_named() {
    let folder = folder();
    let r = FolderResolver::new(folder.path().join("scene"));
    for name in ["nothing.txt", "sub/nothing", "a.txt/below"] {
        let e = r.read(name, 100).expect_err(name);
        assert!(matches!(&e, ResolveError::Open { name: said, .. } if said == name), "{e}");
        assert!(e.to_string().contains(name), "{e}");
    }
    for name in ["sub", "."] {
        assert!(matches!(r.read(name, 100), Err(ResolveError::NotAFile(_))), "{name}");
    }
    let gone = FolderResolver::new(folder.path().join("no such folder"));
    assert!(matches!(gone.read("a.txt", 100), Err(ResolveError::Open { .. })));
    assert!(matches!(NoFiles.read("a.txt", 100), Err(ResolveError::Outside(_))));
}

#[test]
fn the_limit_is_exact() {
    let folder = folder();
    let r = FolderResolver::new(folder.path().join("scene"));
    assert_eq!(r.read("a.txt", 6).unwrap().len(), 6);
    assert!(matches!(r.read("a.txt", 5), Err(ResolveError::TooLarge { limit: 5, .. })));
    assert_eq!(r.read("a.txt", u64::MAX).unwrap().len(), 6);
}

#[cfg(unix)]
#[test]
fn links_are_followed_inside_and_refused_outside() {
    use std::os::unix::fs::symlink;
    let folder = folder();
    let scene = folder.path().join("scene");
    symlink(scene.join("a.txt"), scene.join("within")).unwrap();
    symlink(folder.path().join("secret.txt"), scene.join("out")).unwrap();
    symlink(folder.path(), scene.join("up")).unwrap();
    symlink("/dev/zero", scene.join("zero")).unwrap();
    symlink("nowhere", scene.join("dangling")).unwrap();
    let r = FolderResolver::new(&scene);
    assert_eq!(r.read("within", 100).unwrap(), b"inside");
    for name in ["out", "up/secret.txt", "zero"] {
        assert!(matches!(r.read(name, 100), Err(ResolveError::Outside(_))), "{name}");
    }
    assert!(matches!(r.read("dangling", 100), Err(ResolveError::Open { .. })));
    // The folder itself may be a link.
    let link = folder.path().join("link");
    symlink(&scene, &link).unwrap();
    assert_eq!(FolderResolver::new(&link).read("a.txt", 100).unwrap(), b"inside");
}

/// A device is no file even where the folder holds it: nothing is read from it.
#[cfg(target_os = "linux")]
#[test]
fn devices_are_not_read() {
    let r = FolderResolver::new("/dev");
    for name in ["zero", "null", "random"] {
        assert!(matches!(r.read(name, 100), Err(ResolveError::NotAFile(_))), "{name}");
    }
    let r = FolderResolver::beside(Path::new("/dev/some.obj"));
    assert!(matches!(r.read("zero", 100), Err(ResolveError::NotAFile(_))));
}
