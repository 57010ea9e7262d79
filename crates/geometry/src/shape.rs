use etendue_core::{Aabb, Fingerprint, Ray, Vec2, Vec3A};

use crate::Surface;

/// Where a ray meets a shape, before anything else about the point is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// Ray parameter.
    pub t: f32,
    /// Parameters of the point on the shape, in the shape's own convention.
    pub uv: Vec2,
}

/// A point drawn on a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSample {
    /// Position, object space.
    pub p: Vec3A,
    /// Bound on its absolute error per axis.
    pub p_err: Vec3A,
    /// Unit geometric normal of the front side.
    pub ng: Vec3A,
    /// Surface parameters of the point, in the convention of [`ShapeHit::uv`].
    pub uv: Vec2,
    /// Density per area, m⁻².
    pub pdf_area: f32,
}

/// A single surface that rays can meet. Meshes are not shapes: they live in flat arrays of triangles.
///
/// All positions are object space. `check_shape` of `etendue-testkit` tests any implementation.
pub trait Shape: Send + Sync {
    /// A box around the surface. [`Aabb::INFINITE`] for an unbounded one, which is then tested by every ray.
    fn bounds(&self) -> Aabb;

    /// The nearest hit that [`Ray::accepts`]. `ray.d` need not be unit; never panics, whatever the ray.
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit>;

    /// Everything about the point that [`Shape::intersect`] found on this ray.
    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface;

    /// Area in m²; 0 where it is not known (such a shape cannot be a light).
    fn area(&self) -> f32 {
        0.0
    }

    /// A point on the surface from `u` in `[0, 1)²`; `None` where the shape cannot be sampled.
    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let _ = u;
        None
    }

    /// What decides the shape, for comparing scenes.
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.opaque();
    }
}
