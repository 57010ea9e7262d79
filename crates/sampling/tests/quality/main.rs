//! Measures of point sets against independent values, closed forms, brute force, and their own invariances.

mod bounds;
mod l2;
mod nets;
mod reference;
mod star;

use etendue_sampling::quality::{self, QualityError};
use proptest::prelude::*;

/// Random points; every other set on a coarse lattice, where coordinates tie.
pub(crate) fn point_sets<const D: usize>(most: usize) -> impl Strategy<Value = Vec<[f64; D]>> {
    (prop::collection::vec(prop::array::uniform(0.0..1.0f64), 1..=most), any::<bool>()).prop_map(
        |(mut points, lattice)| {
            if lattice {
                points.iter_mut().flatten().for_each(|x| *x = (*x * 8.0).floor() / 8.0);
            }
            points
        },
    )
}

pub(crate) fn config(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: prop::test_runner::RngSeed::Fixed(seed),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

#[test]
fn bad_points_are_refused() {
    assert_eq!(quality::star_discrepancy_1d(&[]), Err(QualityError::Empty));
    for value in [1.0, -0.1, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let points = [[0.5, 0.5, 0.5], [0.25, 0.75, value]];
        for got in [
            quality::star_discrepancy(&points),
            quality::l2_star(&points),
            quality::centred_l2(&points),
            quality::wrap_around_l2(&points),
            quality::mixture(&points),
            quality::star_discrepancy_bounds(&points, 4).map(|bounds| bounds.upper),
        ] {
            match got {
                Err(QualityError::OutsideUnitCube { point: 1, axis: 2, value: v }) => {
                    assert_eq!(v.to_bits(), value.to_bits());
                }
                other => panic!("{value}: {other:?}"),
            }
        }
    }
    // Points without coordinates are all in the one box.
    assert_eq!(quality::star_discrepancy::<0>(&[[]]), Ok(0.0));
    assert_eq!(quality::l2_star::<0>(&[[], []]), Ok(0.0));
    assert_eq!(quality::star_discrepancy_2d(&[[-0.0, 0.0]]), Ok(1.0));
}
