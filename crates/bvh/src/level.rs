use std::sync::Arc;

use etendue_core::rounding::gamma;
use etendue_core::{Aabb, Motion, Ray, Transform, Vec3A, vector};
use etendue_geometry::{ReturnBound, return_error};

use crate::BuildError;
use crate::build::{Costs, Leaves, Stored, build_tree};
use crate::group::{BuildContext, Group, GroupQuery};
use crate::kernel::{BoxRay, Tree, Visitor};
use crate::sink::Sink;

/// How an instance stands in the world: still or moving. Each kind has a tree of its own, so that what stands still runs
/// the same code whether something else moves or not.
pub(crate) trait Stand: Clone {
    /// The ray in object space, at its own time.
    fn ray_to_object(&self, ray: &Ray) -> Ray;
    /// Around the image of a box, at every time.
    fn bounds_of(&self, b: &Aabb) -> Aabb;
    /// At every time.
    fn drift(&self) -> Drift;
}

impl Stand for Transform {
    #[inline]
    fn ray_to_object(&self, ray: &Ray) -> Ray {
        self.ray_to_object(ray).0
    }

    fn bounds_of(&self, b: &Aabb) -> Aabb {
        self.aabb(b)
    }

    fn drift(&self) -> Drift {
        let largest = |v: Vec3A| vector::max_element(v.abs());
        let at_zero = largest(return_error(self, Vec3A::ZERO));
        // Without the translation, what is left grows with the coordinate alone.
        let [x, y, z, _] = self.columns();
        let linear = Self::from_columns(x, y, z, Vec3A::ZERO).unwrap_or(*self);
        Drift { slope: largest(return_error(&linear, Vec3A::ONE)), offset: at_zero }
    }
}

/// Where it stands at time 0, and what it does then.
#[derive(Clone, Debug)]
pub(crate) struct Moving {
    pub(crate) start: Transform,
    pub(crate) motion: Arc<Motion>,
}

impl Stand for Moving {
    fn ray_to_object(&self, ray: &Ray) -> Ray {
        self.motion.placement(&self.start, ray.time).ray_to_object(ray).0
    }

    fn bounds_of(&self, b: &Aabb) -> Aabb {
        self.motion.bounds_after(&self.start, b)
    }

    fn drift(&self) -> Drift {
        let ReturnBound { slope, offset } = ReturnBound::new(&self.start, &self.motion);
        Drift { slope, offset }
    }
}

/// Bound on the distance between a ray and its image in object space, seen from the world: `slope` times the largest
/// coordinate at play plus `offset`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Drift {
    slope: f32,
    offset: f32,
}

impl Drift {
    fn including(self, other: Self) -> Self {
        Self {
            slope: if other.slope > self.slope { other.slope } else { self.slope },
            offset: if other.offset > self.offset { other.offset } else { self.offset },
        }
    }

    fn is_finite(&self) -> bool {
        self.slope.is_finite() && self.offset.is_finite()
    }

    /// Three times the error of a point: that of the origin, that of the direction times `t`, and the rounding of the
    /// boxes and of this sum.
    fn pad(self, ray: &Ray, bounds: &Aabb) -> f32 {
        let largest = |v: Vec3A| vector::max_element(v.abs());
        let reach = largest(ray.o) + largest(bounds.lo) + largest(bounds.hi);
        3.0 * ((self.slope + gamma(4)) * reach + self.offset)
    }
}

/// One instance, ready to be tested.
#[derive(Clone, Debug)]
pub(crate) struct Placed<P> {
    pub(crate) stand: P,
    pub(crate) group: u32,
    pub(crate) inst: u32,
    pub(crate) mask: u32,
}

impl<P: Stand> Placed<P> {
    /// Offers what the world-space ray hits. True ends the query.
    #[allow(clippy::ptr_arg, reason = "one register less than a slice, in the walk's innermost call")]
    fn enter<S: Sink>(&self, groups: &Vec<Group>, ray: &Ray, masks: &[u32], sink: &mut S) -> bool {
        if self.mask & ray.mask == 0 {
            return false;
        }
        let Some(group) = groups.get(self.group as usize) else { return false };
        let object_ray = self.stand.ray_to_object(ray);
        object_ray.is_valid() && group.query(&GroupQuery { ray: &object_ray, inst: self.inst, masks }, sink)
    }
}

/// A tree over the world-space boxes of instances of one kind.
///
/// A ray is tested against boxes in world space and against geometry in object space, and the two disagree by the
/// rounding of the way there. For each ray the boxes are therefore widened by a bound on that difference, so that no
/// hit found in object space is ever lost, wherever the instances stand.
pub(crate) struct Level<P> {
    tree: Option<Tree>,
    /// In the order of the tree.
    placed: Vec<Placed<P>>,
    /// Instances that no box holds.
    unbounded: Vec<Placed<P>>,
    drift: Drift,
}

impl<P: Stand> Level<P> {
    pub(crate) fn build(
        all: Vec<Placed<P>>,
        groups: &[Group],
        cx: &mut BuildContext<'_>,
    ) -> Result<Self, BuildError> {
        let (mut boxes, mut bounded, mut unbounded) = (Vec::new(), Vec::new(), Vec::new());
        let mut drift = Drift::default();
        for placed in all {
            let Some(content) = groups.get(placed.group as usize) else { continue };
            let (bounds, own) = (placed.stand.bounds_of(&content.bounds()), placed.stand.drift());
            if content.is_unbounded() || !bounds.is_finite() || !own.is_finite() {
                unbounded.push(placed);
            } else {
                drift = drift.including(own);
                boxes.push(bounds);
                bounded.push(placed);
            }
        }
        let mut order = Order(Vec::with_capacity(bounded.len()));
        let costs = Costs { item: 4.0, per_item: 1, most: 2 };
        let built = build_tree(&boxes, &costs, cx.options, &mut order, cx.cancel)?;
        let placed: Vec<Placed<P>> =
            order.0.iter().filter_map(|&i| bounded.get(i as usize).cloned()).collect();
        let tree = built.map(|b| {
            cx.report.nodes += b.tree.nodes.len();
            cx.report.depth = cx.report.depth.max(b.depth);
            cx.report.fallbacks += usize::from(b.fell_back);
            cx.report.bytes += size_of_val(b.tree.nodes.as_slice());
            b.tree
        });
        cx.report.bytes += size_of_val(placed.as_slice()) + size_of_val(unbounded.as_slice());
        Ok(Self { tree, placed, unbounded, drift })
    }

    pub(crate) fn bounds(&self, groups: &[Group]) -> Aabb {
        let unbounded = self.unbounded.iter().map(|p| {
            let content = groups.get(p.group as usize).map_or(Aabb::EMPTY, Group::bounds);
            p.stand.bounds_of(&content)
        });
        let start = self.tree.as_ref().map_or(Aabb::EMPTY, |t| t.bounds);
        unbounded.filter(Aabb::is_finite).fold(start, Aabb::union)
    }

    /// Offers what the world-space ray hits. True ends the query.
    #[inline]
    pub(crate) fn query<S: Sink>(&self, groups: &Vec<Group>, ray: &Ray, masks: &[u32], sink: &mut S) -> bool {
        if self.unbounded.iter().any(|p| p.enter(groups, ray, masks, sink)) {
            return true;
        }
        let Some(tree) = &self.tree else { return false };
        let boxes = BoxRay::padded(ray, self.drift.pad(ray, &tree.bounds));
        tree.visit(&boxes, &mut LevelVisitor { level: self, groups, ray, masks, sink })
    }
}

struct Order(Vec<u32>);

impl Leaves for Order {
    fn store(&mut self, primitives: &[u32]) -> Stored {
        let first = self.0.len() as u32;
        self.0.extend_from_slice(primitives);
        Stored { first, count: primitives.len() as u32 }
    }
}

struct LevelVisitor<'a, P, S> {
    level: &'a Level<P>,
    groups: &'a Vec<Group>,
    ray: &'a Ray,
    masks: &'a [u32],
    sink: &'a mut S,
}

impl<P: Stand, S: Sink> Visitor for LevelVisitor<'_, P, S> {
    fn limit(&self) -> f32 {
        self.sink.limit()
    }

    fn leaf(&mut self, first: u32, count: u32) -> bool {
        let range = first as usize..(first + count) as usize;
        self.level
            .placed
            .get(range)
            .unwrap_or(&[])
            .iter()
            .any(|p| p.enter(self.groups, self.ray, self.masks, self.sink))
    }
}
