use etendue_core::{Aabb, Ray};
use etendue_geometry::triangle::TriangleRay;
use etendue_geometry::{Geometry, Hit};

use crate::shape_hits::offer_shape;
use crate::sink::{Answer, Any, Closest, Filtered, Sink};
use crate::{Accel, BuildError, HitFilter, World};

/// Tests every ray against everything: the oracle that hierarchies are compared with.
#[derive(Clone, Debug)]
pub struct BruteForce {
    world: World,
}

impl BruteForce {
    /// Keeps a copy of the world; meshes are shared, not copied.
    ///
    /// # Errors
    /// As [`World::check`].
    pub fn build(world: &World) -> Result<Self, BuildError> {
        world.check()?;
        Ok(Self { world: world.clone() })
    }

    fn query(&self, ray: &Ray, sink: &mut impl Sink) {
        if !ray.is_valid() || self.group(&self.world.direct, ray, Hit::NO_INSTANCE, sink) {
            return;
        }
        for (inst, instance) in self.world.instances.iter().enumerate() {
            if instance.mask & ray.mask != 0 {
                let object_ray = instance.ray_to_object(ray);
                if object_ray.is_valid() && self.group(&instance.geoms, &object_ray, inst as u32, sink) {
                    return;
                }
            }
        }
    }

    fn group(&self, geoms: &[u32], ray: &Ray, inst: u32, sink: &mut impl Sink) -> bool {
        let prepared = TriangleRay::new(ray);
        geoms.iter().any(|&geom| {
            let Some(geometry) = self.world.geometries.get(geom as usize) else { return false };
            if self.world.mask(geom) & ray.mask == 0 {
                return false;
            }
            match geometry {
                Geometry::Mesh(mesh) => (0..mesh.triangle_count() as u32).any(|prim| {
                    if mesh.is_degenerate(prim) {
                        return false;
                    }
                    let Some(at) = prepared.intersect(mesh.triangle(prim)) else { return false };
                    ray.accepts(at.t)
                        && sink.offer(&Hit { t: at.t, uv: at.uv, inst, geom, prim }) == Answer::Done
                }),
                other => other.shape().is_some_and(|shape| offer_shape(shape, ray, inst, geom, sink)),
            }
        })
    }
}

impl Accel for BruteForce {
    fn bounds(&self) -> Aabb {
        let finite = |b: Aabb| if b.is_finite() { b } else { Aabb::EMPTY };
        let alone = |g: &u32| finite(self.world.bounds_of(&[*g]));
        let direct = self.world.direct.iter().map(alone).fold(Aabb::EMPTY, Aabb::union);
        self.world
            .instances
            .iter()
            .map(|i| i.bounds_of(&i.geoms.iter().map(alone).fold(Aabb::EMPTY, Aabb::union)))
            .fold(direct, Aabb::union)
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
        self.world.geometries.iter().map(Geometry::bytes).sum()
    }
}
