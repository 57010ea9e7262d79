//! Odd and hostile pictures from outside, where they are at hand: set `ETENDUE_SHARED` to the folder above `corpus`.
#![cfg(all(feature = "png", feature = "exr", feature = "hdr", feature = "obj"))]

use std::path::{Path, PathBuf};
use std::time::Duration;

use etendue_io::{ImageBudget, Limits, decode_texture, read_picture, read_picture_bytes};
use etendue_texture::Encoding;

fn files(folder: &Path, out: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.filter_map(|e| Some(e.ok()?.path())) {
        if path.is_dir() {
            files(&path, out);
        } else if path
            .extension()
            .is_some_and(|e| ["png", "jpg", "webp", "hdr", "exr"].iter().any(|x| e == *x))
        {
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
        let limits = Limits::default();
        let said = match read_picture(&owned, &limits) {
            Ok(p) => {
                assert_eq!(p.rgb.len(), p.width as usize * p.height as usize);
                format!("Ok: {} x {}, {}", p.width, p.height, p.layers.join(" "))
            }
            Err(e) => {
                let (name, said) = (owned.display().to_string(), e.to_string());
                assert!(said.contains(&name), "the error does not name the file: {said}");
                format!("Err: {}", said.replace(&name, "…"))
            }
        };
        let bytes = std::fs::read(&owned).expect("the corpus is readable");
        let picture = read_picture_bytes(&bytes, &limits).is_ok();
        let texture = decode_texture(&bytes, Encoding::Linear, &mut ImageBudget::new(&limits));
        // A texture must be finite; a picture may hold anything.
        assert!(picture || texture.is_err());
        let _ = send.send(said);
    });
    match receive.recv_timeout(Duration::from_secs(20)) {
        Ok(said) => {
            worker.join().expect("it has sent its outcome");
            said
        }
        Err(std::sync::mpsc::RecvTimeoutError::Timeout) => panic!("{}: more than 20 s", path.display()),
        Err(_) => panic!("{}: {:?}", path.display(), worker.join().err()),
    }
}

#[test]
fn every_picture_of_the_corpus_is_read_or_refused() {
    let Some(shared) = std::env::var_os("ETENDUE_SHARED").map(PathBuf::from) else {
        println!("ETENDUE_SHARED is not set: skipped");
        return;
    };
    let corpus = shared.join("corpus");
    let mut found = Vec::new();
    for folder in ["exr", "hdr", "png", "image-ok", "crafted/exr", "crafted/hdr", "crafted/png"] {
        files(&corpus.join(folder), &mut found);
    }
    assert!(found.len() > 200, "only {} files in {}", found.len(), corpus.display());
    let mut refused = 0;
    for path in &found {
        let said = outcome(path);
        refused += usize::from(said.starts_with("Err"));
        println!("{}: {said}", path.strip_prefix(&corpus).unwrap_or(path).display());
    }
    println!("{} read, {refused} refused", found.len() - refused);
}
