use std::f64::consts::PI;

use etendue_core::{Ray, Segment, Spectrum, Vec2, Vec3A, vector};
use etendue_geometry::Surface;
use etendue_light::{Light, LightSample, LitPoint, Sides};
use etendue_sampling::{Moments, warp};

use crate::budget::{Budget, EXTREMES, Failure, Judge, Outcome, Random};
use crate::check_bsdf::{fits, unseen};
use crate::partition::Partition;
use crate::rounding::steps;
use crate::stats::p_of_z_beyond;

const SAMPLES: usize = 20_000;
/// Fine and coarse density, mass, irradiance.
const TESTS: usize = 4;

/// The point of a light's part that a ray meets first, as a scene would find it.
pub type Seen<'a> = dyn Fn(&Ray) -> Option<Surface> + 'a;

/// Tests one part of a light against the contract of [`Light`], as it is seen from `points`.
///
/// `seen` finds the light's own surface along a ray (its part alone); `|_| None` for point lights and lights at
/// infinity.
///
/// * Samples are finite and unit, on the side the point uses, and end on the light: within [`Light::bounds`] and its
///   cone, and the shadow ray to them does not meet the light itself.
/// * `pdf` and `emitted` or `escaped` say of a direction what the sample says.
/// * Directions fit the density (χ² on a fine and a coarse partition that follows the light, however small), whose
///   integral is the sampled fraction.
/// * The irradiance by light sampling is that found by looking around, by quadrature: no part of the light is left out.
/// * `power` is what leaves through a sphere around the light, or enters the scene: no less than nine tenths of it, no
///   more than twice (half may stay inside).
///
/// Power at effort 1, on 99 of 100 seeds: a density or radiance wrong by 2 % throughout, or by 20 % (rms) over the
/// light; a power too small by a quarter. Not seen: a light or part of one so small and far from what is sampled that no
/// direction of the quadrature meets it.
///
/// # Errors
/// The first [`Failure`].
pub fn check_light(
    light: &dyn Light,
    part: u32,
    points: &[LitPoint],
    seen: &Seen<'_>,
    budget: &Budget,
) -> Outcome {
    let mut judge = Judge::new(budget, points.len() * TESTS + 1);
    judge.require(part < light.parts(), "parts", || format!("part {part} of {}", light.parts()))?;
    let mut random = budget.random(0x116e);
    let probe = Probe { light, part, seen };
    let mut found = false;
    for at in points {
        found |= from_point(&probe, at, budget, &mut random, &mut judge)
            .map_err(|f| Failure { what: format!("{}; from {} ({:?})", f.what, at.p, at.sides), ..f })?;
    }
    let power = light.power(part, 1.0);
    let sound = power.is_finite() && power.to_array().iter().all(|&p| p >= 0.0);
    judge.require(sound && (!found || !power.is_black()), "power", || {
        format!("{power:?}, light found: {found}")
    })?;
    whole_power(&probe, power, budget, &mut random, &mut judge)?;
    judge.done()
}

/// A point that lights can be asked from, on a surface with normal `n` or, with `Vec3A::ZERO`, in free space.
pub fn lit_point(p: Vec3A, n: Vec3A) -> LitPoint {
    let sides = if n == Vec3A::ZERO { Sides::Free } else { Sides::Same };
    LitPoint { p, p_err: Vec3A::ZERO, ng: n, ns: n, sides, time: 0.0 }
}

/// The part under test and how rays find it.
struct Probe<'a> {
    light: &'a dyn Light,
    part: u32,
    seen: &'a Seen<'a>,
}

/// What a ray finds.
#[derive(Clone, Copy, Debug)]
struct Look {
    radiance: Spectrum,
    pdf: f32,
}

impl Probe<'_> {
    /// What a scene would find along a direction: radiance and light-sampling density.
    fn look(&self, at: &LitPoint, wi: Vec3A) -> Look {
        let ray = at.origin().ray(wi, at.time);
        if self.light.is_infinite() {
            let pdf = self.light.pdf(at, self.part, wi, None);
            return Look { radiance: self.light.escaped(&ray), pdf };
        }
        match (self.seen)(&ray) {
            Some(s) => Look {
                radiance: self.light.emitted(self.part, &s, -wi),
                pdf: self.light.pdf(at, self.part, wi, Some(&s)),
            },
            None => Look { radiance: Spectrum::BLACK, pdf: 0.0 },
        }
    }

    /// Whether a sample says what a ray along it finds, within what rounding the direction changes: at a limb, and from
    /// afar, that is much.
    fn agrees(&self, at: &LitPoint, s: &LightSample, found: &Look) -> bool {
        let off = |l: &Look| [(l.radiance.mean() - s.li.mean()).abs(), (l.pdf - s.pdf).abs()];
        let allowed = [2e-3 * s.li.mean(), 2e-3 * s.pdf];
        let [l, p] = off(found);
        if l <= allowed[0] && p <= allowed[1] {
            return true;
        }
        let mut moved = [0.0f32; 2];
        for step in steps() {
            let near = self.look(at, s.wi + step);
            moved[0] = moved[0].max((near.radiance.mean() - found.radiance.mean()).abs());
            moved[1] = moved[1].max((near.pdf - found.pdf).abs());
        }
        l <= allowed[0] + 2.0 * moved[0] && p <= allowed[1] + 2.0 * moved[1]
    }

    /// What must hold for any sample.
    fn sound(&self, at: &LitPoint, s: &LightSample, judge: &mut Judge) -> Result<(), Failure> {
        let ok = s.wi.is_finite()
            && (vector::length(s.wi) - 1.0).abs() < 1e-5
            && s.li.is_finite()
            && s.li.to_array().iter().all(|&l| l >= 0.0)
            && s.pdf > 0.0
            && s.pdf.is_finite();
        judge.require(ok, "sample", || format!("{s:?}"))?;
        judge.require(usable(at, s.wi), "side", || format!("{s:?} is behind the surface"))?;
        let delta = s.is_delta == self.light.is_delta() && (!s.is_delta || s.pdf == 1.0);
        judge.require(delta, "delta", || {
            format!("{s:?} of a light whose is_delta is {}", self.light.is_delta())
        })?;
        let bounds = self.light.bounds(self.part);
        judge.require(s.end.is_none() == bounds.is_none(), "end", || {
            format!("{:?} of a light whose place is {bounds:?}", s.end)
        })?;
        judge.require(!self.light.is_infinite() || bounds.is_none(), "bounds", || {
            format!("{bounds:?} of a light at infinity")
        })?;
        let Some(end) = s.end else { return Ok(()) };
        let span = end.p - at.p;
        let distance = vector::length(span);
        // Both ends are rounded.
        let slack = (vector::length(end.p) + vector::length(at.p)) * 1e-6 + distance * 1e-5;
        let off = vector::length(span - s.wi * distance);
        judge.require(off <= slack, "end", || format!("{} lies {off} beside the direction", end.p))?;
        let Some(b) = bounds else { return Ok(()) };
        let inside = end.p.cmpge(b.bounds.lo - slack).all() && end.p.cmple(b.bounds.hi + slack).all();
        judge.require(inside, "bounds", || format!("{} outside of {:?}", end.p, b.bounds))?;
        let leaves = f64::from(b.axis.dot(-s.wi)).clamp(-1.0, 1.0).acos();
        let cone = f64::from(b.cos_normals).clamp(-1.0, 1.0).acos()
            + f64::from(b.cos_emission).clamp(-1.0, 1.0).acos();
        judge.require(s.li.is_black() || leaves <= cone + 1e-3, "bounds", || {
            format!("light leaves {leaves} rad from the axis, the cone has {cone}")
        })
    }
}

/// Whether the point's own side of its surface sees the direction.
fn usable(at: &LitPoint, wi: Vec3A) -> bool {
    at.sides != Sides::Same || at.ng == Vec3A::ZERO || wi.dot(at.ng) > 0.0
}

/// The receiver's cosine; 1 in free space.
fn cosine(at: &LitPoint, wi: Vec3A) -> f32 {
    if at.ng == Vec3A::ZERO {
        1.0
    } else if usable(at, wi) {
        wi.dot(at.ng).abs()
    } else {
        0.0
    }
}

/// All tests from one point; whether any light was found.
fn from_point(
    probe: &Probe<'_>,
    at: &LitPoint,
    budget: &Budget,
    random: &mut Random,
    judge: &mut Judge,
) -> Result<bool, Failure> {
    let (light, part) = (probe.light, probe.part);
    for u in EXTREMES.iter().flat_map(|&x| EXTREMES.map(|y| Vec2::new(x, y))) {
        if let Some(s) = light.sample(at, part, u) {
            probe.sound(at, &s, judge)?;
        }
    }
    let n = budget.samples(SAMPLES);
    let scouts: Vec<Vec3A> = (0..n / 4)
        .filter_map(|_| light.sample(at, part, random.pair()).filter(|s| !s.is_delta).map(|s| s.wi))
        .collect();
    let mut directions = Vec::with_capacity(n);
    let mut sampled = Moments::default();
    let mut any = false;
    let (mut disagree, mut own_shadow) = (Odd::default(), Odd::default());
    for _ in 0..n {
        let Some(s) = light.sample(at, part, random.pair()) else {
            sampled.add(0.0);
            continue;
        };
        probe.sound(at, &s, judge)?;
        any |= !s.li.is_black();
        if s.is_delta {
            let pdf = light.pdf(at, part, s.wi, None);
            judge.require(pdf == 0.0, "delta", || format!("pdf() of a delta light is {pdf}"))?;
            continue;
        }
        sampled.add(f64::from(s.li.mean()) * f64::from(cosine(at, s.wi)) / f64::from(s.pdf));
        directions.push(s.wi);
        let found = probe.look(at, s.wi);
        let agrees = probe.agrees(at, &s, &found);
        disagree.note(!agrees, &s, || format!("a ray finds {found:?}"));
        let segment = Segment { from: at.origin(), d: s.wi, to: s.end, time: at.time };
        let meets = segment.ray().is_none_or(|r| (probe.seen)(&r).is_some());
        own_shadow.note(meets, &s, || format!("{:?}", segment.ray()));
    }
    disagree.judge(
        "agreement",
        "samples disagree in radiance or density with what a ray along them finds",
        judge,
    )?;
    own_shadow.judge("own shadow", "samples whose shadow ray meets the light itself", judge)?;
    if light.is_delta() {
        return Ok(any);
    }
    // Density and irradiance by quadrature.
    let both = |wi: Vec3A| {
        let l = probe.look(at, wi);
        [f64::from(l.pdf), f64::from(l.radiance.mean()) * f64::from(cosine(at, wi))]
    };
    let partition = Partition::new(&scouts, &directions, n, sampled.mean(), random, &both);
    fits(&partition, directions.len(), n, judge)?;
    let (mean, around) = (sampled.mean(), partition.other());
    let p = p_of_z_beyond(mean - around.value, around.error + unseen(mean, n), sampled.standard_error());
    judge.p_value(p, "irradiance", || {
        format!("{mean} ± {} by sampling the light, {around:?} by looking around", sampled.standard_error())
    })?;
    Ok(any)
}

/// Samples that are not as they should be, by what they carry.
#[derive(Default)]
struct Odd {
    all: f64,
    odd: f64,
    largest: f64,
    count: usize,
    first: String,
}

impl Odd {
    fn note(&mut self, odd: bool, s: &LightSample, how: impl FnOnce() -> String) {
        let carries = f64::from(s.li.mean()) / f64::from(s.pdf);
        self.all += carries;
        if odd {
            if self.count == 0 {
                self.first = format!("{s:?}: {}", how());
            }
            self.odd += carries;
            self.largest = self.largest.max(carries);
            self.count += 1;
        }
    }

    /// At an outline a ray may just miss, a limb is met a little off, and textures have edges: all of that carries
    /// little.
    fn judge(&self, test: &'static str, what: &str, judge: &mut Judge) -> Result<(), Failure> {
        judge.require(self.odd - self.largest <= 2e-3 * self.all, test, || {
            format!(
                "{} {what}; they carry {:.1e} of the light; {}",
                self.count,
                self.odd / self.all,
                self.first
            )
        })
    }
}

/// Power against what passes through a sphere around the light, or enters one of radius 1.
fn whole_power(
    probe: &Probe<'_>,
    claimed: Spectrum,
    budget: &Budget,
    random: &mut Random,
    judge: &mut Judge,
) -> Result<(), Failure> {
    let (light, part) = (probe.light, probe.part);
    let place = light.bounds(part).map(|b| b.bounds);
    let (center, radius) = match place {
        Some(b) if b.is_empty() || !b.is_finite() => return Ok(()),
        Some(b) => (b.center(), if b.radius() > 0.0 { 2.0 * b.radius() } else { 1.0 }),
        None => (Vec3A::ZERO, 1.0),
    };
    let mut flux = Moments::default();
    for _ in 0..budget.samples(SAMPLES) {
        let out = warp::sphere(random.pair());
        // At infinity all points see the same; half of the directions enter at each.
        let at = lit_point(center + out * radius, if place.is_none() { out } else { -out });
        let s = light.sample(&at, part, random.pair());
        flux.add(s.map_or(0.0, |s| f64::from(s.li.mean()) * f64::from(cosine(&at, s.wi)) / f64::from(s.pdf)));
    }
    let area = 4.0 * PI * f64::from(radius) * f64::from(radius);
    let (mean, se) = (flux.mean() * area, flux.standard_error() * area);
    // A closed light that shines both ways keeps half of its power inside.
    let claimed = f64::from(claimed.mean());
    let nearest = claimed.clamp(0.9 * mean, 2.2 * mean);
    let p = if mean > 0.0 { p_of_z_beyond(claimed - nearest, 0.0, se) } else { 1.0 };
    judge.p_value(p, "power", || format!("{claimed} W claimed, {mean} ± {se} W found"))
}
