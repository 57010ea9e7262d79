//! Filters: what is drawn has the filter's density, what is weighed has its sign, and a constant stays itself.

use etendue_camera::{Filter, FilterSampler};
use etendue_core::{Fingerprint, Vec2};
use etendue_sampling::{Dim, Independent, Sampler};
use etendue_testkit::stats::{chi2_test, mean_test};

const FILTERS: [(&str, Filter); 8] = [
    ("box", Filter::BOX),
    ("wide box", Filter::Box { radius: 1.3 }),
    ("tent", Filter::Tent { radius: 1.0 }),
    ("gaussian", Filter::Gaussian { radius: 1.5, sigma: 0.5 }),
    ("broad gaussian", Filter::Gaussian { radius: 2.0, sigma: 3.0 }),
    ("mitchell", Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 }),
    ("catmull-rom", Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 }),
    ("b-spline", Filter::Mitchell { radius: 1.5, b: 1.0, c: 0.0 }),
];

const N: u64 = 400_000;

fn draws(sampler: &FilterSampler, seed: u64) -> impl Iterator<Item = (Vec2, f64)> {
    let points = Independent::new(seed, 1);
    (0..N).map(move |i| {
        let s = sampler.sample(points.start(i, 0).get_2d(Dim::FILM));
        (s.offset, f64::from(s.weight))
    })
}

/// ∫ g over the filter's axis by the midpoint rule.
fn integral(filter: &Filter, g: impl Fn(f64, f64) -> f64) -> f64 {
    const STEPS: u32 = 40_000;
    let r = f64::from(filter.radius());
    (0..STEPS)
        .map(|i| ((f64::from(i) + 0.5) / f64::from(STEPS) * 2.0 - 1.0) * r)
        .map(|x| g(x, f64::from(filter.value(x as f32))) * 2.0 * r / f64::from(STEPS))
        .sum()
}

/// The mean weight is 1, so that a constant picture stays what it is. A bias of 1 % is five standard errors.
#[test]
fn weights_have_mean_one() {
    for (name, filter) in FILTERS {
        let sampler = filter.sampler();
        let weights: Vec<f64> = draws(&sampler, 1).map(|(_, w)| w).collect();
        let test = mean_test(&weights, 1.0);
        assert!(!test.rejects(1e-6), "{name}: {test:?}");
        assert!(5.0 * test.standard_error < 0.01, "{name}: {test:?}");
        let mutant: Vec<f64> = weights.iter().map(|w| w * 1.02).collect();
        assert!(mean_test(&mutant, 1.0).rejects(1e-6), "{name}");
        // Along one axis exactly: the numbers of a fine lattice.
        let lattice =
            (0..1 << 16).map(|i| f64::from(sampler.sample(Vec2::new(i as f32 / 65_536.0, 0.5)).weight));
        let centre = f64::from(sampler.sample(Vec2::splat(0.5)).weight).abs().sqrt();
        let mean = lattice.sum::<f64>() / 65_536.0 / centre;
        assert!((mean - 1.0).abs() < 1e-3, "{name}: {mean}");
    }
}

fn histogram_p(sampled: &Filter, expected: &Filter) -> f64 {
    const BINS: usize = 64;
    let r = f64::from(expected.radius());
    let total = integral(expected, |_, f| f.abs());
    let expected: Vec<f64> = (0..BINS)
        .map(|bin| {
            let lo = (bin as f64 / BINS as f64 * 2.0 - 1.0) * r;
            let hi = lo + 2.0 * r / BINS as f64;
            integral(expected, |x, f| if x >= lo && x < hi { f.abs() } else { 0.0 }) / total * N as f64
        })
        .collect();
    let mut counts = [[0u64; BINS]; 2];
    for (offset, _) in draws(&sampled.sampler(), 2) {
        for (axis, counts) in counts.iter_mut().enumerate() {
            let x = f64::from(offset[axis]);
            assert!(x.abs() <= r, "{x} beyond {r}");
            counts[(((x / r + 1.0) * 0.5 * BINS as f64) as usize).min(BINS - 1)] += 1;
        }
    }
    counts.iter().map(|c| chi2_test(c, &expected).p).fold(1.0, f64::min)
}

/// Offsets have the density of the filter's magnitude, on both axes.
#[test]
fn offsets_have_the_filters_density() {
    for (name, filter) in FILTERS {
        assert!(histogram_p(&filter, &filter) > 1e-6, "{name}");
    }
    // A width wrong by 2 % or another shape does not pass.
    let gaussian = Filter::Gaussian { radius: 1.5, sigma: 0.5 };
    assert!(histogram_p(&Filter::Gaussian { radius: 1.5, sigma: 0.51 }, &gaussian) < 1e-6);
    let mitchell = Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 };
    assert!(histogram_p(&Filter::Mitchell { radius: 2.0, b: 0.35, c: 0.325 }, &mitchell) < 1e-6);
}

/// The weight's sign is the filter's, its magnitude one constant.
#[test]
fn negative_lobes_have_negative_weights() {
    for (name, filter) in FILTERS {
        let constant = (integral(&filter, |_, f| f.abs()) / integral(&filter, |_, f| f)).powi(2);
        let (mut negative, mut unclear) = (0u64, 0u64);
        for (offset, weight) in draws(&filter.sampler(), 3) {
            assert!((weight.abs() / constant - 1.0).abs() < 1e-3, "{name}: {weight} for {constant}");
            negative += u64::from(weight < 0.0);
            // Within a cell of the table around a zero the sign may be the neighbour's.
            let near_zero = |x: f32| {
                let cell = 2.0 * filter.radius() / 1024.0;
                filter.value(x - cell) * filter.value(x + cell) <= 0.0
            };
            if near_zero(offset.x) || near_zero(offset.y) {
                unclear += 1;
            } else {
                let sign = f64::from(filter.value(offset.x) * filter.value(offset.y));
                assert!(sign * weight > 0.0, "{name}: weight {weight} at {offset}");
            }
        }
        assert!(unclear < N / 50, "{name}: {unclear}");
        // Of positive and negative draws: P(−) = (1 − 1/constant) / 2.
        let expected = 0.5 * (1.0 - 1.0 / constant) * N as f64;
        assert!(
            (negative as f64 - expected).abs() < 6.0 * expected.sqrt() + 1.0,
            "{name}: {negative} for {expected}"
        );
        assert_eq!(negative > 0, matches!(name, "mitchell" | "catmull-rom"), "{name}");
    }
}

/// ∫ x² f / ∫ f along one axis in closed form.
fn second_moment(filter: &Filter) -> f64 {
    match *filter {
        Filter::Box { radius } => f64::from(radius).powi(2) / 3.0,
        Filter::Tent { radius } => f64::from(radius).powi(2) / 6.0,
        Filter::Gaussian { .. } => integral(filter, |x, f| x * x * f) / integral(filter, |_, f| f),
        Filter::Mitchell { radius, b, c } => {
            let (b, c) = (f64::from(b), f64::from(c));
            let inner =
                (12.0 - 9.0 * b - 6.0 * c) / 6.0 + (-18.0 + 12.0 * b + 6.0 * c) / 5.0 + (6.0 - 2.0 * b) / 3.0;
            let outer = (-b - 6.0 * c) * 63.0 / 6.0
                + (6.0 * b + 30.0 * c) * 31.0 / 5.0
                + (-12.0 * b - 48.0 * c) * 15.0 / 4.0
                + (8.0 * b + 24.0 * c) * 7.0 / 3.0;
            // Both halves, and the family's own unit is half the radius.
            (inner + outer) / 3.0 * (0.5 * f64::from(radius)).powi(2)
        }
    }
}

/// How much a filter blurs: E[weight x²] on either axis. A width wrong by 1 % (2 % of the moment) is five standard
/// errors for the filters that are positive.
#[test]
fn second_moments_are_the_filters() {
    let spline = second_moment(&Filter::Mitchell { radius: 2.0, b: 1.0, c: 0.0 });
    assert!((spline - 1.0 / 3.0).abs() < 1e-12, "the cubic B-spline's is 1/3: {spline}");
    for (name, filter) in FILTERS {
        for axis in 0..2 {
            let xs: Vec<f64> =
                draws(&filter.sampler(), 4).map(|(o, w)| w * f64::from(o[axis]).powi(2)).collect();
            let truth = second_moment(&filter);
            let test = mean_test(&xs, truth);
            assert!(!test.rejects(1e-6), "{name}, axis {axis}: {test:?}");
            let scale = f64::from(filter.radius()).powi(2);
            assert!(
                5.0 * test.standard_error < 0.02 * truth.max(0.25 * scale),
                "{name}, axis {axis}: {test:?}"
            );
            let odd: Vec<f64> = draws(&filter.sampler(), 5).map(|(o, w)| w * f64::from(o[axis])).collect();
            assert!(!mean_test(&odd, 0.0).rejects(1e-6), "{name}, axis {axis}: shifted");
        }
    }
}

#[test]
fn extreme_numbers_stay_inside() {
    let last = 1.0 - f32::EPSILON / 2.0;
    for (name, filter) in FILTERS {
        for u in [Vec2::ZERO, Vec2::splat(last), Vec2::new(0.0, last), Vec2::splat(1.0)] {
            let s = filter.sampler().sample(u);
            assert!(s.offset.abs().max_element() <= filter.radius(), "{name}: {s:?}");
            assert!(s.weight.is_finite(), "{name}: {s:?}");
        }
    }
}

#[test]
fn filters_that_are_none_act_as_the_box() {
    let bad = [0.0, -1.0, f32::NAN, f32::INFINITY];
    let mut filters: Vec<Filter> = Vec::new();
    for b in bad {
        filters.push(Filter::Box { radius: b });
        filters.push(Filter::Tent { radius: b });
        filters.push(Filter::Gaussian { radius: b, sigma: 0.5 });
        filters.push(Filter::Gaussian { radius: 1.0, sigma: b });
        filters.push(Filter::Mitchell { radius: b, b: 0.3, c: 0.3 });
    }
    filters.push(Filter::Mitchell { radius: 2.0, b: f32::NAN, c: 0.3 });
    filters.push(Filter::Mitchell { radius: 2.0, b: 0.3, c: f32::INFINITY });
    // Negative all in all: it has no density.
    filters.push(Filter::Mitchell { radius: 2.0, b: 30.0, c: 0.0 });
    for filter in filters {
        let sampler = filter.sampler();
        if matches!(filter, Filter::Mitchell { b: 30.0, .. }) {
            let s = sampler.sample(Vec2::splat(0.3));
            assert!(s.weight.is_finite() && s.offset.is_finite(), "{s:?}");
            continue;
        }
        assert_eq!(sampler.filter(), Filter::BOX, "{filter:?}");
    }
}

#[test]
fn digests_tell_filters_apart() {
    let mut seen: Vec<u128> = FILTERS
        .iter()
        .map(|(_, filter)| {
            let mut f = Fingerprint::default();
            filter.fingerprint(&mut f);
            assert!(!f.is_opaque());
            f.value()
        })
        .collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), FILTERS.len());
}
