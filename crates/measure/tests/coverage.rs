//! Whether the intervals hold the truth as often as they say: 1,000 measurements of an integral whose variance is
//! known. If the true coverage is 95 %, that of 1,000 lies within 93–97 % with probability 99.6 %; if it is 91 % or
//! 99 %, with probability 2 % and less.

mod common;

use common::{Ramp, VARIANCE, Wound, contender, uniform};
use etendue_measure::{Axis, Budget, Clocks, Curve, Metric, Point, Reference, Residual, convergence, race};

const PIXELS: usize = 64;
const SIZE: [u32; 2] = [8, 8];
const RUNS: u64 = 5;
const TRIALS: u64 = 1000;
const BUDGET: Budget = Budget { spp: 16, seconds: None };

fn exact() -> Reference {
    Reference::exact(SIZE, vec![[1.0; 3]; PIXELS])
}

/// A machine whose speed varies by ±20 % at random.
fn unsteady(_: f64, salt: u64) -> f64 {
    0.8 + 0.4 * uniform(77, salt, 0)
}

/// One that also halves its speed now and then, for as long as somebody else uses it.
fn busy(now: f64, salt: u64, trial: u64) -> f64 {
    let shared = uniform(trial, (now / 0.07) as u64, 5) < 0.4;
    unsteady(now, salt) * if shared { 2.0 } else { 1.0 }
}

fn measure(trial: u64, factor: f64, budget: Budget, reference: &Reference) -> Curve {
    let clock = Wound::default();
    let clocks = Clocks { wall: &clock, cpu: None };
    let ramp = contender("ramp", RUNS, |k| Ramp {
        factor,
        slowness: &unsteady,
        ..Ramp::new(PIXELS, trial * 1000 + k, &clock)
    });
    convergence(ramp, Some(reference), &budget, clocks).expect("a curve")
}

fn last(curve: &Curve) -> &Point {
    curve.points.last().expect("points")
}

/// Fraction of trials that hold.
fn coverage(mut holds: impl FnMut(u64) -> bool) -> f64 {
    (0..TRIALS).filter(|&t| holds(t)).count() as f64 / TRIALS as f64
}

#[test]
fn intervals_of_error_efficiency_slope_and_time_cover() {
    let reference = exact();
    let mse = VARIANCE / 16.0;
    let relative = mse / 1.01;
    let target = 1.5 * relative;
    let mut hits = [0u64; 7];
    for trial in 0..TRIALS {
        let curve = measure(trial, 1.0, BUDGET, &reference);
        let p = last(&curve);
        let to_error = curve.to_error(Metric::Relative, target, Axis::Samples);
        let measured = [
            (p.error(Metric::Absolute), mse),
            (p.corrected(Metric::Relative), relative),
            (p.variance(Metric::Absolute), mse),
            (p.cost(Axis::Seconds), 16e-3),
            (p.efficiency(Metric::Relative, Axis::Seconds), 1.0 / (relative * 16e-3)),
            (curve.slope(Metric::Relative, Axis::Samples), -1.0),
            (to_error.map(|t| t.cost), PIXELS as f64 * 16.0 / 1.5),
        ];
        for (hit, (measured, truth)) in hits.iter_mut().zip(measured) {
            *hit += u64::from(measured.expect("a number").holds(truth));
        }
    }
    let names = ["MSE", "relMSE", "variance", "seconds", "efficiency", "slope", "samples to an error"];
    for (name, hit) in names.iter().zip(hits) {
        let share = hit as f64 / TRIALS as f64;
        println!("{name}: {share}");
        // Leaving one out makes intervals of a variance a little too wide: see `jackknife`.
        let most = if *name == "variance" { 0.98 } else { 0.97 };
        assert!((0.93..=most).contains(&share), "{name}: {share} of the intervals hold the truth");
    }
}

/// The mutants of the test above: a truth that is 5 % off is not covered, an interval of two thirds the width neither.
#[test]
fn wrong_truths_and_narrow_intervals_are_found_out() {
    let reference = exact();
    let mse = VARIANCE / 16.0;
    let error = |t| last(&measure(t, 1.0, BUDGET, &reference)).error(Metric::Absolute).expect("a number");
    assert!(coverage(|t| error(t).holds(1.05 * mse)) < 0.93);
    let narrow = |t| {
        let m = error(t);
        (m.value - mse).abs() < 0.33 * (m.bounds()[1] - m.bounds()[0])
    };
    assert!(coverage(narrow) < 0.93);
}

/// A noisy reference: its own error is taken out of the error, and does not pass for bias.
#[test]
fn the_references_own_error_is_taken_out() {
    let mse = VARIANCE / 16.0;
    let measure = |trial: u64| {
        // 64 samples in each of two halves, whose difference tells the error of their mean.
        let half = |h: u64| -> Vec<[f64; 3]> {
            let value = |i: u64| (0..64).map(|k| 2.0 * uniform(!trial, i, 64 * h + k)).sum::<f64>() / 64.0;
            (0..PIXELS as u64).map(|p| [value(3 * p), value(3 * p + 1), value(3 * p + 2)]).collect()
        };
        let (a, b) = (half(0), half(1));
        let both = |f: fn(f64, f64) -> f64| -> Vec<[f64; 3]> {
            a.iter().zip(&b).map(|(a, b)| [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])]).collect()
        };
        let squares: f64 = both(|a, b| (a - b).powi(2) / 4.0).iter().flatten().sum();
        let residual = Residual { absolute: squares / (3 * PIXELS) as f64, ..Residual::default() };
        let rgb = both(|a, b| 0.5 * (a + b)).iter().map(|p| p.map(|v| v as f32)).collect();
        measure(trial, 1.0, BUDGET, &Reference { size: SIZE, rgb, residual })
    };
    let curves: Vec<Curve> = (0..TRIALS).map(measure).collect();
    let of = |t: u64| last(&curves[t as usize]);
    let corrected = coverage(|t| of(t).corrected(Metric::Absolute).expect("a number").holds(mse));
    let plain = coverage(|t| of(t).error(Metric::Absolute).expect("a number").holds(mse));
    let unbiased = coverage(|t| of(t).bias_squared(Metric::Absolute).expect("a number").holds(0.0));
    println!("corrected {corrected}, as measured {plain}, no bias {unbiased}");
    assert!((0.92..=0.97).contains(&corrected), "{corrected}");
    assert!(plain < 0.9, "the reference's error is an eighth of the whole: {plain}");
    // Too wide at zero by design: see `jackknife`.
    assert!(unbiased > 0.93, "{unbiased}");
}

#[test]
fn a_bias_of_one_percent_is_shown_as_bias() {
    let reference = exact();
    let budget = Budget { spp: 1024, seconds: None };
    let (mut found, mut false_alarms) = (0, 0);
    for trial in 0..40 {
        let [honest, mutant] = [1.0, 1.01].map(|f| measure(trial, f, budget, &reference));
        let bias = |c: &Curve| last(c).bias_squared(Metric::Absolute).expect("a number");
        let b = bias(&mutant);
        found += usize::from(!b.holds(0.0) && b.holds(1e-4));
        false_alarms += usize::from(!bias(&honest).holds(0.0));
        // The variance is that of 1.01 times the samples: not a trace of the bias is in it.
        let variances =
            [&honest, &mutant].map(|c| last(c).variance(Metric::Absolute).expect("a number").value);
        assert!((variances[1] / variances[0] / 1.01f64.powi(2) - 1.0).abs() < 1e-3, "{variances:?}");
        let flat = mutant.slope(Metric::Absolute, Axis::Samples).expect("a slope").value;
        assert!(flat > honest.slope(Metric::Absolute, Axis::Samples).expect("a slope").value + 0.02);
    }
    assert!(found >= 36 && false_alarms <= 4, "{found} of 40 found, {false_alarms} false");
}

/// In a picture of many pixels a bias is seen beneath noise of ten times its size.
#[test]
fn a_bias_of_a_tenth_of_the_noise_is_shown_as_bias() {
    let pixels = 128 * 128;
    let reference = Reference::exact([128, 128], vec![[1.0; 3]; pixels]);
    let (clock, budget) = (Wound::default(), Budget { spp: 32, seconds: None });
    let mut found = 0;
    for trial in 0..10 {
        let clocks = Clocks { wall: &clock, cpu: None };
        let ramp =
            contender("ramp", RUNS, |k| Ramp { factor: 1.01, ..Ramp::new(pixels, trial * 1000 + k, &clock) });
        let curve = convergence(ramp, Some(&reference), &budget, clocks).expect("a curve");
        let of = |m: Option<etendue_measure::Measured>| m.expect("a number");
        let [variance, bias] =
            [last(&curve).variance(Metric::Absolute), last(&curve).bias_squared(Metric::Absolute)].map(of);
        assert!(variance.value > 100.0 * 1e-4, "{variance:?}");
        found += usize::from(!bias.holds(0.0) && bias.holds(1e-4));
    }
    assert!(found >= 8, "{found} of 10 found");
}

/// The same estimator as two contenders on a machine that slows down and speeds up: their ratio is 1 within its
/// interval. A contender that really is 1.3 times as efficient is told apart.
#[test]
fn a_contender_against_itself_is_as_good_as_itself() {
    let reference = exact();
    let ratio = |trial: u64, speed: f64| {
        let busy = |now: f64, salt: u64| busy(now, salt, trial);
        let clock = Wound::default();
        let clocks = Clocks { wall: &clock, cpu: None };
        let ramp = |salt: u64, seconds: f64| {
            contender("ramp", RUNS, |k| Ramp {
                seconds,
                slowness: &busy,
                ..Ramp::new(PIXELS, trial * 1000 + salt + k, &clock)
            })
        };
        let mut both = [ramp(0, 1e-3), ramp(500, 1e-3 / speed)];
        let curves = race(&mut both, Some(&reference), &BUDGET, clocks, &()).expect("curves");
        let (b, a) = (last(&curves[1]), last(&curves[0]));
        b.efficiency_over(a, Metric::Relative, Axis::Seconds).expect("a ratio")
    };
    let same = coverage(|t| ratio(t, 1.0).holds(1.0));
    let faster = coverage(|t| ratio(t, 1.3).holds(1.3));
    let mistaken = coverage(|t| ratio(t, 1.3).holds(1.0));
    println!("itself {same}, faster {faster}, mistaken {mistaken}");
    assert!((0.93..=0.97).contains(&same), "{same}");
    assert!((0.93..=0.97).contains(&faster), "{faster}");
    assert!(mistaken < 0.6, "{mistaken}");
}
