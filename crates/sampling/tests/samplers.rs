//! What every built-in sampler promises, whatever its point set.

use etendue_core::{Fingerprint, Vec2};
use etendue_sampling::{
    BounceDraws, CorrelatedMultiJittered, Dim, Halton, Independent, LatinHypercube, Sampler, Scrambling,
    Slot, Sobol, Stratified, mix, pcg32,
};

const SLOTS: [Slot; 7] =
    [Slot::Light, Slot::Bsdf, Slot::Roulette, Slot::Cutout, Slot::Lobe, Slot::Spare0, Slot::Spare1];

/// Runs a check on each sampler.
macro_rules! each {
    ($check:ident) => {
        $check(Sobol::new(1, 64));
        $check(Sobol::new(2, 24).with_replicates(3));
        $check(Independent::new(3, 64));
        $check(Independent::new(4, 64).with_replicates(4));
        $check(Stratified::new(5, 64));
        $check(Stratified::new(6, 7));
        $check(Stratified::new(7, 30).with_replicates(3));
        $check(Halton::new(8, 64));
        $check(Halton::new(9, 24).with_replicates(3).with_scrambling(Scrambling::DigitPermutation));
        $check(LatinHypercube::new(10, 30));
        $check(CorrelatedMultiJittered::new(11, 37));
    };
}

fn dims() -> impl Iterator<Item = Dim> {
    let camera = [Dim::FILM, Dim::LENS, Dim::TIME];
    camera.into_iter().chain([0, 1, 2, 9, 1000].into_iter().flat_map(|d| SLOTS.map(|s| Dim::bounce(d, s))))
}

#[test]
fn numbers_are_functions_of_seed_stream_index_and_dimension() {
    fn check<S: Sampler>(s: S) {
        for (stream, index) in [(0, 0), (1, 0), (0, 1), (u64::MAX, u64::MAX), (77, 1 << 33)] {
            let a = s.start(stream, index);
            // Starting anew from a started sampler is the same point.
            let b = s.start(3, 4).start(stream, index);
            for d in dims() {
                assert_eq!(a.bits_1d(d), b.bits_1d(d));
                assert_eq!(a.get_2d(d), b.get_2d(d));
                let Vec2 { x, y } = a.get_2d(d);
                assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                assert!((0.0..1.0).contains(&a.get_1d(d)) && (0.0..1.0).contains(&a.get_1d_f64(d)));
            }
        }
    }
    each!(check);
}

#[test]
fn a_whole_bounce_equals_its_parts() {
    fn check<S: Sampler>(s: S) {
        for depth in [0, 1, 2, 50, 400_000_000] {
            let p = s.start(8, 13);
            let parts = BounceDraws {
                light: p.get_2d(Dim::bounce(depth, Slot::Light)),
                bsdf: p.get_2d(Dim::bounce(depth, Slot::Bsdf)),
                lobe: p.get_1d(Dim::bounce(depth, Slot::Lobe)),
                roulette: p.get_1d(Dim::bounce(depth, Slot::Roulette)),
            };
            assert_eq!(p.bounce(depth), parts, "depth {depth}");
        }
    }
    each!(check);
}

/// Correlation between draws that must have nothing to do with each other: neighbouring pixels, dimensions, forks,
/// seeds. Over 10,000 pairs |r| < 0.045 is 4.5 standard errors; the mutant (the same draw, jittered) has 0.9.
#[test]
fn streams_dimensions_and_forks_are_uncorrelated() {
    fn correlation(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
        let (mut n, mut xy) = (0.0, 0.0);
        for (x, y) in pairs {
            n += 1.0;
            xy += 12.0 * (x - 0.5) * (y - 0.5);
        }
        xy / n
    }
    fn check<S: Sampler>(s: S) {
        let n = 10_000u64;
        let film = |s: S, stream: u64| s.start(stream, stream % 5).get_1d_f64(Dim::FILM);
        let r = correlation((0..n).map(|i| (film(s, i), film(s, i + 1))));
        assert!(r.abs() < 0.045, "neighbouring streams {r}");
        let r = correlation((0..n).map(|i| (film(s, i), film(s, i << 32))));
        assert!(r.abs() < 0.045, "far streams {r}");
        let r = correlation((0..n).map(|i| {
            let p = s.start(i, 3);
            (p.get_1d_f64(Dim::FILM), p.fork(1).get_1d_f64(Dim::FILM))
        }));
        assert!(r.abs() < 0.045, "fork {r}");
        let all: Vec<Dim> = dims().collect();
        for (k, &a) in all.iter().enumerate() {
            let b = all[(k * 7 + 3) % all.len()];
            if a == b {
                continue;
            }
            let r = correlation((0..n).map(|i| {
                let p = s.start(i, 1);
                (p.get_1d_f64(a), p.get_1d_f64(b))
            }));
            assert!(r.abs() < 0.045, "{a:?} against {b:?}: {r}");
        }
        let mutant = correlation((0..n).map(|i| (film(s, i), 0.9 * film(s, i) + 0.1 * film(s, i + 1))));
        assert!(mutant > 0.5);
    }
    each!(check);
}

/// A single index over many streams is uniform (Kolmogorov–Smirnov, 20,000 values: 1.95 is p = 0.001; a density
/// tilted by 3 % gives about 2.1).
#[test]
fn every_dimension_is_uniform_over_streams() {
    fn ks(mut v: Vec<f64>) -> f64 {
        v.sort_by(f64::total_cmp);
        let n = v.len() as f64;
        let d = v.iter().enumerate().map(|(i, x)| (x - (i as f64 + 0.5) / n).abs()).fold(0.0, f64::max);
        d * n.sqrt()
    }
    fn check<S: Sampler>(s: S) {
        for d in dims() {
            for index in [0, 2, 5] {
                let values = (0..20_000).map(|i| s.start(i, index).get_1d_f64(d)).collect();
                let k = ks(values);
                assert!(k < 2.2, "{d:?}, index {index}: {k}");
            }
        }
    }
    each!(check);
    let mutant = (0..20_000u64).map(|i| (mix(i) as f64 / u64::MAX as f64).powf(1.1)).collect();
    assert!(ks(mutant) > 2.2);
}

/// One input bit flips each of the 64 output bits half of the time: 50 ± 2 % per cell over 20,000 words (5.6 standard
/// errors).
#[test]
fn the_hash_avalanches() {
    for bit in 0..64 {
        let mut flips = [0u32; 64];
        for i in 0..20_000u64 {
            let x = i.wrapping_mul(0x1234_5678_9abc_def1);
            let d = mix(x) ^ mix(x ^ 1 << bit);
            for (k, f) in flips.iter_mut().enumerate() {
                *f += (d >> k & 1) as u32;
            }
        }
        for (k, f) in flips.iter().enumerate() {
            let share = f64::from(*f) / 20_000.0;
            assert!((share - 0.5).abs() < 0.02, "bit {bit} to {k}: {share}");
        }
    }
}

/// Sequential numbers, as samplers use them: bytes of the hash of a counter are uniform (chi-square, 255 degrees of
/// freedom, 4.5 standard deviations).
#[test]
fn counters_hash_to_uniform_bytes() {
    for byte in 0..8 {
        let mut counts = [0u32; 256];
        for i in 0..256_000u64 {
            counts[(mix(i) >> (8 * byte) & 255) as usize] += 1;
        }
        let chi2: f64 = counts.iter().map(|&c| (f64::from(c) - 1000.0).powi(2) / 1000.0).sum();
        assert!(((chi2 - 255.0) / 510f64.sqrt()).abs() < 4.5, "byte {byte}: {chi2}");
    }
}

#[test]
fn stratified_fills_every_interval_and_no_cell_twice() {
    for spp in [1u32, 2, 3, 5, 7, 12, 16, 30, 64, 97, 100] {
        let s = Stratified::new(9, spp);
        // The first set and, past spp, the next one.
        for set in 0..2u64 {
            let (columns, rows) = (spp.isqrt(), spp.div_ceil(spp.isqrt()));
            let mut intervals = vec![0; spp as usize];
            let mut cells = vec![0; (columns * rows) as usize];
            for i in 0..u64::from(spp) {
                let p = s.start(4, set * u64::from(spp) + i);
                intervals[(p.get_1d_f64(Dim::TIME) * f64::from(spp)) as usize] += 1;
                let q = p.get_2d(Dim::FILM);
                cells[((q.y * rows as f32) as u32 * columns + (q.x * columns as f32) as u32) as usize] += 1;
            }
            assert!(intervals.iter().all(|&c| c == 1), "{spp}: {intervals:?}");
            assert!(cells.iter().all(|&c| c <= 1), "{spp}: {cells:?}");
        }
        let first = s.start(4, 0).get_1d(Dim::TIME);
        assert_ne!(first, s.start(4, u64::from(spp)).get_1d(Dim::TIME), "the next set is another");
    }
}

#[test]
fn replicates_tell_the_true_error() {
    // 16 replicates of 16 samples: their scatter must predict the error of the whole mean. The sample variance of
    // 256 Sobol points as if independent would be far too large.
    let truth = 0.557_746_285_351_033_7;
    let (mut predicted, mut actual, runs) = (0.0, 0.0, 500);
    for run in 0..runs {
        let s = Sobol::new(run, 256).with_replicates(16);
        let mut means = [0.0; 16];
        for i in 0..256u64 {
            let p = s.start(run, i).get_2d(Dim::FILM);
            means[(i % 16) as usize] += (-f64::from(p.length_squared())).exp() / 16.0;
        }
        let mean = means.iter().sum::<f64>() / 16.0;
        predicted += means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (15.0 * 16.0);
        actual += (mean - truth).powi(2);
    }
    // Standard error of the ratio: about 7 %.
    let ratio = predicted / actual;
    assert!((0.75..1.3).contains(&ratio), "{ratio}");
}

#[test]
fn fingerprints_tell_samplers_apart() {
    let digest = |f: &dyn Fn(&mut Fingerprint)| {
        let mut d = Fingerprint::default();
        f(&mut d);
        d.value()
    };
    let all = [
        digest(&|f| Sobol::new(1, 16).fingerprint(f)),
        digest(&|f| Sobol::new(2, 16).fingerprint(f)),
        digest(&|f| Sobol::new(1, 16).with_replicates(2).fingerprint(f)),
        digest(&|f| Independent::new(1, 16).fingerprint(f)),
        digest(&|f| Stratified::new(1, 16).fingerprint(f)),
        digest(&|f| Stratified::new(1, 17).fingerprint(f)),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(!all[..i].contains(a));
    }
    // More samples of the same sequence are the same point set.
    assert_eq!(all[0], digest(&|f| Sobol::new(1, 1024).fingerprint(f)));
}

#[test]
fn generators_differ_by_key_point_and_stream() {
    let s = Sobol::new(1, 64);
    let a = pcg32(&s.start(1, 1), 1);
    assert_eq!(a, pcg32(&s.start(1, 1), 1));
    for b in [pcg32(&s.start(1, 1), 2), pcg32(&s.start(1, 2), 1), pcg32(&s.start(2, 1), 1)] {
        assert_ne!(a, b);
    }
}

/// The bits themselves, equal on every target. A deliberate change of a sampler changes this number, and with it every
/// picture; nothing else may.
#[test]
fn bits_are_the_same_on_every_target() {
    let mut digest = Fingerprint::default();
    for i in 0..2000u64 {
        let (stream, index) = (i >> 4, i * 7);
        let s = Sobol::new(3, 256).with_replicates(4).start(stream, index);
        let b = s.bounce((i & 7) as u32);
        digest.floats(&[b.light.x, b.light.y, b.bsdf.x, b.bsdf.y, b.lobe, b.roulette]);
        digest.floats(&s.fork(5).get_2d(Dim::LENS).to_array());
        let s = Stratified::new(3, 100).start(stream, index);
        digest.floats(&[s.get_2d(Dim::FILM).x, s.get_2d(Dim::FILM).y, s.get_1d(Dim::TIME)]);
        digest.floats(&Independent::new(3, 100).start(stream, index).get_2d(Dim::FILM).to_array());
    }
    assert_eq!(digest.value(), PINNED, "{:#034x}", digest.value());
}

const PINNED: u128 = 0x0310_3075_c22e_bcde_7a9d_05a4_070f_e259;
