//! Numbers out of buffers: every size is checked before anything is allocated or read.

use std::cell::Cell;

use gltf::json::accessor::{ComponentType, Type, sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::GltfError;
use super::document::Document;

/// Elements that an accessor without any bytes may stand for beyond what the file's size vouches for.
const FREE_ZEROS: u64 = 1 << 16;

/// Reads accessors of one document under its budget.
pub(super) struct Accessors<'a> {
    doc: &'a Document<'a>,
    /// Elements that may still be read.
    left: Cell<u64>,
}

/// The bytes of one element after the other.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a [u8]> {
        // The last element may be shorter than the stride.
        self.bytes.chunks(self.stride.max(1)).take(self.count).map(|c| c.get(..self.size).unwrap_or(&[]))
    }
}

/// One component as a number; normalised integers by the rules of the specification (section 3.6.2.2).
fn number(bytes: &[u8], kind: ComponentType, normalized: bool) -> f32 {
    let of = |v: f32, most: f32| {
        if normalized {
            let n = v / most;
            if n < -1.0 { -1.0 } else { n }
        } else {
            v
        }
    };
    match (kind, bytes) {
        (ComponentType::I8, &[a]) => of(f32::from(i8::from_le_bytes([a])), 127.0),
        (ComponentType::U8, &[a]) => of(f32::from(a), 255.0),
        (ComponentType::I16, &[a, b]) => of(f32::from(i16::from_le_bytes([a, b])), 32_767.0),
        (ComponentType::U16, &[a, b]) => of(f32::from(u16::from_le_bytes([a, b])), 65_535.0),
        (ComponentType::U32, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]) as f32,
        (ComponentType::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        _ => 0.0,
    }
}

fn whole(bytes: &[u8]) -> u32 {
    match *bytes {
        [a] => u32::from(a),
        [a, b] => u32::from(u16::from_le_bytes([a, b])),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
        _ => 0,
    }
}

impl<'a> Accessors<'a> {
    pub(super) fn new(doc: &'a Document<'a>) -> Self {
        Self { doc, left: Cell::new(doc.limits().vertices) }
    }

    /// Vectors of `N` components, of whatever kind they are stored as.
    pub(super) fn floats<const N: usize>(&self, index: Index<Accessor>) -> Result<Vec<[f32; N]>, GltfError> {
        let (a, kind) = self.open(index, components(N))?;
        let read = |bytes: &[u8]| {
            let mut out = [0.0; N];
            for (o, b) in out.iter_mut().zip(bytes.chunks_exact(kind.size())) {
                *o = number(b, kind, a.normalized);
            }
            out
        };
        self.read(index, a, kind, N, [0.0; N], read)
    }

    /// Colours: three or four components, alpha 1 where there is none.
    pub(super) fn colors(&self, index: Index<Accessor>) -> Result<Vec<[f32; 4]>, GltfError> {
        if self.is(index, Type::Vec3) {
            return Ok(self.floats::<3>(index)?.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect());
        }
        self.floats::<4>(index)
    }

    /// Whole numbers.
    pub(super) fn indices(&self, index: Index<Accessor>) -> Result<Vec<u32>, GltfError> {
        let (a, kind) = self.open(index, &[Type::Scalar])?;
        self.read(index, a, kind, 1, 0, whole)
    }

    /// Four whole numbers each: joints.
    pub(super) fn joints(&self, index: Index<Accessor>) -> Result<Vec<[u32; 4]>, GltfError> {
        let (a, kind) = self.open(index, &[Type::Vec4])?;
        let read = |bytes: &[u8]| {
            let mut out = [0; 4];
            for (o, b) in out.iter_mut().zip(bytes.chunks_exact(kind.size())) {
                *o = whole(b);
            }
            out
        };
        self.read(index, a, kind, 4, [0; 4], read)
    }

    fn is(&self, index: Index<Accessor>, wanted: Type) -> bool {
        self.doc
            .root
            .accessors
            .get(index.value())
            .is_some_and(|a| matches!(a.type_, Checked::Valid(t) if t == wanted))
    }

    fn fail(&self, index: Index<Accessor>, message: String) -> GltfError {
        self.doc.unusable(format!("/accessors/{}", index.value()), message)
    }

    fn open(
        &self,
        index: Index<Accessor>,
        wanted: &[Type],
    ) -> Result<(&'a Accessor, ComponentType), GltfError> {
        let a = self
            .doc
            .root
            .accessors
            .get(index.value())
            .ok_or_else(|| self.fail(index, "there is no such accessor".into()))?;
        let (Checked::Valid(kind), Checked::Valid(shape)) = (a.component_type, a.type_) else {
            return Err(self.fail(index, "its component type or type is not one that glTF has".into()));
        };
        if !wanted.contains(&shape) {
            return Err(self.fail(index, format!("it holds {shape:?} where {wanted:?} is needed")));
        }
        Ok((a, kind.0))
    }

    fn read<T: Clone>(
        &self,
        index: Index<Accessor>,
        a: &Accessor,
        kind: ComponentType,
        components: usize,
        zero: T,
        read: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, GltfError> {
        let left = self.left.get();
        let Some(rest) = left.checked_sub(a.count.0) else {
            return Err(GltfError::Limit {
                file: self.doc.name.into(),
                pointer: format!("/accessors/{}", index.value()),
                what: "elements",
                asked: a.count.0,
                limit: left,
            });
        };
        self.left.set(rest);
        let size = kind.size().saturating_mul(components);
        let mut out = Vec::new();
        let mut reserve = |n: u64| {
            out.try_reserve_exact(usize::try_from(n).unwrap_or(usize::MAX))
                .map_err(|_| self.fail(index, format!("its {n} elements do not fit in memory")))
        };
        match a.buffer_view {
            Some(view) => {
                let offset = a.byte_offset.unwrap_or_default().0;
                let elements = self.elements(index, view.value(), offset, size, a.count.0)?;
                reserve(a.count.0)?;
                out.extend(elements.iter().map(&read));
            }
            None => {
                // Zeros that no bytes stand for: the file must be worth them.
                let vouched = self.doc.bytes().saturating_add(FREE_ZEROS);
                if a.count.0 > vouched {
                    let what = format!("it claims {} elements without any bytes behind them", a.count.0);
                    return Err(self.fail(index, what));
                }
                reserve(a.count.0)?;
                out.resize(usize::try_from(a.count.0).unwrap_or(0), zero);
            }
        }
        if let Some(s) = &a.sparse {
            self.overwrite(index, s, size, &read, &mut out)?;
        }
        Ok(out)
    }

    /// Puts sparse values where they belong.
    fn overwrite<T>(
        &self,
        index: Index<Accessor>,
        s: &sparse::Sparse,
        size: usize,
        read: impl Fn(&[u8]) -> T,
        out: &mut [T],
    ) -> Result<(), GltfError> {
        let Checked::Valid(kind) = s.indices.component_type else {
            return Err(self.fail(index, "its sparse indices are of no known type".into()));
        };
        let (at, values) = (&s.indices, &s.values);
        let places =
            self.elements(index, at.buffer_view.value(), at.byte_offset.0, kind.0.size(), s.count.0)?;
        let values =
            self.elements(index, values.buffer_view.value(), values.byte_offset.0, size, s.count.0)?;
        for (place, value) in places.iter().map(whole).zip(values.iter()) {
            match out.get_mut(place as usize) {
                Some(slot) => *slot = read(value),
                None => {
                    let message = format!("its sparse index {place} is beyond its {} elements", out.len());
                    return Err(self.fail(index, message));
                }
            }
        }
        Ok(())
    }

    fn elements(
        &self,
        index: Index<Accessor>,
        view: usize,
        offset: u64,
        size: usize,
        count: u64,
    ) -> Result<Elements<'a>, GltfError> {
        let bytes = self.doc.view(view).ok_or_else(|| {
            self.fail(index, format!("buffer view {view} does not exist or lies outside of its buffer"))
        })?;
        let stride = self.doc.root.buffer_views.get(view).and_then(|v| v.byte_stride).map_or(size, |s| s.0);
        if stride < size {
            return Err(self.fail(index, format!("elements of {size} bytes do not fit a stride of {stride}")));
        }
        let there = bytes.len() as u64;
        let needed = count
            .checked_sub(1)
            .map_or(Some(0), |n| n.checked_mul(stride as u64)?.checked_add(size as u64))
            .and_then(|n| n.checked_add(offset));
        let bytes = match needed {
            Some(n) if n <= there => {
                bytes.get(usize::try_from(offset).unwrap_or(usize::MAX)..).unwrap_or(&[])
            }
            _ => {
                let message = format!(
                    "{count} elements of {size} bytes at offset {offset}, {stride} apart, do not fit the {there} \
                     bytes of buffer view {view}"
                );
                return Err(self.fail(index, message));
            }
        };
        Ok(Elements { bytes, stride, size, count: usize::try_from(count).unwrap_or(usize::MAX) })
    }
}

fn components(n: usize) -> &'static [Type] {
    match n {
        1 => &[Type::Scalar],
        2 => &[Type::Vec2],
        3 => &[Type::Vec3],
        4 => &[Type::Vec4],
        16 => &[Type::Mat4],
        _ => &[],
    }
}
