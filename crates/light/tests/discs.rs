//! Disc lights: irradiance over and off the disc against closed forms, and how much less noise there is than by area.

mod support;

use std::f64::consts::PI;
use std::sync::Arc;

use etendue_core::glam::DVec3;
use etendue_core::{Ray, Spectrum, Vec2, Vec3A, vector};
use etendue_geometry::{Disc, Shape};
use etendue_light::{DiscLight, Light, LightBounds, LightSample, LitPoint, ShapeLight};
use etendue_testkit::{Budget, check_light, lit_point};
use etendue_texture::Tex;
use support::{Mean, Rng, irradiance_of, receiver};

const ONE: Tex = Tex::Constant(Spectrum::ONE);
/// Heights over the plane and lateral distances from the centre, in radii: over the disc, at its rim and off it.
const HEIGHTS: [f32; 4] = [0.05, 0.3, 1.0, 3.0];
const ASIDE: [f32; 5] = [0.0, 0.5, 0.95, 1.5, 4.0];

fn places() -> impl Iterator<Item = (f32, f32)> {
    HEIGHTS.into_iter().flat_map(|h| ASIDE.map(|aside| (h, aside)))
}

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

/// A disc of radius 0.7 that faces down on a tilted receiver plane, seen from the point where `h` and `aside` say.
fn disc_over(h: f32, aside: f32, p: Vec3A) -> (Disc, Vec3A) {
    let (n, t) = (Vec3A::new(0.36, 0.8, 0.48), Vec3A::new(0.8, -0.6, 0.4));
    let t = vector::normalize(t - n * t.dot(n));
    let r = 0.7;
    (Disc::new(p + n * (h * r) + t * (aside * r), -n, r).expect("a disc"), n)
}

/// E = π ½ (1 − (h² + ρ² − r²) / √((h² + ρ² + r²)² − 4 r² ρ²)) on a plane parallel to the disc, from the disc
/// as it was rounded; against quadrature in `the_closed_form_is_the_integral`.
fn parallel(disc: &Disc, p: Vec3A) -> f64 {
    let n = wide(disc.normal()).normalize();
    let c = wide(disc.center()) - wide(p);
    let (h, r) = (c.dot(n), f64::from(disc.radius()));
    let (h2, rho2, r2) = (h * h, (c - n * h).length_squared(), r * r);
    0.5 * PI * (1.0 - (h2 + rho2 - r2) / ((h2 + rho2 + r2).powi(2) - 4.0 * r2 * rho2).sqrt())
}

/// On any plane that has the whole disc in front of it, by rings and spokes over the disc (midpoints).
fn by_quadrature(disc: &Disc, p: Vec3A, normal: Vec3A) -> f64 {
    let (n, receiver, r) =
        (wide(disc.normal()).normalize(), wide(normal).normalize(), f64::from(disc.radius()));
    let (x, y) = n.any_orthonormal_pair();
    let c = wide(disc.center()) - wide(p);
    let (rings, spokes) = (3000, 720);
    let mut sum = 0.0;
    for i in 0..rings {
        let s = r * (f64::from(i) + 0.5) / f64::from(rings);
        for j in 0..spokes {
            let (sin, cos) = (2.0 * PI * (f64::from(j) + 0.5) / f64::from(spokes)).sin_cos();
            let d = c + (x * cos + y * sin) * s;
            let d2 = d.length_squared();
            sum += d.dot(receiver).max(0.0) * d.dot(n).abs() / (d2 * d2) * s;
        }
    }
    sum * r / f64::from(rings) * 2.0 * PI / f64::from(spokes)
}

#[test]
fn the_closed_form_is_the_integral() {
    for (h, aside) in [(0.3, 0.0), (0.3, 0.95), (1.0, 0.5), (1.0, 1.5), (3.0, 4.0)] {
        let p = Vec3A::new(3.0, -1.0, 2.0);
        let (disc, n) = disc_over(h, aside, p);
        let (closed, sum) = (parallel(&disc, p), by_quadrature(&disc, p, n));
        assert!((sum / closed - 1.0).abs() < 1e-5, "h {h} aside {aside}: {closed}, {sum} by quadrature");
    }
}

/// Facing the disc's plane, and leaning by 30° with all of the disc in front; by solid angle at every place, by area
/// where its noise allows.
#[test]
fn irradiance_over_and_off_the_disc() {
    let p = Vec3A::new(3.0, -1.0, 2.0);
    for (i, (h, aside)) in places().enumerate() {
        let (disc, n) = disc_over(h, aside, p);
        let light = DiscLight::new(disc, ONE);
        let what = format!("h {h} aside {aside}");
        let e = parallel(&disc, p);
        support::irradiance(&light, &receiver(p, n), 300_000, i as u64).check(e, &what);
        if h >= 1.0 {
            let by_area = ShapeLight::new(Arc::new(disc), None, ONE, false);
            support::irradiance(&by_area, &receiver(p, n), 1_000_000, 40 + i as u64).check(e, &what);
        }
        let lean = vector::normalize(n + Vec3A::new(-0.48, 0.0, 0.36) * 0.577);
        let in_front = (0..64).all(|k| {
            let (s, c) = (f64::from(k) * PI / 32.0).sin_cos();
            let (x, y) = wide(n).any_orthonormal_pair();
            (wide(disc.center()) - wide(p) + (x * c + y * s) * f64::from(disc.radius())).dot(wide(lean)) > 0.0
        });
        if in_front && h >= 0.3 {
            let e = by_quadrature(&disc, p, lean);
            support::irradiance(&light, &receiver(p, lean), 300_000, 80 + i as u64)
                .check(e, &format!("{what}, leaning"));
        }
    }
}

/// Variance over the square of the mean, of one sample.
fn relative_variance(light: &dyn Light, at: &LitPoint, n: u32) -> f64 {
    let (mut rng, mut mean, mut sum) = (Rng(5), Mean::default(), 0.0);
    for _ in 0..n {
        let e = irradiance_of(light.sample(at, 0, rng.pair()), at.ns);
        sum += e;
        mean.add(e);
    }
    (mean.error() * f64::from(n) / sum).powi(2) * f64::from(n)
}

/// Facing the disc: never more noise than drawn by area, and bounded where that has no bound.
#[test]
fn less_noise_than_by_area() {
    let p = Vec3A::new(3.0, -1.0, 2.0);
    let mut near = 0.0f64;
    for (h, aside) in places() {
        let (disc, n) = disc_over(h, aside, p);
        let by_area =
            relative_variance(&ShapeLight::new(Arc::new(disc), None, ONE, false), &receiver(p, n), 400_000);
        let by_angle = relative_variance(&DiscLight::new(disc, ONE), &receiver(p, n), 400_000);
        println!(
            "h {h} aside {aside}: {by_angle:.4} by solid angle, {by_area:.4} by area, {:.1} times",
            by_area / by_angle
        );
        // A disc that fills a hemisphere: ∫ cos² / (∫ cos)² over it is 4/3, evenly drawn.
        assert!(by_angle < 0.6, "h {h} aside {aside}: {by_angle}");
        assert!(by_angle < by_area, "h {h} aside {aside}: {by_angle}, {by_area} by area");
        if h == 0.05 {
            near = near.max(by_area / by_angle);
        }
    }
    assert!(near > 50.0, "{near}");
}

fn check(light: &dyn Light, disc: &Disc, points: &[LitPoint], budget: &Budget) -> Result<(), String> {
    let seen = |ray: &Ray| disc.intersect(ray).map(|h| disc.surface(ray, &h));
    check_light(light, 0, points, &seen, budget).map(drop).map_err(|f| f.to_string())
}

/// The contract at every place, one-sided and two-sided, facing it, across and in free space.
#[test]
fn the_suite_passes() {
    let p = Vec3A::new(0.3, -0.1, 0.2);
    for (h, aside) in places() {
        let (disc, n) = disc_over(h, aside, p);
        let across = vector::normalize(Vec3A::new(0.8, -0.6, 0.4).cross(n));
        let points = [lit_point(p, n), lit_point(p, across), lit_point(p, Vec3A::ZERO)];
        let behind = Disc::new(disc.center(), n, disc.radius()).expect("a disc");
        for seed in 1..=2 {
            let budget = Budget::default().shared(120).seed(seed).effort(0.3);
            let light = DiscLight::new(disc, Tex::gray(3.0));
            check(&light, &disc, &points, &budget).unwrap_or_else(|f| panic!("h {h} aside {aside}: {f}"));
            let both = DiscLight { two_sided: true, ..DiscLight::new(behind, Tex::gray(3.0)) };
            check(&both, &behind, &points, &budget)
                .unwrap_or_else(|f| panic!("h {h} aside {aside}, behind: {f}"));
        }
    }
}

/// A disc light whose density is altered.
struct Altered(DiscLight, fn(f32, f32) -> f32);

impl Light for Altered {
    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
        let s = self.0.sample(at, part, u)?;
        let seen = etendue_geometry::Surface::new(s.end?.p, s.end?.p_err, s.end?.ng);
        Some(LightSample { pdf: self.pdf(at, part, s.wi, Some(&seen)), ..s })
    }
    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&etendue_geometry::Surface>) -> f32 {
        let round = ShapeLight::new(Arc::new(self.0.disc), None, ONE, false).pdf(at, part, wi, seen);
        (self.1)(self.0.pdf(at, part, wi, seen), round)
    }
    fn power(&self, part: u32, radius: f32) -> Spectrum {
        self.0.power(part, radius)
    }
    fn bounds(&self, part: u32) -> Option<LightBounds> {
        self.0.bounds(part)
    }
    fn emitted(&self, part: u32, at: &etendue_geometry::Surface, wo: Vec3A) -> Spectrum {
        self.0.emitted(part, at, wo)
    }
}

/// Mutants: 3 % too much density; the density by area; one that forgets the sectors.
#[test]
fn wrong_densities_are_rejected() {
    let p = Vec3A::new(0.3, -0.1, 0.2);
    let (disc, n) = disc_over(0.3, 1.5, p);
    let budget = Budget::default();
    let light = |alter| Altered(DiscLight::new(disc, Tex::gray(3.0)), alter);
    let points = [lit_point(p, n)];
    assert!(check(&light(|pdf, _| pdf), &disc, &points, &budget).is_ok(), "the frame of the mutants");
    for (name, alter) in [
        ("3 %", (|pdf, _| 1.03 * pdf) as fn(f32, f32) -> f32),
        ("by area", |_, area| area),
        ("halfway", |pdf, area| 0.8 * pdf + 0.2 * area),
    ] {
        assert!(check(&light(alter), &disc, &points, &budget).is_err(), "{name}");
    }
}

/// Seen edge-on it is drawn by area, and says so the same way from both sides of the question; within its plane it is
/// dark.
#[test]
fn edge_on() {
    let disc = Disc::new(Vec3A::ZERO, Vec3A::Y, 0.5).expect("a disc");
    let light = DiscLight::new(disc, ONE);
    let at = lit_point(Vec3A::new(1.0, 2e-5, 0.0), Vec3A::NEG_X);
    let mut rng = Rng(3);
    let mut mean = Mean::default();
    for _ in 0..2_000_000 {
        let s = light.sample(&at, 0, rng.pair()).expect("in front");
        let end = s.end.expect("an end");
        let seen = etendue_geometry::Surface::new(end.p, end.p_err, end.ng);
        assert_eq!(light.pdf(&at, 0, s.wi, Some(&seen)), s.pdf);
        mean.add(irradiance_of(Some(s), at.ns));
    }
    mean.check(by_quadrature(&disc, at.p, at.ns), "edge-on");
    for p in [Vec3A::X, Vec3A::X * 0.2, Vec3A::ZERO] {
        let at = lit_point(p, Vec3A::ZERO);
        let both = DiscLight { two_sided: true, ..light.clone() };
        assert!(
            light.sample(&at, 0, Vec2::splat(0.3)).is_none()
                && both.sample(&at, 0, Vec2::splat(0.3)).is_none()
        );
    }
}
