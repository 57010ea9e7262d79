use std::collections::BTreeMap;

use etendue_core::rounding::gamma;
use etendue_core::{Aabb, Ray, Transform, Vec3A};
use etendue_geometry::return_error;

use crate::build::{Costs, Leaves, Stored, build_tree};
use crate::group::{BuildContext, Group, GroupQuery};
use crate::kernel::{BoxRay, Tree, Visitor};
use crate::sink::Sink;
use crate::{BuildError, BuildReport, World};

/// One instance, ready to be tested.
#[derive(Clone, Debug)]
struct Placed {
    to_world: Transform,
    group: u32,
    inst: u32,
    mask: u32,
}

/// The top level: a tree over the world-space boxes of the instances.
///
/// A ray is tested against boxes in world space and against geometry in object space, and the two disagree by the
/// rounding of the way there. For each ray the boxes are therefore widened by a bound on that difference, so that no
/// hit found in object space is ever lost, wherever the instances stand.
pub(crate) struct Instances {
    groups: Vec<Group>,
    tree: Option<Tree>,
    /// In the order of the tree.
    placed: Vec<Placed>,
    /// Instances of groups that no box holds.
    unbounded: Vec<Placed>,
    drift: Drift,
}

/// Bound on the distance between a ray and its image in object space, seen from the world: `slope` times the largest
/// coordinate at play plus `offset`.
#[derive(Clone, Copy, Debug, Default)]
struct Drift {
    slope: f32,
    offset: f32,
}

impl Drift {
    fn including(self, to_world: &Transform) -> Self {
        let largest = |v: Vec3A| etendue_core::vector::max_element(v.abs());
        let at_zero = largest(return_error(to_world, Vec3A::ZERO));
        // Without the translation, what is left grows with the coordinate alone.
        let [x, y, z, _] = to_world.columns();
        let linear = Transform::from_columns(x, y, z, Vec3A::ZERO).unwrap_or(*to_world);
        let at_one = largest(return_error(&linear, Vec3A::ONE));
        Self {
            slope: if at_one > self.slope { at_one } else { self.slope },
            offset: if at_zero > self.offset { at_zero } else { self.offset },
        }
    }

    /// Three times the error of a point: that of the origin, that of the direction times `t`, and the rounding of the
    /// boxes and of this sum.
    fn pad(self, ray: &Ray, bounds: &Aabb) -> f32 {
        let largest = |v: Vec3A| etendue_core::vector::max_element(v.abs());
        let reach = largest(ray.o) + largest(bounds.lo) + largest(bounds.hi);
        3.0 * ((self.slope + gamma(4)) * reach + self.offset)
    }
}

impl Instances {
    pub(crate) fn build(world: &World, cx: &mut BuildContext<'_>) -> Result<Self, BuildError> {
        // Groups are told apart by what is in them, so that instances share wherever they can.
        let mut numbers: BTreeMap<&[u32], u32> = BTreeMap::new();
        let mut lists: Vec<&[u32]> = Vec::new();
        for instance in &world.instances {
            numbers.entry(&instance.geoms).or_insert_with(|| {
                lists.push(&instance.geoms);
                lists.len() as u32 - 1
            });
        }
        let mut groups = Vec::with_capacity(lists.len());
        for built in build_groups(world, &lists, cx) {
            let BuiltGroup { group, report } = built?;
            cx.report.add(&report);
            groups.push(group);
        }
        let (mut boxes, mut bounded, mut unbounded) = (Vec::new(), Vec::new(), Vec::new());
        let mut drift = Drift::default();
        for (inst, instance) in world.instances.iter().enumerate() {
            let Some(&group) = numbers.get(&*instance.geoms) else { continue };
            let Some(content) = groups.get(group as usize) else { continue };
            if content.is_empty() {
                continue;
            }
            let placed =
                Placed { to_world: instance.to_world, group, inst: inst as u32, mask: instance.mask };
            let bounds = instance.to_world.aabb(&content.bounds());
            if content.is_unbounded() || !bounds.is_finite() {
                unbounded.push(placed);
            } else {
                drift = drift.including(&instance.to_world);
                boxes.push(bounds);
                bounded.push(placed);
            }
        }

        let mut order = Order(Vec::with_capacity(bounded.len()));
        let costs = Costs { item: 4.0, per_item: 1, most: 2 };
        let built = build_tree(&boxes, &costs, cx.options, &mut order, cx.cancel)?;
        let placed: Vec<Placed> = order.0.iter().filter_map(|&i| bounded.get(i as usize).cloned()).collect();
        let tree = built.map(|b| {
            cx.report.nodes += b.tree.nodes.len();
            cx.report.depth = cx.report.depth.max(b.depth);
            cx.report.fallbacks += usize::from(b.fell_back);
            cx.report.bytes += size_of_val(b.tree.nodes.as_slice());
            b.tree
        });
        cx.report.bytes += size_of_val(placed.as_slice()) + size_of_val(unbounded.as_slice());
        Ok(Self { groups, tree, placed, unbounded, drift })
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let unbounded = self.unbounded.iter().map(|p| {
            let content = self.groups.get(p.group as usize).map_or(Aabb::EMPTY, Group::bounds);
            p.to_world.aabb(&content)
        });
        let start = self.tree.as_ref().map_or(Aabb::EMPTY, |t| t.bounds);
        unbounded.filter(Aabb::is_finite).fold(start, Aabb::union)
    }

    /// Offers what the world-space ray hits. True ends the query.
    pub(crate) fn query<S: Sink>(&self, ray: &Ray, masks: &[u32], sink: &mut S) -> bool {
        if self.unbounded.iter().any(|p| self.enter(p, ray, masks, sink)) {
            return true;
        }
        let Some(tree) = &self.tree else { return false };
        let boxes = BoxRay::padded(ray, self.drift.pad(ray, &tree.bounds));
        tree.visit(&boxes, &mut InstanceVisitor { all: self, ray, masks, sink })
    }

    fn enter<S: Sink>(&self, placed: &Placed, ray: &Ray, masks: &[u32], sink: &mut S) -> bool {
        if placed.mask & ray.mask == 0 {
            return false;
        }
        let Some(group) = self.groups.get(placed.group as usize) else { return false };
        let (object_ray, _) = placed.to_world.ray_to_object(ray);
        object_ray.is_valid() && group.query(&GroupQuery { ray: &object_ray, inst: placed.inst, masks }, sink)
    }
}

struct BuiltGroup {
    group: Group,
    report: BuildReport,
}

/// Each on its own; with the feature `parallel` on the current rayon pool.
fn build_groups(
    world: &World,
    lists: &[&[u32]],
    cx: &BuildContext<'_>,
) -> Vec<Result<BuiltGroup, BuildError>> {
    let (options, cancel) = (cx.options, cx.cancel);
    let build = |geoms: &&[u32]| {
        let mut cx = BuildContext { options, cancel, report: BuildReport::default() };
        let group = Group::build(world, geoms, &mut cx)?;
        Ok(BuiltGroup { group, report: cx.report })
    };
    #[cfg(feature = "parallel")]
    {
        use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
        lists.par_iter().map(build).collect()
    }
    #[cfg(not(feature = "parallel"))]
    lists.iter().map(build).collect()
}

struct Order(Vec<u32>);

impl Leaves for Order {
    fn store(&mut self, primitives: &[u32]) -> Stored {
        let first = self.0.len() as u32;
        self.0.extend_from_slice(primitives);
        Stored { first, count: primitives.len() as u32 }
    }
}

struct InstanceVisitor<'a, S> {
    all: &'a Instances,
    ray: &'a Ray,
    masks: &'a [u32],
    sink: &'a mut S,
}

impl<S: Sink> Visitor for InstanceVisitor<'_, S> {
    fn limit(&self) -> f32 {
        self.sink.limit()
    }

    fn leaf(&mut self, first: u32, count: u32) -> bool {
        let range = first as usize..(first + count) as usize;
        self.all
            .placed
            .get(range)
            .unwrap_or(&[])
            .iter()
            .any(|p| self.all.enter(p, self.ray, self.masks, self.sink))
    }
}
