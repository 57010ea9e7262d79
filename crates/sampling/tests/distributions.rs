//! Tabulated distributions, the alias table, remapped choices, MIS weights and running moments.

use etendue_core::Vec2;
use etendue_sampling::stats::Moments;
use etendue_sampling::{AliasTable, Distribution1d, Distribution2d, DistributionError, mis, mix, remap};

/// Numbers just around every knot of the distribution function, and the ends.
fn around_knots(weights: &[f32]) -> Vec<f32> {
    let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
    let mut sum = 0.0;
    let mut out = vec![0.0, 1.0 - f32::EPSILON / 2.0];
    for w in weights {
        sum += f64::from(*w) / total;
        let u = sum as f32;
        out.extend([u.next_down(), u, u.next_up()].into_iter().filter(|u| (0.0..1.0).contains(u)));
    }
    out
}

fn unit(i: u64) -> f32 {
    (mix(i) >> 40) as f32 / 16_777_216.0
}

#[test]
fn one_dimension_draws_its_density() {
    let weights = [0.0f32, 3.0, 0.0, 1.0, 1e-6, 0.0, 4.0, 0.0, 0.0];
    let d = Distribution1d::new(weights).unwrap();
    assert_eq!(d.len(), 9);
    let n = 1_000_000;
    let mut counts = [0u32; 9];
    for u in (0..n).map(|i| i as f32 / n as f32).chain(around_knots(&weights)) {
        let s = d.sample(u);
        assert!(weights[s.index] > 0.0, "zero weight drawn at {u}");
        assert!(s.pdf > 0.0 && (0.0..1.0).contains(&s.u) && (0.0..1.0).contains(&s.x));
        assert_eq!((s.x * 9.0) as usize, s.index, "the position lies in its interval");
        assert_eq!(s.pdf, d.pdf(s.x));
        assert_eq!(s.pmf, d.pmf(s.index));
        counts[s.index] += 1;
    }
    for (i, &c) in counts.iter().enumerate() {
        assert!((f64::from(c) / n as f64 - f64::from(d.pmf(i))).abs() < 4e-5, "{i}");
    }
    let integral: f64 = (0..9).map(|i| f64::from(d.pdf((i as f32 + 0.5) / 9.0)) / 9.0).sum();
    assert!((integral - 1.0).abs() < 1e-6);
    // Inversion: position back to number.
    let s = d.sample(0.7f32);
    let below: f32 = (0..s.index).map(|i| d.pmf(i)).sum();
    assert!((below + s.u * s.pmf - 0.7).abs() < 1e-6);
    // Out of contract, but harmless.
    for u in [-1.0, 1.0, 2.0, f64::NAN] {
        let s = d.sample(u);
        assert!(s.index < 9 && s.x.is_finite() && s.u < 1.0, "{u}: {s:?}");
    }
    assert_eq!(d.pmf(9), 0.0);
    assert_eq!(d.pmf(usize::MAX), 0.0);
}

/// The guide must not change what a plain search over all sums finds.
#[test]
fn guided_search_equals_full_search() {
    for n in [1usize, 2, 3, 4, 5, 8, 31, 64, 1000] {
        let weights: Vec<f32> =
            (0..n as u64).map(|i| if i % 3 == 1 { 0.0 } else { unit(i + n as u64).powi(6) + 1e-6 }).collect();
        let d = Distribution1d::new(weights.iter().copied()).unwrap();
        let mut sums = vec![0.0];
        weights.iter().for_each(|&w| sums.push(sums[sums.len() - 1] + f64::from(w)));
        let borders = (0..1024).flat_map(|i| {
            let u = f64::from(i) / 1024.0;
            [u, u.next_up(), u.next_down().max(0.0)]
        });
        let knots = sums.iter().flat_map(|s| {
            let u = s / d.total();
            [u, u.next_up(), u.next_down()]
        });
        for u in borders.chain(knots).filter(|u| (0.0..1.0).contains(u)) {
            let full = sums.partition_point(|&s| s <= u * d.total()) - 1;
            if full < n {
                assert_eq!(d.sample(u).index, full, "{n} weights, u = {u}");
            }
        }
    }
}

#[test]
fn one_dimension_keeps_small_bins_among_many() {
    // Ten million equal bins: single-precision sums would stall.
    let n = 10_000_000;
    let d = Distribution1d::new((0..n).map(|_| 0.1f32)).unwrap();
    for u in [0.1f64, 0.5, 0.999_999_9] {
        assert_eq!(d.sample(u).index, (u * n as f64) as usize);
    }
    assert!((f64::from(d.pdf(0.9)) - 1.0).abs() < 1e-6);
}

#[test]
fn unfit_weights_are_refused_with_their_place() {
    use DistributionError::{AllZero, Empty, Negative, NotFinite, Overflow, SizeMismatch};
    assert_eq!(Distribution1d::new([0.0f32; 0]), Err(Empty));
    assert_eq!(Distribution1d::new([0.0f32, 0.0]), Err(AllZero));
    assert_eq!(Distribution1d::new([1.0, -2.0]), Err(Negative { index: 1, value: -2.0 }));
    assert!(matches!(Distribution1d::new([1.0, f64::NAN]), Err(NotFinite { index: 1, .. })));
    assert_eq!(Distribution1d::new([f64::MAX, f64::MAX]), Err(Overflow));
    assert_eq!(AliasTable::new([0.0f32; 0]), Err(Empty));
    assert_eq!(AliasTable::new([0.0f32]), Err(AllZero));
    assert_eq!(AliasTable::new([f64::MAX, f64::MAX]), Err(Overflow));
    assert!(matches!(AliasTable::new([f32::INFINITY]), Err(NotFinite { index: 0, .. })));
    assert_eq!(Distribution2d::new(&[1.0f32; 5], 2, 3), Err(SizeMismatch { width: 2, height: 3, got: 5 }));
    assert_eq!(Distribution2d::new(&[0.0f32; 6], 2, 3), Err(AllZero));
    assert!(matches!(Distribution2d::new(&[1.0, 1.0, 1.0, f32::NAN], 2, 2), Err(NotFinite { index: 3, .. })));
    assert!(DistributionError::AllZero.to_string().contains("uniform"), "the message says the cure");
}

#[test]
fn two_dimensions_draw_their_density() {
    let (w, h) = (13, 7);
    let weights: Vec<f32> =
        (0..w * h).map(|i| if i % 5 == 0 || i / w == 3 { 0.0 } else { (i % 11) as f32 }).collect();
    let d = Distribution2d::new(&weights, w, h).unwrap();
    let total: f64 = weights.iter().map(|&x| f64::from(x)).sum();
    let n = 400_000u64;
    let mut counts = vec![0u32; w * h];
    let ends = [0.0, f32::EPSILON / 2.0, 0.5, 1.0 - f32::EPSILON / 2.0];
    let corners = ends.iter().flat_map(|&x| ends.map(|y| Vec2::new(x, y)));
    for u in (0..n).map(|i| Vec2::new(unit(2 * i), unit(2 * i + 1))).chain(corners) {
        let s = d.sample(u).unwrap();
        let at = s.cell.y as usize * w + s.cell.x as usize;
        assert!(weights[at] > 0.0);
        assert_eq!(((s.p.x * w as f32) as usize, (s.p.y * h as f32) as usize), (at % w, at / w));
        assert_eq!(s.pdf, d.pdf(s.p));
        let want = f64::from(weights[at]) / total * (w * h) as f64;
        assert!((f64::from(s.pdf) / want - 1.0).abs() < 1e-6);
        assert!(s.u.min_element() >= 0.0 && s.u.max_element() < 1.0);
        counts[at] += 1;
    }
    let chi2: f64 = counts
        .iter()
        .zip(&weights)
        .filter(|(_, w)| **w > 0.0)
        .map(|(&c, &w)| {
            let e = f64::from(w) / total * n as f64;
            (f64::from(c) - e).powi(2) / e
        })
        .sum();
    let dof = weights.iter().filter(|w| **w > 0.0).count() as f64 - 1.0;
    // 4.5 standard deviations; counting a neighbour's weight instead (mutant) is far outside.
    assert!(((chi2 - dof) / (2.0 * dof).sqrt()).abs() < 4.5, "{chi2} for {dof}");
    let shifted: f64 = (1..w * h)
        .filter(|&i| weights[i] > 0.0 && weights[i - 1] > 0.0)
        .map(|i| {
            let e = f64::from(weights[i - 1]) / total * n as f64;
            (f64::from(counts[i]) - e).powi(2) / e
        })
        .sum();
    assert!(shifted > 100.0 * dof);
    assert!(d.sample(Vec2::splat(f32::NAN)).is_none());
    assert!(d.pdf(Vec2::splat(7.0)).is_finite() && d.pdf(Vec2::splat(-7.0)).is_finite());
}

#[test]
fn alias_table_is_exact_in_total_and_in_every_part() {
    let tables: [Vec<f32>; 5] = [
        vec![1.0],
        vec![0.0, 0.0, 1.0, 0.0],
        vec![1e-30, 1e30, 1.0],
        (0..1000).map(|i| if i % 3 == 0 { 0.0 } else { (i as f32).sqrt() }).collect(),
        (0..97).map(|i| 0.1 + (i % 7) as f32 * 0.1).collect(),
    ];
    for weights in tables {
        let t = AliasTable::new(weights.iter().copied()).unwrap();
        let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
        let mass: f64 = (0..t.len()).map(|i| f64::from(t.pmf(i))).sum();
        assert!((mass - 1.0).abs() < 1e-6);
        // A fine regular grid measures each index's share of [0, 1).
        let n = 2_000_000;
        let mut counts = vec![0u32; weights.len()];
        for i in 0..n {
            let s = t.sample((f64::from(i) + 0.5) / f64::from(n));
            assert!(weights[s.index] > 0.0 && (0.0..1.0).contains(&s.u));
            counts[s.index] += 1;
        }
        for (c, w) in counts.iter().zip(&weights) {
            let (got, want) = (f64::from(*c) / f64::from(n), f64::from(*w) / total);
            assert!((got - want).abs() < 2e-6 * weights.len() as f64, "{got} {want}");
        }
        for u in [0.0, 1.0 - f64::EPSILON / 2.0, 1.0, -1.0, f64::NAN] {
            assert!(weights[t.sample(u).index] > 0.0, "{u}");
        }
    }
}

#[test]
fn whatever_is_drawn_has_a_usable_probability() {
    let weights = [1e-30f32, 1e30, 0.0, 1e-20];
    let one = Distribution1d::new(weights).unwrap();
    let alias = AliasTable::new(weights).unwrap();
    let two = Distribution2d::new(&weights, 2, 2).unwrap();
    for u in around_knots(&weights) {
        let (a, b, c) = (one.sample(u), alias.sample(u), two.sample(Vec2::splat(u)).unwrap());
        assert!((1.0 / a.pdf).is_finite() && (1.0 / a.pmf).is_finite(), "{a:?}");
        assert!((1.0 / b.pmf).is_finite(), "{b:?}");
        assert!((1.0 / c.pdf).is_finite(), "{c:?}");
    }
}

#[test]
fn remapped_numbers_are_uniform_again() {
    // A regular grid of numbers stays regular within each outcome.
    for p in [0.0, 1e-7, 0.25, 0.5, 0.999, 1.0, -1.0, 2.0, f32::NAN] {
        let n = 100_000;
        let (mut heads, mut sums) = (0u32, [0.0f64; 2]);
        for i in 0..n {
            let c = remap::coin((i as f32 + 0.5) / n as f32, p);
            assert!((0.0..1.0).contains(&c.u), "{p}: {c:?}");
            heads += u32::from(c.heads);
            sums[usize::from(c.heads)] += f64::from(c.u);
        }
        let want = if p.is_nan() { 0.0 } else { f64::from(p.clamp(0.0, 1.0)) };
        assert!((f64::from(heads) / f64::from(n) - want).abs() < 2e-5, "{p}");
        if heads > 1000 {
            assert!((sums[1] / f64::from(heads) - 0.5).abs() < 1e-3);
        }
        if n - heads > 1000 && !p.is_nan() {
            assert!((sums[0] / f64::from(n - heads) - 0.5).abs() < 6e-3);
        }
    }
    let weights = [0.0, 2.0, 0.0, 1.0, 5.0, f32::NAN, -3.0, 0.0];
    let mut counts = [0u32; 8];
    for u in (0..80_000).map(|i| i as f32 / 80_000.0).chain(around_knots(&[0.0, 2.0, 0.0, 1.0, 5.0, 0.0])) {
        let c = remap::choose(u, &weights).unwrap();
        assert!((0.0..1.0).contains(&c.u));
        assert_eq!(c.pmf, weights[c.index] / 8.0);
        counts[c.index] += 1;
    }
    assert!(
        [1, 3, 4].iter().all(|&i| (counts[i] as f32 / 80_000.0 - weights[i] / 8.0).abs() < 3e-4),
        "{counts:?}"
    );
    assert_eq!(counts.iter().sum::<u32>(), counts[1] + counts[3] + counts[4]);
    for none in [&[][..], &[0.0, 0.0], &[f32::NAN], &[-1.0], &[f32::INFINITY, 1.0]] {
        assert!(remap::choose(0.5, none).is_none(), "{none:?}");
    }
}

#[test]
fn mis_weights_share_one_at_every_extreme() {
    let values = [0.0f32, 1e-45, 1e-38, 0.5, 1.0, 3.0, 1e19, 1e38, f32::MAX, f32::INFINITY, f32::NAN, -1.0];
    for pa in values {
        for pb in values {
            for (name, wa, wb) in [
                ("balance", mis::balance(pa, pb), mis::balance(pb, pa)),
                ("power", mis::power(pa, pb), mis::power(pb, pa)),
                ("balance_n", mis::balance_n(3, pa, 5, pb), mis::balance_n(5, pb, 3, pa)),
                ("power_n", mis::power_n(3, pa, 5, pb), mis::power_n(5, pb, 3, pa)),
            ] {
                let what = format!("{name}({pa:e}, {pb:e}) = {wa}, {wb}");
                assert!((0.0..=1.0).contains(&wa) && (0.0..=1.0).contains(&wb), "{what}");
                let unusable = |p: f32| p.is_nan() || p <= 0.0;
                if unusable(pa) && unusable(pb) {
                    assert_eq!((wa, wb), (0.0, 0.0), "{what}");
                } else {
                    assert!((wa + wb - 1.0).abs() <= 2.0 * f32::EPSILON, "{what}");
                }
            }
        }
    }
    assert_eq!(mis::balance(1.0, 3.0), 0.25);
    assert_eq!(mis::power(1.0, 3.0), 0.1);
    assert_eq!(mis::balance_n(2, 1.0, 1, 6.0), 0.25);
    assert_eq!(mis::power_n(3, 1.0, 1, 1.0), 0.9);
    assert_eq!(mis::balance(f32::INFINITY, 5.0), 1.0);
    assert_eq!(mis::balance_n(0, f32::INFINITY, 1, 1.0), 0.0);
    assert_eq!(mis::balance_n(u32::MAX, f32::MAX, u32::MAX, f32::MAX), 0.5);
}

#[test]
fn moments_merge_and_survive_spikes() {
    let values: Vec<f64> =
        (0..100_000).map(|i| if i % 1000 == 17 { 1e6 } else { 1e-3 * f64::from(unit(i)) }).collect();
    let whole: Moments = values.iter().copied().collect();
    let parts = values.chunks(777).map(|c| c.iter().copied().collect::<Moments>());
    let merged = parts.fold(Moments::default(), Moments::merged);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let var = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (values.len() - 1) as f64;
    for m in [whole, merged, merged.merged(Moments::default()), Moments::default().merged(merged)] {
        assert_eq!(m.count(), 100_000);
        assert!((m.mean() / mean - 1.0).abs() < 1e-12);
        assert!((m.variance() / var - 1.0).abs() < 1e-9);
    }
    assert_eq!(Moments::default().variance(), 0.0);
    assert_eq!([5.0].into_iter().collect::<Moments>().standard_error(), 0.0);
}

/// The textbook's four events of probability 0.2, 0.1, 0.2 and 0.5 (sec. 14.4), with events of zero mass
/// before, between and after them. Event i owns the half-open interval [Σ before i, Σ with i): its beginning is its
/// own, its end the next event's, and what has no width has no number.
#[test]
fn discrete_events_own_half_open_intervals() {
    let events = [0.0f64, 0.2, 0.1, 0.0, 0.2, 0.5, 0.0];
    let d = Distribution1d::new(events).unwrap();
    assert_eq!(d.total(), 1.0);
    let sums: Vec<f64> = (0..=events.len()).map(|i| events[..i].iter().sum()).collect();
    // The mutant of Eq. 14.19 as printed, with closed intervals: the first whose end is at or above the number.
    let closed = |u: f64| sums[1..].iter().position(|&s| u <= s).unwrap();
    assert_eq!(closed(0.0), 0, "closed intervals draw an event of zero mass");
    for (i, &p) in events.iter().enumerate() {
        let (begin, end) = (sums[i], sums[i + 1]);
        if p > 0.0 {
            assert_eq!(d.sample(begin).index, i, "its beginning");
            assert_eq!(d.sample(end.next_down()).index, i, "just below its end");
            assert!(end == 1.0 || d.sample(end).index > i, "its end is the next one's");
            assert!(end == 1.0 || closed(end) == i, "the mutant differs here");
        }
    }
    let n = 100_000u32;
    let mut counts = [0u32; 7];
    for i in 0..n {
        counts[d.sample((f64::from(i) + 0.5) / f64::from(n)).index] += 1;
    }
    assert_eq!(counts, [0, 20_000, 10_000, 0, 20_000, 50_000, 0]);
    let table = AliasTable::new(events).unwrap();
    assert!((0..n).all(|i| events[table.sample(f64::from(i) / f64::from(n)).index] > 0.0));
}
