//! Buffers, views and accessors: do they fit into one another?

use serde_json::Value;

use super::model::{Accessor, AccessorUse, Component, Format, Model, SparsePart, ViewUse};
use super::report::{At, Report};
use super::uri::{self, Uri};
use super::values::{is_whole, list, shown, text_of, whole_of};

/// Checks buffers, buffer views and accessors.
pub(super) fn check(model: &Model<'_>, report: &mut Report) {
    let array = At::Root.key("buffers");
    for (i, buffer) in model.list("buffers").iter().enumerate() {
        check_buffer(buffer, &array.index(i), report);
    }
    let array = At::Root.key("bufferViews");
    for i in 0..model.views.len() {
        check_view(model, i, &array.index(i), report);
    }
    let array = At::Root.key("accessors");
    for (i, (accessor, value)) in model.accessors.iter().zip(model.list("accessors")).enumerate() {
        check_accessor(model, accessor, value, &array.index(i), report);
    }
}

fn check_buffer(buffer: &Value, at: &At<'_>, report: &mut Report) {
    let Some(text) = text_of(buffer, "uri") else { return };
    let here = at.key("uri");
    let Some(Uri::Data(data)) = uri::check(text, &here, report) else { return };
    if !["application/octet-stream", "application/gltf-buffer"].contains(&data.mime.as_str()) {
        return report.error("BUFFER_DATA_URI_MIME_TYPE_INVALID", &here, || {
            format!(
                "the media type is '{}'; it must be application/octet-stream or application/gltf-buffer",
                super::values::short(&data.mime)
            )
        });
    }
    if let Some(declared) = whole_of(buffer, "byteLength").filter(|n| *n > data.length) {
        report.error("BUFFER_BYTE_LENGTH_MISMATCH", at, || too_short(declared, data.length));
    }
}

pub(super) fn too_short(declared: u64, actual: u64) -> String {
    format!(
        "its data are {actual} bytes but 'byteLength' says {declared}; the file is cut off or for another scene"
    )
}

fn check_view(model: &Model<'_>, index: usize, at: &At<'_>, report: &mut Report) {
    let Some(view) = model.views.get(index).copied() else { return };
    if let Some(stride) = view.stride {
        let here = at.key("byteStride");
        if view.length > 0 && stride > view.length {
            report.error("BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", &here, || {
                format!("the stride of {stride} is more than the {} bytes of the view", view.length)
            });
        }
        if view.usage == Some(ViewUse::Indices) {
            report.error("BUFFER_VIEW_INVALID_BYTE_STRIDE", &here, || {
                "only views of vertices have a stride; leave it out".into()
            });
        }
    }
    let buffer = view.buffer.and_then(|b| model.list("buffers").get(b));
    let Some(length) = buffer.and_then(|b| whole_of(b, "byteLength")) else { return };
    if view.offset >= length && view.offset > 0 {
        report.error("BUFFER_VIEW_TOO_LONG", &at.key("byteOffset"), || {
            format!("it begins at byte {} of a buffer of {length}", view.offset)
        });
    } else if view.offset.checked_add(view.length).is_none_or(|end| end > length) {
        report.error("BUFFER_VIEW_TOO_LONG", &at.key("byteLength"), || {
            format!("{} bytes from byte {} do not fit in a buffer of {length}", view.length, view.offset)
        });
    }
}

fn check_accessor(model: &Model<'_>, accessor: &Accessor, value: &Value, at: &At<'_>, report: &mut Report) {
    let Some(format) = accessor.format else { return };
    if format.normalized && matches!(format.component, Component::F32 | Component::U32) {
        report.error("ACCESSOR_NORMALIZED_INVALID", &at.key("normalized"), || {
            "only components of 8 or 16 bits are normalized; leave it out".into()
        });
    }
    for name in ["min", "max"] {
        check_bounds(value, name, &format, at, report);
    }
    let size = format.component.size();
    if format.shape.is_matrix() {
        if !accessor.offset.is_multiple_of(4) {
            report.error("ACCESSOR_MATRIX_ALIGNMENT", &at.key("byteOffset"), || {
                format!("the offset {} of matrices is not a multiple of 4", accessor.offset)
            });
        }
    } else if accessor.offset.checked_rem(size) != Some(0) {
        report.error("ACCESSOR_OFFSET_ALIGNMENT", &at.key("byteOffset"), || {
            format!("the offset {} is not a multiple of the component's {size} bytes", accessor.offset)
        });
    }
    if let Some(view) = model.view_of(accessor) {
        if let Some(stride) = view.stride.filter(|s| *s < format.size()) {
            report.error("ACCESSOR_SMALL_BYTESTRIDE", at, || {
                format!("its elements have {} bytes but the view's stride is {stride}", format.size())
            });
        }
        let part = SparsePart { view: accessor.view, offset: accessor.offset };
        fits(model, &part, &format, accessor.count, at, report);
    }
    let Some(sparse) = accessor.sparse else { return };
    let at = at.key("sparse");
    if sparse.count > accessor.count {
        report.error("ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", &at.key("count"), || {
            format!("it replaces {} elements of {}", sparse.count, accessor.count)
        });
    }
    let indices = sparse.component.map(|c| Format::new(super::model::SCALAR, c, false));
    for (name, part, format) in
        [("indices", sparse.indices, indices), ("values", sparse.values, Some(format))]
    {
        let here = at.key(name);
        let Some(view) = part.view.and_then(|v| model.views.get(v)) else { continue };
        if view.stride.is_some() {
            report.error("BUFFER_VIEW_INVALID_BYTE_STRIDE", &here.key("bufferView"), || {
                "only views of vertices have a stride; leave it out".into()
            });
        }
        if let Some(format) = format {
            // Values of a sparse accessor are packed.
            fits(model, &part, &format, sparse.count, &here, report);
        }
    }
}

/// Whether so many elements are in a view, at places where they can be read.
fn fits(model: &Model<'_>, part: &SparsePart, format: &Format, count: u64, at: &At<'_>, report: &mut Report) {
    let Some((index, view)) = part.view.and_then(|v| Some((v, model.views.get(v)?))) else { return };
    let size = format.component.size();
    let total = view.offset.saturating_add(part.offset);
    if total.checked_rem(size) != Some(0) {
        report.error("ACCESSOR_TOTAL_OFFSET_ALIGNMENT", at, || {
            format!(
                "it begins at byte {total} of the buffer, which is not a multiple of the component's {size}"
            )
        });
    }
    let stride = view.stride.unwrap_or(format.size());
    let length = count.saturating_sub(1).saturating_mul(stride).saturating_add(if count == 0 {
        0
    } else {
        format.last()
    });
    let message = || {
        format!(
            "{count} elements from byte {} need {length} bytes, but view {index} has {}",
            part.offset, view.length
        )
    };
    if part.offset >= view.length && part.offset > 0 {
        report.error("ACCESSOR_TOO_LONG", &at.key("byteOffset"), message);
    } else if part.offset.saturating_add(length) > view.length {
        report.error("ACCESSOR_TOO_LONG", at, message);
    }
}

fn check_bounds(value: &Value, name: &str, format: &Format, at: &At<'_>, report: &mut Report) {
    let here = at.key(name);
    let bounds = list(value, name);
    let wanted = format.shape.components();
    if !bounds.is_empty() && bounds.len() as u64 != wanted {
        return report.error("ARRAY_LENGTH_NOT_IN_LIST", &here, || {
            format!("{} numbers where there must be {wanted}", bounds.len())
        });
    }
    if format.component == Component::F32 {
        return;
    }
    let (least, most) = format.component.range();
    for (i, bound) in bounds.iter().enumerate() {
        let Some(x) = bound.as_f64() else { continue };
        if !is_whole(bound) {
            report.error("ARRAY_TYPE_MISMATCH", &here, || {
                format!("{} in it, where a whole number must be", shown(bound))
            });
        } else if x < least || x > most {
            report.error("INVALID_GL_VALUE", &here.index(i), || {
                format!("{} is out of the component's range of {least} to {most}", shown(bound))
            });
        }
    }
}

/// Notes what a view is used for: only one thing.
pub(super) fn use_view(
    model: &mut Model<'_>,
    view: Option<usize>,
    usage: ViewUse,
    at: &At<'_>,
    report: &mut Report,
) {
    let Some(view) = view.and_then(|v| model.views.get_mut(v)) else { return };
    let first = *view.usage.get_or_insert(usage);
    if first != usage {
        report.error("BUFFER_VIEW_TARGET_OVERRIDE", at, || {
            format!("the buffer view holds {} already and cannot hold {} too", of_view(first), of_view(usage))
        });
    }
}

/// Notes what an accessor is used for: only one thing.
pub(super) fn use_accessor(
    model: &mut Model<'_>,
    accessor: usize,
    usage: AccessorUse,
    at: &At<'_>,
    report: &mut Report,
) {
    let Some(accessor) = model.accessors.get_mut(accessor) else { return };
    let first = *accessor.usage.get_or_insert(usage);
    if first != usage {
        report.error("ACCESSOR_USAGE_OVERRIDE", at, || {
            format!("the accessor is used for {} already and cannot be for {} too", of(first), of(usage))
        });
    }
}

fn of_view(usage: ViewUse) -> &'static str {
    match usage {
        ViewUse::Vertices => "vertices",
        ViewUse::Indices => "indices",
        ViewUse::Image => "an image",
        ViewUse::Matrices => "inverse bind matrices",
        ViewUse::Other => "other data",
    }
}

fn of(usage: AccessorUse) -> &'static str {
    match usage {
        AccessorUse::Attribute => "vertices",
        AccessorUse::Indices => "indices",
        AccessorUse::Matrices => "inverse bind matrices",
        AccessorUse::AnimationInput => "times of an animation",
        AccessorUse::AnimationOutput => "values of an animation",
    }
}
