use std::f64::consts::PI;

use etendue_core::glam::DVec3;
use etendue_core::{Aabb, Fingerprint, Frame, Ray, Vec2, Vec3A, vector};
use etendue_sampling::warp;

use crate::double::{Rounded, largest, rounded, wide};
use crate::{Shape, ShapeError, ShapeHit, ShapeSample, Surface};

/// A flat round disc. Its front is the side the normal points to; `uv` are those of the square around it, along the
/// two tangents of [`Frame::from_normal`], so that the middle is (½, ½) and there is no seam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    center: Vec3A,
    normal: Vec3A,
    radius: f32,
}

/// Orthogonal tangents in double precision, of the normal's length or nearly: those of single precision leave the
/// plane by more than positions are rounded.
struct Axes {
    x: DVec3,
    y: DVec3,
    n: DVec3,
}

impl Disc {
    /// A disc from its centre, normal (of any length) and radius.
    ///
    /// # Errors
    /// [`ShapeError`] where a number is not finite, the normal is zero or the radius is not greater than zero.
    pub fn new(center: Vec3A, normal: Vec3A, radius: f32) -> Result<Self, ShapeError> {
        let shape = "disc";
        for (finite, parameter) in [
            (center.is_finite(), "the centre"),
            (normal.is_finite(), "the normal"),
            (radius.is_finite(), "the radius"),
        ] {
            if !finite {
                return Err(ShapeError::NotFinite { shape, parameter });
            }
        }
        if radius <= 0.0 {
            return Err(ShapeError::Radius { shape, radius });
        }
        let normal = vector::try_normalize(normal).ok_or(ShapeError::ZeroNormal { shape })?;
        Ok(Self { center, normal, radius })
    }

    /// Centre.
    pub fn center(&self) -> Vec3A {
        self.center
    }

    /// Unit normal of the front.
    pub fn normal(&self) -> Vec3A {
        self.normal
    }

    /// Radius in m, greater than zero.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    fn axes(&self) -> Axes {
        let n = wide(self.normal);
        let n = n / n.dot(n).sqrt();
        let x = wide(Frame::from_normal(self.normal).x);
        let x = x - n * x.dot(n);
        let x = x / x.dot(x).sqrt();
        Axes { x, y: n.cross(x), n }
    }

    /// The `uv` of a point within the plane, from its displacement from the centre.
    pub fn parameters(&self, from_center: DVec3) -> Vec2 {
        let axes = self.axes();
        let half = 0.5 / f64::from(self.radius);
        let at = |axis: DVec3| (0.5 + from_center.dot(axis) * half) as f32;
        Vec2::new(at(axes.x), at(axes.y))
    }

    fn rounded(&self, from_center: DVec3) -> Rounded {
        let c = wide(self.center);
        rounded(c + from_center, largest(c) + f64::from(self.radius))
    }
}

impl Shape for Disc {
    fn bounds(&self) -> Aabb {
        let (c, n, r) = (wide(self.center), wide(self.normal), f64::from(self.radius));
        let squared = n * n;
        // How far the rim reaches along an axis: the sine of the angle between axis and normal.
        let reach = |others: f64| r * (others / n.dot(n)).sqrt();
        let e = DVec3::new(
            reach(squared.y + squared.z),
            reach(squared.z + squared.x),
            reach(squared.x + squared.y),
        );
        let side = |v: DVec3, f: fn(f32) -> f32| Vec3A::new(f(v.x as f32), f(v.y as f32), f(v.z as f32));
        Aabb { lo: side(c - e, f32::next_down), hi: side(c + e, f32::next_up) }
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let (o, d, n) = (wide(ray.o), wide(ray.d), wide(self.normal));
        let f = o - wide(self.center);
        let t = -f.dot(n) / d.dot(n);
        let v = f + d * t;
        let r = f64::from(self.radius);
        let rounded = t as f32;
        // A parallel ray gives an infinity or no number: neither is accepted.
        (v.dot(v) <= r * r && ray.accepts(rounded) && rounded.is_finite())
            .then(|| ShapeHit { t: rounded, uv: self.parameters(v) })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let n = wide(self.normal);
        let v = wide(ray.o) - wide(self.center) + wide(ray.d) * f64::from(hit.t);
        // Back onto the plane and into the rim: the rounding of `t` moved the point along the ray.
        let v = v - n * (v.dot(n) / n.dot(n));
        let (l, r) = (v.dot(v).sqrt(), f64::from(self.radius));
        let at = self.rounded(if l > r { v * (r / l) } else { v });
        let mut surface = Surface::new(at.p, at.p_err, self.normal);
        surface.uv = [hit.uv; 2];
        surface.dpdu = surface.shading.x * (2.0 * self.radius);
        surface.dpdv = surface.shading.y * (2.0 * self.radius);
        surface
    }

    fn area(&self) -> f32 {
        (PI * f64::from(self.radius) * f64::from(self.radius)) as f32
    }

    /// Uniform over the area.
    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let (axes, p) = (self.axes(), warp::disc(u));
        let r = f64::from(self.radius);
        let v = (axes.x * f64::from(p.x) + axes.y * f64::from(p.y)) * r;
        let at = self.rounded(v - axes.n * v.dot(axes.n));
        let pdf_area = 1.0 / self.area();
        (pdf_area.is_finite() && pdf_area > 0.0).then(|| ShapeSample {
            p: at.p,
            p_err: at.p_err,
            ng: self.normal,
            uv: (p + Vec2::ONE) * 0.5,
            pdf_area,
        })
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("disc");
        f.floats(&self.center.to_array());
        f.floats(&self.normal.to_array());
        f.f32(self.radius);
    }
}
