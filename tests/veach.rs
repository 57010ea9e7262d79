//! The plates and lamps of Veach and Guibas: every way of finding light gives one picture, and each fails where theirs do.

mod support;

use etendue::core::vector;
use etendue::prelude::*;
use etendue::scene::presets::veach_mis;
use etendue_testkit::stats::welch_test;
use support::radiance;

/// The four that find all of the light.
const ALL: [DirectLight; 4] =
    [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisBalance, DirectLight::MisPower];
/// Heights and depths of the plates' middles, from the smooth one to the rough one.
const PLATES: [(f32, f32); 4] = [(0.70, -0.05), (0.47, 0.30), (0.31, 0.70), (0.20, 1.12)];
/// Places of the lamps along x, from the small one to the large one.
const LAMPS: [f32; 4] = [-1.05, -0.35, 0.35, 1.05];

/// Rows of a picture of 24 that show the wall, the smoothest plate, and all that is before it.
const STRIPS: [std::ops::Range<usize>; 3] = [0..9, 9..12, 12..24];

/// What is reflected into each strip of the picture, on average, once for each of `n` seeds. What is emitted into it is rendered along the same rays and taken away: the sight of the small lamp is noisy too.
fn strips(direct: DirectLight, first_seed: u64, n: u64) -> [Vec<f64>; 3] {
    let p = veach_mis();
    let size = UVec2::new(32, 24);
    let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, size).unwrap();
    let scene = p.builder.build().unwrap();
    let picture = |path: PathTracer, seed| {
        let mut film = Film::new(size, 1).unwrap();
        let sampler = Independent::new(seed, 16);
        render(&scene, &camera, &path, sampler, &mut film, &RenderOptions::default()).unwrap();
        film.to_rgb()
    };
    let mut out = [const { Vec::new() }; 3];
    for seed in first_seed..first_seed + n {
        let all = picture(PathTracer { direct, ..PathTracer::default() }, seed);
        let emitted = picture(PathTracer { direct, max_depth: Some(0), ..PathTracer::default() }, seed);
        let reflected: Vec<f64> = all
            .iter()
            .flatten()
            .zip(emitted.iter().flatten())
            .map(|(a, e)| f64::from(*a) - f64::from(*e))
            .collect();
        for (out, rows) in out.iter_mut().zip(STRIPS) {
            let strip = &reflected[rows.start * 96..rows.end * 96];
            out.push(strip.iter().sum::<f64>() / strip.len() as f64);
        }
    }
    out
}

#[test]
fn all_ways_agree_about_the_picture() {
    let truth = strips(DirectLight::MisPower, 1000, 64);
    for (i, direct) in ALL.into_iter().enumerate() {
        let xs = strips(direct, 100 * i as u64 + 1, 64);
        // What factor in brightness would be seen; by light sampling on the smoothest plate none (it is far too noisy).
        let seen = match direct {
            DirectLight::Light => [Some(1.5), None, Some(1.5)],
            DirectLight::Bsdf => [Some(2.0), Some(2.0), Some(1.5)],
            _ => [Some(1.05), Some(2.0), Some(1.1)],
        };
        for ((xs, truth), factor) in xs.iter().zip(&truth).zip(seen) {
            let test = welch_test(xs, truth);
            println!("{direct:?}: {:.4} ± {:.4}, true {:.4}", test.estimate, test.standard_error, test.truth);
            assert!(!test.rejects(1e-6), "{direct:?}: {test:?}");
            let Some(factor) = factor else { continue };
            let bright: Vec<f64> = xs.iter().map(|x| x * factor).collect();
            assert!(welch_test(&bright, truth).rejects(1e-6), "{direct:?} is too noisy to tell {factor}");
            // Mutant: both ways in full, with no weights.
            let both: Vec<f64> = xs.iter().zip(truth).map(|(a, b)| a + b).collect();
            assert!(welch_test(&both, truth).rejects(1e-6), "{direct:?}");
        }
    }
}

/// One sample of the direct light where a plate mirrors a lamp.
#[derive(Clone, Copy, Debug)]
struct Spread {
    mean: f64,
    variance: f64,
}

fn spread(scene: &Scene, eye: Vec3A, plate: (f32, f32), lamp: f32, direct: DirectLight) -> Spread {
    let center = Vec3A::new(0.0, plate.0, plate.1);
    let (near, far) = (vector::length(eye - center), vector::length(Vec3A::new(0.0, 1.5, 0.0) - center));
    let seen = center + Vec3A::X * (lamp * near / (near + far));
    let path = PathTracer { direct, max_depth: Some(1), ..PathTracer::default() };
    let view = |_: &Independent| Ray::new(eye, vector::normalize(seen - eye));
    let xs = radiance(scene, &path, 7, 40_000, &view);
    let mean = xs.iter().sum::<f64>() / xs.len() as f64;
    let variance = xs.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (xs.len() - 1) as f64;
    Spread { mean, variance }
}

/// The balance heuristic has at most half the squared mean more variance than either way alone (Veach 1997, theorem 9.2
/// with one sample of each). Each way alone has hundreds of times that somewhere.
#[test]
fn each_way_alone_fails_somewhere_and_both_together_nowhere() {
    let p = veach_mis();
    let scene = p.builder.build().unwrap();
    for (i, plate) in PLATES.into_iter().enumerate() {
        for (j, lamp) in LAMPS.into_iter().enumerate() {
            let [light, bsdf, balance, power] = ALL.map(|way| spread(&scene, p.eye, plate, lamp, way));
            println!(
                "plate {i}, lamp {j}: mean {:.2e}; variance: lights {:.2e}, BSDF {:.2e}, balance {:.2e}, power {:.2e}",
                balance.mean, light.variance, bsdf.variance, balance.variance, power.variance
            );
            let bound = light.variance.min(bsdf.variance) + 0.5 * balance.mean * balance.mean;
            assert!(balance.variance <= 1.1 * bound, "plate {i}, lamp {j}: {balance:?}, bound {bound}");
            assert!(power.variance <= 1.5 * bound, "plate {i}, lamp {j}: {power:?}, bound {bound}");
            match (i, j) {
                (0, 3) => assert!(light.variance > 100.0 * bound, "smooth plate, large lamp: {light:?}"),
                (3, 0) => assert!(bsdf.variance > 100.0 * bound, "rough plate, small lamp: {bsdf:?}"),
                _ => {}
            }
        }
    }
}
