//! The strict check of a glTF 2.0 document against the specification, before anything is made of it. The codes are
//! those of the Khronos validator, with whose verdicts on its own test files this check is compared.

mod animations;
mod attributes;
mod core_types;
mod data;
mod extension_types;
mod glb;
mod graph;
mod harmless;
mod instancing;
mod kinds;
mod materials;
mod meshes;
mod model;
mod nodes;
mod picture;
mod report;
mod rules;
mod schema;
mod storage;
mod text;
mod uri;
mod values;

#[cfg(test)]
mod tests;

use serde_json::Value;

pub(crate) use data::{Bytes, data};
pub(crate) use glb::glb;
pub(crate) use picture::image;
pub(crate) use report::{Issue, Severity};
pub(crate) use text::text;

/// Checks a document by itself: the JSON schema and how its parts refer to one another.
pub(crate) fn structure(root: &Value) -> Vec<Issue> {
    let mut report = report::Report::default();
    let Some(object) = root.as_object() else {
        report.error("TYPE_MISMATCH", &report::At::Root, || {
            format!("{} where the document, an object, must be", values::shown(root))
        });
        return report.finish();
    };
    schema::check(object, root, &mut report);
    let mut model = model::Model::new(root);
    rules::check_asset(root, &mut report);
    storage::check(&model, &mut report);
    let mimes = rules::check_images(&mut model, &mut report);
    materials::check_textures(&model, &mimes, &mut report);
    let made = materials::check(&model, &mut report);
    let meshes = meshes::check(&mut model, &made, &mut report);
    materials::check_variants(&model, &mut report);
    nodes::check(&mut model, &meshes, &mut report);
    animations::check(&mut model, &meshes, &mut report);
    instancing::check(&model, &mut report);
    rules::check_cameras(&model, &mut report);
    rules::check_lights(&model, &mut report);
    report.finish()
}

/// Checks the bytes of a buffer against its `byteLength`; `bin` says that they are the chunk of a GLB. No bytes at
/// all are a chunk that is missing.
pub(crate) fn buffer(root: &Value, index: usize, bytes: Option<&[u8]>, bin: bool) -> Option<Issue> {
    let declared = values::whole_of(values::list(root, "buffers").get(index)?, "byteLength")?;
    let pointer = format!("/buffers/{index}");
    let Some(actual) = bytes.map(|b| b.len() as u64) else {
        let message = "the buffer has no 'uri' and the file no binary chunk; its data are missing".into();
        return Some(Issue::error("BUFFER_MISSING_GLB_DATA", pointer, message));
    };
    if actual < declared {
        let message = storage::too_short(declared, actual);
        return Some(Issue::error("BUFFER_BYTE_LENGTH_MISMATCH", pointer, message));
    }
    // The chunk is padded to a multiple of 4.
    if bin && actual.saturating_sub(declared) > 3 {
        let message = format!("the binary chunk has {actual} bytes but the buffer {declared}");
        return Some(Issue::warning("BUFFER_GLB_CHUNK_TOO_BIG", pointer, message));
    }
    None
}
