use etendue_core::{Origin, Ray, Spectrum, Vec3A, vector};
use etendue_geometry::Surface;
use etendue_light::{Light, LitPoint, Sides};

use crate::budget::{Budget, EXTREMES, Failure, Judge, Outcome, Random};
use crate::sphere_grid::SphereGrid;
use crate::stats::{mean_test, welch_test};

const SAMPLES: usize = 40_000;
const GRIDS: [SphereGrid; 2] = [SphereGrid { rows: 20, cols: 20 }, SphereGrid { rows: 60, cols: 60 }];

/// The point of a light's part that a ray meets first, as a scene would find it.
pub type Seen<'a> = dyn Fn(&Ray) -> Option<Surface> + 'a;

/// Tests one part of a light against the contract of [`Light`], as it is seen from `points`.
///
/// `seen` finds the light's own surface along a ray (its part alone); `|_| None` for point lights and lights at
/// infinity. Samples are finite and unit; `pdf` is that of the sample; the directions fit the density, whose
/// integral is the sampled mass (χ² on two grids); sampled radiance is the radiance that a ray along it finds; the
/// irradiance by light sampling equals that by following random directions; power is positive if light was found.
///
/// Power: a density or radiance wrong by 2 % is rejected for lights of more than a hundredth of the sphere.
///
/// # Errors
/// The first [`Failure`].
pub fn check_light(light: &dyn Light, part: u32, points: &[LitPoint], seen: &Seen<'_>, budget: &Budget) -> Outcome {
    let mut judge = Judge::new(budget, points.len() * (GRIDS.len() + 2));
    judge.require(part < light.parts(), "parts", || format!("part {part} of {}", light.parts()))?;
    let mut random = budget.random(0x116e);
    let mut found = false;
    for at in points {
        found |= from_point(light, part, at, seen, budget, &mut random, &mut judge)
            .map_err(|f| Failure { what: format!("{}; from {}", f.what, at.p), ..f })?;
    }
    let power = light.power(part, 1.0);
    let sound = power.is_finite() && power.to_array().iter().all(|&p| p >= 0.0);
    judge.require(sound && (!found || !power.is_black()), "power", || format!("{power:?}, light found: {found}"))?;
    judge.done()
}

/// A point that lights can be asked from, on a surface with normal `n` or, with `Vec3A::ZERO`, in free space.
pub fn lit_point(p: Vec3A, n: Vec3A) -> LitPoint {
    let sides = if n == Vec3A::ZERO { Sides::Free } else { Sides::Same };
    LitPoint { p, p_err: Vec3A::ZERO, ng: n, ns: n, sides, time: 0.0 }
}

fn usable(at: &LitPoint, wi: Vec3A) -> bool {
    at.sides != Sides::Same || wi.dot(at.ng) > 0.0
}

fn from_point(
    light: &dyn Light,
    part: u32,
    at: &LitPoint,
    seen: &Seen<'_>,
    budget: &Budget,
    random: &mut Random,
    judge: &mut Judge,
) -> Result<bool, Failure> {
    let sound = |s: &etendue_light::LightSample| {
        s.wi.is_finite()
            && (vector::length(s.wi) - 1.0).abs() < 1e-4
            && s.li.is_finite()
            && s.li.to_array().iter().all(|&l| l >= 0.0)
            && s.pdf > 0.0
            && s.pdf.is_finite()
    };
    for u in EXTREMES.iter().flat_map(|&x| EXTREMES.map(|y| etendue_core::Vec2::new(x, y))) {
        if let Some(s) = light.sample(at, part, u) {
            judge.require(sound(&s), "extreme u", || format!("{s:?} at u = {u}"))?;
        }
    }
    // What a scene would find along a direction: radiance and light-sampling density.
    let look = |wi: Vec3A| -> (Spectrum, f32) {
        let origin = Origin { p: at.p, p_err: at.p_err, ng: at.ng };
        let ray = origin.ray(wi, at.time);
        if light.is_infinite() {
            return (light.escaped(&ray), light.pdf(at, part, wi, None));
        }
        match seen(&ray) {
            Some(s) => (light.emitted(part, &s, -wi), light.pdf(at, part, wi, Some(&s))),
            None => (Spectrum::BLACK, 0.0),
        }
    };
    let n = budget.samples(SAMPLES);
    let mut observed = GRIDS.map(|g| vec![0u64; g.cells()]);
    let cosine = |wi: Vec3A| if at.sides == Sides::Free { 1.0 } else { wi.dot(at.ng).abs() };
    let mut sampled = Vec::with_capacity(n);
    let (mut any, mut off_surface) = (false, 0);
    for _ in 0..n {
        let Some(s) = light.sample(at, part, random.pair()) else {
            sampled.push(0.0);
            continue;
        };
        judge.require(sound(&s), "sample", || format!("{s:?}"))?;
        any |= !s.li.is_black();
        if s.is_delta {
            judge.require(light.is_delta(), "delta", || "a delta sample of a light that is not delta".into())?;
            sampled.push(0.0);
            continue;
        }
        let usable = usable(at, s.wi);
        sampled.push(if usable { f64::from(s.li.mean() * cosine(s.wi) / s.pdf) } else { 0.0 });
        for (grid, cells) in GRIDS.iter().zip(&mut observed) {
            cells[grid.cell(s.wi)] += 1;
        }
        let (le, pdf) = look(s.wi);
        // At the outline the ray may just miss, and textures have edges: single disagreements are counted.
        let agrees = (le.mean() - s.li.mean()).abs() <= 2e-3 * le.mean().max(s.li.mean())
            && (pdf - s.pdf).abs() <= 2e-3 * pdf.max(s.pdf);
        off_surface += usize::from(!agrees);
    }
    judge.require(off_surface as f64 <= 2e-3 * n as f64 + 1.0, "agreement", || {
        format!("{off_surface} of {n} samples disagree in radiance or density with what a ray along them finds")
    })?;
    if light.is_delta() || !any {
        return Ok(any);
    }
    let drawn: u64 = observed[0].iter().sum();
    for (grid, cells) in GRIDS.iter().zip(&observed) {
        let (chi2, mass) = grid.test(cells, n as u64, &|wi| f64::from(look(wi).1));
        judge.require(mass <= 1.01, "mass", || format!("the density integrates to {mass}"))?;
        judge.require((drawn as f64 / n as f64 - mass).abs() < 0.01, "mass", || {
            format!("{drawn} of {n} attempts gave a direction, the density's mass is {mass}")
        })?;
        judge.p_value(chi2.p, "density", || {
            format!("directions do not fit the density: χ² = {:.1} with {} degrees of freedom", chi2.statistic, chi2.dof)
        })?;
    }
    // The same irradiance by directions over the sphere.
    let mut looked = Vec::with_capacity(n);
    for _ in 0..n {
        let wi = random.direction();
        let l = if usable(at, wi) { look(wi).0.mean() * cosine(wi) } else { 0.0 };
        looked.push(f64::from(l) * 4.0 * std::f64::consts::PI);
    }
    let test = welch_test(&sampled, &looked);
    // Too few of the random directions find a small light to speak.
    let speaks = looked.iter().filter(|&&l| l > 0.0).count() > 200;
    judge.p_value(if speaks { test.p } else { 1.0 }, "irradiance", || {
        format!("{} by sampling the light, {} by looking around", test.estimate, test.truth)
    })?;
    let own = mean_test(&sampled, f64::from(0.0f32));
    judge.require(own.estimate >= 0.0, "irradiance", || format!("{}", own.estimate))?;
    Ok(any)
}
