use etendue_core::{Aabb, Ray};
use etendue_geometry::Hit;

use crate::group::{BuildContext, Group, GroupQuery};
use crate::instances::Instances;
use crate::sink::{Any, Closest, Filtered, Sink};
use crate::{Accel, BuildError, HitFilter, World};

/// How much time a build may spend on a faster hierarchy. Hits do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// For previews and editing.
    Fast,
    /// About as long as a good renderer's default.
    #[default]
    Balanced,
    /// Several times longer, a few per cent faster rays.
    High,
}

/// Options of [`TreeAccel::build`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuildOptions {
    /// Time against speed.
    pub quality: Quality,
    /// A tree deeper than this is built again by halving, which cannot be deeper than 33. At most 64.
    pub max_depth: u32,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self { quality: Quality::Balanced, max_depth: 64 }
    }
}

/// What became of the geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildReport {
    /// Primitives in the hierarchies; those of a shared group once.
    pub primitives: usize,
    /// Triangles of exactly zero area: never hit.
    pub dropped_degenerate: usize,
    /// Triangles with the corners of an earlier one of their mesh: an earlier one wins every tie.
    pub dropped_duplicates: usize,
    /// Triangles and shapes that are not finite or beyond 2⁶⁰: never hit.
    pub dropped_non_finite: usize,
    /// Nodes of all trees.
    pub nodes: usize,
    /// Depth of the deepest binary tree, in nodes from root to leaf.
    pub depth: u32,
    /// Trees that became too deep and were built by halving.
    pub fallbacks: usize,
    /// Bytes held.
    pub bytes: usize,
}

impl BuildReport {
    /// The sum of two reports; of depths, the larger.
    pub(crate) fn add(&mut self, o: &Self) {
        self.primitives += o.primitives;
        self.dropped_degenerate += o.dropped_degenerate;
        self.dropped_duplicates += o.dropped_duplicates;
        self.dropped_non_finite += o.dropped_non_finite;
        self.nodes += o.nodes;
        self.depth = self.depth.max(o.depth);
        self.fallbacks += o.fallbacks;
        self.bytes += o.bytes;
    }
}

/// Hierarchies over triangles, shapes and instances: the general [`Accel`].
pub struct TreeAccel {
    direct: Group,
    /// Absent where there are no instances.
    instances: Option<Instances>,
    /// Empty where every geometry is seen by every ray.
    masks: Vec<u32>,
    bounds: Aabb,
    report: BuildReport,
}

impl TreeAccel {
    /// Builds the hierarchies. `cancel` is asked now and then, from any thread; once it says true the build ends.
    ///
    /// # Errors
    /// As [`World::check`]; [`BuildError::TooMany`]; [`BuildError::Cancelled`].
    pub fn build(
        world: &World,
        options: &BuildOptions,
        cancel: &(dyn Fn() -> bool + Sync),
    ) -> Result<Self, BuildError> {
        world.check()?;
        let mut cx = BuildContext { options, cancel, report: BuildReport::default() };
        let direct = Group::build(world, &world.direct, &mut cx)?;
        let instances =
            if world.instances.is_empty() { None } else { Some(Instances::build(world, &mut cx)?) };
        let masks = if world.masks.iter().all(|&m| m == u32::MAX) { Vec::new() } else { world.masks.clone() };
        let mut report = cx.report;
        report.bytes += size_of_val(masks.as_slice());
        let bounds = instances.as_ref().map_or(Aabb::EMPTY, Instances::bounds).union(direct.bounds());
        Ok(Self { direct, instances, masks, bounds, report })
    }

    /// What became of the geometry.
    pub fn report(&self) -> BuildReport {
        self.report
    }

    #[inline]
    fn query(&self, ray: &Ray, sink: &mut impl Sink) {
        if !ray.is_valid() {
            return;
        }
        let q = GroupQuery { ray, inst: Hit::NO_INSTANCE, masks: &self.masks };
        if self.direct.query(&q, sink) {
            return;
        }
        if let Some(instances) = &self.instances {
            instances.query(ray, &self.masks, sink);
        }
    }
}

impl Accel for TreeAccel {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let mut sink = Closest::new(ray);
        self.query(ray, &mut sink);
        sink.best
    }

    fn occluded(&self, ray: &Ray) -> bool {
        let mut sink = Any::new(ray);
        self.query(ray, &mut sink);
        sink.found
    }

    fn intersect_filtered(&self, ray: &Ray, ray_index: u32, filter: &dyn HitFilter) -> Option<Hit> {
        let mut sink = Filtered::new(Closest::new(ray), ray, ray_index, filter);
        self.query(ray, &mut sink);
        sink.inner.best
    }

    fn occluded_filtered(&self, ray: &Ray, ray_index: u32, filter: &dyn HitFilter) -> bool {
        let mut sink = Filtered::new(Any::new(ray), ray, ray_index, filter);
        self.query(ray, &mut sink);
        sink.inner.found
    }

    fn bytes(&self) -> usize {
        self.report.bytes
    }
}
