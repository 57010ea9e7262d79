//! What the tests of this crate share: receivers, fixed random numbers, sample means with their error, closed forms.
#![allow(dead_code)]

use etendue_core::glam::DVec3;
use etendue_core::{Vec2, Vec3A};
use etendue_light::{Light, LightSample, LitPoint, Sides};

/// Splitmix64: independent numbers from a fixed seed.
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / 16_777_216.0
    }

    pub(crate) fn pair(&mut self) -> Vec2 {
        let x = self.next();
        Vec2::new(x, self.next())
    }

    /// Uniform in the cube [-1, 1]³.
    pub(crate) fn point(&mut self) -> Vec3A {
        Vec3A::new(2.0 * self.next() - 1.0, 2.0 * self.next() - 1.0, 2.0 * self.next() - 1.0)
    }
}

/// A point on a surface with the normal given, using one side.
pub(crate) fn receiver(p: Vec3A, n: Vec3A) -> LitPoint {
    LitPoint { p, p_err: Vec3A::ZERO, ng: n, ns: n, sides: Sides::Same, time: 0.0 }
}

/// A point in free space.
pub(crate) fn free(p: Vec3A) -> LitPoint {
    LitPoint { p, p_err: Vec3A::ZERO, ng: Vec3A::ZERO, ns: Vec3A::ZERO, sides: Sides::Free, time: 0.0 }
}

/// A sample mean and its standard error (Welford 1962).
#[derive(Default)]
pub(crate) struct Mean {
    n: f64,
    mean: f64,
    m2: f64,
}

impl Mean {
    pub(crate) fn add(&mut self, x: f64) {
        self.n += 1.0;
        let d = x - self.mean;
        self.mean += d / self.n;
        self.m2 += d * (x - self.mean);
    }

    pub(crate) fn error(&self) -> f64 {
        (self.m2 / (self.n - 1.0) / self.n).sqrt()
    }

    /// A z-test at five standard errors with the power to see a bias of 0.5 %: the mutant, the same estimator times
    /// 1.005, has to fail. (Estimators without any variance are compared to rounding.)
    pub(crate) fn check(&self, truth: f64, what: &str) {
        let (error, floor) = (self.error(), 2e-6 * truth.abs());
        let off = |m: f64| (m - truth).abs() > 5.0 * error + floor;
        assert!(!off(self.mean), "{what}: {} ± {error} for {truth}", self.mean);
        assert!(
            off(self.mean * 1.005) || off(self.mean * 0.995),
            "{what}: ± {error} is too wide to see 0.5 % of {truth}"
        );
    }
}

/// What a sample adds to the irradiance on a plane of normal `n`, red.
pub(crate) fn irradiance_of(s: Option<LightSample>, n: Vec3A) -> f64 {
    s.map_or(0.0, |s| f64::from(s.li.r()) * f64::from(s.wi.dot(n)).max(0.0) / f64::from(s.pdf))
}

/// Irradiance at a point from all parts of a light, `n` samples of each.
pub(crate) fn irradiance(light: &dyn Light, at: &LitPoint, n: u32, seed: u64) -> Mean {
    let mut rng = Rng(seed);
    let mut mean = Mean::default();
    for _ in 0..n {
        let sum =
            (0..light.parts()).map(|part| irradiance_of(light.sample(at, part, rng.pair()), at.ns)).sum();
        mean.add(sum);
    }
    mean
}

/// Irradiance from a polygon of radiance 1 that lies wholly above the horizon: half the sum of the edges' angles times
/// the cosines of their planes (Lambert 1760). `corners` counter-clockwise as seen from the point's side.
pub(crate) fn polygon_irradiance(corners: &[Vec3A], p: Vec3A, n: Vec3A) -> f64 {
    let wide = |v: Vec3A| DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z));
    let seen: Vec<DVec3> = corners.iter().map(|&c| (wide(c) - wide(p)).normalize()).collect();
    let edges = seen.iter().zip(seen.iter().cycle().skip(1));
    let sum: f64 = edges
        .map(|(a, b)| {
            let cross = a.cross(*b);
            cross.length().atan2(a.dot(*b)) * cross.normalize().dot(wide(n))
        })
        .sum();
    (0.5 * sum).abs()
}

/// Integral over the sphere by midpoints in (cos θ, φ) around `axis`, down to `cos_min`.
pub(crate) fn integrate_cap(axis: Vec3A, cos_min: f64, n: [u32; 2], f: impl Fn(Vec3A) -> f64) -> f64 {
    let frame = etendue_core::Frame::from_normal(axis);
    // In h = 1 − cos, which keeps its digits in a narrow cap.
    let (dh, dp) = ((1.0 - cos_min) / f64::from(n[0]), std::f64::consts::TAU / f64::from(n[1]));
    let mut sum = 0.0;
    for i in 0..n[0] {
        let h = (f64::from(i) + 0.5) * dh;
        let s = (h * (2.0 - h)).sqrt();
        for j in 0..n[1] {
            let p = (f64::from(j) + 0.5) * dp;
            let local = Vec3A::new((s * p.cos()) as f32, (s * p.sin()) as f32, (1.0 - h) as f32);
            sum += f(frame.to_world(local));
        }
    }
    sum * dh * dp
}
