use etendue_core::{Aabb, Ray};
use etendue_geometry::Hit;

/// Decides whether a hit counts: cut-outs. The answer must be a function of its arguments alone, never of the order
/// of visits.
pub trait HitFilter: Sync {
    /// Whether the hit is solid. `ray_index` is the ray's place in its batch (0 for a single ray).
    fn keep(&self, ray_index: u32, ray: &Ray, hit: &Hit) -> bool;
}

/// Ray queries against a fixed set of geometry.
///
/// Hits never depend on the tree, the number of threads or the order in which objects were added (up to their ids);
/// ties at equal `t` go to the lowest (inst, geom, prim). An invalid ray hits nothing.
pub trait Accel: Send + Sync {
    /// A box around everything bounded.
    fn bounds(&self) -> Aabb;

    /// Closest hit.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;

    /// Whether anything is hit.
    fn occluded(&self, ray: &Ray) -> bool;

    /// Closest hit that `filter` keeps.
    fn intersect_filtered(&self, ray: &Ray, ray_index: u32, filter: &dyn HitFilter) -> Option<Hit>;

    /// Whether anything that `filter` keeps is hit.
    fn occluded_filtered(&self, ray: &Ray, ray_index: u32, filter: &dyn HitFilter) -> bool {
        self.intersect_filtered(ray, ray_index, filter).is_some()
    }

    /// Closest hits of many independent rays. `hits` must be as long as `rays`; extra entries of either are ignored.
    fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.intersect(ray);
        }
    }

    /// Occlusion of many independent rays.
    fn occluded_batch(&self, rays: &[Ray], blocked: &mut [bool]) {
        for (ray, b) in rays.iter().zip(blocked) {
            *b = self.occluded(ray);
        }
    }

    /// [`Accel::intersect_batch`] with a filter.
    fn intersect_batch_filtered(&self, rays: &[Ray], hits: &mut [Option<Hit>], filter: &dyn HitFilter) {
        for (i, (ray, hit)) in rays.iter().zip(hits).enumerate() {
            *hit = self.intersect_filtered(ray, i as u32, filter);
        }
    }

    /// [`Accel::occluded_batch`] with a filter.
    fn occluded_batch_filtered(&self, rays: &[Ray], blocked: &mut [bool], filter: &dyn HitFilter) {
        for (i, (ray, b)) in rays.iter().zip(blocked).enumerate() {
            *b = self.occluded_filtered(ray, i as u32, filter);
        }
    }

    /// Bytes held, for the memory report.
    fn bytes(&self) -> usize;
}
