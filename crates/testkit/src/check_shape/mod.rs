mod area;
mod hits;

use etendue_core::{Frame, Ray, Vec2, Vec3A};
use etendue_geometry::Shape;
use etendue_sampling::warp;

use crate::budget::{Budget, EXTREMES, Failure, Judge, Outcome, Random};
use area::Places;
use hits::follow;

const LINES: usize = 60_000;
const SAMPLES: usize = 30_000;

/// Tests a shape against the contract of [`Shape`].
///
/// Along random lines through its bounds: every hit lies within the ray's interval and the bounds, and is the nearest;
/// the surface point lies on the ray within rounding; frames are orthonormal and on the normal's side; the normal
/// and the derivatives are those of the surface around; a ray spawned at a hit, to either side, does not hit the same
/// place again; non-unit directions keep the meaning of `t`; invalid rays hit nothing.
///
/// Of the area: lines meet the surface as often as [`Shape::area`] claims (Cauchy–Crofton). If the shape can be
/// sampled, rays find the surface under every sample, with the same normal; `1/pdf_area` is the area in the mean, and
/// weighted samples lie as densely everywhere as the lines' crossings, which are uniform over the area (χ²).
///
/// Power at effort 1, on 99 of 100 seeds: an area wrong by 5 % for a shape that fills a third of its bounds' silhouette,
/// a sampling density wrong by 20 % (rms); a normal off by 0.1 on 3 % of the surface. Not seen: the area and samples
/// of an unbounded shape; details smaller than a ten-thousandth of the shape.
///
/// # Errors
/// The first [`Failure`].
pub fn check_shape(shape: &dyn Shape, budget: &Budget) -> Outcome {
    let mut judge = Judge::new(budget, 3);
    let mut random = budget.random(0x5a9e);
    let bounds = shape.bounds();
    judge.require(!bounds.is_empty(), "bounds", || format!("{bounds:?} is empty"))?;
    let (center, radius) =
        if bounds.is_finite() { (bounds.center(), bounds.radius()) } else { (Vec3A::ZERO, 1.0) };
    judge.require(radius > 0.0 && radius.is_finite(), "bounds", || {
        format!("{bounds:?} has radius {radius}")
    })?;
    invalid_rays(shape, center, radius, &mut judge)?;
    let lines = budget.samples(LINES);
    let mut places = Places::new(&bounds);
    let mut around = hits::Around::default();
    for _ in 0..lines {
        let mut crossings = Vec::new();
        follow(
            shape,
            &through(center, radius, &mut random),
            radius,
            &mut around,
            &mut crossings,
            &mut judge,
        )?;
        places.add_line(&crossings);
    }
    around.judge(&mut judge)?;
    area::check(shape, &places, lines, radius, budget.samples(SAMPLES), &mut random, &mut judge)?;
    judge.done()
}

/// A line through a disc of the bounding sphere's radius: uniform over all lines that meet the sphere.
fn through(center: Vec3A, radius: f32, random: &mut Random) -> Ray {
    let d = random.direction();
    let frame = Frame::from_normal(d);
    let disc = warp::disc(random.pair()) * radius;
    Ray::new(center + frame.x * disc.x + frame.y * disc.y - d * (2.0 * radius), d)
}

fn invalid_rays(shape: &dyn Shape, center: Vec3A, radius: f32, judge: &mut Judge) -> Result<(), Failure> {
    let o = center - Vec3A::Z * (2.0 * radius);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for ray in [
            Ray::new(Vec3A::new(bad, o.y, o.z), Vec3A::Z),
            Ray::new(o, Vec3A::new(bad, 0.0, 1.0)),
            Ray::new(o, Vec3A::ZERO),
            Ray { t_max: f32::NAN, ..Ray::new(o, Vec3A::Z) },
            Ray { t_min: bad.abs(), ..Ray::new(o, Vec3A::Z) },
            Ray { t_min: 1.0, t_max: -1.0, ..Ray::new(o, Vec3A::Z) },
        ] {
            let hit = shape.intersect(&ray);
            judge.require(hit.is_none_or(|h| ray.accepts(h.t) && h.t.is_finite()), "invalid ray", || {
                format!("{ray:?}: {hit:?}")
            })?;
        }
    }
    for u in EXTREMES.iter().flat_map(|&x| EXTREMES.map(|y| Vec2::new(x, y))) {
        if let Some(s) = shape.sample(u) {
            let ok = s.p.is_finite() && s.pdf_area > 0.0 && s.pdf_area.is_finite();
            judge.require(ok, "sample", || format!("{s:?} at u = {u}"))?;
        }
    }
    Ok(())
}
