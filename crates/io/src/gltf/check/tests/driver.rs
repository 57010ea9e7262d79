//! All checks over a file with its neighbours, as a loader makes them.

use std::path::Path;

use serde_json::Value;

use super::super::*;
use crate::{FolderResolver, Resolver};

/// The buffers of a document.
pub(super) struct Buffers<'v> {
    root: &'v Value,
    buffers: Vec<Option<Vec<u8>>>,
}

impl Bytes for Buffers<'_> {
    fn view(&self, index: usize) -> Option<&[u8]> {
        let view = values::list(self.root, "bufferViews").get(index)?;
        let buffer = self.buffers.get(values::index_of(view, "buffer")?)?.as_ref()?;
        let offset = values::index_of(view, "byteOffset").unwrap_or(0);
        buffer.get(offset..offset.checked_add(values::index_of(view, "byteLength")?)?)
    }

    fn total(&self) -> u64 {
        self.buffers.iter().flatten().map(|b| b.len() as u64).sum()
    }
}

fn data_uri(uri: &str) -> Option<Vec<u8>> {
    use base64::Engine;
    let (_, body) = uri.split_once(";base64,")?;
    let engine = base64::engine::GeneralPurpose::new(
        &base64::alphabet::STANDARD,
        base64::engine::GeneralPurposeConfig::new()
            .with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent),
    );
    engine.decode(body).ok()
}

/// Everything that is wrong with a file.
pub(super) fn issues(path: &Path) -> Vec<Issue> {
    let bytes = std::fs::read(path).expect("the file is there");
    issues_of(&bytes, path.extension().is_some_and(|e| e == "glb"), &FolderResolver::beside(path))
}

pub(super) fn issues_of(bytes: &[u8], binary: bool, files: &dyn Resolver) -> Vec<Issue> {
    let mut out = Vec::new();
    let (json, bin) = if binary {
        match glb(bytes) {
            Ok(glb) => {
                out.extend(glb.warnings);
                (glb.json, glb.bin)
            }
            Err(issue) => return vec![issue],
        }
    } else {
        (bytes, None)
    };
    let root = match text(json, 1 << 23) {
        Ok(text) => {
            out.extend(text.warnings);
            text.root
        }
        Err(issue) => return vec![issue],
    };
    out.extend(structure(&root));
    let mut buffers = Vec::new();
    for (i, value) in values::list(&root, "buffers").iter().enumerate() {
        let loaded = match values::text_of(value, "uri") {
            Some(uri) if uri.starts_with("data:") => data_uri(uri),
            Some(uri) if uri.contains(':') => None,
            Some(uri) => match files.read(uri, 1 << 28) {
                Ok(bytes) => {
                    out.extend(buffer(&root, i, Some(&bytes), false));
                    Some(bytes)
                }
                Err(e) => {
                    let pointer = format!("/buffers/{i}/uri");
                    out.push(Issue::error("IO_ERROR", pointer, e.to_string()));
                    None
                }
            },
            None if binary && i == 0 => {
                out.extend(buffer(&root, i, bin, true));
                bin.map(<[u8]>::to_vec)
            }
            None => None,
        };
        buffers.push(loaded);
    }
    let buffers = Buffers { root: &root, buffers };
    out.extend(data(&root, &buffers));
    for (i, value) in values::list(&root, "images").iter().enumerate() {
        let loaded = match values::text_of(value, "uri") {
            Some(uri) if uri.starts_with("data:") => data_uri(uri),
            Some(uri) if uri.contains(':') => None,
            Some(uri) => files.read(uri, 1 << 28).map(Some).unwrap_or_else(|e| {
                out.push(Issue::error("IO_ERROR", format!("/images/{i}/uri"), e.to_string()));
                None
            }),
            None => values::index_of(value, "bufferView").and_then(|v| buffers.view(v)).map(<[u8]>::to_vec),
        };
        if let Some(bytes) = loaded {
            out.extend(image(&root, i, &bytes));
        }
    }
    out
}
