//! Numbers out of buffers: every size is checked before anything is allocated or read.

use std::cell::Cell;

use gltf::json::accessor::{ComponentType, Type, sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::GltfError;
use super::document::Document;

/// Elements that an accessor without any bytes may stand for beyond what the file's size vouches for.
const FREE_ZEROS: u64 = 1 << 16;
/// Elements that may be read beyond [`AGAIN`] for each byte of the file.
const FREE_ELEMENTS: u64 = 1 << 24;
/// How often a byte may be read again: many primitives may share an accessor, but a small file must not ask for the memory
/// of a large one.
const AGAIN: u64 = 8;

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

    /// Element `i`; nothing beyond the last.
    fn at(&self, i: u32) -> &'a [u8] {
        let start = (i as usize).checked_mul(self.stride).filter(|_| (i as usize) < self.count);
        let range = start.and_then(|s| Some(s..s.checked_add(self.size)?));
        range.and_then(|r| self.bytes.get(r)).unwrap_or(&[])
    }
}

/// Which elements of an accessor are wanted.
#[derive(Clone, Copy)]
pub(super) enum Which<'a> {
    /// All of them.
    All,
    /// These, ascending.
    These(&'a [u32]),
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
        let worth = doc.bytes().saturating_mul(AGAIN).saturating_add(FREE_ELEMENTS);
        Self { doc, left: Cell::new(doc.limits().vertices.min(worth)) }
    }

    /// Vectors of `N` components, of whatever kind they are stored as.
    pub(super) fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        which: Which<'_>,
    ) -> Result<Vec<[f32; N]>, GltfError> {
        let (a, kind) = self.open(index, components(N))?;
        let read = |bytes: &[u8]| {
            let mut out = [0.0; N];
            for (o, b) in out.iter_mut().zip(bytes.chunks_exact(kind.size())) {
                *o = number(b, kind, a.normalized);
            }
            out
        };
        self.read(index, a, kind, which, N, [0.0; N], read)
    }

    /// Colours: three or four components, alpha 1 where there is none.
    pub(super) fn colors(
        &self,
        index: Index<Accessor>,
        which: Which<'_>,
    ) -> Result<Vec<[f32; 4]>, GltfError> {
        if self.is(index, Type::Vec3) {
            return Ok(self.floats::<3>(index, which)?.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect());
        }
        self.floats::<4>(index, which)
    }

    /// Whole numbers.
    pub(super) fn indices(&self, index: Index<Accessor>) -> Result<Vec<u32>, GltfError> {
        let (a, kind) = self.open(index, &[Type::Scalar])?;
        self.read(index, a, kind, Which::All, 1, 0, whole)
    }

    /// Four whole numbers each: joints.
    pub(super) fn joints(
        &self,
        index: Index<Accessor>,
        which: Which<'_>,
    ) -> Result<Vec<[u32; 4]>, GltfError> {
        let (a, kind) = self.open(index, &[Type::Vec4])?;
        let read = |bytes: &[u8]| {
            let mut out = [0; 4];
            for (o, b) in out.iter_mut().zip(bytes.chunks_exact(kind.size())) {
                *o = whole(b);
            }
            out
        };
        self.read(index, a, kind, which, 4, [0; 4], read)
    }

    /// How many elements an accessor says it has.
    pub(super) fn count(&self, index: Index<Accessor>) -> u64 {
        self.doc.root.accessors.get(index.value()).map_or(0, |a| a.count.0)
    }

    /// Whether the elements that an accessor claims are there, without reading them.
    pub(super) fn vouch<const N: usize>(&self, index: Index<Accessor>) -> Result<(), GltfError> {
        let (a, kind) = self.open(index, components(N))?;
        match a.buffer_view {
            Some(view) => {
                let offset = a.byte_offset.unwrap_or_default().0;
                let size = kind.size().saturating_mul(N);
                self.elements(index, view.value(), offset, size, a.count.0).map(|_| ())
            }
            None => self.zeros(index, a.count.0),
        }
    }

    /// Zeros that no bytes stand for: the file must be worth them.
    fn zeros(&self, index: Index<Accessor>, count: u64) -> Result<(), GltfError> {
        if count > self.doc.bytes().saturating_add(FREE_ZEROS) {
            let what = format!("it claims {count} elements without any bytes behind them");
            return Err(self.fail(index, what));
        }
        Ok(())
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

    #[allow(clippy::too_many_arguments)]
    fn read<T: Clone>(
        &self,
        index: Index<Accessor>,
        a: &Accessor,
        kind: ComponentType,
        which: Which<'_>,
        components: usize,
        zero: T,
        read: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, GltfError> {
        let asked = match which {
            Which::All => a.count.0,
            Which::These(places) => places.len() as u64,
        };
        self.charge(index, asked)?;
        let size = kind.size().saturating_mul(components);
        let mut out = Vec::new();
        let mut reserve = || {
            out.try_reserve_exact(usize::try_from(asked).unwrap_or(usize::MAX))
                .map_err(|_| self.fail(index, format!("its {asked} elements do not fit in memory")))
        };
        match a.buffer_view {
            Some(view) => {
                let offset = a.byte_offset.unwrap_or_default().0;
                let elements = self.elements(index, view.value(), offset, size, a.count.0)?;
                reserve()?;
                match which {
                    Which::All => out.extend(elements.iter().map(&read)),
                    Which::These(places) => out.extend(places.iter().map(|&i| read(elements.at(i)))),
                }
            }
            None => {
                self.zeros(index, asked)?;
                reserve()?;
                out.resize(usize::try_from(asked).unwrap_or(0), zero);
            }
        }
        if let Some(s) = &a.sparse {
            self.overwrite(index, s, a.count.0, which, size, &read, &mut out)?;
        }
        Ok(out)
    }

    /// Takes elements out of the budget.
    pub(super) fn charge(&self, index: Index<Accessor>, asked: u64) -> Result<(), GltfError> {
        let left = self.left.get();
        match left.checked_sub(asked) {
            Some(rest) => {
                self.left.set(rest);
                Ok(())
            }
            None => Err(GltfError::Limit {
                file: self.doc.name.into(),
                pointer: format!("/accessors/{}", index.value()),
                what: "elements more",
                asked,
                limit: left,
            }),
        }
    }

    /// Puts sparse values where they belong.
    #[allow(clippy::too_many_arguments)]
    fn overwrite<T>(
        &self,
        index: Index<Accessor>,
        s: &sparse::Sparse,
        count: u64,
        which: Which<'_>,
        size: usize,
        read: impl Fn(&[u8]) -> T,
        out: &mut [T],
    ) -> Result<(), GltfError> {
        let Checked::Valid(kind) = s.indices.component_type else {
            return Err(self.fail(index, "its sparse indices are of no known type".into()));
        };
        let (at, values) = (&s.indices, &s.values);
        self.charge(index, s.count.0)?;
        let places =
            self.elements(index, at.buffer_view.value(), at.byte_offset.0, kind.0.size(), s.count.0)?;
        let values =
            self.elements(index, values.buffer_view.value(), values.byte_offset.0, size, s.count.0)?;
        for (place, value) in places.iter().map(whole).zip(values.iter()) {
            if u64::from(place) >= count {
                let message = format!("its sparse index {place} is beyond its {count} elements");
                return Err(self.fail(index, message));
            }
            let slot = match which {
                Which::All => Some(place as usize),
                Which::These(wanted) => wanted.binary_search(&place).ok(),
            };
            if let Some(slot) = slot.and_then(|i| out.get_mut(i)) {
                *slot = read(value);
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
