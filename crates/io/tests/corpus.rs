//! Odd and hostile files from outside, where they are at hand: set `ETENDUE_SHARED` to the folder above `corpus`.
#![cfg(feature = "obj")]

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::time::Duration;

use etendue_io::obj::read;
use etendue_io::{FolderResolver, Limits, ResolveError, Resolver};
use etendue_scene::SceneBuilder;

/// Writes down what was read.
struct Watched {
    inner: FolderResolver,
    read: RefCell<Vec<String>>,
}

impl Resolver for Watched {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, ResolveError> {
        let result = self.inner.read(name, limit);
        if result.is_ok() {
            self.read.borrow_mut().push(name.into());
        }
        result
    }
}

fn files(folder: &Path, ends: &[&str], out: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.filter_map(|e| Some(e.ok()?.path())) {
        if path.is_dir() {
            files(&path, ends, out);
        } else if path.extension().is_some_and(|e| ends.iter().any(|end| e == *end)) {
            out.push(path);
        }
    }
    out.sort();
}

/// One file on a thread of its own, with a time limit. What became of it, in words.
fn outcome(path: &Path) -> String {
    let (send, receive) = std::sync::mpsc::channel();
    let owned = path.to_owned();
    let worker = std::thread::spawn(move || {
        let name = owned.display().to_string();
        let bytes = std::fs::read(&owned).expect("the corpus is readable");
        // A material file is loaded through a scene that names it.
        let bytes = match owned.extension().and_then(|e| e.to_str()) {
            Some("mtl") => {
                let file = owned.file_name().unwrap_or_default().to_string_lossy().into_owned();
                format!("mtllib {file}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n").into_bytes()
            }
            _ => bytes,
        };
        let folder = owned.parent().expect("in a folder").canonicalize().expect("a folder");
        let resolver = Watched { inner: FolderResolver::beside(&owned), read: RefCell::default() };
        let mut b = SceneBuilder::new();
        let said = match read(&name, &bytes, &resolver, &Limits::default(), &mut b) {
            Ok(report) => match b.build() {
                Ok(scene) => format!("Ok: {}; {} warnings", scene.report(), report.warnings.len()),
                Err(e) => panic!("{name} loads but does not build: {e}"),
            },
            Err(e) => {
                assert!(e.to_string().contains(&name), "the error does not name the file: {e}");
                format!("Err: {}", e.to_string().replace(&name, "…"))
            }
        };
        for file in resolver.read.borrow().iter() {
            let real = folder.join(file.replace('\\', "/")).canonicalize().expect("it was read");
            assert!(real.starts_with(&folder), "{name} read {}", real.display());
        }
        let _ = send.send(said);
    });
    match receive.recv_timeout(Duration::from_secs(5)) {
        Ok(said) => {
            worker.join().expect("it has sent its outcome");
            said
        }
        Err(std::sync::mpsc::RecvTimeoutError::Timeout) => panic!("{}: more than 5 s", path.display()),
        Err(_) => panic!("{}: {:?}", path.display(), worker.join().err()),
    }
}

#[test]
fn every_file_of_the_corpus_gives_a_scene_or_a_typed_error() {
    let Some(shared) = std::env::var_os("ETENDUE_SHARED").map(PathBuf::from) else {
        println!("ETENDUE_SHARED is not set: skipped");
        return;
    };
    let corpus = shared.join("corpus");
    let mut found = Vec::new();
    for folder in ["obj", "crafted/obj", "crafted/mtl"] {
        files(&corpus.join(folder), &["obj", "mtl"], &mut found);
    }
    assert!(found.len() > 80, "only {} files in {}", found.len(), corpus.display());
    for path in &found {
        println!("{}: {}", path.strip_prefix(&corpus).unwrap_or(path).display(), outcome(path));
    }
}
