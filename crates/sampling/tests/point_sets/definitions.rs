//! Points as defined, and discrepancies known in closed form or from elsewhere.

use etendue_core::Vec2;
use etendue_sampling::{Dim, Halton, Hammersley, Sampler, Scrambling, Slot, radical_inverse, unit_f32};

use crate::{BSDF, LIGHT};

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
