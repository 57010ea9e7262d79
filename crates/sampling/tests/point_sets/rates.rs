//! How fast errors fall, and what is joined how.

use etendue_sampling::{
    CorrelatedMultiJittered, Dim, Halton, Independent, LatinHypercube, Sampler, Slot, mix,
};
use std::f64::consts::E;
use std::f64::consts::PI;

use crate::mutants::{Mutant, blind_to_dimension, with_replacement};
use crate::{BSDF, LIGHT, permuted};

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
