//! Strengths of nets: tabulated ones, by counting against by ranks, and closed forms.

use etendue_sampling::Sobol;
use etendue_sampling::quality::{QualityError, net_t_by_counting, net_t_by_rank};
use proptest::prelude::*;

use crate::config;

type Matrix = [u32; 32];

/// Exact t of the first 2^m points of Joe & Kuo's sequence in some of its dimensions, for m = 4, 6, 8, 10, 12.
const TABLE: [(&[u32], [u32; 5]); 11] = [
    (&[0, 1], [0, 0, 0, 0, 0]),
    (&[0, 2], [0, 1, 1, 1, 1]),
    (&[0, 3], [2, 1, 1, 2, 1]),
    (&[1, 2], [1, 1, 1, 1, 1]),
    (&[1, 3], [1, 0, 2, 1, 2]),
    (&[2, 3], [0, 1, 1, 1, 2]),
    (&[4, 5], [0, 1, 3, 1, 2]),
    (&[6, 7], [2, 1, 2, 1, 3]),
    (&[0, 1, 2], [1, 1, 1, 1, 1]),
    (&[1, 2, 3], [1, 1, 3, 2, 2]),
    (&[0, 1, 2, 3], [2, 2, 3, 2, 3]),
];

/// The first table entry that a strength misses.
fn missed(strength: impl Fn(&[Matrix], u32) -> u32) -> Option<String> {
    TABLE.iter().find_map(|(dims, want)| {
        let matrices: Vec<Matrix> = dims.iter().map(|&d| Sobol::direction_numbers(d).unwrap()).collect();
        want.iter().zip([4, 6, 8, 10, 12]).find_map(|(&want, m)| {
            let got = strength(&matrices, m);
            (got != want).then(|| format!("dimensions {dims:?}, m = {m}: {got}, not {want}"))
        })
    })
}

/// The first 2^m points of matrices.
fn points<const D: usize>(matrices: &[Matrix], m: u32) -> Vec<[u32; D]> {
    let digits = |i: u32, v: &Matrix| (0..32).filter(|k| i >> k & 1 == 1).fold(0, |x, k| x ^ v[k]);
    (0..1 << m).map(|i| std::array::from_fn(|d| digits(i, &matrices[d]))).collect()
}

fn by_counting(matrices: &[Matrix], m: u32) -> u32 {
    match matrices.len() {
        1 => net_t_by_counting::<1>(&points(matrices, m), m),
        2 => net_t_by_counting::<2>(&points(matrices, m), m),
        3 => net_t_by_counting::<3>(&points(matrices, m), m),
        _ => net_t_by_counting::<4>(&points(matrices, m), m),
    }
    .unwrap()
}

#[test]
fn strengths_of_joe_and_kuo_are_the_tabulated_ones() {
    assert_eq!(missed(by_counting), None);
    assert_eq!(missed(|matrices, m| net_t_by_rank(matrices, m).unwrap()), None);
}

#[test]
fn wrong_strengths_are_rejected() {
    // Digits from the last one on, and matrices on their sides.
    let reversed = |v: &Matrix| v.map(u32::reverse_bits);
    let transposed =
        |v: &Matrix| std::array::from_fn(|r| (0..32).fold(0, |c, k| c << 1 | v[k] >> (31 - r) & 1));
    for wrong in [reversed, transposed] {
        let by_rank = |matrices: &[Matrix], m| {
            net_t_by_rank(&matrices.iter().map(wrong).collect::<Vec<_>>(), m).unwrap()
        };
        assert!(missed(by_rank).is_some());
    }
    // One digit less.
    assert!(missed(|matrices, m| net_t_by_rank(matrices, m - 1).unwrap()).is_some());
    // A coordinate that is left out.
    assert!(missed(|matrices, m| net_t_by_rank(&matrices[1..], m).unwrap()).is_some());
    // A single point in another box.
    let moved = |matrices: &[Matrix], m| {
        let mut points = points::<2>(&matrices[..2], m);
        points[3][1] ^= 1 << 31;
        net_t_by_counting(&points, m).unwrap()
    };
    assert!(missed(moved).is_some());
}

#[test]
fn strengths_match_the_closed_forms() {
    let van_der_corput: Matrix = std::array::from_fn(|k| 1 << (31 - k));
    for m in 0..=10 {
        // One axis, or Hammersley's index beside it.
        let index: Matrix =
            std::array::from_fn(|k| if (k as u32) < m { 1 << (32 - m + k as u32) } else { 0 });
        for matrices in [&[van_der_corput][..], &[index, van_der_corput]] {
            assert_eq!(by_counting(matrices, m), 0);
            assert_eq!(net_t_by_rank(matrices, m), Ok(0));
        }
        // The diagonal: two halves of an axis already say the same twice.
        let diagonal = [van_der_corput; 2];
        assert_eq!(by_counting(&diagonal, m), m.saturating_sub(1));
        assert_eq!(net_t_by_rank(&diagonal, m), Ok(m.saturating_sub(1)));
        // All points in one place.
        let nothing = [[0; 32]; 3];
        assert_eq!(by_counting(&nothing, m), m);
        assert_eq!(net_t_by_rank(&nothing, m), Ok(m));
    }
    // Two dimensions of Sobol's are a (0, 2)-sequence to the last digit (Sobol 1967).
    let two = [0, 1].map(|d| Sobol::direction_numbers(d).unwrap());
    assert!((0..=32).all(|m| net_t_by_rank(&two, m) == Ok(0)));
}

#[test]
fn direction_numbers_are_those_of_the_table() {
    // In eighths, as the first points of scipy's sequence (which go in the order of Gray's code) imply them.
    let first = |d| Sobol::direction_numbers(d).map(|v| [v[0], v[1], v[2]].map(|x| x >> 29));
    assert_eq!(first(0), Some([4, 2, 1]));
    assert_eq!(first(1), Some([4, 6, 5]));
    assert_eq!(first(2), Some([4, 6, 3]));
    assert_eq!(first(3), Some([4, 6, 1]));
    assert!(first(9).is_some());
    assert_eq!(first(10), None);
    assert_eq!(first(u32::MAX), None);
}

/// Matrices of any rank, or (where bit `k` decides the `k`-th digit) with stratified coordinates each.
fn matrices() -> impl Strategy<Value = Vec<Matrix>> {
    (prop::collection::vec(prop::array::uniform32(any::<u32>()), 1..=4), any::<bool>()).prop_map(
        |(mut matrices, stratified)| {
            if stratified {
                for v in &mut matrices {
                    v.iter_mut().enumerate().for_each(|(k, x)| *x = (*x | 1) << (31 - k));
                }
            }
            matrices
        },
    )
}

proptest! {
    #![proptest_config(config(400, 3))]

    #[test]
    fn ranks_say_what_counting_says(matrices in matrices(), m in 0..=8u32) {
        prop_assert_eq!(net_t_by_rank(&matrices, m).unwrap(), by_counting(&matrices, m));
    }
}

#[test]
fn what_is_no_net_is_refused() {
    assert_eq!(net_t_by_counting(&[[0, 0]; 3], 2), Err(QualityError::PointCount { m: 2, got: 3 }));
    assert_eq!(net_t_by_counting::<2>(&[], 0), Err(QualityError::PointCount { m: 0, got: 0 }));
    assert_eq!(net_t_by_counting(&[[0, 0]; 3], 32), Err(QualityError::PointCount { m: 32, got: 3 }));
    for m in [33, 64, u32::MAX] {
        assert_eq!(net_t_by_counting(&[[0, 0]; 3], m), Err(QualityError::Digits { m }));
        assert_eq!(net_t_by_rank(&[[0; 32]], m), Err(QualityError::Digits { m }));
    }
    // Without coordinates nothing can be uneven.
    assert_eq!(net_t_by_counting::<0>(&[[], []], 1), Ok(0));
    assert_eq!(net_t_by_rank(&[], 32), Ok(0));
}
