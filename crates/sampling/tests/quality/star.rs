//! Exact star discrepancies, against references, closed forms and all boxes.

use etendue_sampling::quality;
use proptest::prelude::*;

use crate::reference::{Grid, Halton, Hammersley, Row, TOLERANCE, missed};
use crate::{config, point_sets};

/// Largest excess (closed boxes) and deficit (open boxes) of points at every corner of the grid of their coordinates.
/// O(N^(D + 1)).
fn enumerated<const D: usize>(points: &[[f64; D]]) -> [f64; 2] {
    let n = points.len();
    let corner = |d: usize, i: usize| points.get(i).map_or(1.0, |p| p[d]);
    let mut worst = [0.0f64; 2];
    for index in 0..(n + 1).pow(D as u32) {
        let q: [f64; D] = std::array::from_fn(|d| corner(d, index / (n + 1).pow(d as u32) % (n + 1)));
        let volume: f64 = q.iter().product();
        let closed = points.iter().filter(|p| p.iter().zip(&q).all(|(x, q)| x <= q)).count();
        let open = points.iter().filter(|p| p.iter().zip(&q).all(|(x, q)| x < q)).count();
        worst[0] = worst[0].max(closed as f64 / n as f64 - volume);
        worst[1] = worst[1].max(volume - open as f64 / n as f64);
    }
    worst
}

#[test]
fn star_discrepancy_matches_the_reference() {
    let star = |row: &Row| row.star;
    assert_eq!(missed::<1>(|p| quality::star_discrepancy_1d(p).unwrap(), star), None);
    assert_eq!(missed::<1>(|p| quality::star_discrepancy(p).unwrap(), star), None);
    assert_eq!(missed::<2>(|p| quality::star_discrepancy_2d(p).unwrap(), star), None);
    assert_eq!(missed::<4>(|p| quality::star_discrepancy(p).unwrap(), star), None);
}

/// Whether a measure misses the reference values, or the star discrepancy max(1 - xy, x, y) of a single point.
fn is_wrong_star(measure: impl Fn(&[[f64; 2]]) -> f64) -> bool {
    let single = [[0.25, 0.5], [0.75, 0.75], [0.875, 0.125], [0.5, 0.9375]];
    let misses = |[x, y]: [f64; 2]| measure(&[[x, y]]) != (1.0 - x * y).max(x).max(y);
    single.into_iter().any(misses) || missed::<2>(measure, |row| row.star.filter(|_| row.n <= 64)).is_some()
}

#[test]
fn star_discrepancy_of_wrong_boxes_is_rejected() {
    assert!(!is_wrong_star(|p| quality::star_discrepancy_2d(p).unwrap()));
    assert!(!is_wrong_star(|p| enumerated(p).into_iter().fold(0.0, f64::max)));
    // Only boxes with too many points, only boxes with too few.
    assert!(is_wrong_star(|p| enumerated(p)[0]));
    assert!(is_wrong_star(|p| enumerated(p)[1]));
    // Closed boxes for both: points on the far faces of a box fill what should be empty. And open ones for both.
    let both = |points: &[[f64; 2]], is_inside: fn(&f64, &f64) -> bool| {
        let mut worst = 0.0f64;
        let coordinates = |d: usize| points.iter().map(move |p| p[d]).chain([1.0]);
        for (x, y) in coordinates(0).flat_map(|x| coordinates(1).map(move |y| (x, y))) {
            let inside = points.iter().filter(|p| is_inside(&p[0], &x) && is_inside(&p[1], &y)).count();
            worst = worst.max((inside as f64 / points.len() as f64 - x * y).abs());
        }
        worst
    };
    assert!(is_wrong_star(|p| both(p, f64::le)));
    assert!(is_wrong_star(|p| both(p, f64::lt)));
}

#[test]
fn star_discrepancy_matches_the_closed_forms() {
    for m in 0..=12 {
        let n = 1 << m;
        let len = n as f64;
        let near = |got: f64, want: f64| assert!((got - want).abs() <= TOLERANCE, "2^{m}: {got}, not {want}");
        near(quality::star_discrepancy_1d(&Halton.points(n)).unwrap(), 1.0 / len);
        near(quality::star_discrepancy_1d(&Grid.points(n)).unwrap(), 0.5 / len);
        // Hammersley in base 2 (Halton & Zaremba 1969), from four points on: two have 3/4.
        if m > 1 {
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            let want = (f64::from(m) / 3.0 + 13.0 / 9.0 - sign * 4.0 / (9.0 * len)) / len;
            near(quality::star_discrepancy_2d(&Hammersley.points(n)).unwrap(), want);
        }
    }
}

proptest! {
    #![proptest_config(config(300, 1))]

    #[test]
    fn star_discrepancy_is_that_of_all_boxes_in_1d(points in point_sets::<1>(40)) {
        let want = enumerated(&points).into_iter().fold(0.0, f64::max);
        prop_assert!((quality::star_discrepancy_1d(&points).unwrap() - want).abs() <= TOLERANCE);
        prop_assert!((quality::star_discrepancy(&points).unwrap() - want).abs() <= TOLERANCE);
    }

    #[test]
    fn star_discrepancy_is_that_of_all_boxes_in_2d(points in point_sets::<2>(24)) {
        let want = enumerated(&points).into_iter().fold(0.0, f64::max);
        prop_assert!((quality::star_discrepancy_2d(&points).unwrap() - want).abs() <= TOLERANCE);
    }

    #[test]
    fn star_discrepancy_is_that_of_all_boxes_in_3d(points in point_sets::<3>(10)) {
        let want = enumerated(&points).into_iter().fold(0.0, f64::max);
        prop_assert!((quality::star_discrepancy(&points).unwrap() - want).abs() <= TOLERANCE);
    }
}
