use etendue_core::Aabb;

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
    /// The most items of one leaf.
    pub(crate) const MOST_ITEMS: usize = 8;
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
    /// Low and high planes, by axis and child.
    planes: [[[f32; WIDTH]; 3]; 2],
    children: [Child; WIDTH],
}

impl Node {
    /// All places empty: boxes that no ray meets.
    pub(crate) const EMPTY: Self = Self {
        planes: [[[f32::INFINITY; WIDTH]; 3], [[f32::NEG_INFINITY; WIDTH]; 3]],
        children: [Child(0); WIDTH],
    };

    pub(crate) fn set(&mut self, place: usize, bounds: &Aabb, child: Child) {
        for axis in 0..3 {
            self.planes[0][axis][place] = bounds.lo[axis];
            self.planes[1][axis][place] = bounds.hi[axis];
        }
        self.children[place] = child;
    }

    /// Where the ray enters each box, and whether it meets it before `limit`.
    #[inline(always)]
    fn enter(&self, ray: &BoxRay, limit: f32) -> ([f32; WIDTH], [bool; WIDTH]) {
        let mut near = [ray.t_min; WIDTH];
        let mut far = [limit; WIDTH];
        for axis in 0..3 {
            let down = ray.down[axis] & 1;
            let (n, f) = (&self.planes[down][axis], &self.planes[1 - down][axis]);
            let (no, fo, inverse) = (ray.near_origin[axis], ray.far_origin[axis], ray.inverse[axis]);
            for i in 0..WIDTH {
                let (tn, tf) = ((n[i] - no) * inverse, (f[i] - fo) * inverse);
                near[i] = if tn > near[i] { tn } else { near[i] };
                far[i] = if tf < far[i] { tf } else { far[i] };
            }
        }
        let met = std::array::from_fn(|i| near[i] <= far[i] + far[i].abs() * FAR_PAD);
        (near, met)
    }
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
            let (near, met) = node.enter(ray, visitor.limit());
            let base = top;
            for i in 0..WIDTH {
                if met[i] && top < STACK {
                    // Insertion, farthest at the bottom.
                    let mut at = top;
                    while at > base && stack[at - 1].near < near[i] {
                        stack[at] = stack[at - 1];
                        at -= 1;
                    }
                    stack[at] = Waiting { near: near[i], child: node.children[i] };
                    top += 1;
                }
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
