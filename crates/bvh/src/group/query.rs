use etendue_core::Ray;
use etendue_geometry::triangle::TriangleRay;
use etendue_geometry::{Hit, Shape};

use super::{Group, OpenItem, Solid, SolidItem};
use crate::kernel::{BLOCK, Block, BoxRay, FilterRay, Visitor};
use crate::shape_hits::offer_shape;
use crate::sink::{Answer, Sink};

/// What a query carries into a group.
pub(crate) struct GroupQuery<'a> {
    /// In the group's space.
    pub(crate) ray: &'a Ray,
    pub(crate) inst: u32,
    /// Masks by geometry; empty where every geometry is seen by every ray.
    pub(crate) masks: &'a [u32],
}

impl GroupQuery<'_> {
    #[inline]
    fn sees(&self, geom: u32) -> bool {
        self.masks.is_empty()
            || self.masks.get(geom as usize).copied().unwrap_or(u32::MAX) & self.ray.mask != 0
    }
}

impl Group {
    /// Offers what the ray hits. True ends the query. The ray must be valid.
    #[inline]
    pub(crate) fn query<S: Sink>(&self, q: &GroupQuery<'_>, sink: &mut S) -> bool {
        for item in &self.unbounded_solids {
            if q.sees(item.geom) && item.offer(q, sink) {
                return true;
            }
        }
        for item in &self.unbounded_open {
            if q.sees(item.geom) && offer_shape(&*item.shape, q.ray, q.inst, item.geom, sink) {
                return true;
            }
        }
        let boxes = BoxRay::new(q.ray);
        if let Some(tree) = &self.solids.tree {
            let mut visitor = ItemVisitor { items: &self.solids.items, q, sink };
            if tree.visit(&boxes, &mut visitor) {
                return true;
            }
        }
        if let Some(tree) = &self.open.tree {
            let mut visitor = ItemVisitor { items: &self.open.items, q, sink };
            if tree.visit(&boxes, &mut visitor) {
                return true;
            }
        }
        if let Some(tree) = &self.triangles.tree {
            let mut visitor = TriangleVisitor {
                blocks: &self.triangles.items,
                filter: FilterRay::new(q.ray),
                exact: TriangleRay::new(q.ray),
                q,
                sink,
            };
            return tree.visit(&boxes, &mut visitor);
        }
        false
    }
}

/// An item that is a shape.
trait ShapeItem {
    fn geom(&self) -> u32;
    fn offer<S: Sink>(&self, q: &GroupQuery<'_>, sink: &mut S) -> bool;
}

impl ShapeItem for SolidItem {
    #[inline]
    fn geom(&self) -> u32 {
        self.geom
    }

    #[inline]
    fn offer<S: Sink>(&self, q: &GroupQuery<'_>, sink: &mut S) -> bool {
        match &self.solid {
            Solid::Sphere(s) => offer_shape(s, q.ray, q.inst, self.geom, sink),
            Solid::Plane(s) => offer_shape(s, q.ray, q.inst, self.geom, sink),
            Solid::Parallelogram(s) => offer_shape(s, q.ray, q.inst, self.geom, sink),
            Solid::Disc(s) => offer_apart(s, q, self.geom, sink),
            Solid::Cylinder(s) => offer_apart(s, q, self.geom, sink),
        }
    }
}

/// Out of line, so that the loop over the common shapes keeps its size.
#[inline(never)]
fn offer_apart<S: Sink>(shape: &dyn Shape, q: &GroupQuery<'_>, geom: u32, sink: &mut S) -> bool {
    offer_shape(shape, q.ray, q.inst, geom, sink)
}

impl ShapeItem for OpenItem {
    #[inline]
    fn geom(&self) -> u32 {
        self.geom
    }

    #[inline]
    fn offer<S: Sink>(&self, q: &GroupQuery<'_>, sink: &mut S) -> bool {
        offer_shape(&*self.shape, q.ray, q.inst, self.geom, sink)
    }
}

struct ItemVisitor<'a, T, S> {
    items: &'a [T],
    q: &'a GroupQuery<'a>,
    sink: &'a mut S,
}

impl<T: ShapeItem, S: Sink> Visitor for ItemVisitor<'_, T, S> {
    #[inline]
    fn limit(&self) -> f32 {
        self.sink.limit()
    }

    #[inline]
    fn leaf(&mut self, first: u32, count: u32) -> bool {
        let range = first as usize..(first + count) as usize;
        self.items
            .get(range)
            .unwrap_or(&[])
            .iter()
            .any(|item| self.q.sees(item.geom()) && item.offer(self.q, self.sink))
    }
}

struct TriangleVisitor<'a, S> {
    blocks: &'a [Block],
    filter: FilterRay,
    exact: TriangleRay,
    q: &'a GroupQuery<'a>,
    sink: &'a mut S,
}

impl<S: Sink> Visitor for TriangleVisitor<'_, S> {
    #[inline]
    fn limit(&self) -> f32 {
        self.sink.limit()
    }

    #[inline]
    fn leaf(&mut self, first: u32, count: u32) -> bool {
        let range = first as usize..(first + count) as usize;
        for block in self.blocks.get(range).unwrap_or(&[]) {
            let mut candidates = block.candidates(&self.filter);
            while candidates != 0 {
                let place = candidates.trailing_zeros() as usize % BLOCK;
                candidates &= candidates - 1;
                if self.exact_test(block, place) {
                    return true;
                }
            }
        }
        false
    }
}

impl<S: Sink> TriangleVisitor<'_, S> {
    #[inline]
    fn exact_test(&mut self, block: &Block, place: usize) -> bool {
        let Some(at) = self.exact.intersect(block.triangle(place)) else { return false };
        let (geom, prim) = (block.geom[place], block.prim[place]);
        if !(self.q.ray.accepts(at.t) && at.t <= self.sink.limit() && self.q.sees(geom)) {
            return false;
        }
        self.sink.offer(&Hit { t: at.t, uv: at.uv, inst: self.q.inst, geom, prim }) == Answer::Done
    }
}
