use etendue_core::{Ray, Vec3A, vector};
use etendue_geometry::{Shape, ShapeHit, Surface};

use crate::budget::{Failure, Judge};

/// Most crossings of one line.
const MOST: usize = 64;

/// Follows a line through the shape from hit to hit, and keeps where it met the surface.
pub(super) fn follow(
    shape: &dyn Shape,
    ray: &Ray,
    radius: f32,
    around: &mut Around,
    crossings: &mut Vec<Vec3A>,
    judge: &mut Judge,
) -> Result<(), Failure> {
    let mut ray = *ray;
    while let Some(hit) = shape.intersect(&ray) {
        let s = shape.surface(&ray, &hit);
        interval(shape, &ray, &hit, radius, judge)?;
        point(shape, &ray, &hit, &s, radius, judge)?;
        respawn(shape, &ray, &s, radius, judge)?;
        if crossings.is_empty() {
            around.look(shape, &ray, &hit, &s, radius);
        }
        crossings.push(s.p);
        if crossings.len() > MOST {
            return Err(Failure { test: "endless", what: format!("{} crossings along {ray:?}", MOST + 1) });
        }
        ray = s.origin().ray(ray.d, 0.0);
    }
    Ok(())
}

/// The interval of the ray, and the meaning of `t`.
fn interval(
    shape: &dyn Shape,
    ray: &Ray,
    hit: &ShapeHit,
    radius: f32,
    judge: &mut Judge,
) -> Result<(), Failure> {
    judge.require(ray.accepts(hit.t), "interval", || format!("t = {} on {ray:?}", hit.t))?;
    // The same ray with a longer direction: t is measured in its lengths.
    let double = Ray { d: ray.d * 2.0, t_min: ray.t_min * 0.5, t_max: ray.t_max * 0.5, ..*ray };
    let t2 = shape.intersect(&double).map(|h| h.t * 2.0);
    let slack = 1e-4 * hit.t.abs().max(radius);
    judge.require(t2.is_some_and(|t| (t - hit.t).abs() <= slack), "non-unit", || {
        format!("t = {}, with twice the direction {t2:?}, on {ray:?}", hit.t)
    })?;
    // An open interval that ends before the hit, or begins behind it, does not hold it.
    let before = Ray { t_max: hit.t, ..*ray };
    let behind = Ray { t_min: hit.t, ..*ray };
    let (b, a) = (shape.intersect(&before), shape.intersect(&behind));
    judge.require(
        b.is_none_or(|h| before.accepts(h.t)) && a.is_none_or(|h| behind.accepts(h.t)),
        "interval",
        || format!("t_max = {}: {b:?}; t_min the same: {a:?}", hit.t),
    )?;
    judge.require(b.is_none(), "nearest", || format!("t = {} on {ray:?}, but {b:?} is nearer", hit.t))
}

/// Place, error bound and frame of the surface point.
fn point(
    shape: &dyn Shape,
    ray: &Ray,
    hit: &ShapeHit,
    s: &Surface,
    radius: f32,
    judge: &mut Judge,
) -> Result<(), Failure> {
    // The point may lie a little beside the ray, along the surface: parameters are rounded too.
    let far = hit.t.abs() * vector::length(ray.d);
    let slack = s.p_err + (ray.o.abs() + s.p.abs() + Vec3A::splat(far)) * 1e-5 + radius * 1e-6;
    let on_ray = (ray.at(hit.t) - s.p).abs().cmple(slack).all();
    judge.require(s.p.is_finite() && on_ray, "point", || {
        format!("{} on the ray, {} on the surface, bound {}", ray.at(hit.t), s.p, s.p_err)
    })?;
    let bound = s.p_err.cmpge(Vec3A::ZERO).all() && s.p_err.is_finite();
    judge.require(bound, "error bound", || format!("{}", s.p_err))?;
    let bounds = shape.bounds();
    let inside = s.p.cmpge(bounds.lo - slack).all() && s.p.cmple(bounds.hi + slack).all();
    judge.require(inside, "bounds", || format!("{} outside of {bounds:?}", s.p))?;
    let f = &s.shading;
    let unit = |v: Vec3A| (vector::length(v) - 1.0).abs() < 1e-4;
    let square = |a: Vec3A, b: Vec3A| a.dot(b).abs() < 1e-4;
    let frame = unit(s.ng) && unit(f.x) && unit(f.y) && unit(f.z);
    let frame = frame && square(f.x, f.y) && square(f.y, f.z) && square(f.z, f.x) && f.z.dot(s.ng) > 0.0;
    judge.require(frame, "frame", || format!("ng = {}, shading = {f:?}", s.ng))
}

/// What leaves here must not find this place again, on either side.
fn respawn(shape: &dyn Shape, ray: &Ray, s: &Surface, radius: f32, judge: &mut Judge) -> Result<(), Failure> {
    // Across a convex edge another face may be as near, but it faces elsewhere.
    // A chord as flat as the rays below is met again truly: a ball's is a thousandth of its bounds away.
    let near = (1e-5 * (radius + vector::length(s.p))).min(1e-3 * radius);
    // Grazing by a thousandth: less, and the surface's own curvature may bring it back.
    let grazing = s.shading.x;
    for d in [ray.d, -ray.d, grazing + s.ng * 1e-3, grazing - s.ng * 1e-3] {
        let d = vector::normalize(d);
        let spawned = s.origin().ray(d, 0.0);
        let again = shape.intersect(&spawned);
        let same =
            again.filter(|h| h.t <= near).is_some_and(|h| shape.surface(&spawned, &h).ng.dot(s.ng) > 0.9);
        judge.require(!same, "self-hit", || format!("at {} along {d}: {again:?}, bound {}", s.p, s.p_err))?;
    }
    Ok(())
}

/// Normals and derivatives against the surface around the hits.
#[derive(Default)]
pub(super) struct Around {
    normals: Tally,
    derivatives: Tally,
    worst: String,
}

#[derive(Default)]
struct Tally {
    asked: u32,
    wrong: u32,
}

impl Around {
    /// Looks at two places beside the hit.
    fn look(&mut self, shape: &dyn Shape, ray: &Ray, hit: &ShapeHit, s: &Surface, radius: f32) {
        // Edge-on, a step aside is a leap along the surface.
        if s.ng.dot(ray.d).abs() < 0.2 {
            return;
        }
        let frame = etendue_core::Frame::from_normal(ray.d);
        for aside in [frame.x, frame.y] {
            let beside = Ray { o: ray.o + aside * (1e-3 * radius), ..*ray };
            let Some(h) = shape.intersect(&beside).filter(|h| (h.t - hit.t).abs() < 1e-2 * radius) else {
                continue;
            };
            let other = shape.surface(&beside, &h);
            let along = other.p - s.p;
            let length = vector::length(along);
            self.normals.asked += 1;
            // A sphere of the same radius bends by 0.0005 over this distance.
            if along.dot(s.ng).abs() > 0.03 * length {
                self.normals.wrong += 1;
                self.worst = format!("ng = {} at {}, but the surface goes on to {}", s.ng, s.p, other.p);
            }
            let du = other.uv[0] - s.uv[0];
            let known = s.dpdu != Vec3A::ZERO && s.dpdv != Vec3A::ZERO;
            if known && du.x.abs() < 0.1 && du.y.abs() < 0.1 {
                self.derivatives.asked += 1;
                let predicted = s.dpdu * du.x + s.dpdv * du.y;
                if vector::length(predicted - along) > 0.2 * length {
                    self.derivatives.wrong += 1;
                    self.worst =
                        format!("dpdu {} and dpdv {} give {predicted} for a step {along}", s.dpdu, s.dpdv);
                }
            }
        }
    }

    /// Edges, poles and seams may disagree, if they are few.
    pub(super) fn judge(&self, judge: &mut Judge) -> Result<(), Failure> {
        let few = |t: &Tally| f64::from(t.wrong) <= 0.01 * f64::from(t.asked) + 2.0;
        judge.require(few(&self.normals), "normal", || {
            format!("wrong at {} of {} places; {}", self.normals.wrong, self.normals.asked, self.worst)
        })?;
        judge.require(few(&self.derivatives), "derivatives", || {
            format!(
                "wrong at {} of {} places; {}",
                self.derivatives.wrong, self.derivatives.asked, self.worst
            )
        })
    }
}
