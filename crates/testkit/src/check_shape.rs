use etendue_core::{Ray, Vec3A, vector};
use etendue_geometry::Shape;

use crate::budget::{Budget, EXTREMES, Failure, Judge, Outcome};
use crate::stats::mean_test;

const RAYS: usize = 20_000;
const SAMPLES: usize = 20_000;

/// Tests a shape against the contract of [`Shape`].
///
/// Every hit lies within the ray's interval and the bounds; the surface point lies on the ray within its own error
/// bound; normals and frames are unit and on one side; a ray spawned at a hit, to either side, does not hit the same
/// place again; non-unit directions keep the meaning of `t`; invalid rays hit nothing. If the shape can be sampled:
/// samples lie where rays find the shape, the density is 1/area in the mean, and rays through it see the area that
/// [`Shape::area`] claims (Cauchy–Crofton).
///
/// Power: an area or a sampling density wrong by 5 % is rejected.
///
/// # Errors
/// The first [`Failure`].
pub fn check_shape(shape: &dyn Shape, budget: &Budget) -> Outcome {
    let mut judge = Judge::new(budget, 2);
    let mut random = budget.random(0x5a9e);
    let bounds = shape.bounds();
    judge.require(!bounds.is_empty(), "bounds", || format!("{bounds:?} is empty"))?;
    let (center, radius) =
        if bounds.is_finite() { (bounds.center(), bounds.radius()) } else { (Vec3A::ZERO, 1.0) };
    judge.require(radius > 0.0, "bounds", || "a box without extent".into())?;

    invalid_rays(shape, center, radius, &mut judge)?;
    let mut crossings = Vec::new();
    for _ in 0..budget.samples(RAYS) {
        // Lines through a disc of the bounding sphere's radius: uniform over all lines that meet the sphere.
        let d = random.direction();
        let frame = etendue_core::Frame::from_normal(d);
        let disc = etendue_sampling::warp::disc(random.pair()) * radius;
        let through = center + frame.x * disc.x + frame.y * disc.y;
        let ray = Ray::new(through - d * (2.0 * radius), d);
        crossings.push(f64::from(follow(shape, &ray, radius, &mut judge)?));
    }
    let area = shape.area();
    judge.require(area >= 0.0 && area.is_finite(), "area", || format!("{area}"))?;
    if area > 0.0 && bounds.is_finite() {
        // The mean number of crossings of such a line is A / (2 π R²).
        let expected = f64::from(area) / (std::f64::consts::TAU * f64::from(radius).powi(2));
        let test = mean_test(&crossings, expected);
        judge.p_value(test.p, "area", || {
            format!("lines cross {} times in the mean, the area says {expected}", test.estimate)
        })?;
    }
    sampling(shape, budget, radius, &mut judge)?;
    judge.done()
}

/// Follows a line through the shape; returns the number of crossings.
fn follow(shape: &dyn Shape, ray: &Ray, radius: f32, judge: &mut Judge) -> Result<u32, Failure> {
    let bounds = shape.bounds();
    let mut ray = *ray;
    let mut crossings = 0;
    while let Some(hit) = shape.intersect(&ray) {
        judge.require(ray.accepts(hit.t), "interval", || format!("t = {} on {ray:?}", hit.t))?;
        // The same ray with a longer direction: t is measured in its lengths.
        let double = Ray { d: ray.d * 2.0, t_min: ray.t_min * 0.5, t_max: ray.t_max * 0.5, ..ray };
        let t2 = shape.intersect(&double).map(|h| h.t * 2.0);
        judge.require(t2.is_some_and(|t| (t - hit.t).abs() <= 1e-4 * hit.t.abs().max(radius)), "non-unit", || {
            format!("t = {}, with twice the direction {t2:?}", hit.t)
        })?;
        let s = shape.surface(&ray, &hit);
        let slack = s.p_err + (ray.o.abs() + s.p.abs()) * 1e-5;
        let on_ray = (ray.at(hit.t) - s.p).abs().cmple(slack * 2.0 + hit.t.abs() * 1e-5);
        judge.require(s.p.is_finite() && on_ray.all(), "point", || {
            format!("{} on the ray, {} on the surface, bound {}", ray.at(hit.t), s.p, s.p_err)
        })?;
        judge.require(s.p_err.cmpge(Vec3A::ZERO).all() && s.p_err.is_finite(), "error bound", || format!("{}", s.p_err))?;
        if bounds.is_finite() {
            let inside = s.p.cmpge(bounds.lo - slack).all() && s.p.cmple(bounds.hi + slack).all();
            judge.require(inside, "bounds", || format!("{} outside of {bounds:?}", s.p))?;
        }
        let unit = |v: Vec3A| (vector::length(v) - 1.0).abs() < 1e-4;
        let f = &s.shading;
        let frame = unit(s.ng) && unit(f.x) && unit(f.y) && unit(f.z) && f.z.dot(s.ng) > 0.0;
        judge.require(frame, "frame", || format!("ng = {}, shading = {f:?}", s.ng))?;
        // What leaves here must not find this place again, on either side.
        for d in [ray.d, -ray.d] {
            let again = shape.intersect(&s.origin().ray(d, 0.0));
            let near = again.is_some_and(|h| h.t <= 1e-5 * radius && h.t <= 4.0 * vector::length(s.p_err));
            judge.require(!near, "self-hit", || format!("at {} along {d}: {again:?}", s.p))?;
        }
        crossings += 1;
        if crossings > 64 {
            return Err(Failure { test: "endless", what: format!("65 crossings along {ray:?}") });
        }
        ray = s.origin().ray(ray.d, 0.0);
    }
    Ok(crossings)
}

fn invalid_rays(shape: &dyn Shape, center: Vec3A, radius: f32, judge: &mut Judge) -> Result<(), Failure> {
    let o = center - Vec3A::Z * (2.0 * radius);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for ray in [
            Ray::new(Vec3A::new(bad, o.y, o.z), Vec3A::Z),
            Ray::new(o, Vec3A::new(bad, 0.0, 1.0)),
            Ray { t_max: f32::NAN, ..Ray::new(o, Vec3A::Z) },
            Ray { t_min: bad.abs(), ..Ray::new(o, Vec3A::Z) },
        ] {
            if let Some(h) = shape.intersect(&ray) {
                judge.require(ray.accepts(h.t) && h.t.is_finite(), "invalid ray", || format!("{ray:?} hit at {}", h.t))?;
            }
        }
    }
    Ok(())
}

fn sampling(shape: &dyn Shape, budget: &Budget, radius: f32, judge: &mut Judge) -> Result<(), Failure> {
    for u in EXTREMES.iter().flat_map(|&x| EXTREMES.map(|y| etendue_core::Vec2::new(x, y))) {
        if let Some(s) = shape.sample(u) {
            let ok = s.p.is_finite() && s.pdf_area > 0.0 && s.pdf_area.is_finite();
            judge.require(ok, "sample", || format!("{s:?} at u = {u}"))?;
        }
    }
    let mut random = budget.random(0x5a9f);
    let mut areas = Vec::new();
    for _ in 0..budget.samples(SAMPLES) {
        let Some(s) = shape.sample(random.pair()) else { continue };
        areas.push(1.0 / f64::from(s.pdf_area));
        // A ray onto the point from its front finds the shape there.
        let o = s.p + s.ng * (0.25 * radius);
        let ray = Ray::new(o, -s.ng);
        let found = shape.intersect(&ray).is_some_and(|h| h.t <= 0.25 * radius * (1.0 + 1e-3));
        judge.require(found, "sample", || format!("no surface under the sample at {}", s.p))?;
    }
    if areas.is_empty() {
        return Ok(());
    }
    let test = mean_test(&areas, f64::from(shape.area()));
    judge.p_value(test.p, "density", || format!("1/pdf is {} in the mean, the area {}", test.estimate, test.truth))
}
