use glam::Vec3A;

use crate::rounding::gamma;
use crate::vector;
use crate::{Ray, Transform};

/// A point that rays leave from or end at, with its error bound.
///
/// No caller ever adds an epsilon: the true point lies within `p ± p_err`, and the ray starts outside of that box
/// on the side it leaves by (Pharr, Jakob & Humphreys 2023, section 6.8.6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// The computed point, world space.
    pub p: Vec3A,
    /// Bound on its absolute error, per axis. Zero for points in free space (a pinhole, a point light).
    pub p_err: Vec3A,
    /// Unit geometric normal of the surface the point lies on; zero in free space.
    pub ng: Vec3A,
}

impl Origin {
    /// A point that lies on no surface.
    pub fn free(p: Vec3A) -> Self {
        Self { p, p_err: Vec3A::ZERO, ng: Vec3A::ZERO }
    }

    /// The point moved along `ng` out of its error box, to the side that `d` points to, and rounded outward.
    #[inline]
    pub fn toward(&self, d: Vec3A) -> Vec3A {
        let reach = self.ng.abs().dot(self.p_err);
        if reach == 0.0 {
            return self.p;
        }
        let offset = if d.dot(self.ng) < 0.0 { -self.ng * reach } else { self.ng * reach };
        let po = self.p + offset;
        let away = |p: f32, o: f32| {
            if o > 0.0 {
                p.next_up()
            } else if o < 0.0 {
                p.next_down()
            } else {
                p
            }
        };
        Vec3A::new(away(po.x, offset.x), away(po.y, offset.y), away(po.z, offset.z))
    }

    /// The ray that leaves here along the unit vector `d`.
    #[inline]
    pub fn ray(&self, d: Vec3A, time: f32) -> Ray {
        Ray { o: self.toward(d), d, t_min: 0.0, t_max: f32::INFINITY, time, mask: u32::MAX }
    }

    /// The same point seen from the other side of `transform`, with the error that the mapping adds.
    pub fn transformed(&self, transform: &Transform) -> Self {
        let (p, p_err) = transform.point_with_error(self.p, self.p_err);
        Self { p, p_err, ng: if self.ng == Vec3A::ZERO { self.ng } else { transform.normal(self.ng) } }
    }
}

/// The stretch between two points, or from a point to infinity, along which visibility is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where the question is asked.
    pub from: Origin,
    /// Unit direction toward the other end as the sampler chose it; used as it is when `to` is `None`.
    pub d: Vec3A,
    /// The other end; `None` is at infinity.
    pub to: Option<Origin>,
    /// Moment in the shutter interval, in `[0, 1)`.
    pub time: f32,
}

impl Segment {
    /// The ray whose occlusion answers the question; `None` when the ends coincide.
    ///
    /// Both ends are moved out of their error boxes toward each other, the far one by as much more as computing the
    /// direction and the distance may lose, so that neither surface can shadow itself.
    #[inline(always)]
    pub fn ray(&self) -> Option<Ray> {
        let Some(to) = &self.to else {
            return Some(self.from.ray(self.d, self.time));
        };
        let o = self.from.toward(self.d);
        let widened = Origin { p_err: to.p_err + (o.abs() + to.p.abs()) * gamma(5), ..*to };
        let span = widened.toward(-self.d) - o;
        let d = vector::try_normalize(span)?;
        if span.dot(self.d) <= 0.0 {
            return None;
        }
        Some(Ray { o, d, t_min: 0.0, t_max: vector::length(span), time: self.time, mask: u32::MAX })
    }
}
