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
        // A small stack is cheaper to clear: in a scene of a dozen shapes it is 2 % of all instructions. Almost every tree
        // fits the second.
        if self.waiting <= 16 {
            self.visit_with::<16>(ray, visitor)
        } else if self.waiting <= 56 {
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

#[cfg(test)]
mod tests {
    use etendue_core::{Ray, Vec3A};

    use super::*;

    fn meets(b: &Aabb, ray: &Ray) -> bool {
        let mut node = Node::EMPTY;
        node.set(2, b, Child::leaf(0, 1));
        let Met { mask, .. } = node.enter(&BoxRay::new(ray), ray.t_max);
        assert_eq!(mask & !4, 0, "an empty place was met");
        mask != 0
    }

    fn bits(state: &mut u64) -> u64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *state >> 33
    }

    #[test]
    fn a_ray_from_the_border_meets_the_box() {
        // Boxes with 0 to 3 extents of zero; origins on every face, edge and corner; all 26 directions, both zeros.
        let places = [-1.0f32, -0.0, 0.0, 1.0];
        let mut count = 0;
        for flat in 0..8 {
            let hi = |axis: usize| if flat >> axis & 1 == 1 { 1.0 } else { 3.0 };
            let b = Aabb { lo: Vec3A::ONE, hi: Vec3A::new(hi(0), hi(1), hi(2)) };
            for corner in 0..27 {
                let at = |axis: usize, k: usize| match k % 3 {
                    0 => 1.0,
                    1 => hi(axis),
                    _ => 0.5 * (1.0 + hi(axis)),
                };
                let o = Vec3A::new(at(0, corner), at(1, corner / 3), at(2, corner / 9));
                for d in 0..64 {
                    let d = Vec3A::new(places[d % 4], places[d / 4 % 4], places[d / 16]);
                    if d != Vec3A::ZERO {
                        assert!(meets(&b, &Ray::new(o, d)), "{o} {d} {b:?}");
                        count += 1;
                    }
                }
            }
        }
        assert_eq!(count, 8 * 27 * (64 - 8));
    }

    #[test]
    fn parallel_rays_outside_miss() {
        let b = Aabb { lo: Vec3A::ZERO, hi: Vec3A::ONE };
        for zero in [0.0, -0.0] {
            let d = Vec3A::new(zero, zero, 1.0);
            assert!(!meets(&b, &Ray::new(Vec3A::new(1.0f32.next_up(), 0.5, -1.0), d)));
            assert!(!meets(&b, &Ray::new(Vec3A::new(0.5, -1e-30, -1.0), d)));
            assert!(meets(&b, &Ray::new(Vec3A::new(1.0, 0.0, -1.0), d)));
            assert!(!meets(&b, &Ray::new(Vec3A::new(0.5, 0.5, 2.0), d)));
        }
    }

    /// The test without the slack on the far side; what it loses shows that rays below are hard enough.
    fn plain(b: &Aabb, ray: &Ray) -> bool {
        let inverse = Vec3A::ONE / ray.d;
        let (t0, t1) = ((b.lo - ray.o) * inverse, (b.hi - ray.o) * inverse);
        let (mut near, mut far) = (ray.t_min, ray.t_max);
        for i in 0..3 {
            let (n, f) = if t0[i] < t1[i] { (t0[i], t1[i]) } else { (t1[i], t0[i]) };
            near = if n > near { n } else { near };
            far = if f < far { f } else { far };
        }
        near <= far
    }

    #[test]
    fn flat_boxes_are_not_lost() {
        let mut state = 7;
        let mut unit = || (bits(&mut state) & 0xff_ffff) as f32 / (1 << 24) as f32;
        let mut lost_by_plain = 0;
        let mut met = 0;
        for i in 0..400_000 {
            // A box without thickness far from the origin, and a ray that passes its border closely.
            let axis = i % 3;
            let lo = Vec3A::splat(1000.0) + Vec3A::new(unit(), unit(), unit());
            let mut hi = lo + Vec3A::new(unit(), unit(), unit());
            hi[axis] = lo[axis];
            let b = Aabb { lo, hi };
            let mut p = lo + (hi - lo) * Vec3A::new(unit(), unit(), unit());
            p[(axis + 1) % 3] = hi[(axis + 1) % 3];
            let o = p - Vec3A::new(unit() - 0.5, unit() - 0.5, unit() - 0.5) * 10.0;
            let d = p - o;
            let ray = Ray::new(o, d * (0.3 + unit()));
            // The truth, in double precision with a margin for its own rounding.
            let t = (f64::from(lo[axis]) - f64::from(o[axis])) / f64::from(ray.d[axis]);
            let inside = (0..3).all(|k| {
                let x = f64::from(o[k]) + t * f64::from(ray.d[k]);
                k == axis || (x > f64::from(lo[k]) + 1e-11 && x < f64::from(hi[k]) - 1e-11)
            });
            if inside && t > 0.0 {
                assert!(meets(&b, &ray), "{ray:?} {b:?}");
                lost_by_plain += usize::from(!plain(&b, &ray));
                met += 1;
            }
        }
        assert!(met > 50_000, "only {met} rays meet their box");
        assert!(lost_by_plain > 0, "no ray was hard enough to tell the tests apart");
    }
}
