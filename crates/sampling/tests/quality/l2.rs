//! Discrepancies in L2, against references, closed forms and their invariances.

use etendue_sampling::quality;
use proptest::prelude::*;

use crate::config;
use crate::reference::{Grid, Halton, Hammersley, Row, TOLERANCE, missed};

/// The four discrepancies in L2 by their index in a row, squared.
fn l2_square<const D: usize>(which: usize, points: &[[f64; D]]) -> f64 {
    let root = match which {
        0 => quality::l2_star(points),
        1 => quality::centred_l2(points),
        2 => quality::wrap_around_l2(points),
        _ => quality::mixture(points),
    };
    root.unwrap().powi(2)
}

fn l2_square_reference(which: usize, row: &Row) -> f64 {
    if which == 0 { row.l2_star * row.l2_star } else { row.squares[which - 1] }
}

fn l2_missed<const D: usize>() {
    assert_eq!(missed::<D>(|p| quality::l2_star(p).unwrap(), |row| Some(row.l2_star)), None);
    for which in 0..4 {
        let value = |row: &Row| Some(l2_square_reference(which, row));
        assert_eq!(missed::<D>(|p| l2_square(which, p), value), None);
        // Without the root or the square, or by another's name, nothing agrees (but on a line, where the centred
        // one is the star's).
        assert!(missed::<D>(|p| l2_square(which, p).sqrt(), value).is_some());
        assert!(missed::<D>(|p| l2_square(which, p).powi(2), value).is_some());
        for other in (0..4).filter(|&other| other != which && D > 1) {
            assert!(missed::<D>(|p| l2_square(other, p), value).is_some(), "{other} passes for {which}");
        }
    }
}

#[test]
fn l2_discrepancies_match_the_reference() {
    l2_missed::<1>();
    l2_missed::<2>();
    l2_missed::<4>();
}

#[test]
fn l2_star_matches_the_closed_forms() {
    for m in 0..=12 {
        let n = 1 << m;
        let (len, log) = (n as f64, f64::from(m));
        let near = |got: f64, want: f64| assert!((got - want).abs() <= TOLERANCE, "2^{m}: {got}, not {want}");
        near(quality::l2_star(&Halton.points::<1>(n)).unwrap(), 1.0 / (3f64.sqrt() * len));
        near(quality::l2_star(&Grid.points::<1>(n)).unwrap(), 1.0 / (12f64.sqrt() * len));
        // Hammersley in base 2 (Halton & Zaremba 1969; Vilenkin 1967).
        let scaled = log * log / 64.0 + 29.0 * log / 192.0 + 0.375 - log / (16.0 * len) + 0.25 / len
            - 1.0 / (72.0 * len * len);
        near(quality::l2_star(&Hammersley.points::<2>(n)).unwrap(), scaled.sqrt() / len);
    }
}

/// Whether a discrepancy stays as it is when points are mirrored in an axis, and when they are shifted on the torus.
fn invariances(which: usize, points: &[[f64; 3]]) -> [bool; 2] {
    let want = l2_square(which, points);
    let moved =
        |f: fn(f64) -> f64| -> Vec<[f64; 3]> { points.iter().map(|&[x, y, z]| [x, f(y), z]).collect() };
    [moved(|y| (1.0 - y).min(1f64.next_down())), moved(|y| (y + 0.3) % 1.0)]
        .map(|moved| (l2_square(which, &moved) - want).abs() <= 1e-12)
}

proptest! {
    #![proptest_config(config(100, 2))]

    #[test]
    fn l2_discrepancies_keep_their_invariances(
        points in prop::collection::vec(prop::array::uniform3(0.0..1.0f64), 2..=30),
    ) {
        prop_assert_eq!(invariances(0, &points), [false, false]);
        prop_assert_eq!(invariances(1, &points), [true, false]);
        prop_assert_eq!(invariances(2, &points), [true, true]);
        prop_assert_eq!(invariances(3, &points), [true, false]);
    }
}
