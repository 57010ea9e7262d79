use std::f64::consts::TAU;

use etendue_core::glam::DVec3;
use etendue_core::math::wide;
use etendue_core::{Vec2, Vec3A};

use super::spherical_triangle::{cross, dot, unit, wide3};
use super::{MAX_SOLID_ANGLE, MIN_SOLID_ANGLE};

/// A rectangle seen from a point, ready to be sampled uniformly in solid angle (Ureña, Fajardo & King 2013), in double
/// precision and with the interior angles by arc tangents instead of the paper's arc cosines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalRectangle {
    /// Unit axes along the edges and away from the viewpoint.
    x: DVec3,
    y: DVec3,
    z: DVec3,
    /// Extents along the axes, and the distance of the plane.
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    distance: f64,
    /// z components of the normals of the two edges along x, and the angle offset of the paper.
    b0: f64,
    b1: f64,
    k: f64,
    solid_angle: f64,
}

/// A point of a rectangle, chosen uniformly in solid angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RectangleSample {
    /// Unit direction toward it.
    pub w: Vec3A,
    /// Position in the rectangle: the point is corner + `st.x` edge_x + `st.y` edge_y.
    pub st: Vec2,
    /// Density per solid angle (sr⁻¹).
    pub pdf: f32,
}

impl SphericalRectangle {
    /// The rectangle with the given corner (as displacement from the viewpoint) and *perpendicular* edges.
    /// `None` where its solid angle is outside [[`MIN_SOLID_ANGLE`], [`MAX_SOLID_ANGLE`]] (then sample by area), or
    /// where it degenerates.
    #[inline]
    pub fn new(corner: Vec3A, edge_x: Vec3A, edge_y: Vec3A) -> Option<Self> {
        let (corner, edge_x, edge_y) = (wide3(corner), wide3(edge_x), wide3(edge_y));
        let (x, y) = (unit(edge_x)?, unit(edge_y)?);
        let z = unit(cross(x, y))?;
        let signed = dot(corner, z);
        let (z, distance) = if signed < 0.0 { (-z, -signed) } else { (z, signed) };
        let (x0, y0) = (dot(corner, x), dot(corner, y));
        let (x1, y1) = (x0 + dot(edge_x, x), y0 + dot(edge_y, y));
        let h2 = distance * distance;
        // Interior angle at a corner: the cosine is ± the product of two normals' z components, the sine follows.
        let angle = |cx: f64, cy: f64, sign: f64| {
            wide::atan2(distance * (cx * cx + cy * cy + h2).sqrt(), sign * cx * cy)
        };
        let (g0, g1) = (angle(x1, y0, 1.0), angle(x1, y1, -1.0));
        let (g2, g3) = (angle(x0, y1, 1.0), angle(x0, y0, -1.0));
        let solid_angle = (g0 + g1) + (g2 + g3) - TAU;
        if !(MIN_SOLID_ANGLE..=MAX_SOLID_ANGLE).contains(&solid_angle) {
            return None;
        }
        let b0 = -y0 / (y0 * y0 + h2).sqrt();
        let b1 = y1 / (y1 * y1 + h2).sqrt();
        Some(Self { x, y, z, x0, x1, y0, y1, distance, b0, b1, k: TAU - g2 - g3, solid_angle })
    }

    /// Solid angle in steradian.
    #[inline]
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Density of [`SphericalRectangle::sample`] for every direction inside (sr⁻¹).
    #[inline]
    pub fn pdf(&self) -> f32 {
        (1.0 / self.solid_angle) as f32
    }

    /// A point uniform in solid angle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Option<RectangleSample> {
        // x such that the part of the rectangle below it has the wanted solid angle.
        let (sin, cos) = wide::sin_cos(f64::from(u.x) * self.solid_angle + self.k);
        let fu = (cos * self.b0 - self.b1) / sin;
        let tail = fu * fu + (self.b0 - 1.0) * (self.b0 + 1.0);
        let x = if tail > 0.0 { (self.distance / tail.sqrt()).copysign(fu) } else { self.x1.copysign(fu) };
        let x = x.clamp(self.x0, self.x1);
        // y uniform in the sine of its elevation over the line at x.
        let d2 = x * x + self.distance * self.distance;
        let sine = |y: f64| y / (d2 + y * y).sqrt();
        let (h0, h1) = (sine(self.y0), sine(self.y1));
        let h = h0 + f64::from(u.y) * (h1 - h0);
        let rest = (1.0 - h) * (1.0 + h);
        let y = if rest > 0.0 { h * (d2 / rest).sqrt() } else { self.y1 };
        let y = y.clamp(self.y0, self.y1);
        let w = unit(self.x * x + self.y * y + self.z * self.distance)?;
        let st = Vec2::new(
            ((x - self.x0) / (self.x1 - self.x0)) as f32,
            ((y - self.y0) / (self.y1 - self.y0)) as f32,
        );
        let w = Vec3A::new(w.x as f32, w.y as f32, w.z as f32);
        (w.is_finite() && st.is_finite()).then(|| RectangleSample { w, st, pdf: self.pdf() })
    }
}
