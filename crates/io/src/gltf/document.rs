//! From bytes to a checked document with its buffers.

use std::borrow::Cow;
use std::collections::HashSet;

use gltf::json::Root;
use serde_json::Value;

use super::check::{self, Issue, Severity};
use super::extensions;
use super::{GltfError, uri};
use crate::{Limits, LoadOptions, Resolver};

/// A document that has passed the checks, its buffers in memory.
pub(super) struct Document<'a> {
    pub(super) name: &'a str,
    pub(super) root: Root,
    pub(super) options: &'a LoadOptions<'a>,
    pub(super) resolver: &'a dyn Resolver,
    buffers: Vec<Cow<'a, [u8]>>,
    bytes: u64,
}

/// Buffers without the rest, for the checks of their contents.
struct Views<'a> {
    root: &'a Value,
    buffers: &'a [Cow<'a, [u8]>],
}

impl check::Bytes for Views<'_> {
    fn view(&self, index: usize) -> Option<&[u8]> {
        let view = self.root.get("bufferViews")?.get(index)?;
        let number = |key: &str| view.get(key).and_then(Value::as_u64);
        let buffer = self.buffers.get(usize::try_from(number("buffer")?).ok()?)?;
        slice(buffer, number("byteOffset").unwrap_or(0), number("byteLength")?)
    }

    fn total(&self) -> u64 {
        self.buffers.iter().fold(0, |sum, b| sum.saturating_add(b.len() as u64))
    }
}

fn slice(buffer: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let end = usize::try_from(offset.checked_add(length)?).ok()?;
    buffer.get(usize::try_from(offset).ok()?..end)
}

impl<'a> Document<'a> {
    /// Parses and checks. Faults that do not stop a picture become warnings under a lenient load.
    pub(super) fn open(
        name: &'a str,
        bytes: &'a [u8],
        resolver: &'a dyn Resolver,
        options: &'a LoadOptions<'a>,
        warnings: &mut Vec<String>,
    ) -> Result<Self, GltfError> {
        let mut judge = |issues: Vec<Issue>| judge(name, issues, options.lenient, warnings);
        let (json, chunk) = if bytes.starts_with(b"glTF") {
            let glb = check::glb(bytes).map_err(|e| refusal(name, e, String::new()))?;
            judge(glb.warnings)?;
            (glb.json, Chunk::Binary(glb.bin))
        } else {
            (bytes, Chunk::NotAGlb)
        };
        let text =
            check::text(json, options.limits.json_values).map_err(|e| refusal(name, e, String::new()))?;
        judge(text.warnings)?;
        let mut value = text.root;
        judge(check::structure(&value))?;
        extensions::required(name, &value)?;
        let buffers = load_buffers(name, &value, chunk, resolver, options, &mut judge)?;
        let views = Views { root: &value, buffers: &buffers };
        judge(check::data(&value, &views))?;
        check_images(name, &views, resolver, options, &mut judge)?;

        let bytes = buffers.iter().fold(json.len() as u64, |sum, b| sum.saturating_add(b.len() as u64));
        tidy(&mut value);
        let root = serde_json::from_value(value).map_err(|e| GltfError::Unusable {
            file: name.into(),
            pointer: String::new(),
            message: format!("the document does not have the shape of glTF 2.0: {e}"),
        })?;
        Ok(Self { name, root, options, resolver, buffers, bytes })
    }

    pub(super) fn limits(&self) -> &Limits {
        &self.options.limits
    }

    /// Bytes that the file brought.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, index: usize) -> Option<&[u8]> {
        let view = self.root.buffer_views.get(index)?;
        let buffer = self.buffers.get(view.buffer.value())?;
        slice(buffer, view.byte_offset.unwrap_or_default().0, view.byte_length.0)
    }

    pub(super) fn unusable(&self, pointer: String, message: String) -> GltfError {
        GltfError::Unusable { file: self.name.into(), pointer, message }
    }

    pub(super) fn go_on(&self) -> Result<(), GltfError> {
        if self.options.progress.cancelled() { Err(GltfError::Cancelled(self.name.into())) } else { Ok(()) }
    }
}

/// What a file brings besides its JSON.
#[derive(Clone, Copy)]
enum Chunk<'a> {
    /// It is JSON alone.
    NotAGlb,
    /// The binary chunk, if the container has one.
    Binary(Option<&'a [u8]>),
}

fn refusal(name: &str, issue: Issue, more: String) -> GltfError {
    GltfError::Invalid {
        file: name.into(),
        pointer: issue.pointer,
        code: issue.code.into(),
        message: issue.message,
        more,
    }
}

/// What the checks remark on and the loader does as the specification says: nothing that an author needs to hear.
const SILENT: &[&str] = &["MESH_PRIMITIVE_GENERATED_TANGENT_SPACE"];

/// The first fault that stops the load; the others as warnings.
fn judge(name: &str, issues: Vec<Issue>, lenient: bool, warnings: &mut Vec<String>) -> Result<(), GltfError> {
    let is_fault = |i: &Issue| i.severity == Severity::Error;
    let faults = issues.iter().filter(|i| is_fault(i)).count();
    let all_harmless = issues.iter().all(|i| i.harmless || !is_fault(i));
    for issue in issues {
        if is_fault(&issue) && !(lenient && issue.harmless) {
            let others = faults.saturating_sub(1);
            let mut more = if others > 0 { format!(" (and {others} more faults)") } else { String::new() };
            if all_harmless && !lenient {
                more.push_str("; a lenient load (--lenient) gets past it");
            }
            return Err(refusal(name, issue, more));
        }
        if !SILENT.contains(&issue.code) {
            warnings.push(format!("{name}, at '{}': {} [{}]", issue.pointer, issue.message, issue.code));
        }
    }
    Ok(())
}

fn load_buffers<'a>(
    name: &str,
    root: &Value,
    chunk: Chunk<'a>,
    resolver: &dyn Resolver,
    options: &LoadOptions<'_>,
    judge: &mut impl FnMut(Vec<Issue>) -> Result<(), GltfError>,
) -> Result<Vec<Cow<'a, [u8]>>, GltfError> {
    let mut out = Vec::new();
    let mut left = options.limits.file_bytes;
    for (i, buffer) in list(root, "buffers").iter().enumerate() {
        let bytes = match (buffer.get("uri").and_then(Value::as_str), chunk) {
            (Some(uri), _) => {
                let failed = |source| GltfError::Resource {
                    file: name.into(),
                    pointer: format!("/buffers/{i}/uri"),
                    source,
                };
                let bytes = uri::read(uri, resolver, left).map_err(failed)?;
                // Of bytes in the document itself the structure has told.
                if !uri.starts_with("data:") {
                    judge(check::buffer(root, i, Some(&bytes), false).into_iter().collect())?;
                }
                Cow::Owned(bytes)
            }
            (None, Chunk::Binary(bin)) if i == 0 => {
                judge(check::buffer(root, i, bin, true).into_iter().collect())?;
                Cow::Borrowed(bin.unwrap_or(&[]))
            }
            // A buffer without bytes: of an extension that this file can do without, or of nothing that is shown.
            (None, _) => Cow::Borrowed(&[][..]),
        };
        left = left.saturating_sub(bytes.len() as u64);
        out.push(bytes);
    }
    Ok(out)
}

/// Looks at the headers of all images, used or not, without decoding any.
fn check_images(
    name: &str,
    views: &Views<'_>,
    resolver: &dyn Resolver,
    options: &LoadOptions<'_>,
    judge: &mut impl FnMut(Vec<Issue>) -> Result<(), GltfError>,
) -> Result<(), GltfError> {
    let mut left = options.limits.file_bytes;
    let mut seen = HashSet::new();
    for (i, image) in list(views.root, "images").iter().enumerate() {
        if options.progress.cancelled() {
            return Err(GltfError::Cancelled(name.into()));
        }
        let view = image.get("bufferView").and_then(Value::as_u64).and_then(|v| usize::try_from(v).ok());
        let bytes = match image.get("uri").and_then(Value::as_str) {
            // A file that many images name is looked at once.
            Some(uri) if !seen.insert(uri) => None,
            Some(uri) => match uri::read(uri, resolver, left) {
                Ok(bytes) => {
                    left = left.saturating_sub(bytes.len() as u64);
                    Some(Cow::Owned(bytes))
                }
                // Under a lenient load it is left out, and said so, where it is used.
                Err(_) if options.lenient => None,
                Err(source) => {
                    let pointer = format!("/images/{i}/uri");
                    return Err(GltfError::Resource { file: name.into(), pointer, source });
                }
            },
            None => view.and_then(|v| check::Bytes::view(views, v)).map(Cow::Borrowed),
        };
        if let Some(bytes) = bytes {
            judge(check::image(views.root, i, &bytes))?;
        }
    }
    Ok(())
}

fn list<'v>(root: &'v Value, key: &str) -> &'v [Value] {
    root.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// Takes out what a picture does not need and what the typed layer is stricter about than the specification:
/// animations, extras, and whole numbers that are written as `1.0`.
fn tidy(value: &mut Value) {
    if let Some(root) = value.as_object_mut() {
        root.remove("animations");
        // A scene may be empty.
        for scene in root.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
            if let Some(scene) = scene.as_object_mut() {
                scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
            }
        }
    }
    let mut todo = vec![value];
    while let Some(v) = todo.pop() {
        match v {
            Value::Object(map) => {
                map.remove("extras");
                todo.extend(map.values_mut());
            }
            Value::Array(items) => todo.extend(items.iter_mut()),
            Value::Number(n) => {
                // Exact below 2⁵³.
                if let Some(f) = n.as_f64().filter(|f| n.is_f64() && f.abs() < 9e15 && *f == f.trunc()) {
                    *n = if f < 0.0 { (f as i64).into() } else { (f as u64).into() };
                }
            }
            _ => {}
        }
    }
}
