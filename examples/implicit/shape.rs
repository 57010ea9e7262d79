//! Any surface that a function describes, as a shape.
//!
//! A surface in implicit form is the set of points with f(p) = 0. A ray is o + t d, so it meets the surface where
//!
//! ```text
//! h(t) = f(o + t d) = 0,
//! ```
//!
//! one equation in one unknown. Where f is linear, as for the plane n·p − d = 0, t = (d − n·o) / (n·d); for the sphere
//! |p − c|² − r² = 0 the equation is a quadratic; for others there is no formula. The normal there is the direction of
//! ∇f: along any curve p(s) within the surface f(p(s)) stays 0, so 0 = d/ds f(p(s)) = ∇f · p'(s), and ∇f is orthogonal
//! to all tangents.
//!
//! What helps to find the *first* root is a bound on the slope: with |∇f| ≤ L, f cannot reach 0 within |f(p)| / L of p,
//! so that the ray may go that far at once (Hart 1996, "Sphere tracing"). A signed distance has L = 1.

use etendue::core::glam::DVec3;
use etendue::prelude::*;

/// A surface f(p) = 0 within a box, negative inside: its front is where f is positive.
///
/// Roots are bracketed by a change of sign and bisected to the last bit, in double precision. Steps are no shorter than
/// 2⁻¹⁶ of the box's diagonal, so a ray takes at most 2¹⁶ of them; nothing that is thicker than one is stepped over.
pub(crate) struct Implicit<F> {
    function: F,
    slope: f64,
    lo: DVec3,
    hi: DVec3,
}

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

fn narrow(v: DVec3) -> Vec3A {
    Vec3A::new(v.x as f32, v.y as f32, v.z as f32)
}

/// A ray in double precision, by lengths in metres instead of its own parameter.
struct Line {
    o: DVec3,
    d: DVec3,
    scale: f64,
}

impl<F: Fn(DVec3) -> f64 + Send + Sync> Implicit<F> {
    /// The surface of `function` within the box, with `slope` a bound on |∇f|: 1 for a signed distance.
    pub(crate) fn new(lo: Vec3A, hi: Vec3A, slope: f64, function: F) -> Self {
        Self { function, slope, lo: wide(lo), hi: wide(hi) }
    }

    fn diagonal(&self) -> f64 {
        (self.hi - self.lo).length()
    }

    /// By central differences. Their step balances what they neglect (its square) and what rounding loses (10⁻¹⁶ of
    /// f over it).
    fn gradient(&self, p: DVec3) -> DVec3 {
        let e = self.diagonal() * 1e-6;
        let along = |axis: DVec3| ((self.function)(p + axis * e) - (self.function)(p - axis * e)) / (2.0 * e);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// Where the line is inside the box.
    fn clip(&self, line: &Line) -> Option<[f64; 2]> {
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        for i in 0..3 {
            if line.d[i] == 0.0 {
                if line.o[i] < self.lo[i] || line.o[i] > self.hi[i] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((self.lo[i] - line.o[i]) / line.d[i], (self.hi[i] - line.o[i]) / line.d[i]);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        (from <= to).then_some([from, to])
    }

    /// The first root after `from` whose parameter the ray accepts.
    fn first_root(&self, ray: &Ray, line: &Line, [from, to]: [f64; 2]) -> Option<f32> {
        let h = |s: f64| (self.function)(line.o + line.d * s);
        let least = self.diagonal() / 65536.0;
        let (mut s, mut value) = (from, h(from));
        while s < to {
            let step = (value.abs() / self.slope).max(least);
            let next = (s + step).min(to);
            let at_next = h(next);
            // Also ends where f is no number.
            if !(at_next.is_finite() && next > s) {
                return None;
            }
            if (value < 0.0) != (at_next < 0.0) {
                let t = (bisect(&h, s, next, value < 0.0) / line.scale) as f32;
                if ray.accepts(t) {
                    return Some(t);
                }
            }
            (s, value) = (next, at_next);
        }
        None
    }

    /// The point of the surface next to `p`, by a few steps along the gradient (Newton).
    fn onto(&self, mut p: DVec3) -> DVec3 {
        for _ in 0..4 {
            let g = self.gradient(p);
            let squared = g.dot(g);
            if !(squared > 0.0) {
                break;
            }
            p -= g * ((self.function)(p) / squared);
        }
        p
    }
}

/// Halves the interval, at whose start h is negative or not and at whose end the other, until no number is between.
fn bisect(h: &impl Fn(f64) -> f64, mut a: f64, mut b: f64, negative: bool) -> f64 {
    loop {
        let middle = 0.5 * (a + b);
        if !(middle > a && middle < b) {
            return middle;
        }
        if (h(middle) < 0.0) == negative {
            a = middle;
        } else {
            b = middle;
        }
    }
}

impl<F: Fn(DVec3) -> f64 + Send + Sync> Shape for Implicit<F> {
    fn bounds(&self) -> etendue::core::Aabb {
        etendue::core::Aabb { lo: narrow(self.lo), hi: narrow(self.hi) }
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let (o, d) = (wide(ray.o), wide(ray.d));
        let scale = d.length();
        if !(o.is_finite() && scale > 0.0 && scale.is_finite()) {
            return None;
        }
        let line = Line { o, d: d / scale, scale };
        let [from, to] = self.clip(&line)?;
        let from = from.max(f64::from(ray.t_min) * scale);
        let to = to.min(f64::from(ray.t_max) * scale);
        // A distance behind the box is no root: and a limit that is no number ends it here.
        if !(from < to && ray.t_min.is_finite() && !ray.t_max.is_nan()) {
            return None;
        }
        self.first_root(ray, &line, [from, to]).map(|t| ShapeHit { t, uv: Vec2::ZERO })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let p = self.onto(wide(ray.o) + wide(ray.d) * f64::from(hit.t));
        let g = self.gradient(p);
        let ng = etendue::core::vector::try_normalize(narrow(g)).unwrap_or(-ray.d);
        // One rounding to single precision, and what double precision and the search have left: f over its slope.
        let left = (self.function)(p).abs() / g.length().max(1e-6 * self.slope);
        let reach = p.abs().max_element() + self.diagonal();
        let bound = p.abs() / 16_777_216.0 + DVec3::splat(2.0 * left + reach * f64::EPSILON * 64.0);
        Surface::new(narrow(p), narrow(bound * (1.0 + 1e-6)), ng)
    }
}

/// Signed distances and ways to join them, each with a slope of at most 1 (Hart 1996; Quilez 2013 for the blend).
pub(crate) mod distance {
    use etendue::core::math::wide::sin_cos;

    use super::DVec3;

    /// To a ball.
    pub(crate) fn ball(p: DVec3, center: DVec3, radius: f64) -> f64 {
        (p - center).length() - radius
    }

    /// To a ring around the vertical axis through `center`.
    pub(crate) fn torus(p: DVec3, center: DVec3, major: f64, minor: f64) -> f64 {
        let v = p - center;
        let around = (v.x * v.x + v.z * v.z).sqrt() - major;
        (around * around + v.y * v.y).sqrt() - minor
    }

    /// The union of two, with the crease between them filled over a width of `k`.
    pub(crate) fn blend(a: f64, b: f64, k: f64) -> f64 {
        let h = (k - (a - b).abs()).max(0.0) / k;
        a.min(b) - 0.25 * k * h * h
    }

    /// Walls along the gyroid sin x cos y + sin y cos z + sin z cos x = 0 (Schoen 1970) with waves of `k` per metre. It
    /// is no distance: each component of that sum's gradient is a difference of products of sines and cosines, at most
    /// √2 in size, so that the slope is at most k √6, by which it is divided.
    pub(crate) fn gyroid(p: DVec3, k: f64, thickness: f64) -> f64 {
        let ((sx, cx), (sy, cy), (sz, cz)) = (sin_cos(p.x * k), sin_cos(p.y * k), sin_cos(p.z * k));
        let sum = sx * cy + sy * cz + sz * cx;
        (sum.abs() - thickness) / (k * 6f64.sqrt())
    }
}
