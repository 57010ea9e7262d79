//! Discs seen from a point: the cone against closed forms, the density against what is drawn, and where it gives way.

use std::f64::consts::{PI, TAU};

use etendue_core::glam::DVec3;
use etendue_core::{Vec2, Vec3A};
use etendue_sampling::warp::SphericalDisc;

/// Splitmix64.
struct Rng(u64);

impl Rng {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 40) as f32 / 16_777_216.0
    }
    fn pair(&mut self) -> Vec2 {
        Vec2::new(self.unit(), self.unit())
    }
}

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

/// The unit disc over the plane y = 0 at height `h`, its centre `rho` aside.
fn overhead(h: f64, rho: f64) -> Option<SphericalDisc> {
    SphericalDisc::new(DVec3::new(rho, h, 0.0), Vec3A::NEG_Y, 1.0)
}

/// Heights and lateral distances in radii: in front, aside, inside of the rim and out of it; none of them edge-on.
fn places() -> impl Iterator<Item = (f64, f64)> {
    let heights = [1e-3, 0.05, 0.3, 1.0, 3.0, 100.0, 1e5];
    let aside = [0.0, 1e-5, 0.5, 0.95, 1.0, 1.05, 2.0, 50.0];
    let all = heights.into_iter().flat_map(move |h| aside.map(|rho| (h, rho)));
    all.filter(|(h, rho)| *h > 1e-4 * rho).map(|(h, rho)| (f64::from(h as f32), f64::from(rho as f32)))
}

/// Every rim point lies on the cone: (x / sin α)² + (y / sin β)² = 1, to the rounding of double precision.
#[test]
fn the_rim_is_the_ellipse() {
    let mut worst = 0.0f64;
    for (h, rho) in places() {
        let disc = overhead(h, rho).expect("not edge-on");
        let ([a, b], z) = (disc.sines(), disc.axis());
        let across = DVec3::Z;
        let within = z.cross(across);
        assert!(a > b * (1.0 - 1e-15) && (z.length() - 1.0).abs() < 1e-14 && z.dot(across) == 0.0);
        for k in 0..64 {
            let (s, c) = (TAU * f64::from(k) / 64.0).sin_cos();
            let w = DVec3::new(rho + c, h, s).normalize();
            let on = (w.dot(across) / a).powi(2) + (w.dot(within) / b).powi(2);
            worst = worst.max((on - 1.0).abs() * b.min(1.0));
        }
    }
    println!("off by {worst:.1e} of the narrow axis");
    assert!(worst < 1e-11, "{worst}");
}

/// What a receiver gets: across the axis π sin α sin β, in general that times the cosine to the axis, and parallel to
/// the disc the configuration factor ½ (1 − (h² + ρ² − r²) / √((h² + ρ² + r²)² − 4 r² ρ²)), which is checked by
/// quadrature below.
#[test]
fn sines_and_axis_are_the_irradiance() {
    for (h, rho) in places() {
        let disc = overhead(h, rho).expect("not edge-on");
        let ([a, b], z) = (disc.sines(), disc.axis());
        let sum = h * h + rho * rho + 1.0;
        // The difference times its conjugate, so that no digits are lost.
        let root = ((h * h + (rho - 1.0).powi(2)) * (h * h + (rho + 1.0).powi(2))).sqrt();
        let m = sum - 2.0;
        let factor = if m > 0.0 { 2.0 * h * h / (root * (root + m)) } else { 0.5 * (1.0 - m / root) };
        let found = a * b * z.y;
        assert!((found / factor - 1.0).abs() < 1e-9, "h {h} rho {rho}: {found} for {factor}");
        let plain = 0.5 * (1.0 - m / (sum * sum - 4.0 * rho * rho).sqrt());
        assert!((factor - plain).abs() < 1e-6, "h {h} rho {rho}: {factor} for {plain}");
    }
    // By rings and spokes over the disc.
    for (h, rho) in [(0.3, 0.0), (0.3, 0.9), (1.0, 0.5), (1.0, 2.0), (3.0, 4.0)] {
        let n = 2000;
        let mut sum = 0.0;
        for i in 0..n {
            let r = (f64::from(i) + 0.5) / f64::from(n);
            for j in 0..256 {
                let (s, c) = (TAU * (f64::from(j) + 0.5) / 256.0).sin_cos();
                let d2 = (rho + r * c).powi(2) + h * h + (r * s).powi(2);
                sum += h * h / (d2 * d2) * r;
            }
        }
        let e = sum * TAU / (f64::from(n) * 256.0);
        let [a, b] = overhead(h, rho).expect("not edge-on").sines();
        let found = PI * a * b * overhead(h, rho).expect("not edge-on").axis().y;
        assert!((found / e - 1.0).abs() < 2e-6, "h {h} rho {rho}: {found} for {e}");
    }
}

/// Moments of 1/pdf over what is drawn: ∫ dω, ∫ x dω … for each, and that all drawn lie on the disc.
///
/// The solid angle from the density against that from rings; the vector irradiance against its closed form; the second
/// moment in `x` against the one by area. With 400,000 draws a density off by 1 % over half of the cone moves one of
/// them by more than the five standard errors allowed. The mutant, uniform as if sectors were all alike, must fail.
#[test]
fn densities_are_what_is_drawn() {
    let n = 400_000u32;
    let mut mutants = 0;
    for (k, (h, rho)) in [
        (1e-3, 0.5),
        (0.05, 0.0),
        (0.05, 0.95),
        (0.05, 1.05),
        (0.3, 1.0),
        (1.0, 2.0),
        (3.0, 50.0),
        (100.0, 1.0),
    ]
    .into_iter()
    .map(|(h, rho)| (f64::from(h as f32), f64::from(rho as f32)))
    .enumerate()
    {
        let disc = overhead(h, rho).expect("not edge-on");
        let ([a, b], z) = (disc.sines(), disc.axis());
        let within = z.cross(DVec3::Z);
        let functions =
            |w: DVec3| [1.0, w.dot(z), w.dot(DVec3::Z).powi(2) / (a * a), w.dot(within).powi(2) / (b * b)];
        let truths = by_cone(&disc, functions);
        assert!((truths[1] / (PI * a * b) - 1.0).abs() < 1e-6, "h {h} rho {rho}: {truths:?}");
        let (mut rng, mut sums, mut squares) = (Rng(k as u64 + 1), [0.0; 4], [0.0; 4]);
        let mut uniform = [0.0; 4];
        for _ in 0..n {
            let s = disc.sample(rng.pair()).expect("a sample");
            assert_eq!(disc.pdf(s.w), s.pdf);
            let end = DVec3::new(rho, h, 0.0) + s.from_center;
            assert!(s.from_center.length() <= 1.0 + 1e-14 && s.from_center.y.abs() < 1e-12);
            assert!((end.normalize() - wide(s.w)).length() < 2e-7, "h {h} rho {rho}: {end} {}", s.w);
            for (i, f) in functions(wide(s.w)).into_iter().enumerate() {
                let x = f / f64::from(s.pdf);
                sums[i] += x;
                squares[i] += x * x;
                uniform[i] += f * truths[0];
            }
        }
        let mut seen = false;
        for i in 0..4 {
            let mean = sums[i] / f64::from(n);
            let error = ((squares[i] / f64::from(n) - mean * mean) / f64::from(n)).max(0.0).sqrt();
            let off = |mean: f64| (mean - truths[i]).abs() > 5.0 * error + 1e-6 * truths[i];
            assert!(!off(mean), "h {h} rho {rho}, {i}: {mean} ± {error} for {}", truths[i]);
            assert!(error < 2e-3 * truths[i]);
            seen |= off(uniform[i] / f64::from(n));
        }
        mutants += u32::from(seen);
    }
    // Where the cone is round or narrow the mutant is right.
    assert!(mutants >= 4, "{mutants}");
}

/// ∫ f dω over the cone: midpoints in the azimuth of the ellipse and in 1 − cos, without the sampling code.
fn by_cone(disc: &SphericalDisc, f: impl Fn(DVec3) -> [f64; 4]) -> [f64; 4] {
    let ([a, b], z) = (disc.sines(), disc.axis());
    let (x, y) = (DVec3::Z, z.cross(DVec3::Z));
    let (n, m) = (400, 4000);
    let mut sums = [0.0; 4];
    for j in 0..m {
        // φ with tan φ = (b / a) tan ψ, ψ uniform: dφ = a b dψ / s².
        let (sin, cos) = (TAU * (f64::from(j) + 0.5) / f64::from(m)).sin_cos();
        let s2 = (a * cos).powi(2) + (b * sin).powi(2);
        let rim = (1.0 - s2).max(0.0).sqrt();
        let most = s2 / (1.0 + rim);
        for i in 0..n {
            let less = most * (f64::from(i) + 0.5) / f64::from(n);
            let across = (less * (2.0 - less) / s2).sqrt();
            let w = x * (a * cos * across) + y * (b * sin * across) + z * (1.0 - less);
            let weight = a * b / s2 * most * TAU / f64::from(n * m);
            for (sum, f) in sums.iter_mut().zip(f(w)) {
                *sum += f * weight;
            }
        }
    }
    sums
}

/// The density over the disc varies by less than two; drawn by area it varies without bound as the disc comes near.
#[test]
fn the_density_is_even() {
    for (h, rho) in places() {
        let disc = overhead(h, rho).expect("not edge-on");
        let mut rng = Rng(3);
        let (mut least, mut most) = (f32::INFINITY, 0.0f32);
        for _ in 0..2000 {
            let s = disc.sample(rng.pair()).expect("a sample");
            (least, most) = (least.min(s.pdf), most.max(s.pdf));
        }
        assert!(most < 2.0 * least, "h {h} rho {rho}: {least} to {most}");
    }
}

/// The corners of the unit square, its middle, and discs at the ends of single precision.
#[test]
fn extremes() {
    let ends = [0.0, 1.0 / 16_777_216.0, 0.5, 1.0 - 1.0 / 16_777_216.0];
    for (h, rho) in places() {
        for scale in [1.0f32, 2f32.powi(-100), 2f32.powi(100)] {
            let center = DVec3::new(rho, h, 0.0) * f64::from(scale);
            let disc = SphericalDisc::new(center, Vec3A::Y * 3.0, scale).expect("not edge-on");
            for u in ends.into_iter().flat_map(|x| ends.map(|y| Vec2::new(x, y))) {
                let s = disc.sample(u).expect("a sample");
                let plain = overhead(h, rho).and_then(|d| d.sample(u)).expect("a sample");
                assert_eq!((s.w, s.pdf), (plain.w, plain.pdf), "scale {scale}");
                assert!(
                    (s.w.dot(s.w) - 1.0).abs() < 1e-6
                        && s.from_center.length() <= f64::from(scale) * (1.0 + 1e-14)
                );
            }
        }
    }
    for (center, n, r) in [
        (DVec3::X * 2.0, Vec3A::Y, 1.0),
        (DVec3::ZERO, Vec3A::Y, 1.0),
        (DVec3::new(2.0, 1e-5, 0.0), Vec3A::Y, 1.0),
        (DVec3::Y, Vec3A::ZERO, 1.0),
        (DVec3::Y, Vec3A::Y, 0.0),
        (DVec3::Y, Vec3A::Y, f32::NAN),
        (DVec3::splat(f64::NAN), Vec3A::Y, 1.0),
        (DVec3::Y, Vec3A::splat(f32::INFINITY), 1.0),
    ] {
        assert_eq!(SphericalDisc::new(center, n, r), None, "{center} {n} {r}");
    }
}

/// The narrowest ellipses that are drawn: rounding of the direction moves it among sectors of other density, and the
/// irradiance across the axis must not notice. The mean of w·axis / pdf over a grid, against π sin α sin β. Turned, as
/// along the axes of the world a small coordinate would keep its digits.
#[test]
fn narrow_ellipses_are_right() {
    let turned = |h: f64, rho: f64| {
        let (n, t) = (DVec3::new(1.0, 2.0, 2.0) / 3.0, DVec3::new(2.0, 1.0, -2.0) / 3.0);
        let c = n * h + t * rho;
        SphericalDisc::new(c, Vec3A::new(1.0, 2.0, 2.0), 1.0)
    };
    for (rho, narrow) in [(1.01f64, 1.1e-4f64), (1.5, 1.1e-4), (1.5, 1e-3), (30.0, 1.1e-4)] {
        // The height at which sin β / sin α is that.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let h = 0.5 * (low + high);
            let wide_enough = turned(h, rho).is_some_and(|d| d.sines()[1] > narrow * d.sines()[0]);
            (low, high) = if wide_enough { (low, h) } else { (h, high) };
        }
        let disc = turned(high, rho).expect("not edge-on");
        let ([a, b], z) = (disc.sines(), disc.axis());
        let n = 1500u32;
        let mean = (0..n * n)
            .map(|i| Vec2::new(((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32))
            .filter_map(|u| disc.sample(u))
            .map(|s| wide(s.w).dot(z) / f64::from(s.pdf))
            .sum::<f64>()
            / f64::from(n * n);
        println!("rho {rho} b/a {:.2e}: off by {:.1e}", b / a, mean / (PI * a * b) - 1.0);
        assert!((mean / (PI * a * b) - 1.0).abs() < 1e-5, "rho {rho}: {mean} for {}", PI * a * b);
    }
}
