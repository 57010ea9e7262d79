//! Bounds of the star discrepancy, against the exact one and against their definition.

use etendue_sampling::quality::{self, QualityError, StarBounds};
use proptest::prelude::*;

use crate::reference::{REFERENCE, TOLERANCE};
use crate::{config, point_sets};

/// Whether bounds hold the exact value and are as close as a grid of that many cells has them.
fn are_bounds<const D: usize>(bounds: StarBounds, exact: f64, cells: usize) -> bool {
    let most = 1.0 - (1.0 - 1.0 / cells as f64).powi(D as i32);
    let StarBounds { lower, upper } = bounds;
    lower <= exact + TOLERANCE && exact <= upper + TOLERANCE && upper - lower <= most + TOLERANCE
}

/// Bounds by the definition: every corner by itself, all points each.
fn plain_bounds<const D: usize>(points: &[[f64; D]], cells: usize) -> StarBounds {
    let n = points.len() as f64;
    let corner = |at: [usize; D]| at.map(|j| j as f64 / cells as f64);
    let share =
        |q: [f64; D]| points.iter().filter(|p| p.iter().zip(&q).all(|(x, q)| x < q)).count() as f64 / n;
    let volume = |q: [f64; D]| q.iter().product::<f64>();
    let mut bounds = StarBounds { lower: 0.0, upper: 0.0 };
    for index in 0..cells.pow(D as u32) {
        let near: [usize; D] = std::array::from_fn(|d| index / cells.pow(d as u32) % cells);
        let (far, near) = (corner(near.map(|j| j + 1)), corner(near));
        bounds.lower = bounds.lower.max((share(far) - volume(far)).abs());
        bounds.upper = bounds.upper.max(share(far) - volume(near)).max(volume(far) - share(near));
    }
    bounds
}

proptest! {
    #![proptest_config(config(300, 4))]

    #[test]
    fn bounds_are_bounds(points in point_sets::<3>(12), cells in 1..=12usize) {
        let bounds = quality::star_discrepancy_bounds(&points, cells).unwrap();
        prop_assert!(are_bounds::<3>(bounds, quality::star_discrepancy(&points).unwrap(), cells));
        let plain = plain_bounds(&points, cells);
        prop_assert!((bounds.lower - plain.lower).abs() <= TOLERANCE);
        prop_assert!((bounds.upper - plain.upper).abs() <= TOLERANCE);
    }
}

#[test]
fn bounds_hold_the_reference() {
    for row in REFERENCE.iter().filter(|row| row.dims == 4) {
        let Some(exact) = row.star else { continue };
        for cells in [1, 7, 16, 24] {
            let bounds = quality::star_discrepancy_bounds(&row.set.points::<4>(row.n), cells).unwrap();
            assert!(are_bounds::<4>(bounds, exact, cells), "{row:?}: {bounds:?}");
            // Bounds that change places do not.
            let swapped = StarBounds { lower: bounds.upper, upper: bounds.lower };
            assert!(!are_bounds::<4>(swapped, exact, cells));
        }
    }
}

#[test]
fn grids_that_cannot_be_are_refused() {
    let points = [[0.5; 3]];
    for cells in [0, 256, usize::MAX - 1, usize::MAX] {
        let refused = Err(QualityError::Grid { cells, dimensions: 3 });
        assert_eq!(quality::star_discrepancy_bounds(&points, cells), refused);
    }
    let exact = StarBounds { lower: 0.0, upper: 0.0 };
    assert_eq!(quality::star_discrepancy_bounds::<0>(&[[]], 3), Ok(exact));
    assert_eq!(quality::star_discrepancy_bounds::<1>(&[], 3), Err(QualityError::Empty));
}
