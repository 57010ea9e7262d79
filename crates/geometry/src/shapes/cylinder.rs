use std::f64::consts::TAU;

use etendue_core::glam::DVec3;
use etendue_core::{Aabb, Fingerprint, Frame, Ray, Vec2, Vec3A, math};

use crate::double::{direction, largest, narrow, rounded, wide};
use crate::exact::squared_distance_beyond;
use crate::{Shape, ShapeError, ShapeHit, ShapeSample, Surface};

/// An open tube, of finite length or without ends. Its front is the outside. `uv` are the azimuth around the axis over
/// 2π, counter-clockwise as the axis comes toward the eye, and the way along it: as a fraction of the length, or in
/// metres from the given point where there are no ends. An image on it reads rightly from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    from: Vec3A,
    /// The other end; without ends the direction of the axis.
    to: Vec3A,
    radius: f32,
    has_ends: bool,
}

/// A vector's parts along the axis, in lengths of it, and across.
struct Parts {
    along: f64,
    across: DVec3,
}

impl Cylinder {
    /// The tube of a radius around the line between two points.
    ///
    /// # Errors
    /// [`ShapeError`] where a number is not finite, the points coincide or the radius is not greater than zero.
    pub fn new(from: Vec3A, to: Vec3A, radius: f32) -> Result<Self, ShapeError> {
        Self { from, to, radius, has_ends: true }.sound("an end")
    }

    /// The tube of a radius around the line through a point, without ends.
    ///
    /// # Errors
    /// [`ShapeError`] where a number is not finite, the axis is zero or the radius is not greater than zero.
    pub fn endless(point: Vec3A, axis: Vec3A, radius: f32) -> Result<Self, ShapeError> {
        Self { from: point, to: axis, radius, has_ends: false }.sound("the axis")
    }

    fn sound(self, second: &'static str) -> Result<Self, ShapeError> {
        let shape = "cylinder";
        let first = if self.has_ends { "an end" } else { "the point" };
        for (finite, parameter) in [
            (self.from.is_finite(), first),
            (self.to.is_finite(), second),
            (self.radius.is_finite(), "the radius"),
        ] {
            if !finite {
                return Err(ShapeError::NotFinite { shape, parameter });
            }
        }
        if self.radius <= 0.0 {
            return Err(ShapeError::Radius { shape, radius: self.radius });
        }
        direction(self.span()).map(|_| self).ok_or(ShapeError::NoAxis)
    }

    /// Where it begins; without ends a point of the axis.
    pub fn from(&self) -> Vec3A {
        self.from
    }

    /// Where it ends; `None` without ends.
    pub fn to(&self) -> Option<Vec3A> {
        self.has_ends.then_some(self.to)
    }

    /// Unit direction of the axis.
    pub fn axis(&self) -> Vec3A {
        direction(self.span()).unwrap_or(Vec3A::Z)
    }

    /// Radius in m, greater than zero.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Length in m; infinite without ends.
    pub fn length(&self) -> f32 {
        let span = self.span();
        if self.has_ends { span.dot(span).sqrt() as f32 } else { f32::INFINITY }
    }

    /// Along the axis, of the length if there are ends. Exact for coordinates of like size.
    fn span(&self) -> DVec3 {
        if self.has_ends { wide(self.to) - wide(self.from) } else { wide(self.to) }
    }

    fn parts(v: DVec3, span: DVec3) -> Parts {
        let along = v.dot(span) / span.dot(span);
        Parts { along, across: v - span * along }
    }

    /// The point at `t`: how far along the axis, and the unit vector away from it. Taking the direction alone puts the
    /// point back on the tube.
    fn outward(&self, ray: &Ray, t: f32) -> Parts {
        let span = self.span();
        let v = wide(ray.o) - wide(self.from) + wide(ray.d) * f64::from(t);
        let Parts { along, across } = Self::parts(v, span);
        let l = across.dot(across).sqrt();
        let held = if self.has_ends { along.clamp(0.0, 1.0) } else { along };
        let away = if l > 0.0 { across / l } else { span.any_orthonormal_vector() };
        Parts { along: held, across: away }
    }

    fn parameters(&self, at: &Parts) -> Vec2 {
        let frame = Frame::from_normal(self.axis());
        let (x, y) = (at.across.dot(wide(frame.x)), at.across.dot(wide(frame.y)));
        let turns = f64::from(math::atan2(y as f32, x as f32)) / TAU;
        let span = self.span();
        let along = if self.has_ends { at.along } else { at.along * span.dot(span).sqrt() };
        Vec2::new(if turns < 0.0 { turns + 1.0 } else { turns } as f32, along as f32)
    }

    fn place(&self, at: &Parts) -> crate::double::Rounded {
        let (from, span, r) = (wide(self.from), self.span(), f64::from(self.radius));
        let along = span * at.along;
        rounded(from + along + at.across * r, largest(from) + largest(along) + r)
    }
}

impl Shape for Cylinder {
    fn bounds(&self) -> Aabb {
        if !self.has_ends {
            return Aabb::INFINITE;
        }
        let (from, to, span) = (wide(self.from), wide(self.to), self.span());
        let squared = span * span;
        let reach = |others: f64| f64::from(self.radius) * (others / span.dot(span)).sqrt();
        let e = DVec3::new(
            reach(squared.y + squared.z),
            reach(squared.z + squared.x),
            reach(squared.x + squared.y),
        );
        let side = |v: DVec3, f: fn(f32) -> f32| Vec3A::new(f(v.x as f32), f(v.y as f32), f(v.z as f32));
        let end = |c: DVec3| Aabb { lo: side(c - e, f32::next_down), hi: side(c + e, f32::next_up) };
        end(from).union(end(to))
    }

    /// As for the sphere, across the axis: the discriminant from the distance of the axis to the ray, the roots without
    /// cancellation (Haines, Günther & Akenine-Möller 2019, "Precision improvements for ray/sphere intersection").
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let (span, r) = (self.span(), f64::from(self.radius));
        let d = Self::parts(wide(ray.d), span);
        let f = Self::parts(wide(ray.o) - wide(self.from), span);
        let a = d.across.dot(d.across);
        let b = -f.across.dot(d.across);
        let nearest = f.across + d.across * (b / a);
        let discriminant = r * r - nearest.dot(nearest);
        // Also false for an invalid ray, whose terms are not numbers, and along the axis.
        if !(discriminant >= 0.0 && a > 0.0) {
            return None;
        }
        let root = (a * discriminant).sqrt();
        let q = if b < 0.0 { b - root } else { b + root };
        let c = squared_distance_beyond(f.across, r);
        let (t0, t1) = (c / q, q / a);
        let (near, far) = if t0 < t1 { (t0, t1) } else { (t1, t0) };
        let within = |t: f64| !self.has_ends || (0.0..=1.0).contains(&(f.along + d.along * t));
        let t = [near, far].into_iter().find(|&t| within(t) && ray.accepts(t as f32))? as f32;
        t.is_finite().then(|| ShapeHit { t, uv: self.parameters(&self.outward(ray, t)) })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let n = self.outward(ray, hit.t);
        let at = self.place(&n);
        let (ng, axis) = (narrow(n.across), self.axis());
        let mut surface = Surface::new(at.p, at.p_err, ng);
        surface.uv = [hit.uv; 2];
        surface.dpdu = axis.cross(ng) * (TAU as f32 * self.radius);
        surface.dpdv = if self.has_ends { narrow(self.span()) } else { axis };
        surface.shading = Frame::from_normal_tangent(ng, surface.dpdu);
        surface
    }

    /// Without ends it has none that is known.
    fn area(&self) -> f32 {
        let span = self.span();
        if self.has_ends { (TAU * f64::from(self.radius) * span.dot(span).sqrt()) as f32 } else { 0.0 }
    }

    /// Uniform over the area.
    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let pdf_area = 1.0 / self.area();
        if !(pdf_area.is_finite() && pdf_area > 0.0) {
            return None;
        }
        let (frame, span) = (Frame::from_normal(self.axis()), self.span());
        let (sin, cos) = math::sin_cos_turns(u.x);
        let across = wide(frame.x) * f64::from(cos) + wide(frame.y) * f64::from(sin);
        let across = Self::parts(across, span).across;
        let across = across / across.dot(across).sqrt();
        let at = self.place(&Parts { along: f64::from(u.y), across });
        Some(ShapeSample { p: at.p, p_err: at.p_err, ng: narrow(across), uv: u, pdf_area })
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag(if self.has_ends { "cylinder" } else { "endless cylinder" });
        f.floats(&self.from.to_array());
        f.floats(&self.to.to_array());
        f.f32(self.radius);
    }
}
