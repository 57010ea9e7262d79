//! The watertight test of a ray against a triangle (Woop, Benthin & Wald 2013), decided in double precision.
//!
//! A corner is translated by the ray's origin and sheared along the ray by arithmetic that knows nothing of the
//! triangle it belongs to, so two triangles that share an edge see the same two points in the plane across the ray.
//! There the *signs* of the three edge functions are exact. A ray exactly through an edge or a corner is decided as if
//! it were moved by an infinitesimal step along x and a far smaller one along y (Edelsbrunner & Mücke 1990), which
//! gives each edge one owner: a ray crosses a closed mesh an even number of times, whatever it is aimed at.

use etendue_core::glam::DVec3;
use etendue_core::{Ray, Vec2, Vec3A, vector};

use crate::double::wide;
use crate::exact::two_product_error;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Ray parameter; it may lie outside of the ray's interval.
    pub t: f32,
    /// Barycentric weights of vertices 1 and 2.
    pub uv: Vec2,
}

/// A ray prepared for the triangle test: the axis it follows most and the shear that turns it into that axis.
#[derive(Clone, Copy, Debug)]
pub struct TriangleRay {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
    axis: usize,
    shear_x: f64,
    shear_y: f64,
    inverse_z: f64,
}

/// A corner seen along the ray: `x` and `y` across it, `z` along its main axis.
#[derive(Clone, Copy)]
struct Corner {
    x: f64,
    y: f64,
    z: f64,
}

/// An edge function and its exact sign.
#[derive(Clone, Copy)]
struct Edge {
    value: f64,
    sign: i8,
}

impl TriangleRay {
    /// Prepares a ray. An invalid ray gives a query that finds nothing.
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        let d = wide(ray.d);
        let axis = vector::max_axis(ray.d.abs());
        let [x, y, z] = permuted(d, axis);
        let inverse = DVec3::new(1.0 / d.x, 1.0 / d.y, 1.0 / d.z);
        Self {
            origin: wide(ray.o),
            direction: d,
            inverse,
            axis,
            shear_x: x / z,
            shear_y: y / z,
            inverse_z: 1.0 / z,
        }
    }

    /// The intersection with the triangle's plane where it lies inside of the triangle, on either side of the
    /// origin. Both faces count. The weights are non-negative before they are rounded.
    #[inline]
    pub fn intersect(&self, v: [Vec3A; 3]) -> Option<TriangleHit> {
        self.intersect_wide(v.map(wide))
    }

    /// The same for corners that need more than single precision.
    pub(crate) fn intersect_wide(&self, v: [DVec3; 3]) -> Option<TriangleHit> {
        let [a, b, c] = v.map(|p| self.corner(p));
        let u = edge(&b, &c)?;
        let v_ = edge(&c, &a)?;
        if u.sign != v_.sign {
            return None;
        }
        let w = edge(&a, &b)?;
        if w.sign != u.sign {
            return None;
        }
        let det = u.value + v_.value + w.value;
        // Three values too close to zero for double precision: the triangle is a point at this distance.
        let (wa, wb, wc) = if det == 0.0 {
            (1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0)
        } else {
            (u.value / det, v_.value / det, w.value / det)
        };
        let t = self.on_plane(v).unwrap_or((wa * a.z + wb * b.z + wc * c.z) * self.inverse_z);
        let t = self.within_box(t, v)? as f32;
        (!t.is_nan()).then_some(TriangleHit { t, uv: Vec2::new(wb as f32, wc as f32) })
    }

    #[inline]
    fn corner(&self, p: DVec3) -> Corner {
        let [x, y, z] = permuted(p - self.origin, self.axis);
        Corner { x: x - self.shear_x * z, y: y - self.shear_y * z, z }
    }

    /// Where the ray meets the triangle's plane; `None` where it runs within the plane. Its error is a few units of
    /// double precision *per axis*, so that the sign is right for an origin that was moved out of its error box.
    #[inline]
    fn on_plane(&self, [a, b, c]: [DVec3; 3]) -> Option<f64> {
        let n = (b - a).cross(c - a);
        let t = (a - self.origin).dot(n) / self.direction.dot(n);
        t.is_finite().then_some(t)
    }

    /// `t` moved, by less than its own error, to where the ray is inside of the triangle's box, so that no
    /// conservative box test disagrees with it. Only nearly edge-on triangles are moved at all.
    ///
    /// `None` where the ray misses the box: that takes a needle so thin for its length that double precision cannot
    /// tell its sides apart. Hierarchies would find such a hit or not, depending on their boxes.
    #[inline]
    fn within_box(&self, t: f64, v: [DVec3; 3]) -> Option<f64> {
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for i in 0..3 {
            let inverse = self.inverse[i];
            if !inverse.is_finite() {
                continue;
            }
            let at = v.map(|p| (p[i] - self.origin[i]) * inverse);
            let lower = |x: f64, y: f64| if x < y { x } else { y };
            let upper = |x: f64, y: f64| if x > y { x } else { y };
            near = upper(lower(lower(at[0], at[1]), at[2]), near);
            far = lower(upper(upper(at[0], at[1]), at[2]), far);
        }
        // Far above the rounding of this test, far below the slack of the boxes.
        const SLACK: f64 = 1.0 / (1u64 << 40) as f64;
        if near > far + far.abs() * SLACK {
            return None;
        }
        Some(if t > far {
            far
        } else if t < near {
            near
        } else {
            t
        })
    }
}

/// The components with `axis` last, in cyclic order.
#[inline]
fn permuted(v: DVec3, axis: usize) -> [f64; 3] {
    match axis {
        0 => [v.y, v.z, v.x],
        1 => [v.z, v.x, v.y],
        _ => [v.x, v.y, v.z],
    }
}

/// The edge function of the origin against the edge from `p` to `q`; `None` where both fall on one point or a
/// coordinate is not a number. Exchanging `p` and `q` changes the sign and nothing else.
#[inline]
fn edge(p: &Corner, q: &Corner) -> Option<Edge> {
    let (l, r) = (p.x * q.y, p.y * q.x);
    let value = l - r;
    // Rounding is monotonic: if the rounded products differ, so do the exact ones, and in the same order.
    let sign = if l > r {
        1
    } else if l < r {
        -1
    } else {
        on_line(p, q, l, r)?
    };
    Some(Edge { value, sign })
}

/// The sign where the rounded products agree: by their rounding errors, then by the infinitesimal step.
#[cold]
fn on_line(p: &Corner, q: &Corner, l: f64, r: f64) -> Option<i8> {
    let sign = |a: f64, b: f64| if a > b { 1 } else { -1 };
    if l != r {
        return None;
    }
    let (le, re) = (two_product_error(p.x, q.y, l), two_product_error(p.y, q.x, r));
    if le.is_nan() || re.is_nan() {
        return None;
    }
    if le != re {
        return Some(sign(le, re));
    }
    // The edge function of (e, e^2) grows by e (p.y - q.y) + e^2 (q.x - p.x).
    if p.y != q.y {
        Some(sign(p.y, q.y))
    } else if q.x != p.x {
        Some(sign(q.x, p.x))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f64, y: f64) -> Corner {
        Corner { x, y, z: 1.0 }
    }

    #[test]
    fn edge_signs_are_exact_and_antisymmetric() {
        let e = f64::EPSILON;
        // (1 + e)(1 - e) and 1 round to the same number and differ.
        let (p, q) = (corner(1.0 + e, 1.0), corner(1.0, 1.0 - e));
        assert_eq!(p.x * q.y, p.y * q.x);
        assert_eq!(edge(&p, &q).map(|e| e.sign), Some(-1));
        assert_eq!(edge(&q, &p).map(|e| e.sign), Some(1));
        // Through the origin: the step decides, the other way round for the other triangle.
        for (p, q) in [
            (corner(-1.0, -1.0), corner(2.0, 2.0)),
            (corner(-1.0, 0.0), corner(2.0, 0.0)),
            (corner(0.0, -1.0), corner(0.0, 3.0)),
            (corner(0.0, 0.0), corner(0.5, 0.25)),
        ] {
            let (a, b) = (edge(&p, &q).map(|e| e.sign), edge(&q, &p).map(|e| e.sign));
            assert!(a.is_some() && a == b.map(|s| -s), "{a:?} {b:?}");
        }
        assert!(edge(&corner(1.0, 2.0), &corner(1.0, 2.0)).is_none());
        assert!(edge(&corner(f64::NAN, 2.0), &corner(1.0, 2.0)).is_none());
    }

    #[test]
    fn a_fan_around_the_ray_is_hit_once() {
        // Exactly through the corner that all triangles of a fan share.
        let ray = TriangleRay::new(&Ray::new(Vec3A::Z, -Vec3A::Z));
        for n in 3..20 {
            let rim = |i: usize| {
                let (s, c) = etendue_core::math::sin_cos(std::f32::consts::TAU * (i % n) as f32 / n as f32);
                Vec3A::new(c, s, 0.0)
            };
            let hits = (0..n).filter(|&i| ray.intersect([Vec3A::ZERO, rim(i), rim(i + 1)]).is_some()).count();
            assert_eq!(hits, 1, "fan of {n}");
        }
    }
}
