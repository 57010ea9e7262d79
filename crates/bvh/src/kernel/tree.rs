use etendue_core::{Aabb, Vec4};

use super::{BoxRay, FAR_PAD};

/// Children of a node.
pub(crate) const WIDTH: usize = 4;

/// What hangs in one place of a node: another node, or a run of leaf items.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const COUNT_SHIFT: u32 = 28;
    const FIRST: u32 = (1 << Self::COUNT_SHIFT) - 1;
    /// The most leaf items a tree can number.
    pub(crate) const MOST_FIRST: usize = Self::FIRST as usize;

    pub(crate) fn node(index: u32) -> Self {
        Self(index & !Self::LEAF)
    }

    /// `count` from 1 to 8.
    pub(crate) fn leaf(first: u32, count: u32) -> Self {
        Self(Self::LEAF | (count - 1) << Self::COUNT_SHIFT | first)
    }

    #[inline]
    fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline]
    fn first(self) -> u32 {
        self.0 & Self::FIRST
    }

    #[inline]
    fn count(self) -> u32 {
        (self.0 >> Self::COUNT_SHIFT & 7) + 1
    }
}

/// Four boxes and what is in them: two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Low and high planes, by axis; one lane for each child.
    planes: [[Vec4; 3]; 2],
    children: [Child; WIDTH],
}

/// The boxes a ray meets.
struct Met {
    /// Where it enters each box.
    near: [f32; WIDTH],
    /// One bit for each box that counts.
    mask: u32,
}

impl Node {
    /// All places empty: boxes that no ray meets.
    pub(crate) const EMPTY: Self =
        Self { planes: [[Vec4::INFINITY; 3], [Vec4::NEG_INFINITY; 3]], children: [Child(0); WIDTH] };

    pub(crate) fn set(&mut self, place: usize, bounds: &Aabb, child: Child) {
        for axis in 0..3 {
            self.planes[0][axis][place] = bounds.lo[axis];
            self.planes[1][axis][place] = bounds.hi[axis];
        }
        self.children[place] = child;
    }

    /// Where the ray enters each box, and whether it meets it before `limit`.
    #[inline(always)]
    fn enter(&self, ray: &BoxRay, limit: f32) -> Met {
        let mut near = Vec4::splat(ray.t_min);
        let mut far = Vec4::splat(limit);
        for axis in 0..3 {
            let down = ray.down[axis] & 1;
            let inverse = Vec4::splat(ray.inverse[axis]);
            let n = (self.planes[down][axis] - Vec4::splat(ray.near_origin[axis])) * inverse;
            let f = (self.planes[1 - down][axis] - Vec4::splat(ray.far_origin[axis])) * inverse;
            near = larger_or(n, near);
            far = smaller_or(f, far);
        }
        let mask = near.cmple(far + far.abs() * FAR_PAD).bitmask();
        Met { near: near.to_array(), mask }
    }
}

/// The larger of each pair; where `a` is not a number, `b`.
#[inline(always)]
fn larger_or(a: Vec4, b: Vec4) -> Vec4 {
    // On x86 this is what the instruction does; elsewhere the instruction may keep the NaN.
    if cfg!(target_arch = "x86_64") { a.max(b) } else { Vec4::select(a.cmpgt(b), a, b) }
}

/// The smaller of each pair; where `a` is not a number, `b`.
#[inline(always)]
fn smaller_or(a: Vec4, b: Vec4) -> Vec4 {
    if cfg!(target_arch = "x86_64") { a.min(b) } else { Vec4::select(a.cmplt(b), a, b) }
}

/// What a traversal calls.
pub(crate) trait Visitor {
    /// Boxes beyond this ray parameter are left out.
    fn limit(&self) -> f32;
    /// Tests a run of leaf items; true ends the traversal.
    fn leaf(&mut self, first: u32, count: u32) -> bool;
}

/// A bounding volume hierarchy over leaf items that somebody else keeps.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Node>,
    pub(crate) bounds: Aabb,
    /// The most children that can wait at once.
    pub(crate) waiting: usize,
}

#[derive(Clone, Copy, Default)]
struct Waiting {
    near: f32,
    child: Child,
}

impl Tree {
    /// Visits every leaf whose box the ray meets before the visitor's limit, near ones first. True if the visitor
    /// ended it.
    #[inline]
    pub(crate) fn visit(&self, ray: &BoxRay, visitor: &mut impl Visitor) -> bool {
        // A small stack is cheaper to clear; almost every tree fits.
        if self.waiting <= 56 {
            self.visit_with::<56>(ray, visitor)
        } else {
            self.visit_with::<{ Self::MOST_WAITING }>(ray, visitor)
        }
    }

    /// Enough for a depth of 64: each node leaves at most three children behind.
    pub(crate) const MOST_WAITING: usize = 64 * (WIDTH - 1) + 1;

    #[inline]
    fn visit_with<const STACK: usize>(&self, ray: &BoxRay, visitor: &mut impl Visitor) -> bool {
        let mut stack = [Waiting::default(); STACK];
        let mut top = 0;
        let mut index = 0u32;
        loop {
            let Some(node) = self.nodes.get(index as usize) else { return false };
            let Met { near, mut mask } = node.enter(ray, visitor.limit());
            let base = top;
            while mask != 0 && top < STACK {
                let i = mask.trailing_zeros() as usize & (WIDTH - 1);
                mask &= mask - 1;
                // Insertion, farthest at the bottom.
                let mut at = top;
                while at > base && stack[at - 1].near < near[i] {
                    stack[at] = stack[at - 1];
                    at -= 1;
                }
                stack[at] = Waiting { near: near[i], child: node.children[i] };
                top += 1;
            }
            index = loop {
                if top == 0 {
                    return false;
                }
                top -= 1;
                let Waiting { near, child } = stack[top];
                let limit = visitor.limit();
                if near > limit + limit.abs() * FAR_PAD {
                    continue;
                }
                if !child.is_leaf() {
                    break child.0;
                }
                if visitor.leaf(child.first(), child.count()) {
                    return true;
                }
            };
        }
    }
}
