use etendue_core::{Aabb, Fingerprint, Frame, Ray, Vec2, Vec3A, vector};

use crate::double::{largest, rounded, wide};
use crate::{Shape, ShapeError, ShapeHit, Surface};

/// An unbounded plane. Its front is the side the normal points to; `uv` are metres along the two tangents of
/// [`Frame::from_normal`], counted from the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: Vec3A,
    normal: Vec3A,
}

impl Plane {
    /// The plane through a point; the normal need not be unit.
    ///
    /// # Errors
    /// [`ShapeError`] where a number is not finite or the normal is zero.
    pub fn new(point: Vec3A, normal: Vec3A) -> Result<Self, ShapeError> {
        let not_finite = |parameter| ShapeError::NotFinite { shape: "plane", parameter };
        if !point.is_finite() {
            return Err(not_finite("the point"));
        }
        if !normal.is_finite() {
            return Err(not_finite("the normal"));
        }
        let normal = vector::try_normalize(normal).ok_or(ShapeError::ZeroNormal { shape: "plane" })?;
        Ok(Self { point, normal })
    }

    /// A point of the plane.
    pub fn point(&self) -> Vec3A {
        self.point
    }

    /// Unit normal.
    pub fn normal(&self) -> Vec3A {
        self.normal
    }

    fn parameters(&self, p: etendue_core::glam::DVec3) -> Vec2 {
        let frame = Frame::from_normal(self.normal);
        let v = p - wide(self.point);
        Vec2::new(v.dot(wide(frame.x)) as f32, v.dot(wide(frame.y)) as f32)
    }
}

impl Shape for Plane {
    fn bounds(&self) -> Aabb {
        Aabb::INFINITE
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let (o, d, n) = (wide(ray.o), wide(ray.d), wide(self.normal));
        let t = (wide(self.point) - o).dot(n) / d.dot(n);
        let rounded = t as f32;
        // A parallel ray gives an infinity or no number: neither is accepted.
        (ray.accepts(rounded) && rounded.is_finite())
            .then(|| ShapeHit { t: rounded, uv: self.parameters(o + d * t) })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let n = wide(self.normal);
        let p = wide(ray.o) + wide(ray.d) * f64::from(hit.t);
        // Back onto the plane: the rounding of `t` moved the point along the ray.
        let p = p - n * ((p - wide(self.point)).dot(n) / n.dot(n));
        let at = rounded(p, largest(p) + largest(wide(self.point)));
        let mut surface = Surface::new(at.p, at.p_err, self.normal);
        surface.uv = [hit.uv; 2];
        surface.dpdu = surface.shading.x;
        surface.dpdv = surface.shading.y;
        surface
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("plane");
        f.floats(&self.point.to_array());
        f.floats(&self.normal.to_array());
    }
}
