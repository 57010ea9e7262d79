use std::f64::consts::TAU;

use etendue_core::glam::DVec3;
use etendue_core::math::wide;
use etendue_core::{Vec2, Vec3A};

use super::spherical_triangle::{cross, dot, unit, wide3};
use super::{MAX_SOLID_ANGLE, MIN_SOLID_ANGLE};

/// A rectangle's own axes, worked out once for all the points it is seen from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RectangleAxes {
    /// Unit vectors along the edges and normal to both.
    x: DVec3,
    y: DVec3,
    z: DVec3,
    /// Lengths of the edges.
    width: f64,
    height: f64,
}

impl RectangleAxes {
    /// The axes of *perpendicular* edges; `None` where an edge has no length.
    pub fn new(edge_x: Vec3A, edge_y: Vec3A) -> Option<Self> {
        let (edge_x, edge_y) = (wide3(edge_x), wide3(edge_y));
        let (x, y) = (unit(edge_x)?, unit(edge_y)?);
        let z = unit(cross(x, y))?;
        Some(Self { x, y, z, width: dot(edge_x, x), height: dot(edge_y, y) })
    }
}

/// A rectangle seen from a point, ready to be sampled uniformly in solid angle (Ureña, Fajardo & King 2013), in double
/// precision. Where the paper adds up arc cosines, the interior angles are multiplied as complex numbers here, so
/// that one arc tangent is left.
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
    /// z components of the normals of the two edges along x.
    b0: f64,
    b1: f64,
    /// The angle offset k of the paper, as cosine and sine.
    k: Complex,
    solid_angle: f64,
}

/// A number whose argument is an angle; the modulus does not matter.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    #[inline]
    fn times(self, o: Self) -> Self {
        Self { re: self.re * o.re - self.im * o.im, im: self.re * o.im + self.im * o.re }
    }
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
        Self::with_axes(corner, &RectangleAxes::new(edge_x, edge_y)?)
    }

    /// The same with the axes worked out before.
    #[inline]
    pub fn with_axes(corner: Vec3A, axes: &RectangleAxes) -> Option<Self> {
        let corner = wide3(corner);
        let RectangleAxes { x, y, z, width, height } = *axes;
        let signed = dot(corner, z);
        let (z, distance) = if signed < 0.0 { (-z, -signed) } else { (z, signed) };
        let (x0, y0) = (dot(corner, x), dot(corner, y));
        let (x1, y1) = (x0 + width, y0 + height);
        let h2 = distance * distance;
        // Interior angle at a corner: the cosine is ± the product of two normals' z components, the sine follows.
        let angle = |cx: f64, cy: f64, sign: f64| Complex {
            re: sign * cx * cy,
            im: distance * (cx * cx + cy * cy + h2).sqrt(),
        };
        let right = angle(x1, y0, 1.0).times(angle(x1, y1, -1.0));
        let left = angle(x0, y1, 1.0).times(angle(x0, y0, -1.0));
        // The four angles less 2π, up to whole turns; a solid angle of a flat thing is within one.
        let all = right.times(left);
        let excess = wide::atan2(all.im, all.re);
        let solid_angle = if excess < 0.0 { excess + TAU } else { excess };
        if !(MIN_SOLID_ANGLE..=MAX_SOLID_ANGLE).contains(&solid_angle) {
            return None;
        }
        let b0 = -y0 / (y0 * y0 + h2).sqrt();
        let b1 = y1 / (y1 * y1 + h2).sqrt();
        // k = 2π − (the angles on the left).
        let modulus = (left.re * left.re + left.im * left.im).sqrt();
        let k = Complex { re: left.re / modulus, im: -left.im / modulus };
        Some(Self { x, y, z, x0, x1, y0, y1, distance, b0, b1, k, solid_angle })
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
        let (im, re) = wide::sin_cos(f64::from(u.x) * self.solid_angle);
        let Complex { re: cos, im: sin } = self.k.times(Complex { re, im });
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
