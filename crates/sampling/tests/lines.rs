//! Piecewise linear densities: drawn masses against quadrature, and what must never be drawn.

use etendue_sampling::{Distribution1d, DistributionError, LinearDistribution1d, mix};

fn unit(i: u64) -> f32 {
    (mix(i) >> 40) as f32 / 16_777_216.0
}

/// ∫ of a linear density from 0 to `x` by the trapezium rule over the segments, which is exact for lines.
fn mass_below(d: &LinearDistribution1d, x: f64) -> f64 {
    let n = d.len() as f64;
    (0..d.len())
        .map(|i| (i as f64 / n, ((i + 1) as f64 / n).min(x)))
        .filter(|(a, b)| a < b)
        .map(|(a, b)| {
            // At two inner points: the ends belong to two segments.
            let h = b - a;
            0.5 * h * (d.pdf(a + 0.25 * h) + d.pdf(a + 0.75 * h))
        })
        .sum()
}

#[test]
fn lines_draw_their_density() {
    let rough: Vec<f64> =
        (0..1000u64).map(|i| if i % 7 < 3 { 0.0 } else { f64::from(unit(i)).powi(8) }).collect();
    let cases: [&[f64]; 10] = [
        &[1.0, 1.0],
        &[0.0, 1.0],
        &[1.0, 0.0],
        &[0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 2.0, 0.0, 0.0],
        &[3.0, 0.0, 0.0, 5.0, 1.0],
        &[1e-300, 1e-290, 2e-300],
        &[1e300, 5e299, 1e300],
        &[1.0, 1.0 + 1e-15, 1.0 - 1e-15],
        &[1e-12, 1.0, 1e-12],
        &rough,
    ];
    for values in cases {
        let d = LinearDistribution1d::new(values.iter().copied()).unwrap();
        let n = d.len();
        assert_eq!(n, values.len() - 1);
        assert!((mass_below(&d, 1.0) - 1.0).abs() < 1e-12, "{values:?}");
        let trapezia: f64 = values.windows(2).map(|v| 0.5 * v[0] + 0.5 * v[1]).sum::<f64>() / n as f64;
        assert!((d.total() / trapezia - 1.0).abs() < 1e-12);
        let knots = (0..n).scan(0.0, |sum, i| {
            *sum += d.pmf(i);
            Some(*sum)
        });
        let mut us: Vec<f64> = knots.flat_map(|u| [u.next_down(), u, u.next_up()]).collect();
        us.extend((0..5000).map(|i| f64::from(i) / 5000.0));
        us.extend([1e-300, 1e-20, 1e-9, 1.0 - 1e-9, 1.0f64.next_down()]);
        us.retain(|u| (0.0..1.0).contains(u));
        us.sort_by(f64::total_cmp);
        let mut last = 0.0;
        for u in us {
            let s = d.sample(u);
            assert!((0.0..1.0).contains(&s.x) && s.pdf > 0.0 && s.pdf == d.pdf(s.x), "{u}: {s:?}");
            assert!((1.0 / s.pdf).is_finite());
            assert_eq!((s.x * n as f64) as usize, s.index, "the position lies in its segment");
            assert!(values[s.index] + values[s.index + 1] > 0.0, "a segment of zero mass drawn at {u}");
            assert!(s.x >= last, "monotone");
            last = s.x;
            assert!((mass_below(&d, s.x) - u).abs() < 1e-12, "{u}: {s:?} of {values:?}");
        }
        for u in [-1.0, 1.0, 2.0, f64::NAN] {
            let s = d.sample(u);
            assert!((0.0..1.0).contains(&s.x) && s.pdf > 0.0, "{u}: {s:?}");
        }
        for x in [-0.1, 1.1, f64::NAN] {
            assert_eq!(d.pdf(x), 0.0);
        }
    }
}

/// The mutant inverts as if each segment were flat, which is right in the segments' masses: only within them is it
/// off, by up to an eighth of the mass of a triangle.
#[test]
fn flat_segments_are_not_lines() {
    let d = LinearDistribution1d::new([0.0, 1.0, 0.0]).unwrap();
    let steps = Distribution1d::new([0.5, 0.5]).unwrap();
    let worst = (0..1000)
        .map(|i| f64::from(i) / 1000.0)
        .map(|u| (mass_below(&d, f64::from(steps.sample(u).x)) - u).abs())
        .fold(0.0, f64::max);
    assert!((worst - 0.125).abs() < 1e-4, "{worst}");
}

#[test]
fn lines_in_many_segments_stay_in_place() {
    // Not a power of two, so that positions round; every other value zero, so that every border is one.
    let n = 2_000_003;
    let d = LinearDistribution1d::new((0..=n).map(|i| f64::from(i % 2))).unwrap();
    for i in (0..n).step_by(997) {
        for u in [
            f64::from(i) / f64::from(n),
            (f64::from(i) / f64::from(n)).next_up(),
            f64::from(i) / f64::from(n) + 1e-12,
        ] {
            let s = d.sample(u);
            assert!(s.pdf > 0.0 && (s.x * f64::from(n)) as usize == s.index, "{u}: {s:?}");
            assert!((s.x - u).abs() < 1.0 / f64::from(n), "{u}: {s:?}");
        }
    }
}

#[test]
fn unfit_lines_are_refused() {
    use DistributionError::{AllZero, Empty, Negative, NotFinite, OneValue};
    assert_eq!(LinearDistribution1d::new([0.0f32; 0]), Err(Empty));
    assert_eq!(LinearDistribution1d::new([2.0]), Err(OneValue));
    assert_eq!(LinearDistribution1d::new([0.0, 0.0]), Err(AllZero));
    assert_eq!(LinearDistribution1d::new([1.0, -2.0]), Err(Negative { index: 1, value: -2.0 }));
    assert!(matches!(LinearDistribution1d::new([1.0, 1.0, f64::NAN]), Err(NotFinite { index: 2, .. })));
    assert_eq!(LinearDistribution1d::new([f64::MAX, f64::MAX]), Err(DistributionError::Overflow));
    assert_eq!(LinearDistribution1d::new([0.0, f64::from_bits(1)]), Err(AllZero), "too small to halve");
}
