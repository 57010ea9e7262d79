use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::SolidAngle;
use crate::math::wide;

pub(super) fn dot(a: DVec3, b: DVec3) -> f64 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

pub(super) fn cross(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// Length by scaling with the largest component: neither overflows nor vanishes.
pub(super) fn length(v: DVec3) -> f64 {
    let m = v.x.abs().max(v.y.abs()).max(v.z.abs());
    if !(m > 0.0 && m < f64::INFINITY) {
        return m;
    }
    let w = v / m;
    m * dot(w, w).sqrt()
}

/// The part of the unit sphere that the triangle with corners `a`, `b`, `c` covers, seen from the origin: at most 2π,
/// whatever the winding. 0 if the origin lies in the triangle's plane outside it, or the triangle is degenerate
/// (Van Oosterom & Strackee 1983).
pub fn triangle_solid_angle(a: DVec3, b: DVec3, c: DVec3) -> SolidAngle {
    SolidAngle(signed_triangle(a, b, c).abs())
}

/// Positive if `a`, `b`, `c` are counter-clockwise seen from the origin's far side, that is `a · (b × c) > 0`.
fn signed_triangle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (length(a), length(b), length(c));
    if !(la > 0.0 && lb > 0.0 && lc > 0.0) {
        return 0.0;
    }
    let (a, b, c) = (a / la, b / lb, c / lc);
    // Edge differences instead of the vectors: the determinant of a small triangle keeps its digits.
    let det = dot(a, cross(b - a, c - a));
    2.0 * wide::atan2(det, 1.0 + dot(a, b) + dot(b, c) + dot(c, a))
}

/// The solid angle of a planar (or spherical) polygon given by the directions of its corners in order: the sum of its
/// signed triangles, so concave polygons are right. At most 2π; 0 for fewer than three corners.
pub fn polygon_solid_angle(corners: &[DVec3]) -> SolidAngle {
    let Some((&first, rest)) = corners.split_first() else { return SolidAngle(0.0) };
    let sum: f64 = rest.windows(2).map(|e| signed_triangle(first, e[0], e[1])).sum();
    SolidAngle(sum.abs())
}

/// Solid angle of the spherical polygon from its interior angles: the spherical excess Σα − (n − 2)π (Girard).
/// Loses digits for small polygons; [`polygon_solid_angle`] does not.
pub fn spherical_excess(interior_angles: &[f64]) -> SolidAngle {
    let n = interior_angles.len() as f64;
    SolidAngle(interior_angles.iter().sum::<f64>() - (n - 2.0) * PI)
}

/// Solid angle of the cap of half-angle `theta` (radians, in [0, π]): 4π sin²(θ/2), which keeps all digits of small
/// caps where 2π(1 − cos θ) loses them.
///
/// ```
/// use etendue_core::radiometry::cap_solid_angle;
/// use std::f64::consts::PI;
/// assert!((cap_solid_angle(PI).0 - 4.0 * PI).abs() < 1e-15 * 16.0, "the whole sphere");
/// let sun = cap_solid_angle(4.65e-3).0;
/// assert!((sun / 6.792_93e-5 - 1.0).abs() < 1e-5);
/// ```
pub fn cap_solid_angle(theta: f64) -> SolidAngle {
    let s = wide::sin_cos(0.5 * theta).0;
    SolidAngle(2.0 * TAU * s * s)
}

/// 1 − cos θ without cancellation: 2 sin²(θ/2).
pub fn one_minus_cos(theta: f64) -> f64 {
    let s = wide::sin_cos(0.5 * theta).0;
    2.0 * s * s
}
