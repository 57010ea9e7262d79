use etendue_core::glam::DVec3;
use etendue_core::math::wide;
use etendue_core::{Vec2, Vec3A};

use super::{MAX_SOLID_ANGLE, MIN_SOLID_ANGLE};

/// A triangle seen from a point, ready to be sampled uniformly in solid angle.
///
/// Arvo (1995) chooses a sub-triangle of the wanted area and then a point on the arc it ends with. Here the
/// sub-triangle comes from the tangent form of the area (Van Oosterom & Strackee 1983) in double precision, which has
/// no cancellation and needs no inverse cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalTriangle {
    corners: [DVec3; 3],
    /// Unit directions of the corners.
    a: DVec3,
    b: DVec3,
    /// Unit, perpendicular to `a`, in the plane of `a` and `c`.
    toward_c: DVec3,
    /// |det(a, b, toward_c)|
    det: f64,
    solid_angle: f64,
}

/// A point of a triangle, chosen uniformly in solid angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleSample {
    /// Unit direction toward it.
    pub w: Vec3A,
    /// Weights of the second and third corner where the direction meets the triangle's plane.
    pub barycentrics: Vec2,
    /// Density per solid angle (sr⁻¹).
    pub pdf: f32,
}

pub(super) fn wide3(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

pub(super) fn dot(a: DVec3, b: DVec3) -> f64 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

pub(super) fn cross(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// Squares of single-precision lengths neither overflow nor vanish in double precision.
pub(super) fn unit(v: DVec3) -> Option<DVec3> {
    let l2 = dot(v, v);
    (l2 > 0.0 && l2 < f64::INFINITY).then(|| v / l2.sqrt())
}

impl SphericalTriangle {
    /// The triangle with corners `a`, `b`, `c`, given as displacements from the viewpoint, of either winding.
    /// `None` where its solid angle is outside [[`MIN_SOLID_ANGLE`], [`MAX_SOLID_ANGLE`]] (then sample by area), or
    /// where it degenerates.
    #[inline]
    pub fn new(a: Vec3A, b: Vec3A, c: Vec3A) -> Option<Self> {
        let corners = [wide3(a), wide3(b), wide3(c)];
        let (a, b, c) = (unit(corners[0])?, unit(corners[1])?, unit(corners[2])?);
        let volume = dot(a, cross(b - a, c - a)).abs();
        let solid_angle = 2.0 * wide::atan2(volume, 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
        if !(MIN_SOLID_ANGLE..=MAX_SOLID_ANGLE).contains(&solid_angle) {
            return None;
        }
        let chord = c - a;
        let toward_c = unit(chord - a * dot(a, chord))?;
        let det = dot(a, cross(b - a, toward_c)).abs();
        Some(Self { corners, a, b, toward_c, det, solid_angle })
    }

    /// Solid angle in steradian.
    #[inline]
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Density of [`SphericalTriangle::sample`] for every direction inside (sr⁻¹).
    #[inline]
    pub fn pdf(&self) -> f32 {
        (1.0 / self.solid_angle) as f32
    }

    /// A point uniform in solid angle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Option<TriangleSample> {
        let (sin_half, cos_half) = wide::sin_cos(0.5 * self.solid_angle * f64::from(u.x));
        // The corner c' on the arc from a to c, at angle φ from a, such that triangle (a, b, c') has area u.x Ω:
        // tan(φ/2) = tan(Ω'/2)(1 + a·b) / (det - tan(Ω'/2) b·t).
        let n = sin_half * (1.0 + dot(self.a, self.b));
        let d = self.det * cos_half - sin_half * dot(self.b, self.toward_c);
        let scale = 1.0 / (n * n + d * d);
        let c = self.a * ((d - n) * (d + n) * scale) + self.toward_c * (2.0 * n * d * scale);
        // On the arc from b to c', uniform in the cosine from b; 1 - cos of the whole arc is half the chord squared.
        let chord = c - self.b;
        let h = f64::from(u.y) * 0.5 * dot(chord, chord);
        let toward = chord - self.b * dot(self.b, chord);
        let w = match unit(toward) {
            Some(t) => self.b * (1.0 - h) + t * (h * (2.0 - h)).sqrt(),
            None => self.b,
        };
        let [a, b, c] = self.corners;
        let (wa, wb, wc) = (dot(w, cross(b, c)), dot(w, cross(c, a)), dot(w, cross(a, b)));
        let sum = wa + wb + wc;
        // Rounding may leave the triangle by an ulp: bring the weights back.
        let v1 = (wb / sum).clamp(0.0, 1.0);
        let v2 = (wc / sum).clamp(0.0, 1.0 - v1);
        let w = Vec3A::new(w.x as f32, w.y as f32, w.z as f32);
        (w.is_finite() && v1.is_finite() && v2.is_finite()).then(|| TriangleSample {
            w,
            barycentrics: Vec2::new(v1 as f32, v2 as f32),
            pdf: self.pdf(),
        })
    }
}
