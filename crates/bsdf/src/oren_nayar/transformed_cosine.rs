use std::f32::consts::{FRAC_1_PI, TAU};

use etendue_core::{Vec2, Vec3A, math, vector};
use etendue_sampling::warp;

/// Directions drawn about as EON scatters them: a cosine lobe, cut by the plane that becomes the horizon, then
/// transformed by a matrix (clipped linearly transformed cosines), mixed with a uniform hemisphere that covers what the
/// clipped lobe leaves out (Portsmouth, Kutz & Hill 2025, section 4; fits of listing 3).
///
/// The matrix is `[a 0 b; 0 c 0; d 0 1]` in a frame whose x axis lies under the outgoing direction.
pub(super) struct TransformedCosine {
    /// Unit, in the surface: the x axis of the lobe.
    x: Vec2,
    a: f32,
    b: f32,
    c: f32,
    /// Not positive: the plane cuts the side of positive x off.
    d: f32,
    /// Share of the cosine's disc that the plane leaves, in [1/2, 1].
    kept: f32,
    /// Probability of the uniform part.
    uniform: f32,
}

impl TransformedCosine {
    #[inline]
    pub(super) fn new(o: Vec3A, r: f32) -> Self {
        let mu = o.z.clamp(0.0, 1.0);
        let length = (o.x * o.x + o.y * o.y).sqrt();
        let x = if length > 0.0 { Vec2::new(o.x, o.y) / length } else { Vec2::X };
        let a = 1.0 + r * (0.303392 + (-0.518982 + 0.111709 * mu) * mu + (-0.276266 + 0.335918 * mu) * r);
        let b = r * (-1.16407 + 1.15859 * mu + (0.150815 - 0.150105 * mu) * r) / (mu * mu * mu - 1.43545);
        let c = 1.0 + r * (0.20013 + (-0.506373 + 0.261777 * mu) * mu);
        let d = r * (0.540852 + (-1.01625 + 0.475392 * mu) * mu) / (-1.0743 + (0.0725628 + mu) * mu);
        // The fit passes 0 by 0.004 near the normal; the disc's clipping is that of the negative side.
        let d = if d < 0.0 { d } else { 0.0 };
        let kept = 0.5 + 0.5 / (1.0 + d * d).sqrt();
        let uniform = if r > 0.0 {
            math::pow(r, 0.1) * (0.162925 + mu * (-0.372058 + (0.538233 - 0.290822 * mu) * mu))
        } else {
            0.0
        };
        Self { x, a, b, c, d, kept, uniform }
    }

    /// Density per solid angle at a direction above the surface.
    #[inline]
    pub(super) fn pdf(&self, i: Vec3A) -> f32 {
        let w = Vec3A::new(self.x.x * i.x + self.x.y * i.y, self.x.x * i.y - self.x.y * i.x, i.z);
        let rest = self.a - self.b * self.d;
        let det = self.c * rest;
        // The inverse times its determinant.
        let v = Vec3A::new(self.c * (w.x - self.b * w.z), rest * w.y, self.c * (self.a * w.z - self.d * w.x));
        let v2 = v.dot(v);
        let lobe = if v.z > 0.0 && v2 > 0.0 {
            let per_length = det / v2;
            v.z * per_length * per_length * FRAC_1_PI / self.kept
        } else {
            0.0
        };
        self.uniform / TAU + (1.0 - self.uniform) * lobe
    }

    /// A direction with that density; `None` if it is rounded into the surface.
    #[inline]
    pub(super) fn sample(&self, u_lobe: f32, u: Vec2) -> Option<Vec3A> {
        if u_lobe < self.uniform {
            return Some(warp::hemisphere(u));
        }
        let disc = warp::disc(u);
        // Each chord of the disc along x is squeezed to what the plane leaves of it: the ellipse x = L / √(1 + d²).
        let half = ((1.0 - disc.y) * (1.0 + disc.y)).sqrt();
        let x = self.kept * disc.x - (1.0 - self.kept) * half;
        let z = (1.0 - x * x - disc.y * disc.y).clamp(0.0, 1.0).sqrt();
        let w = Vec3A::new(self.a * x + self.b * z, self.c * disc.y, self.d * x + z);
        let w = vector::try_normalize(w)?;
        let i = Vec3A::new(self.x.x * w.x - self.x.y * w.y, self.x.y * w.x + self.x.x * w.y, w.z);
        (i.z > 0.0).then_some(i)
    }
}
