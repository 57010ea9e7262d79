//! What the later checks need to know of buffers, views and accessors, read once.

use std::collections::HashSet;

use serde_json::Value;

use super::values::{index_of, list, text_of, whole_of};

/// A type of component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    pub(super) fn new(code: u64) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Bytes.
    pub(super) fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The least and the greatest value.
    pub(super) fn range(self) -> (f64, f64) {
        match self {
            Self::I8 => (-128.0, 127.0),
            Self::U8 => (0.0, 255.0),
            Self::I16 => (-32768.0, 32767.0),
            Self::U16 => (0.0, 65535.0),
            Self::U32 => (0.0, 4_294_967_295.0),
            Self::F32 => (f64::from(f32::MIN), f64::from(f32::MAX)),
        }
    }

    /// One component from its bytes.
    pub(super) fn read(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Self::I8 => f64::from(i8::from_le_bytes(bytes.first_chunk().copied()?)),
            Self::U8 => f64::from(u8::from_le_bytes(bytes.first_chunk().copied()?)),
            Self::I16 => f64::from(i16::from_le_bytes(bytes.first_chunk().copied()?)),
            Self::U16 => f64::from(u16::from_le_bytes(bytes.first_chunk().copied()?)),
            Self::U32 => f64::from(u32::from_le_bytes(bytes.first_chunk().copied()?)),
            Self::F32 => f64::from(f32::from_le_bytes(bytes.first_chunk().copied()?)),
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::I8 => "BYTE",
            Self::U8 => "UNSIGNED_BYTE",
            Self::I16 => "SHORT",
            Self::U16 => "UNSIGNED_SHORT",
            Self::U32 => "UNSIGNED_INT",
            Self::F32 => "FLOAT",
        }
    }
}

/// Columns and rows of an element; vectors are one column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    pub columns: u64,
    pub rows: u64,
}

pub(super) const SCALAR: Shape = Shape { columns: 1, rows: 1 };
pub(super) const VEC2: Shape = Shape { columns: 1, rows: 2 };
pub(super) const VEC3: Shape = Shape { columns: 1, rows: 3 };
pub(super) const VEC4: Shape = Shape { columns: 1, rows: 4 };
pub(super) const MAT4: Shape = Shape { columns: 4, rows: 4 };

impl Shape {
    fn new(name: &str) -> Option<Self> {
        Some(match name {
            "SCALAR" => SCALAR,
            "VEC2" => VEC2,
            "VEC3" => VEC3,
            "VEC4" => VEC4,
            "MAT2" => Self { columns: 2, rows: 2 },
            "MAT3" => Self { columns: 3, rows: 3 },
            "MAT4" => MAT4,
            _ => return None,
        })
    }

    pub(super) fn is_matrix(self) -> bool {
        self.columns > 1
    }

    pub(super) fn components(self) -> u64 {
        self.columns.saturating_mul(self.rows)
    }
}

/// What an element of an accessor is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Format {
    pub shape: Shape,
    pub component: Component,
    pub normalized: bool,
}

impl Format {
    pub(super) const fn new(shape: Shape, component: Component, normalized: bool) -> Self {
        Self { shape, component, normalized }
    }

    /// Bytes of a column: those of matrices begin at multiples of 4.
    pub(super) fn column(&self) -> u64 {
        let bytes = self.shape.rows.saturating_mul(self.component.size());
        if self.shape.is_matrix() { bytes.next_multiple_of(4) } else { bytes }
    }

    /// Bytes of an element.
    pub(super) fn size(&self) -> u64 {
        self.column().saturating_mul(self.shape.columns)
    }

    /// Bytes that the last element needs: its last column is not padded.
    pub(super) fn last(&self) -> u64 {
        let padding = self.column().saturating_sub(self.shape.rows.saturating_mul(self.component.size()));
        self.size().saturating_sub(padding)
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let shape = match (self.shape.columns, self.shape.rows) {
            (1, 1) => "SCALAR".into(),
            (1, rows) => format!("VEC{rows}"),
            (columns, _) => format!("MAT{columns}"),
        };
        let normalized = if self.normalized { " normalized" } else { "" };
        write!(f, "{shape} of {}{normalized}", self.component.name())
    }
}

/// What a view is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ViewUse {
    Vertices,
    Indices,
    Image,
    Matrices,
    Other,
}

/// What an accessor is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AccessorUse {
    Attribute,
    Indices,
    Matrices,
    AnimationInput,
    AnimationOutput,
}

/// A buffer view.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub buffer: Option<usize>,
    pub offset: u64,
    pub length: u64,
    pub stride: Option<u64>,
    pub usage: Option<ViewUse>,
    /// The accessor of vertices that used it first.
    pub first: Option<usize>,
}

/// Half of a sparse accessor.
#[derive(Clone, Copy, Debug)]
pub(super) struct SparsePart {
    pub view: Option<usize>,
    pub offset: u64,
}

/// The sparse part of an accessor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sparse {
    pub count: u64,
    pub component: Option<Component>,
    pub indices: SparsePart,
    pub values: SparsePart,
}

/// An accessor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Accessor {
    pub view: Option<usize>,
    pub offset: u64,
    pub count: u64,
    /// None if its type is not known.
    pub format: Option<Format>,
    pub bounded: bool,
    pub sparse: Option<Sparse>,
    pub usage: Option<AccessorUse>,
}

/// The document.
pub(super) struct Model<'v> {
    pub root: &'v Value,
    used: HashSet<&'v str>,
    pub views: Vec<View>,
    pub accessors: Vec<Accessor>,
}

impl<'v> Model<'v> {
    pub(super) fn new(root: &'v Value) -> Self {
        Self {
            root,
            used: list(root, "extensionsUsed").iter().filter_map(Value::as_str).collect(),
            views: list(root, "bufferViews").iter().map(view).collect(),
            accessors: list(root, "accessors").iter().map(accessor).collect(),
        }
    }

    pub(super) fn list(&self, key: &str) -> &'v [Value] {
        list(self.root, key)
    }

    /// The view of an accessor.
    pub(super) fn view_of(&self, accessor: &Accessor) -> Option<View> {
        self.views.get(accessor.view?).copied()
    }

    /// Whether the document declares an extension.
    pub(super) fn uses(&self, extension: &str) -> bool {
        self.used.contains(extension)
    }
}

fn view(value: &Value) -> View {
    let usage = match whole_of(value, "target") {
        Some(34962) => Some(ViewUse::Vertices),
        Some(34963) => Some(ViewUse::Indices),
        _ => None,
    };
    View {
        buffer: index_of(value, "buffer"),
        offset: whole_of(value, "byteOffset").unwrap_or(0),
        length: whole_of(value, "byteLength").unwrap_or(0),
        stride: whole_of(value, "byteStride"),
        usage,
        first: None,
    }
}

fn accessor(value: &Value) -> Accessor {
    let component = whole_of(value, "componentType").and_then(Component::new);
    let shape = text_of(value, "type").and_then(Shape::new);
    let normalized = value.get("normalized").and_then(Value::as_bool).unwrap_or(false);
    let sparse = value.get("sparse").filter(|s| s.is_object()).map(|s| {
        let part = |name: &str| SparsePart {
            view: s.get(name).and_then(|p| index_of(p, "bufferView")),
            offset: s.get(name).and_then(|p| whole_of(p, "byteOffset")).unwrap_or(0),
        };
        let code = s.get("indices").and_then(|i| whole_of(i, "componentType"));
        Sparse {
            count: whole_of(s, "count").unwrap_or(0),
            component: code.and_then(Component::new),
            indices: part("indices"),
            values: part("values"),
        }
    });
    Accessor {
        view: index_of(value, "bufferView"),
        offset: whole_of(value, "byteOffset").unwrap_or(0),
        count: whole_of(value, "count").unwrap_or(0),
        format: component.zip(shape).map(|(c, s)| Format::new(s, c, normalized)),
        bounded: value.get("min").is_some() && value.get("max").is_some(),
        sparse,
        usage: None,
    }
}
