use std::sync::Arc;

use etendue_core::{Aabb, Motion, Ray, Transform, Vec3A, Vec4};
use etendue_geometry::{AlphaAttributes, Geometry, Hit, Surface};

use crate::{BuildError, Place};

/// A group of geometries placed in the world by a transform.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Geometries, by their place in [`World::geometries`]. Instances with the same list share one hierarchy.
    pub geoms: Arc<[u32]>,
    /// Object space to world space, at time 0 if it moves.
    pub to_world: Transform,
    /// What it does after that; `None` for what stands still. A ray meets it where it is at the ray's own time.
    pub motion: Option<Arc<Motion>>,
    /// Rays that share no bit with this do not see the instance. A geometry's own mask counts too.
    pub mask: u32,
}

/// All that rays can meet. What a hierarchy is built from, and what gives a hit its meaning.
#[derive(Clone, Debug, Default)]
pub struct World {
    /// Geometries, each in its own object space.
    pub geometries: Vec<Geometry>,
    /// Visibility masks by geometry; one that is missing shares every bit.
    pub masks: Vec<u32>,
    /// Geometries that stand in the world itself: their object space is world space.
    pub direct: Vec<u32>,
    /// Geometries placed by transforms; a hit names its place in this list.
    pub instances: Vec<Instance>,
}

impl Instance {
    /// A group that stands still and is seen by every ray.
    pub fn new(geoms: Arc<[u32]>, to_world: Transform) -> Self {
        Self { geoms, to_world, motion: None, mask: u32::MAX }
    }

    /// The same, moving. A motion that moves nothing is none.
    #[must_use]
    pub fn with_motion(mut self, motion: Motion) -> Self {
        self.motion = (!motion.is_still()).then(|| Arc::new(motion));
        self
    }

    /// Where it stands at a moment in `[0, 1]`.
    #[inline]
    pub fn placement(&self, time: f32) -> Transform {
        self.motion.as_ref().map_or(self.to_world, |m| m.placement(&self.to_world, time))
    }

    /// The ray in object space, with `t` as it is.
    #[inline]
    pub fn ray_to_object(&self, ray: &Ray) -> Ray {
        match &self.motion {
            None => self.to_world.ray_to_object(ray).0,
            Some(motion) => motion.placement(&self.to_world, ray.time).ray_to_object(ray).0,
        }
    }

    /// A box, world space, around all that an object-space box passes through.
    pub fn bounds_of(&self, b: &Aabb) -> Aabb {
        match &self.motion {
            None => self.to_world.aabb(b),
            Some(motion) => motion.bounds_after(&self.to_world, b),
        }
    }
}

impl World {
    /// One geometry that stands in the world itself and is seen by every ray; returns its number.
    pub fn add(&mut self, geometry: impl Into<Geometry>) -> u32 {
        let geom = self.geometries.len() as u32;
        self.geometries.push(geometry.into());
        self.direct.push(geom);
        geom
    }

    /// The mask of a geometry.
    #[inline]
    pub fn mask(&self, geom: u32) -> u32 {
        self.masks.get(geom as usize).copied().unwrap_or(u32::MAX)
    }

    /// Whether every reference names a geometry.
    ///
    /// # Errors
    /// [`BuildError::UnknownGeometry`] for the first that does not; [`BuildError::TooMany`].
    pub fn check(&self) -> Result<(), BuildError> {
        let count = self.geometries.len();
        let limit = u32::MAX as usize - 1;
        for (what, count) in [("geometries", count), ("instances", self.instances.len())] {
            if count > limit {
                return Err(BuildError::TooMany { what, count, limit });
            }
        }
        let known = |place: Place, geom: u32| {
            if (geom as usize) < count {
                Ok(())
            } else {
                Err(BuildError::UnknownGeometry { place, geom, count })
            }
        };
        for (i, &geom) in self.direct.iter().enumerate() {
            known(Place::Direct(i), geom)?;
        }
        for (i, instance) in self.instances.iter().enumerate() {
            for &geom in instance.geoms.iter() {
                known(Place::Instance(i), geom)?;
            }
        }
        Ok(())
    }

    /// Everything about the point that a world-space ray hit, in world space.
    ///
    /// What moves is taken where it is at the ray's time. A hit that does not come from this world gives a point on the ray that faces its origin.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let Some(geometry) = self.geometries.get(hit.geom as usize) else {
            return Surface::new(ray.at(hit.t), Vec3A::ZERO, -ray.d);
        };
        match self.instances.get(hit.inst as usize) {
            None => geometry.surface(ray, hit),
            Some(instance) => match &instance.motion {
                None => placed_surface(geometry, &instance.to_world, ray, hit),
                Some(motion) => {
                    let to_world = motion.placement(&instance.to_world, ray.time);
                    let mut surface = placed_surface(geometry, &to_world, ray, hit);
                    surface.time = ray.time;
                    surface
                }
            },
        }
    }

    /// The little that a cut-out needs of the point that a world-space ray hit, in world space.
    pub fn alpha_attributes(&self, ray: &Ray, hit: &Hit) -> AlphaAttributes {
        let Some(Geometry::Mesh(mesh)) = self.geometries.get(hit.geom as usize) else {
            return AlphaAttributes { p: ray.at(hit.t), uv: [hit.uv; 2], color: Vec4::ONE };
        };
        let at = mesh.alpha_attributes(hit.prim, hit.uv);
        match self.instances.get(hit.inst as usize) {
            None => at,
            Some(instance) => match &instance.motion {
                None => AlphaAttributes { p: instance.to_world.point(at.p), ..at },
                Some(motion) => {
                    let to_world = motion.placement(&instance.to_world, ray.time);
                    AlphaAttributes { p: to_world.point(at.p), ..at }
                }
            },
        }
    }

    /// A box around a geometry list, object space.
    pub(crate) fn bounds_of(&self, geoms: &[u32]) -> Aabb {
        geoms
            .iter()
            .filter_map(|&g| self.geometries.get(g as usize))
            .fold(Aabb::EMPTY, |b, g| b.union(g.bounds()))
    }
}

#[inline]
fn placed_surface(geometry: &Geometry, to_world: &Transform, ray: &Ray, hit: &Hit) -> Surface {
    let (object_ray, _) = to_world.ray_to_object(ray);
    geometry.surface(&object_ray, hit).transformed(to_world)
}
