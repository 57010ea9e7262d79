use std::f64::consts::{PI, TAU};

use etendue_core::glam::DVec3;
use etendue_core::{Aabb, Fingerprint, Frame, Ray, Vec2, Vec3A, math};
use etendue_sampling::warp;

use crate::double::{largest, narrow, rounded, wide};
use crate::exact::squared_distance_beyond;
use crate::{Shape, ShapeError, ShapeHit, ShapeSample, Surface};

/// A sphere. Its front side is the outside. The pole is +Y; `uv` is (azimuth from +X toward −Z over 2π, angle from −Y
/// over π), so that an image on it reads rightly from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: Vec3A,
    radius: f32,
}

impl Sphere {
    /// A sphere from its centre and radius.
    ///
    /// # Errors
    /// [`ShapeError`] where a number is not finite or the radius is not greater than zero.
    pub fn new(center: Vec3A, radius: f32) -> Result<Self, ShapeError> {
        let not_finite = |parameter| ShapeError::NotFinite { shape: "sphere", parameter };
        if !center.is_finite() {
            return Err(not_finite("the centre"));
        }
        if !radius.is_finite() {
            return Err(not_finite("the radius"));
        }
        if radius <= 0.0 {
            return Err(ShapeError::Radius { shape: "sphere", radius });
        }
        Ok(Self { center, radius })
    }

    /// Centre.
    pub fn center(&self) -> Vec3A {
        self.center
    }

    /// Radius in m, greater than zero.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Unit vector from the centre to the point at `t`. Taking the direction alone puts the point back on the sphere.
    fn outward(&self, ray: &Ray, t: f32) -> DVec3 {
        let v = wide(ray.o) + wide(ray.d) * f64::from(t) - wide(self.center);
        let l = v.dot(v).sqrt();
        if l > 0.0 { v / l } else { DVec3::Y }
    }

    fn parameters(n: DVec3) -> Vec2 {
        let azimuth = f64::from(math::atan2(-n.z as f32, n.x as f32)) / TAU;
        let azimuth = if azimuth < 0.0 { azimuth + 1.0 } else { azimuth };
        let from_pole = math::atan2((n.x * n.x + n.z * n.z).sqrt() as f32, n.y as f32);
        Vec2::new(azimuth as f32, (1.0 - f64::from(from_pole) / PI) as f32)
    }

    fn reach(&self) -> f64 {
        largest(wide(self.center)) + f64::from(self.radius)
    }
}

impl Shape for Sphere {
    fn bounds(&self) -> Aabb {
        let r = Vec3A::splat(self.radius);
        let outward = |v: Vec3A, f: fn(f32) -> f32| Vec3A::new(f(v.x), f(v.y), f(v.z));
        Aabb { lo: outward(self.center - r, f32::next_down), hi: outward(self.center + r, f32::next_up) }
    }

    /// The discriminant comes from the distance of the centre to the ray and the roots from the sum without
    /// cancellation (Haines, Günther & Akenine-Möller 2019, "Precision improvements for ray/sphere intersection").
    /// Their product is the power of the origin, which is computed with twice the digits: close to the surface it is
    /// a small difference of large squares.
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let (d, r) = (wide(ray.d), f64::from(self.radius));
        let f = wide(ray.o) - wide(self.center);
        let a = d.dot(d);
        let b = -f.dot(d);
        let nearest = f + d * (b / a);
        let discriminant = r * r - nearest.dot(nearest);
        // Also false for an invalid ray, whose terms are not numbers.
        if !(discriminant >= 0.0 && a > 0.0) {
            return None;
        }
        let root = (a * discriminant).sqrt();
        let q = if b < 0.0 { b - root } else { b + root };
        let c = squared_distance_beyond(f, r);
        let (t0, t1) = (c / q, q / a);
        let (near, far) = if t0 < t1 { (t0, t1) } else { (t1, t0) };
        let t = [near, far].into_iter().map(|t| t as f32).find(|&t| ray.accepts(t))?;
        Some(ShapeHit { t, uv: Self::parameters(self.outward(ray, t)) })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let n = self.outward(ray, hit.t);
        let at = rounded(wide(self.center) + n * f64::from(self.radius), self.reach());
        let ng = narrow(n);
        let mut surface = Surface::new(at.p, at.p_err, ng);
        surface.uv = [hit.uv; 2];
        let r = self.radius;
        // Length of the parallel over its radius; zero at the poles, where the azimuth is undefined.
        let s = ((n.x * n.x + n.z * n.z).sqrt()) as f32;
        if s > 0.0 {
            let (tau, pi) = (TAU as f32, PI as f32);
            surface.dpdu = Vec3A::new(ng.z, 0.0, -ng.x) * (tau * r);
            surface.dpdv = Vec3A::new(-ng.x * ng.y / s, s, -ng.z * ng.y / s) * (pi * r);
            surface.shading = Frame::from_normal_tangent(ng, surface.dpdu);
        }
        surface
    }

    fn area(&self) -> f32 {
        (2.0 * TAU * f64::from(self.radius) * f64::from(self.radius)) as f32
    }

    /// Uniform over the area.
    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let n = wide(warp::sphere(u));
        let n = n / n.dot(n).sqrt();
        let at = rounded(wide(self.center) + n * f64::from(self.radius), self.reach());
        let pdf_area = 1.0 / self.area();
        (pdf_area.is_finite() && pdf_area > 0.0).then(|| ShapeSample {
            p: at.p,
            p_err: at.p_err,
            ng: narrow(n),
            uv: Self::parameters(n),
            pdf_area,
        })
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("sphere");
        f.floats(&self.center.to_array());
        f.f32(self.radius);
    }
}
