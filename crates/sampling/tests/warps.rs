//! Warps: uniformity of what they invert to, extremes, and agreement with solid angles computed another way.

use std::f64::consts::{PI, TAU};

use etendue_core::glam::DVec3;
use etendue_core::radiometry::{polygon_solid_angle, triangle_solid_angle};
use etendue_core::{Vec2, Vec3A};
use etendue_sampling::warp::{self, SphericalRectangle, SphericalTriangle};

/// A plain generator (splitmix64); the samplers have their own tests.
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
    fn vector(&mut self) -> Vec3A {
        Vec3A::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5)
    }
}

const BINS: usize = 16;
const N: usize = 400_000;

/// Pearson's statistic of points that should be uniform on the unit square, as standard deviations from its mean
/// (255 degrees of freedom). With N = 400,000 a density error of 1 % rms gives +1.8, of 3 % +16.
fn excess(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut counts = vec![0u32; BINS * BINS];
    let mut n = 0;
    for (x, y) in points {
        let cell = |v: f64| ((v * BINS as f64) as usize).min(BINS - 1);
        counts[cell(x) * BINS + cell(y)] += 1;
        n += 1;
    }
    let expected = f64::from(n) / counts.len() as f64;
    let chi2: f64 = counts.iter().map(|&c| (f64::from(c) - expected).powi(2) / expected).sum();
    let dof = counts.len() as f64 - 1.0;
    (chi2 - dof) / (2.0 * dof).sqrt()
}

fn azimuth(w: Vec3A) -> f64 {
    (f64::from(w.y).atan2(f64::from(w.x)) / TAU).rem_euclid(1.0)
}

/// The angular sample set of a map, as (distribution function of z, azimuth).
fn angular(map: impl Fn(Vec2) -> Vec3A, cdf: impl Fn(f64) -> f64) -> f64 {
    let mut rng = Rng(7);
    excess((0..N).map(|_| {
        let w = map(rng.pair());
        (cdf(f64::from(w.z)), azimuth(w))
    }))
}

#[test]
fn hemisphere_maps_have_their_densities() {
    let limit = 4.0;
    assert!(angular(warp::sphere, |z| (z + 1.0) / 2.0).abs() < limit);
    assert!(angular(warp::hemisphere, |z| z).abs() < limit);
    assert!(angular(warp::cosine, |z| z * z).abs() < limit);
    for n in [0.0, 1.0, 10.0, 1000.0] {
        let e = angular(|u| warp::power_cosine(u, n), |z| z.powf(f64::from(n) + 1.0));
        assert!(e.abs() < limit, "n = {n}: {e}");
    }
    for omc in [2.0, 1.0, 0.01] {
        let e = angular(|u| warp::cone(u, omc), |z| (1.0 - z) / f64::from(omc));
        assert!(e.abs() < limit, "1 - cos = {omc}: {e}");
    }
    // Mutants the test must reject: the wrong exponent by 5 %, and the cosine forgotten.
    assert!(angular(|u| warp::power_cosine(u, 10.5), |z| z.powf(11.0)) > 20.0);
    assert!(angular(warp::hemisphere, |z| z * z) > 1000.0);
}

#[test]
fn disc_and_triangle_are_uniform() {
    let mut rng = Rng(11);
    let e = excess((0..N).map(|_| {
        let p = warp::disc(rng.pair());
        (f64::from(p.length_squared()), (f64::from(p.y).atan2(f64::from(p.x)) / TAU).rem_euclid(1.0))
    }));
    assert!(e.abs() < 4.0, "{e}");
    for map in [warp::triangle, warp::triangle_sqrt] {
        // Back to the square: the first weight's distribution function, and the place along the line.
        let e = excess((0..N).map(|_| {
            let b = map(rng.pair());
            let (b1, b2) = (f64::from(b.x), f64::from(b.y));
            ((b1 + b2).powi(2), b2 / (b1 + b2).max(1e-30))
        }));
        assert!(e.abs() < 4.0, "{e}");
    }
}

#[test]
fn extreme_numbers_stay_in_the_domain() {
    let ends = [0.0, 1.0 / 16_777_216.0, 0.5, 1.0 - 1.0 / 16_777_216.0];
    let unit = |w: Vec3A| (w.length_squared() - 1.0).abs() < 5e-7;
    for u in ends.iter().flat_map(|&x| ends.iter().map(move |&y| Vec2::new(x, y))) {
        let d = warp::disc(u);
        assert!(d.length_squared() < 1.0 + 1e-7);
        for b in [warp::triangle(u), warp::triangle_sqrt(u)] {
            assert!(b.x >= 0.0 && b.y >= 0.0 && b.x + b.y <= 1.0, "{u}: {b}");
        }
        assert!(unit(warp::sphere(u)));
        assert!(unit(warp::hemisphere(u)) && warp::hemisphere(u).z > 0.0);
        let w = warp::cosine(u);
        assert!(unit(w) && w.z > 0.0 && warp::cosine_pdf(w.z) > 0.0, "{u}: {w}");
        for n in [0.0, 0.5, 1.0, 1e3, 1e6, f32::MAX] {
            let w = warp::power_cosine(u, n);
            assert!(unit(w) && w.z > 0.0, "n = {n}, {u}: {w}");
            if n < 1e30 {
                assert!(warp::power_cosine_pdf(w.z, n) > 0.0, "n = {n}, {u}: {w}");
            }
        }
        for omc in [0.0, 1e-40, 1e-12, 1e-3, 1.0, 2.0] {
            assert!(unit(warp::cone(u, omc)), "{omc} {u}");
        }
        let t = SphericalTriangle::new(Vec3A::X, Vec3A::Y, Vec3A::Z).unwrap().sample(u).unwrap();
        assert!(unit(t.w) && t.w.min_element() > -1e-7, "{u} {}", t.w);
        assert!(t.barycentrics.min_element() >= 0.0 && t.barycentrics.element_sum() <= 1.0 + 1e-7);
        let corner = Vec3A::new(-0.3, -0.2, -0.01);
        let r = SphericalRectangle::new(corner, Vec3A::X, Vec3A::Y).unwrap().sample(u).unwrap();
        assert!(unit(r.w) && r.st.min_element() >= 0.0 && r.st.max_element() <= 1.0, "{u} {r:?}");
    }
}

#[test]
fn a_small_cone_keeps_its_digits() {
    // The sun: half-angle 4.65 mrad.
    let half = 4.65e-3f64;
    let omc = (2.0 * (half / 2.0).sin().powi(2)) as f32;
    let w = warp::cone(Vec2::new(0.999_999, 0.3), omc);
    let sine = f64::from(w.x).hypot(f64::from(w.y));
    assert!((sine / half.sin() - 1.0).abs() < 2e-6, "{sine}");
    assert!((f64::from(warp::cone_pdf(omc)) * PI * half * half - 1.0).abs() < 1e-5);
}

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(v.x.into(), v.y.into(), v.z.into())
}

#[test]
fn spherical_triangle_is_uniform_in_solid_angle() {
    let octant = SphericalTriangle::new(Vec3A::X, Vec3A::Y, Vec3A::Z).unwrap();
    assert!((octant.solid_angle() - PI / 2.0).abs() < 1e-15);
    let mut rng = Rng(3);
    let mut tried = 0;
    let mut worst: f64 = 0.0;
    while tried < 60 {
        // Every third one small and far.
        let far = if tried % 3 == 0 { rng.vector() * 30.0 } else { Vec3A::ZERO };
        let [a, b, c] = [rng.vector() + far, rng.vector() + far, rng.vector() + far];
        let Some(t) = SphericalTriangle::new(a, b, c) else { continue };
        tried += 1;
        let (da, db, dc) = (wide(a), wide(b), wide(c));
        let omega = triangle_solid_angle(da, db, dc).0;
        assert!((t.solid_angle() / omega - 1.0).abs() < 1e-9);
        // A point inside splits it in three; each part must get its share.
        let inside = (da * 0.3 + db * 0.5 + dc * 0.2) * 1.0;
        let shares =
            [(da, db), (db, dc), (dc, da)].map(|(p, q)| triangle_solid_angle(p, q, inside).0 / omega);
        let n = 20_000;
        let mut hits = [0; 3];
        for _ in 0..n {
            let s = t.sample(rng.pair()).unwrap();
            // The weights say where it is; the direction must say the same.
            let p = da + (db - da) * f64::from(s.barycentrics.x) + (dc - da) * f64::from(s.barycentrics.y);
            let w = wide(s.w);
            let size = (db - da).length() + (dc - da).length() + p.length();
            assert!((p - w * p.length()).length() < 2e-7 * size, "{} off", (p - w * p.length()).length());
            let side = |from: DVec3| w.dot(from.cross(inside)) * da.dot(db.cross(dc)).signum();
            let (sa, sb, sc) = (side(da), side(db), side(dc));
            let part = if sa <= 0.0 && sb > 0.0 {
                0
            } else if sb <= 0.0 && sc > 0.0 {
                1
            } else {
                2
            };
            hits[part] += 1;
        }
        for (h, share) in hits.iter().zip(shares) {
            let sigma = (share * (1.0 - share) / f64::from(n)).sqrt();
            let z = (f64::from(*h) / f64::from(n) - share) / sigma;
            worst = worst.max(z.abs());
            assert!(z.abs() < 4.5, "{hits:?} against {shares:?}: {a} {b} {c}");
        }
    }
    // 180 fractions: the largest deviation is expected near 2.8 standard deviations. A sampler uniform in *area*
    // fails this by far on the near triangles.
    assert!(worst > 1.5, "suspiciously even: {worst}");
}

#[test]
fn spherical_rectangle_is_uniform_in_solid_angle() {
    // A unit square seen from 1/2 above its middle: a third of the sphere's half, 2π/3.
    let square = SphericalRectangle::new(Vec3A::new(-0.5, -0.5, 0.5), Vec3A::X, Vec3A::Y).unwrap();
    assert!((square.solid_angle() - TAU / 3.0).abs() < 1e-14);
    let mut rng = Rng(5);
    for case in 0..40 {
        let far = if case % 3 == 0 { 20.0 } else { 0.8 };
        let x = rng.vector();
        let y = x.cross(rng.vector());
        let (ex, ey) = (x / x.length() * (0.2 + rng.unit()), y / y.length() * (0.2 + 3.0 * rng.unit()));
        let corner = rng.vector() * far;
        let Some(r) = SphericalRectangle::new(corner, ex, ey) else { continue };
        let (c, dx, dy) = (wide(corner), wide(ex), wide(ey));
        let part = |s0: f64, s1: f64, t0: f64, t1: f64| {
            let p = |s, t| c + dx * s + dy * t;
            polygon_solid_angle(&[p(s0, t0), p(s1, t0), p(s1, t1), p(s0, t1)]).0
        };
        let omega = part(0.0, 1.0, 0.0, 1.0);
        assert!((r.solid_angle() / omega - 1.0).abs() < 1e-6, "{} {omega}", r.solid_angle());
        let (n, mut hits) = (20_000, [[0u32; 3]; 3]);
        for _ in 0..n {
            let s = r.sample(rng.pair()).unwrap();
            let p = c + dx * f64::from(s.st.x) + dy * f64::from(s.st.y);
            let size = dx.length() + dy.length() + p.length();
            assert!((p - wide(s.w) * p.length()).length() < 3e-7 * size);
            hits[((s.st.x * 3.0) as usize).min(2)][((s.st.y * 3.0) as usize).min(2)] += 1;
        }
        for (i, row) in hits.iter().enumerate() {
            for (j, &h) in row.iter().enumerate() {
                let (s, t) = (i as f64 / 3.0, j as f64 / 3.0);
                let share = part(s, s + 1.0 / 3.0, t, t + 1.0 / 3.0) / omega;
                let sigma = (share * (1.0 - share) / f64::from(n)).sqrt();
                let z = (f64::from(h) / f64::from(n) - share) / sigma;
                assert!(z.abs() < 4.5, "case {case}: cell {i} {j} has {z} sigma");
            }
        }
    }
}

#[test]
fn degenerate_and_out_of_range_shapes_are_refused() {
    let x = Vec3A::X;
    assert!(SphericalTriangle::new(x, x, Vec3A::Y).is_none());
    assert!(SphericalTriangle::new(Vec3A::ZERO, x, Vec3A::Y).is_none());
    assert!(SphericalTriangle::new(Vec3A::splat(f32::NAN), x, Vec3A::Y).is_none());
    assert!(SphericalTriangle::new(Vec3A::splat(f32::INFINITY), x, Vec3A::Y).is_none());
    let tiny = 1e-3;
    assert!(SphericalTriangle::new(x, x + Vec3A::Y * tiny, x + Vec3A::Z * tiny).is_none());
    assert!(SphericalRectangle::new(Vec3A::ZERO, x, Vec3A::Y).is_none());
    assert!(SphericalRectangle::new(x, Vec3A::ZERO, Vec3A::Y).is_none());
    assert!(SphericalRectangle::new(Vec3A::new(-1.0, -1.0, 0.0), 2.0 * x, 2.0 * Vec3A::Y).is_none());
    // Scaling changes nothing, up to the smallest and largest lengths.
    let base = SphericalTriangle::new(x, Vec3A::Y, Vec3A::Z).unwrap().sample(Vec2::splat(0.3)).unwrap();
    for s in [1e-37, 1e-3, 1e3, 1e37] {
        let t = SphericalTriangle::new(x * s, Vec3A::Y * s, Vec3A::Z * s).unwrap();
        assert_eq!(t.sample(Vec2::splat(0.3)).unwrap(), base);
    }
}
