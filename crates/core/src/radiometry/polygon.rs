use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::ProjectedSolidAngle;
use super::solid_angle::{cross, dot, length};
use crate::math::wide;

/// What of a polygon lies on the positive side of the plane through the origin with the given normal (Sutherland &
/// Hodgman 1974). Right for convex polygons; a concave one may keep zero-area bridges, which add nothing to the
/// integrals here.
pub fn clip_to_horizon(corners: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut out = Vec::with_capacity(corners.len() + 1);
    let Some(&last) = corners.last() else { return out };
    let (mut from, mut from_height) = (last, dot(last, normal));
    for &to in corners {
        let to_height = dot(to, normal);
        // Signs, not their product, which could vanish.
        if (from_height > 0.0 && to_height < 0.0) || (from_height < 0.0 && to_height > 0.0) {
            let t = from_height / (from_height - to_height);
            out.push(from + (to - from) * t);
        }
        if to_height >= 0.0 {
            out.push(to);
        }
        (from, from_height) = (to, to_height);
    }
    out
}

/// ∫ cos θ dω over the part of a planar polygon above the horizon of `normal` (any length), seen from the origin:
/// the irradiance per radiance that a uniform diffuse polygon casts, at most π. Lambert's formula (1760): half the
/// sum over the edges of the angle they subtend times the cosine of their plane's normal against `normal`. Either
/// winding; 0 where the origin lies in the polygon's plane, or the polygon below the horizon.
///
/// ```
/// use etendue_core::glam::DVec3;
/// use etendue_core::radiometry::projected_solid_angle;
/// // A unit square half a metre above: E = 1.740839503 L.
/// let square = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| DVec3::new(x, y, 0.5));
/// assert!((projected_solid_angle(&square, DVec3::Z).0 - 1.740_839_503).abs() < 1e-9);
/// ```
pub fn projected_solid_angle(corners: &[DVec3], normal: DVec3) -> ProjectedSolidAngle {
    let n = length(normal);
    if !(n > 0.0 && n < f64::INFINITY) {
        return ProjectedSolidAngle(0.0);
    }
    let normal = normal / n;
    let above = clip_to_horizon(corners, normal);
    let Some(&last) = above.last() else { return ProjectedSolidAngle(0.0) };
    let (mut from, mut sum) = (last, 0.0);
    for &to in &above {
        // Through the difference: short edges keep their direction.
        let c = cross(from, to - from);
        let sine = length(c);
        if sine > 0.0 {
            sum += wide::atan2(sine, dot(from, to)) * dot(c, normal) / sine;
        }
        from = to;
    }
    ProjectedSolidAngle(0.5 * sum.abs())
}

/// Form factor from a differential patch at the origin with the given normal to a polygon: the fraction of what the
/// patch sends out diffusely that the polygon receives, in [0, 1].
pub fn polygon_form_factor(corners: &[DVec3], normal: DVec3) -> f64 {
    projected_solid_angle(corners, normal).0 * FRAC_1_PI
}
