//! Halton, Hammersley, Latin hypercubes and correlated multi-jittering: their definitions, what they stratify, and how
//! fast their errors fall.

use std::f64::consts::{E, PI};

use etendue_core::{Fingerprint, Vec2};
use etendue_sampling::{
    CorrelatedMultiJittered, Dim, Halton, Hammersley, Independent, LatinHypercube, Sampler, Scrambling, Slot,
    mix, mix2, radical_inverse, unit_f32,
};
use proptest::prelude::*;

const LIGHT: Dim = Dim::bounce(0, Slot::Light);
const BSDF: Dim = Dim::bounce(0, Slot::Bsdf);
const SCRAMBLINGS: [Scrambling; 3] = [Scrambling::None, Scrambling::DigitPermutation, Scrambling::Owen];

fn permuted(seed: u64, spp: u32) -> Halton {
    Halton::new(seed, spp).with_scrambling(Scrambling::DigitPermutation)
}

/// A deliberately wrong sampler: an independent one whose single draws go through a function of (bits, sampler, dim).
#[derive(Clone, Copy)]
struct Mutant {
    inner: Independent,
    key: u64,
    index: u64,
    draw: fn(&Mutant, Dim) -> u32,
}

impl Mutant {
    fn new(seed: u64, spp: u32, draw: fn(&Mutant, Dim) -> u32) -> Self {
        Self { inner: Independent::new(seed, spp), key: seed, index: 0, draw }
    }
}

impl Sampler for Mutant {
    fn spp(&self) -> u32 {
        self.inner.spp()
    }
    fn start(self, stream: u64, index: u64) -> Self {
        Self { inner: self.inner.start(stream, index), key: mix2(self.key, stream), index, ..self }
    }
    fn fork(self, key: u32) -> Self {
        Self { inner: self.inner.fork(key), ..self }
    }
    fn bits_1d(&self, dim: Dim) -> u32 {
        (self.draw)(self, dim)
    }
    fn get_2d(&self, dim: Dim) -> Vec2 {
        Vec2::new(self.get_1d(dim), self.get_1d(dim.next()))
    }
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("mutant");
    }
}

/// Strata drawn with replacement, then jittered.
fn with_replacement(s: &Mutant, dim: Dim) -> u32 {
    let n = u64::from(s.inner.spp());
    let stratum = mix2(mix(s.key) ^ s.index, u64::from(dim.index())) % n;
    ((stratum << 32 | u64::from(s.inner.bits_1d(dim))) / n) as u32
}

/// Digits shifted by random amounts that are the same in every dimension.
fn blind_to_dimension(s: &Mutant, dim: Dim) -> u32 {
    let base: u32 = [2, 3, 5, 7, 17, 19, 11, 13, 23][dim.index() as usize % 9];
    let (mut rest, mut x, mut scale, mut shifts) = (s.index as u32, 0.0, 1.0, s.key);
    while scale > 1e-11 {
        let wide = u128::from(shifts) * u128::from(base);
        shifts = wide as u64;
        scale /= f64::from(base);
        x += scale * f64::from((rest % base + (wide >> 64) as u32) % base);
        rest /= base;
    }
    (x * 4_294_967_296.0) as u32
}

// ------------------------------------------------------------------------------------------------- definitions

#[test]
fn the_first_points_of_halton_are_as_defined() {
    let thirds = [
        0.0,
        1.0 / 3.0,
        2.0 / 3.0,
        1.0 / 9.0,
        4.0 / 9.0,
        7.0 / 9.0,
        2.0 / 9.0,
        5.0 / 9.0,
        8.0 / 9.0,
        1.0 / 27.0,
    ];
    let halves = [0.0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875, 0.0625, 0.5625];
    let floor = |x: f64| (x * 4_294_967_296.0) as u32;
    let s = Halton::none(16);
    for (i, (x, y)) in halves.into_iter().zip(thirds).enumerate() {
        assert_eq!((radical_inverse(2, i as u32), radical_inverse(3, i as u32)), (x, y));
        for stream in [0, 1, 99] {
            let p = s.start(stream, i as u64);
            assert_eq!(p.get_2d(Dim::FILM), Vec2::new(unit_f32(floor(x)), unit_f32(floor(y))));
        }
    }
    // Every base where the docs say it is; 1/b at index 1 tells it.
    let p = s.start(5, 1);
    let dims = [Dim::FILM, LIGHT, BSDF, Dim::LENS].into_iter().flat_map(|d| [d, d.next()]);
    let dims: Vec<Dim> = dims.chain([Dim::TIME, Dim::bounce(0, Slot::Lobe)]).collect();
    for (dim, base) in dims.into_iter().zip([2, 3, 5, 7, 11, 13, 17, 19, 23, 29]) {
        assert_eq!(p.bits_1d(dim), ((1u64 << 32) / base) as u32, "{dim:?}");
    }
    // Replicates would all be the same.
    assert_eq!(s.with_replicates(4).replicates(), 1);
    assert_eq!(Halton::new(1, 8).with_replicates(4).with_scrambling(Scrambling::None).replicates(), 1);
    // Later vertices differ by stream even so.
    let later = Dim::bounce(1, Slot::Light);
    assert_ne!(s.start(0, 1).bits_1d(later), s.start(1, 1).bits_1d(later));
}

/// The L2 star discrepancy by Warnock's formula, squared.
fn warnock(points: &[Vec<f64>]) -> f64 {
    let (n, d) = (points.len() as f64, points[0].len() as i32);
    let one: f64 = points.iter().map(|p| p.iter().map(|x| 1.0 - x * x).product::<f64>()).sum();
    let max = |p: &Vec<f64>, q: &Vec<f64>| p.iter().zip(q).map(|(x, y)| 1.0 - x.max(*y)).product::<f64>();
    let two: f64 = points.iter().map(|p| points.iter().map(|q| max(p, q)).sum::<f64>()).sum();
    3f64.powi(-d) - 2f64.powi(1 - d) / n * one + two / (n * n)
}

#[test]
fn hammersley_has_the_discrepancy_of_halton_and_zaremba() {
    let set = |n: u32, d: u32| -> Vec<Vec<f64>> {
        let set = Hammersley::new(n);
        (0..n).map(|i| (0..d).map(|k| set.point(i, k).unwrap()).collect()).collect()
    };
    for m in [2, 4, 6, 8] {
        let (k, n) = (f64::from(m), f64::from(1u32 << m));
        // Halton & Zaremba (1969).
        let exact =
            k * k / 64.0 + 29.0 * k / 192.0 + 0.375 - k / (16.0 * n) + 1.0 / (4.0 * n) - 1.0 / (72.0 * n * n);
        let l2 = warnock(&set(1 << m, 2)) * n * n;
        assert!((l2 - exact).abs() < 1e-9 * n * n, "m = {m}: {l2} against {exact}");
    }
    // Computed apart, with the same conventions, by another library (SciPy 1.17).
    let halton = |n: u32, bases: &[u32]| -> Vec<Vec<f64>> {
        (0..n).map(|i| bases.iter().map(|&b| radical_inverse(b, i)).collect()).collect()
    };
    for (points, expected) in [
        (halton(64, &[2, 3]), 0.016_409_44),
        (halton(256, &[2, 3, 5, 7]), 0.007_416_06),
        (set(256, 4), 0.006_602_11),
    ] {
        assert!((warnock(&points).sqrt() - expected).abs() < 1e-8, "{expected}");
    }
    // Centred, one dimension: 1/(√12 N); as it is: 1/(√3 N).
    let line = |set: Hammersley| (0..32).map(|i| vec![set.point(i, 0).unwrap()]).collect::<Vec<_>>();
    let (plain, centred) = (Hammersley::new(32), Hammersley::new(32).centred());
    assert!((warnock(&line(plain)) * 1024.0 - 1.0 / 3.0).abs() < 1e-10);
    assert!((warnock(&line(centred)) * 1024.0 - 1.0 / 12.0).abs() < 1e-10);
    assert_eq!(plain.point(32, 0), None);
    assert_eq!(plain.point(0, Hammersley::DIMENSIONS), None);
    assert_eq!(plain.point(1, Hammersley::DIMENSIONS - 1), Some(1.0 / 131.0));
    assert_eq!(Hammersley::new(0).point(0, 0), None);
}

// ---------------------------------------------------------------------------------------------- stratification

/// The interval of a number among `n`, where its true value may lie up to 2⁻³² above.
fn interval(x: f64, n: u64) -> usize {
    ((((x * 4_294_967_296.0) as u64 + 1) * n - 1) >> 32) as usize
}

/// Whether every elementary box of 2^a × 3^b that holds one point on average holds one, of `sets` successive sets.
fn fills_elementary_boxes<S: Sampler>(s: S) -> bool {
    [(1, 1), (2, 1), (1, 2), (3, 2), (5, 0), (0, 4), (4, 3)].into_iter().all(|(a, b)| {
        let (columns, rows) = (1u64 << a, 3u64.pow(b));
        (0..3).all(|set| {
            let mut cells = vec![0; (columns * rows) as usize];
            for i in 0..columns * rows {
                let p = s.start(8, set * columns * rows + i);
                let (x, y) = (p.get_1d_f64(Dim::FILM), p.get_1d_f64(Dim::FILM.next()));
                cells[interval(x, columns) * rows as usize + interval(y, rows)] += 1;
            }
            cells.iter().all(|&c| c == 1)
        })
    })
}

#[test]
fn halton_has_one_point_in_each_elementary_box() {
    for seed in 0..50 {
        for scrambling in SCRAMBLINGS {
            assert!(
                fills_elementary_boxes(Halton::new(seed, 16).with_scrambling(scrambling)),
                "{scrambling:?}"
            );
        }
    }
    // The test sees what is no net: strata in each coordinate alone.
    assert!(!fills_elementary_boxes(LatinHypercube::new(1, 6)));
}

/// Whether each of a set's `n` intervals in every dimension holds one sample.
fn holds_one_in_each_row<S: Sampler>(s: S, n: u32) -> bool {
    let dims = [
        Dim::FILM,
        Dim::FILM.next(),
        LIGHT,
        Dim::TIME,
        Dim::bounce(3, Slot::Roulette),
        Dim::bounce(900, Slot::Bsdf),
    ];
    dims.into_iter().all(|dim| {
        (0..3).all(|set| {
            let mut rows = vec![0; n as usize];
            (0..n).for_each(|i| {
                rows[interval(
                    s.start(4, set * u64::from(n) + u64::from(i)).get_1d_f64(dim),
                    u64::from(n),
                )] += 1;
            });
            rows.iter().all(|&c| c == 1)
        })
    })
}

#[test]
fn latin_hypercubes_have_one_sample_in_each_row_of_every_dimension() {
    for n in [1, 2, 3, 5, 16, 37, 100, 1000] {
        assert!(holds_one_in_each_row(LatinHypercube::new(7, n), n), "{n}");
        assert!(holds_one_in_each_row(CorrelatedMultiJittered::new(7, n), n), "single draws, {n}");
        if n > 4 {
            assert!(!holds_one_in_each_row(Mutant::new(7, n, with_replacement), n), "mutant, {n}");
        }
    }
    // Each replicate is a set of its own, and the next set is another.
    let s = LatinHypercube::new(7, 30).with_replicates(3);
    for r in 0..3 {
        let mut rows = [0; 10];
        (0..10).for_each(|i| rows[interval(s.start(4, 3 * i + r).get_1d_f64(LIGHT), 10)] += 1);
        assert_eq!(rows, [1; 10]);
    }
    let s = LatinHypercube::new(7, 16);
    let order = |set: u64, d: Dim| {
        (0..16).map(|i| interval(s.start(4, set * 16 + i).get_1d_f64(d), 16)).collect::<Vec<_>>()
    };
    assert_ne!(order(0, LIGHT), order(1, LIGHT));
    assert_ne!(order(0, LIGHT), order(0, BSDF));
}

/// Most samples in a cell, in a column and in a row of the pattern of a set.
fn crowding<S: Sampler>(s: S, dim: Dim, samples: u32, (m, n): (u32, u32)) -> [u32; 3] {
    let count = (m * n) as usize;
    let (mut cells, mut columns, mut rows) = (vec![0; count], vec![0; count], vec![0; count]);
    for i in 0..samples {
        let p = s.start(11, u64::from(i)).get_2d(dim);
        // A float is the true value rounded down to a multiple of 2⁻²⁴.
        let at = |x: f32, n: u32| ((((x * 16_777_216.0) as u64 + 1) * u64::from(n) - 1) >> 24) as usize;
        cells[at(p.y, n) * m as usize + at(p.x, m)] += 1;
        columns[at(p.x, m * n)] += 1;
        rows[at(p.y, m * n)] += 1;
    }
    [cells, columns, rows].map(|v| v.into_iter().max().unwrap_or(0))
}

#[test]
fn multi_jittering_has_one_sample_in_each_cell_column_and_row() {
    for n in [1, 2, 6, 16, 32, 35, 37, 64, 100] {
        for seed in 0..20 {
            let s = CorrelatedMultiJittered::new(seed, n);
            for dim in [Dim::FILM, LIGHT, Dim::bounce(50, Slot::Bsdf)] {
                // As many samples as cells, or fewer: at most one is exactly one where the numbers agree.
                assert_eq!(crowding(s, dim, n, s.cells()), [1; 3], "{n} samples, {:?} cells", s.cells());
            }
        }
    }
    // The test sees patterns that are only one of both.
    let latin = crowding(LatinHypercube::new(1, 64), Dim::FILM, 64, (8, 8));
    let jittered = crowding(etendue_sampling::Stratified::new(1, 64), Dim::FILM, 64, (8, 8));
    assert!(latin[0] > 1 && latin[1] == 1 && latin[2] == 1, "{latin:?}");
    assert!(jittered[0] == 1 && jittered[1] > 1 && jittered[2] > 1, "{jittered:?}");
}

// ------------------------------------------------------------------------------------------------------ means

/// Mean over 400 seeds of `n`-sample means of 4x³ (integral 1), in standard errors from `exact`.
fn z<S: Sampler>(make: impl Fn(u64) -> S, n: u64, dim: Dim, f: impl Fn(f64) -> f64) -> f64 {
    let mean = |seed| {
        let s = make(mix(seed));
        (0..n).map(|i| f(s.start(seed, i).get_1d_f64(dim))).sum::<f64>() / n as f64
    };
    let means: Vec<f64> = (0..400).map(mean).collect();
    let m = means.iter().sum::<f64>() / 400.0;
    let variance = means.iter().map(|x| (x - m).powi(2)).sum::<f64>() / 399.0;
    (m - 1.0) / (variance / 400.0).sqrt()
}

/// Within 4 standard errors over 400 seeds; 40 tests, so that one in 400 choices of seeds would fail. The standard error
/// of the least exact set here, 5 samples of independent quality, is 2.5 %; of a stratified set of 48 it is 0.03 %:
/// the mutant, 1 % off, is 8 or more of them.
#[test]
fn every_point_set_is_unbiased() {
    let cubic = |x: f64| 4.0 * x.powi(3);
    for dim in [Dim::FILM, BSDF.next(), Dim::bounce(0, Slot::Lobe), Dim::bounce(4, Slot::Light)] {
        for n in [5, 48] {
            let spp = n as u32;
            let all = [
                z(|r| Halton::new(r, spp), n, dim, cubic),
                z(|r| permuted(r, spp), n, dim, cubic),
                z(|r| LatinHypercube::new(r, spp), n, dim, cubic),
                // A part of a set, whose size fits no grid.
                z(|r| LatinHypercube::new(r, 2 * spp + 1), n, dim, cubic),
                z(|r| CorrelatedMultiJittered::new(r, 37), n, dim, cubic),
            ];
            assert!(all.iter().all(|z| z.abs() < 4.0), "{dim:?}, {n} samples: {all:?}");
        }
    }
    let mutant = z(|r| LatinHypercube::new(r, 48), 48, Dim::FILM, |x| 1.01 * cubic(x));
    assert!(mutant > 8.0, "{mutant}");
}

/// Mean squared error of `n`-sample means over `runs` randomisations.
fn mse<S: Sampler>(
    make: impl Fn(u64, u32) -> S,
    n: u64,
    runs: u64,
    exact: f64,
    f: impl Fn(&S) -> f64,
) -> f64 {
    let error = |run| {
        let s = make(mix(run), n as u32);
        (0..n).map(|i| f(&s.start(run, i))).sum::<f64>() / n as f64 - exact
    };
    (0..runs).map(|run| error(run).powi(2)).sum::<f64>() / runs as f64
}

/// Slope of log MSE over log N by least squares. Each MSE over 200 runs has a standard error of about 10 %, so the slope
/// over a factor of 64 has 0.04 (0.08 where the errors have heavier tails).
fn slope<S: Sampler>(
    make: impl Fn(u64, u32) -> S + Copy,
    counts: &[u64],
    exact: f64,
    f: impl Fn(&S) -> f64 + Copy,
) -> f64 {
    let logs: Vec<(f64, f64)> =
        counts.iter().map(|&n| ((n as f64).ln(), mse(make, n, 200, exact, f).ln())).collect();
    let n = logs.len() as f64;
    let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    logs.iter().map(|(x, y)| (x - mx) * (y - my)).sum::<f64>()
        / logs.iter().map(|(x, _)| (x - mx).powi(2)).sum::<f64>()
}

fn gauss<S: Sampler>(s: &S) -> f64 {
    (-f64::from(s.get_2d(Dim::FILM).length_squared())).exp()
}
const GAUSS: f64 = 0.557_746_285_351_033_7;

fn additive<S: Sampler>(s: &S) -> f64 {
    let p = s.get_2d(Dim::FILM);
    f64::from(p.x).exp() + f64::from(p.y).exp()
}

fn disc<S: Sampler>(s: &S) -> f64 {
    let p = s.get_2d(Dim::FILM);
    f64::from(u8::from(f64::from(p.x).powi(2) + f64::from(p.y).powi(2) < 2.0 / PI))
}

fn between(what: &str, s: f64, steepest: f64, flattest: f64) {
    println!("{what}: {s:.2}");
    assert!((steepest..flattest).contains(&s), "{what}: {s} outside {steepest} to {flattest}");
}

#[test]
fn errors_fall_at_the_rates_of_theory() {
    let counts = [64, 256, 1024, 4096];
    let sum = 2.0 * (E - 1.0);

    between("latin, additive", slope(LatinHypercube::new, &counts, sum, additive), -3.15, -2.85);
    between("latin, gauss", slope(LatinHypercube::new, &counts, GAUSS, gauss), -1.15, -0.85);
    let mutant = slope(|r, n| Mutant::new(r, n, with_replacement), &counts, sum, additive);
    between("strata with replacement, additive", mutant, -1.15, -0.85);

    between("cmj, additive", slope(CorrelatedMultiJittered::new, &counts, sum, additive), -3.15, -2.85);
    between("cmj, gauss", slope(CorrelatedMultiJittered::new, &counts, GAUSS, gauss), -2.1, -1.4);
    between("cmj, disc", slope(CorrelatedMultiJittered::new, &counts, 0.5, disc), -1.75, -1.3);

    between("halton permuted, gauss", slope(permuted, &counts, GAUSS, gauss), -2.15, -1.8);
    between("halton permuted, disc", slope(permuted, &counts, 0.5, disc), -1.75, -1.3);
    between("halton owen, gauss", slope(Halton::new, &counts, GAUSS, gauss), -2.3, -1.8);
    between("halton owen, disc", slope(Halton::new, &counts, 0.5, disc), -1.75, -1.3);
    // At products of powers of the two bases the pair is a net, and nested scrambling shows what it is worth.
    let balanced = [36, 216, 1296, 7776];
    between("halton owen, gauss, 6^k", slope(Halton::new, &balanced, GAUSS, gauss), -2.8, -2.2);
    between("halton permuted, gauss, 6^k", slope(permuted, &balanced, GAUSS, gauss), -2.15, -1.8);
    // Base 3 in powers of 3: one point in each interval.
    let line = |s: &Halton| s.get_1d_f64(Dim::FILM.next()).exp();
    between("halton owen, 1-D", slope(Halton::new, &[27, 81, 243, 729], E - 1.0, line), -3.2, -2.8);
    between("halton permuted, 1-D", slope(permuted, &[27, 81, 243, 729], E - 1.0, line), -2.2, -1.8);
}

const SQUARES: f64 = 0.199_824_895_698_387_4;

/// Form factor of two parallel unit squares (Kollig & Keller 2002), at two pairs of numbers.
fn squares<S: Sampler>(s: &S, a: Dim, b: Dim) -> f64 {
    let (p, q) = (s.get_2d(a), s.get_2d(b));
    let (x, y) = (f64::from(p.x) - f64::from(q.x), f64::from(p.y) - f64::from(q.y));
    1.0 / (PI * (x * x + y * y + 1.0).powi(2))
}

/// Four dimensions at once: the permuted sequence has 8.3e-7 at 256 samples (measured by another implementation), 5.8e-8
/// at 1024; independent numbers 1.9e-5. Over 300 runs an MSE is known to 9 %.
#[test]
fn halton_stratifies_the_first_block_jointly() {
    for (n, bound) in [(256, 1.2e-6), (1024, 9e-8)] {
        let e = mse(permuted, n, 300, SQUARES, |s| squares(s, Dim::FILM, LIGHT));
        println!("permuted, {n}: {e:.2e}");
        assert!((bound / 3.0..bound).contains(&e), "{n}: {e:e}");
        let e = mse(Halton::new, n, 300, SQUARES, |s| squares(s, Dim::FILM, LIGHT));
        println!("owen, {n}: {e:.2e}");
        assert!(e < bound, "{n}: {e:e}");
    }
    // Bases 2 to 13, no power of two.
    let e = mse(Halton::new, 300, 300, SQUARES, |s| squares(s, Dim::FILM, BSDF));
    assert!(e < 6e-6, "film and BSDF: {e:e}");
}

/// Blocks joined at random are no worse than independent numbers. A ratio over 3000 runs has a standard error of 3.6 %;
/// the mutant, both blocks following one index in the same bases, has 26.
#[test]
fn joining_blocks_is_not_worse_than_independent() {
    let later = Dim::bounce(1, Slot::Light);
    let random = mse(Independent::new, 64, 3000, SQUARES, |s| squares(s, Dim::FILM, later));
    let joint = mse(Halton::new, 64, 3000, SQUARES, |s| squares(s, Dim::FILM, later)) / random;
    let fork = |s: &Halton| {
        let (p, q) = (s.get_2d(Dim::FILM), s.fork(3).get_2d(Dim::FILM));
        let (x, y) = (f64::from(p.x) - f64::from(q.x), f64::from(p.y) - f64::from(q.y));
        1.0 / (PI * (x * x + y * y + 1.0).powi(2))
    };
    let forked = mse(Halton::new, 64, 3000, SQUARES, fork) / random;
    // Both pairs in bases 2 and 3 from the same index, scrambled apart.
    let same = |seed: u64| {
        let sum = |i| {
            let (p, q) = (Halton::new(seed, 64).start(1, i), Halton::new(seed, 64).start(2, i));
            let (p, q) = (p.get_2d(Dim::FILM), q.get_2d(Dim::FILM));
            let (x, y) = (f64::from(p.x) - f64::from(q.x), f64::from(p.y) - f64::from(q.y));
            1.0 / (PI * (x * x + y * y + 1.0).powi(2))
        };
        ((0..64).map(sum).sum::<f64>() / 64.0 - SQUARES).powi(2)
    };
    let mutant = (0..3000).map(|r| same(mix(r))).sum::<f64>() / 3000.0 / random;
    println!("blocks {joint:.3}, forks {forked:.3}, mutant {mutant:.3} of independent");
    assert!(joint < 1.1 && forked < 1.1, "{joint} {forked}");
    assert!(mutant > 2.0, "{mutant}");
}

/// Correlation of two dimensions over streams at one index: 4.5 standard errors over 10,000 streams.
#[test]
fn permutations_depend_on_the_dimension() {
    fn correlation<S: Sampler>(s: S, a: Dim, b: Dim, index: u64) -> f64 {
        let product = |i| {
            let p = s.start(i, index);
            12.0 * (p.get_1d_f64(a) - 0.5) * (p.get_1d_f64(b) - 0.5)
        };
        (0..10_000).map(product).sum::<f64>() / 10_000.0
    }
    let dims: Vec<Dim> = [Dim::FILM, LIGHT, BSDF, Dim::LENS]
        .into_iter()
        .flat_map(|d| [d, d.next()])
        .chain([Dim::TIME])
        .collect();
    let mut worst_mutant: f64 = 0.0;
    for (k, &a) in dims.iter().enumerate() {
        for &b in &dims[..k] {
            for index in [0, 3] {
                for r in
                    [correlation(Halton::new(5, 16), a, b, index), correlation(permuted(6, 16), a, b, index)]
                {
                    assert!(r.abs() < 0.045, "{a:?}, {b:?}: {r}");
                }
                worst_mutant =
                    worst_mutant.max(correlation(Mutant::new(5, 16, blind_to_dimension), a, b, index).abs());
            }
        }
    }
    assert!(worst_mutant > 0.5, "{worst_mutant}");
    // The mutant is a Halton set in each dimension for all that: only joint tests can reject it.
    let s = Mutant::new(5, 16, blind_to_dimension);
    let mut rows = [0; 16];
    (0..16).for_each(|i| rows[(s.start(1, i).get_1d_f64(Dim::FILM) * 16.0 + 1e-6) as usize] += 1);
    assert_eq!(rows, [1; 16]);
}

// ----------------------------------------------------------------------------------------------------- contract

/// Draws of one point in the order given, put back in the order of `dims`.
fn draws<S: Sampler>(s: S, stream: u64, index: u64, dims: &[Dim], backward: bool) -> Vec<(u32, Vec2)> {
    let draw = |d: &Dim| {
        let p = s.start(stream, index);
        (p.bits_1d(*d), p.get_2d(*d))
    };
    if backward {
        let mut all: Vec<_> = dims.iter().rev().map(draw).collect();
        all.reverse();
        all
    } else {
        let p = s.start(index, stream).start(stream, index);
        dims.iter().map(|d| (p.bits_1d(*d), p.get_2d(*d))).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(0x5ee7),
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_order_gives_the_same_numbers_and_none_is_one(
        seed: u64, stream: u64, far: u64, near in 0u64..5000, spp: u32, replicates in 0u32..9, depth: u32,
    ) {
        fn check<S: Sampler>(s: S, stream: u64, index: u64, dims: &[Dim]) -> Result<(), TestCaseError> {
            let forward = draws(s, stream, index, dims, false);
            prop_assert_eq!(&forward, &draws(s, stream, index, dims, true));
            let p = s.start(stream, index);
            for (dim, (bits, pair)) in dims.iter().zip(&forward) {
                prop_assert_eq!(p.get_1d(*dim), unit_f32(*bits));
                prop_assert!((0.0..1.0).contains(&p.get_1d(*dim)) && (0.0..1.0).contains(&p.get_1d_f64(*dim)));
                prop_assert!((0.0..1.0).contains(&pair.x) && (0.0..1.0).contains(&pair.y));
            }
            Ok(())
        }
        let dims = [
            Dim::FILM, Dim::LENS, Dim::TIME, LIGHT, BSDF, Dim::bounce(0, Slot::Lobe), Dim::bounce(depth, Slot::Light),
            Dim::bounce(depth % 50, Slot::Spare1), Dim::bounce(depth % 50, Slot::Bsdf),
        ];
        // All sizes, and the small ones that are used.
        for (index, spp) in [(far, spp), (near, spp % 5000), (u64::from(u32::MAX), u32::MAX)] {
            for scrambling in SCRAMBLINGS {
                let s = Halton::new(seed, spp).with_scrambling(scrambling).with_replicates(replicates);
                check(s, stream, index, &dims)?;
            }
            check(LatinHypercube::new(seed, spp).with_replicates(replicates), stream, index, &dims)?;
            check(CorrelatedMultiJittered::new(seed, spp).with_replicates(replicates), stream, index, &dims)?;
        }
    }

    #[test]
    fn radical_inverses_stay_below_one(base: u32, index: u32, k in 0u32..33) {
        let x = radical_inverse(base, index);
        prop_assert!((0.0..1.0).contains(&x));
        // The largest: all digits b − 1.
        let (base, k) = (base % 1000 + 2, k);
        let top = u64::from(base).checked_pow(k).filter(|p| *p <= 1 << 32).unwrap_or(1) - 1;
        prop_assert!(radical_inverse(base, top as u32) <= 1.0 - 1.0 / 4_294_967_296.0);
    }
}

#[test]
fn fingerprints_tell_point_sets_apart() {
    fn digest<S: Sampler>(s: S) -> u128 {
        let mut f = Fingerprint::default();
        s.fingerprint(&mut f);
        f.value()
    }
    let all = [
        digest(Halton::new(1, 16)),
        digest(Halton::new(2, 16)),
        digest(Halton::new(1, 16).with_replicates(2)),
        digest(permuted(1, 16)),
        digest(Halton::none(16)),
        digest(LatinHypercube::new(1, 16)),
        digest(LatinHypercube::new(2, 16)),
        digest(LatinHypercube::new(1, 17)),
        digest(LatinHypercube::new(1, 16).with_replicates(2)),
        digest(CorrelatedMultiJittered::new(1, 16)),
        digest(CorrelatedMultiJittered::new(2, 16)),
        digest(CorrelatedMultiJittered::new(1, 17)),
        digest(CorrelatedMultiJittered::new(1, 16).with_replicates(2)),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(!all[..i].contains(a), "{i}");
    }
    // More samples of the same sequence are the same point set.
    assert_eq!(all[0], digest(Halton::new(1, 1024)));
}

/// The bits themselves, equal on every target.
#[test]
fn bits_are_the_same_on_every_target() {
    let mut digest = Fingerprint::default();
    for i in 0..2000u64 {
        let (stream, index) = (i >> 4, i * 7);
        for scrambling in SCRAMBLINGS {
            let s = Halton::new(3, 256).with_scrambling(scrambling).with_replicates(4).start(stream, index);
            let b = s.bounce((i & 7) as u32);
            digest.floats(&[b.light.x, b.light.y, b.bsdf.x, b.bsdf.y, b.lobe, b.roulette]);
            digest.floats(&s.fork(5).get_2d(Dim::LENS).to_array());
        }
        digest.floats(&LatinHypercube::new(3, 100).start(stream, index).get_2d(Dim::FILM).to_array());
        let s = CorrelatedMultiJittered::new(3, 100).start(stream, index);
        digest.floats(&[s.get_2d(Dim::FILM).x, s.get_2d(Dim::FILM).y, s.get_1d(Dim::TIME)]);
    }
    assert_eq!(digest.value(), PINNED, "{:#034x}", digest.value());
}

const PINNED: u128 = 0xae15_2e3b_f95b_e997_0628_be43_2280_8720;
