use std::cell::Cell;

use super::super::model::{Component, Format, Model, Sparse};
use super::Bytes;

/// Components of the largest element.
const MOST: usize = 16;

/// How often each byte may be looked at: a component is checked for itself, with its neighbours and for its bounds.
const VISITS: u64 = 8;

/// Work for documents of few bytes.
const LEAST_WORK: u64 = 1 << 20;

/// Reads the elements of accessors.
pub(super) struct Elements<'a> {
    pub model: &'a Model<'a>,
    bytes: &'a dyn Bytes,
    /// Components that may still be read.
    left: Cell<u64>,
    stopped: Cell<bool>,
}

impl<'a> Elements<'a> {
    pub(super) fn new(model: &'a Model<'a>, bytes: &'a dyn Bytes) -> Self {
        let work = bytes.total().saturating_mul(VISITS).saturating_add(LEAST_WORK);
        Self { model, bytes, left: Cell::new(work), stopped: Cell::new(false) }
    }

    /// Whether there was too much to read.
    pub(super) fn stopped(&self) -> bool {
        self.stopped.get()
    }

    /// Gives each element to `f` in order, with its number. Of elements that are zero for want
    /// of bytes only one is given, and none if all are.
    pub(super) fn each(&self, index: usize, f: &mut dyn FnMut(u64, &[f64])) {
        let Some((accessor, format)) = self.model.accessors.get(index).and_then(|a| Some((a, a.format?)))
        else {
            return;
        };
        if accessor.view.is_some() {
            let Some(mut cursor) = self.cursor(index) else { return };
            while let Some(n) = cursor.next() {
                f(n, cursor.element());
            }
            return;
        }
        let Some(sparse) = accessor.sparse else { return };
        let mut element = [0.0; MOST];
        let components = components(&format);
        if sparse.count < accessor.count {
            f(0, element.get(..components).unwrap_or(&[]));
        }
        let mut sparse = self.sparse(&sparse, &format);
        while let Some(n) = sparse.as_mut().and_then(|s| s.next(&format, &mut element)) {
            if !self.pay(components) {
                return;
            }
            f(n, element.get(..components).unwrap_or(&[]));
        }
    }

    /// The elements of an accessor that has a view.
    pub(super) fn cursor(&self, index: usize) -> Option<Cursor<'_, 'a>> {
        let accessor = self.model.accessors.get(index)?;
        let format = accessor.format?;
        let view = self.model.view_of(accessor)?;
        let bytes = self.bytes.view(accessor.view?)?;
        let mut sparse = accessor.sparse.and_then(|s| self.sparse(&s, &format));
        Some(Cursor {
            elements: self,
            bytes: bytes.get(usize::try_from(accessor.offset).ok()?..)?,
            stride: usize::try_from(view.stride.unwrap_or(format.size())).ok()?,
            format,
            n: 0,
            count: accessor.count,
            pending: sparse.as_mut().and_then(|s| s.pair(&format)),
            sparse,
            element: [0.0; MOST],
        })
    }

    /// As [`Self::each`], with normalized integers as the fractions that they stand for.
    pub(super) fn each_normalized(&self, index: usize, f: &mut dyn FnMut(u64, &[f64])) {
        let format = self.model.accessors.get(index).and_then(|a| a.format);
        let Some(format) = format.filter(|f| f.normalized && f.component != Component::F32) else {
            return self.each(index, f);
        };
        self.each(index, &mut |n, element| {
            let mut scaled = [0.0; MOST];
            for (out, x) in scaled.iter_mut().zip(element) {
                *out = fraction(*x, &format);
            }
            f(n, scaled.get(..element.len()).unwrap_or(&[]));
        });
    }

    /// The element numbers that a sparse accessor replaces.
    pub(super) fn each_replaced(&self, sparse: &Sparse, format: &Format, f: &mut dyn FnMut(u64)) {
        let Some(mut sparse) = self.sparse(sparse, format) else { return };
        while let Some(n) = sparse.index() {
            if !self.pay(1) {
                return;
            }
            f(n);
        }
    }

    fn sparse(&self, sparse: &Sparse, format: &Format) -> Option<SparseReader<'a>> {
        let part =
            |view: Option<usize>, offset: u64| self.bytes.view(view?)?.get(usize::try_from(offset).ok()?..);
        Some(SparseReader {
            indices: part(sparse.indices.view, sparse.indices.offset)?,
            values: part(sparse.values.view, sparse.values.offset)?,
            component: sparse.component?,
            left: sparse.count,
            size: usize::try_from(format.size()).ok()?,
        })
    }

    fn pay(&self, components: usize) -> bool {
        let left = self.left.get().checked_sub(components as u64);
        self.left.set(left.unwrap_or(0));
        if left.is_none() {
            self.stopped.set(true);
        }
        left.is_some()
    }
}

/// Goes through the elements of an accessor.
pub(super) struct Cursor<'e, 'a> {
    elements: &'e Elements<'a>,
    bytes: &'a [u8],
    stride: usize,
    pub format: Format,
    n: u64,
    count: u64,
    sparse: Option<SparseReader<'a>>,
    /// The next element that a sparse accessor replaces.
    pending: Option<(u64, [f64; MOST])>,
    element: [f64; MOST],
}

impl Cursor<'_, '_> {
    /// The element that was read last.
    pub(super) fn element(&self) -> &[f64] {
        self.element.get(..components(&self.format)).unwrap_or(&[])
    }

    /// Reads the next element; its number.
    pub(super) fn next(&mut self) -> Option<u64> {
        let n = self.n;
        if n >= self.count || !self.elements.pay(components(&self.format)) {
            return None;
        }
        read(self.bytes, &self.format, &mut self.element)?;
        self.n = n.saturating_add(1);
        self.bytes = self.bytes.get(self.stride..).unwrap_or(&[]);
        if let Some((_, values)) = self.pending.filter(|(replaced, _)| *replaced == n) {
            self.element = values;
            self.pending = self.sparse.as_mut().and_then(|s| s.pair(&self.format));
        }
        Some(n)
    }
}

fn components(format: &Format) -> usize {
    usize::try_from(format.shape.components()).unwrap_or(0).min(MOST)
}

/// What a component stands for.
pub(super) fn fraction(x: f64, format: &Format) -> f64 {
    if format.normalized && format.component != Component::F32 {
        (x / format.component.range().1).max(-1.0)
    } else {
        x
    }
}

struct SparseReader<'a> {
    indices: &'a [u8],
    values: &'a [u8],
    component: Component,
    left: u64,
    size: usize,
}

impl SparseReader<'_> {
    /// The next element's number.
    fn index(&mut self) -> Option<u64> {
        self.left = self.left.checked_sub(1)?;
        let index = self.component.read(self.indices)?;
        let size = usize::try_from(self.component.size()).ok()?;
        self.indices = self.indices.get(size..)?;
        Some(index as u64)
    }

    fn pair(&mut self, format: &Format) -> Option<(u64, [f64; MOST])> {
        let mut values = [0.0; MOST];
        Some((self.next(format, &mut values)?, values))
    }

    /// The next element and its number.
    fn next(&mut self, format: &Format, element: &mut [f64; MOST]) -> Option<u64> {
        let index = self.index()?;
        read(self.values, format, element)?;
        self.values = self.values.get(self.size..).unwrap_or(&[]);
        Some(index)
    }
}

/// One element from its bytes.
fn read(bytes: &[u8], format: &Format, element: &mut [f64; MOST]) -> Option<()> {
    let column = usize::try_from(format.column()).ok()?;
    let size = usize::try_from(format.component.size()).ok()?;
    let rows = usize::try_from(format.shape.rows).ok()?;
    let mut rest = bytes;
    let mut out = element.iter_mut();
    for _ in 0..format.shape.columns {
        let mut here = rest;
        for out in out.by_ref().take(rows) {
            *out = format.component.read(here)?;
            here = here.get(size..)?;
        }
        rest = rest.get(column..).unwrap_or(&[]);
    }
    Some(())
}
