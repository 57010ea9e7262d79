//! Environments: orientation, density, irradiance.

mod support;

use etendue_core::{Ray, Spectrum, Vec2, Vec3A};
use etendue_light::{ConstantEnvironment, EnvironmentError, ImageEnvironment, Light, LitPoint, Sides};
use etendue_texture::ImageTexture;
use support::{Mean, Rng, free, integrate_cap, irradiance, irradiance_of, receiver};

fn environment(width: u32, height: u32, data: Vec<f32>) -> ImageEnvironment {
    let image = ImageTexture::from_f32(width, height, 3, data).expect("sizes agree");
    ImageEnvironment::new(image, 1.0, 0.0).expect("usable")
}

/// A dim sky with a few suns, one of them on the seam and one at the pole.
fn sky() -> ImageEnvironment {
    let (w, h) = (32, 16);
    let mut rng = Rng(2);
    let mut data: Vec<f32> = (0..w * h * 3).map(|_| 0.2 * rng.next()).collect();
    for (x, y, l) in [(0, 5, 40.0), (20, 0, 25.0), (13, 11, 60.0)] {
        for c in 0..3 {
            data[((y * w + x) * 3 + c) as usize] = l * (1.0 + c as f32 * 0.1);
        }
    }
    environment(w, h, data)
}

/// Integral over the sphere on a grid of `rows` × `columns` in the image's own coordinates: a multiple of its size
/// meets its piecewise constant density exactly.
fn integrate_image(columns: u32, rows: u32, f: impl Fn(Vec3A) -> f64) -> f64 {
    let mut sum = 0.0;
    for j in 0..rows {
        let edge = |j: f64| (j / f64::from(rows) * std::f64::consts::PI).cos();
        let band = edge(f64::from(j)) - edge(f64::from(j) + 1.0);
        let cos = edge(f64::from(j) + 0.5);
        let sin = (1.0 - cos * cos).sqrt();
        for i in 0..columns {
            let a = (f64::from(i) + 0.5) / f64::from(columns) * std::f64::consts::TAU;
            let d = Vec3A::new((sin * a.sin()) as f32, cos as f32, (-sin * a.cos()) as f32);
            sum += f(d) * band;
        }
    }
    sum * std::f64::consts::TAU / f64::from(columns)
}

/// The mapping: −Z is the left edge, +X a quarter to the right, +Y the top row.
#[test]
fn directions_find_their_texels() {
    let (w, h) = (8u32, 4u32);
    let data = (0..w * h).flat_map(|i| [(i % w) as f32, (i / w) as f32, 1.0]).collect();
    let env = environment(w, h, data);
    for y in 0..h {
        for x in 0..w {
            let (u, v) = ((f64::from(x) + 0.5) / f64::from(w), (f64::from(y) + 0.5) / f64::from(h));
            let (azimuth, polar) = (u * std::f64::consts::TAU, v * std::f64::consts::PI);
            let d = Vec3A::new(
                (polar.sin() * azimuth.sin()) as f32,
                polar.cos() as f32,
                (-polar.sin() * azimuth.cos()) as f32,
            );
            let l = env.escaped(&Ray::new(Vec3A::ZERO, d));
            let off = (l.r() - x as f32).abs() + (l.g() - y as f32).abs();
            assert!(off < 1e-4, "texel {x} {y}: {l:?}");
        }
    }
    assert_eq!(env.radiance(Vec3A::Y).g(), 0.0);
    assert_eq!(env.radiance(-Vec3A::Y).g(), 3.0);
    assert!((env.radiance(Vec3A::X).r() - 1.5).abs() < 1e-5, "u = 1/4");
    assert!((env.radiance(-Vec3A::Z).r() - 3.5).abs() < 1e-5, "the seam blends the first and last column");
}

/// Turned counter-clockwise from above, what was at −Z comes from −X.
#[test]
fn rotation_turns_the_world() {
    let data = (0..16 * 8).flat_map(|i| [(i % 16) as f32, (i / 16) as f32, 0.0]).collect();
    let image = || ImageTexture::from_f32(16, 8, 3, Vec::clone(&data)).expect("sizes agree");
    let plain = ImageEnvironment::new(image(), 1.0, 0.0).expect("usable");
    for turns in [0.25f32, -0.4, 3.1] {
        let turned = ImageEnvironment::new(image(), 2.0, turns * std::f32::consts::TAU).expect("usable");
        let (s, c) = etendue_core::math::sin_cos_turns(turns);
        let mut rng = Rng(4);
        for _ in 0..200 {
            let d = etendue_core::vector::normalize(rng.point());
            let rotated = Vec3A::new(c * d.x + s * d.z, d.y, c * d.z - s * d.x);
            let (a, b) = (plain.radiance(d) * 2.0, turned.radiance(rotated));
            // Next to the seam the ramp falls steeply.
            if a.r() > 0.5 && a.r() < 29.5 {
                assert!((a.r() - b.r()).abs() < 1e-3 && (a.g() - b.g()).abs() < 1e-3, "{d}: {a:?} {b:?}");
            }
            let at = free(Vec3A::ZERO);
            let (p, q) = (plain.pdf(&at, 0, d, None), turned.pdf(&at, 0, rotated, None));
            // A cell's border may fall between the two roundings.
            if (p - q).abs() > 1e-3 * p {
                let u = etendue_core::math::atan2(d.x, -d.z) * 16.0 / std::f32::consts::TAU;
                assert!((u - u.round()).abs() < 1e-3);
            }
        }
    }
    let quarter = ImageEnvironment::new(image(), 1.0, std::f32::consts::FRAC_PI_2).expect("usable");
    let front = plain.radiance(etendue_core::vector::normalize(Vec3A::new(0.1, 0.0, -1.0)));
    let left = quarter.radiance(etendue_core::vector::normalize(Vec3A::new(-1.0, 0.0, -0.1)));
    assert!((front.r() - left.r()).abs() < 1e-4, "{front:?} {left:?}");
}

#[test]
fn density_integrates_to_one_and_misses_nothing() {
    let at = free(Vec3A::ZERO);
    let turned = ImageEnvironment::new(
        ImageTexture::from_f32(3, 5, 1, (0..15).map(|i| (i * i % 7) as f32).collect()).expect("sizes agree"),
        0.3,
        0.0,
    );
    let single = environment(16, 8, {
        let mut data = vec![0.0; 16 * 8 * 3];
        data[3 * (16 * 3 + 15)] = 5.0;
        data
    });
    for env in [sky(), turned.expect("usable"), single, environment(1, 1, vec![1.0, 2.0, 3.0])] {
        let mass = integrate_image(96 * 2, 80 * 2, |w| f64::from(env.pdf(&at, 0, w, None)));
        assert!((mass - 1.0).abs() < 1e-5, "{mass}");
        let mut rng = Rng(8);
        for _ in 0..200_000 {
            let d = etendue_core::vector::normalize(rng.point());
            assert!(env.radiance(d).is_black() || env.pdf(&at, 0, d, None) > 0.0, "{d} shines undrawn");
        }
    }
}

/// Draws against the density, 24 × 24 cells in (height, azimuth), 500,000 samples, pooled below 5 expected. A density
/// that leans by 10 % has to stand out.
#[test]
fn draws_follow_the_density() {
    let env = sky();
    let at = free(Vec3A::ZERO);
    let (n, samples) = (24usize, 500_000u32);
    let cell = |d: Vec3A| {
        let row = ((f64::from(d.y) + 1.0) * 0.5 * n as f64) as usize;
        let turn = f64::from(d.x).atan2(f64::from(d.z)) / std::f64::consts::TAU + 0.5;
        row.min(n - 1) * n + ((turn * n as f64) as usize).min(n - 1)
    };
    let mut counts = vec![0.0f64; n * n];
    let mut rng = Rng(21);
    for _ in 0..samples {
        let s = env.sample(&at, 0, rng.pair()).expect("light everywhere");
        counts[cell(s.wi)] += 1.0;
    }
    let sigma = |lean: f64| {
        let mut expected = vec![0.0f64; n * n];
        let side = 2400;
        for i in 0..side {
            let y = (f64::from(i) + 0.5) / f64::from(side) * 2.0 - 1.0;
            let s = (1.0 - y * y).sqrt();
            for j in 0..side {
                let a = (f64::from(j) + 0.5) / f64::from(side) * std::f64::consts::TAU;
                let d = Vec3A::new((s * a.sin()) as f32, y as f32, (s * a.cos()) as f32);
                let density = f64::from(env.pdf(&at, 0, d, None)) * (1.0 + lean * f64::from(d.x));
                expected[cell(d)] +=
                    density * 4.0 * std::f64::consts::PI / f64::from(side * side) * f64::from(samples);
            }
        }
        let (mut statistic, mut freedom, mut pool) = (0.0, -1.0f64, [0.0f64; 2]);
        for (c, e) in counts.iter().zip(&expected) {
            if *e < 5.0 {
                pool = [pool[0] + c, pool[1] + e];
            } else {
                statistic += (c - e) * (c - e) / e;
                freedom += 1.0;
            }
        }
        assert!(pool[0] <= pool[1] + 20.0);
        // Wilson & Hilferty 1931.
        let w = 2.0 / (9.0 * freedom);
        ((statistic / freedom).cbrt() - (1.0 - w)) / w.sqrt()
    };
    assert!(sigma(0.0) < 5.0, "{}", sigma(0.0));
    assert!(sigma(0.1) > 5.0, "a leaning density stays hidden: {}", sigma(0.1));
}

/// Irradiance by sampling against the integral of the interpolated image. Power 0.5 %.
#[test]
fn irradiance_of_a_sky() {
    let env = sky();
    for (i, n) in [Vec3A::Y, Vec3A::new(0.6, 0.0, -0.8), Vec3A::new(0.0, -0.6, 0.8)].into_iter().enumerate() {
        let e =
            integrate_image(3200, 1600, |w| f64::from(env.radiance(w).r()) * f64::from(w.dot(n)).max(0.0));
        irradiance(&env, &receiver(Vec3A::ZERO, n), 5_000_000, i as u64).check(e, &format!("toward {n}"));
    }
    // The power that enters a sphere of radius 3 is the integral of radiance times its cross-section.
    let total = integrate_image(1600, 800, |w| f64::from(env.radiance(w).b()));
    let power = f64::from(env.power(0, 3.0).b());
    assert!((power / (total * 9.0 * std::f64::consts::PI) - 1.0).abs() < 5e-3, "{power}");
}

/// In a furnace every point receives π L: exactly, sample by sample, where the cosine is followed.
#[test]
fn constant_environment_is_a_furnace() {
    let env = ConstantEnvironment::new(Spectrum::gray(2.0));
    let n = Vec3A::new(0.48, 0.6, 0.64);
    let at = receiver(Vec3A::ONE, n);
    let mut rng = Rng(6);
    for _ in 0..10_000 {
        let s = env.sample(&at, 0, rng.pair());
        let e = irradiance_of(s, n);
        assert!((e / (2.0 * std::f64::consts::PI) - 1.0).abs() < 1e-5, "{e}");
        let s = s.expect("always");
        assert_eq!(env.pdf(&at, 0, s.wi, None), s.pdf);
    }
    let both = LitPoint { sides: Sides::Both, ..at };
    let mut mean = Mean::default();
    for _ in 0..2_000_000 {
        mean.add(irradiance_of(env.sample(&both, 0, rng.pair()), n));
    }
    mean.check(2.0 * std::f64::consts::PI, "uniform over the sphere");
    let at = |at: &LitPoint| integrate_cap(n, -1.0, [1000, 200], |w| f64::from(env.pdf(at, 0, w, None)));
    assert!((at(&both) - 1.0).abs() < 1e-4 && (at(&receiver(Vec3A::ONE, n)) - 1.0).abs() < 1e-4);
}

/// A shading normal that leans: directions below the real surface are not drawn and have no density; their mass is
/// lost, not moved.
#[test]
fn mass_behind_the_surface_is_lost() {
    let env = ConstantEnvironment::new(Spectrum::ONE);
    let ns = Vec3A::new(0.6, 0.8, 0.0);
    let at = LitPoint { ns, ..receiver(Vec3A::ZERO, Vec3A::Y) };
    let mass = integrate_cap(ns, -1.0, [2000, 1000], |w| f64::from(env.pdf(&at, 0, w, None)));
    // The part of the cosine lobe above a plane that leans by t holds (1 + cos t) / 2.
    assert!((mass - 0.9).abs() < 1e-3, "{mass}");
    let mut rng = Rng(9);
    let hits = (0..200_000).filter_map(|_| env.sample(&at, 0, rng.pair())).inspect(|s| {
        assert!(s.wi.y > 0.0);
        assert_eq!(env.pdf(&at, 0, s.wi, None), s.pdf);
    });
    let rate = hits.count() as f64 / 200_000.0;
    assert!((rate - 0.9).abs() < 5.0 * (0.09f64 / 200_000.0).sqrt(), "{rate}");
    // Directions and densities do not depend on which corner of [0, 1)² is asked for.
    for (a, b) in [(0.0, 0.0), (0.0, 0.999_999_94), (0.999_999_94, 0.0), (0.999_999_94, 0.999_999_94)] {
        for at in [at, free(Vec3A::ZERO)] {
            for light in [&env as &dyn Light, &sky()] {
                if let Some(s) = light.sample(&at, 0, Vec2::new(a, b)) {
                    assert!(s.pdf > 0.0 && s.pdf.is_finite() && (s.wi.dot(s.wi) - 1.0).abs() < 1e-6);
                }
            }
        }
    }
}

#[test]
fn bad_and_dark_environments() {
    let image = |v: f32| ImageTexture::from_f32(2, 2, 1, vec![v; 4]).expect("sizes agree");
    assert_eq!(
        ImageEnvironment::new(image(1.0), -1.0, 0.0).err(),
        Some(EnvironmentError::Scale { scale: -1.0 })
    );
    assert!(matches!(
        ImageEnvironment::new(image(1.0), 1.0, f32::INFINITY),
        Err(EnvironmentError::Rotation { .. })
    ));
    for dark in [ImageEnvironment::new(image(0.0), 1.0, 0.0), ImageEnvironment::new(image(-3.0), 1.0, 0.0)] {
        let dark = dark.expect("valid");
        assert!(dark.sample(&free(Vec3A::ZERO), 0, Vec2::splat(0.3)).is_none());
        assert_eq!(dark.power(0, 5.0), Spectrum::BLACK);
        assert_eq!(dark.radiance(Vec3A::X), Spectrum::BLACK);
    }
}
