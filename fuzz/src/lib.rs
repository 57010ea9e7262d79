//! What the fuzz targets share.

#[path = "../../crates/io/tests/common/documents.rs"]
mod documents;
#[path = "../../crates/io/tests/common/mutate.rs"]
mod mutate;

use etendue_io::{Limits, LoadOptions, NoFiles, ResolveError, Resolver};
use etendue_scene::SceneBuilder;

/// One file, whatever it is called.
pub struct Always<'a>(pub &'a [u8]);

impl Resolver for Always<'_> {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, ResolveError> {
        if self.0.len() as u64 > limit {
            return Err(ResolveError::TooLarge { name: name.into(), limit });
        }
        Ok(self.0.to_vec())
    }
}

/// Limits under which an input of a few kilobytes cannot take the memory that a fuzzer allows.
pub fn limits() -> Limits {
    Limits {
        line_bytes: 1 << 16,
        image_side: 1 << 12,
        image_bytes: 64 << 20,
        all_image_bytes: 128 << 20,
        json_values: 1 << 18,
        instances: 1 << 16,
        vertices: 1 << 20,
        emitters: 1 << 14,
        ..Limits::default()
    }
}

/// What loads must build; what does not must name its file.
pub fn check<T, E: std::fmt::Display>(name: &str, result: Result<T, E>, builder: SceneBuilder) {
    match result {
        Ok(_) => drop(builder.build().expect("what loads builds")),
        Err(e) => assert!(e.to_string().contains(name), "the error does not name the file: {e}"),
    }
}

/// Reads glTF as it should be and as it may be.
pub fn check_gltf(bytes: &[u8]) {
    for lenient in [false, true] {
        let options = LoadOptions { limits: limits(), lenient, ..LoadOptions::default() };
        let mut b = SceneBuilder::new();
        let result = etendue_io::gltf::read("fuzzed.gltf", bytes, &NoFiles, &options, &mut b);
        check("fuzzed.gltf", result, b);
    }
}

/// A small valid document with damage, both chosen by the bytes, as `.gltf` or `.glb`.
pub fn damaged_document(bytes: &[u8]) -> Vec<u8> {
    let (&[kind], damage) = bytes.split_first_chunk().unwrap_or((&[0], &[]));
    let all = documents::all();
    let document = all[usize::from(kind >> 1) % all.len()].damaged(damage);
    if kind & 1 == 0 { document.gltf() } else { document.glb() }
}
