//! What each point set has exactly one sample in.

use etendue_sampling::{CorrelatedMultiJittered, Dim, Halton, LatinHypercube, Sampler, Slot};

use crate::mutants::{Mutant, with_replacement};
use crate::{BSDF, LIGHT, SCRAMBLINGS};

/// The interval of a number among `n`, where its true value may lie up to 2⁻³² above.
fn interval(x: f64, n: u64) -> usize {
    ((((x * 4_294_967_296.0) as u64 + 1) * n - 1) >> 32) as usize
}

/// Whether every elementary box of 2^a × 3^b that holds one point on average holds one, of `sets` successive sets.
fn fills_elementary_boxes<S: Sampler>(s: S) -> bool {
    [(1, 1), (2, 1), (1, 2), (3, 2), (5, 0), (0, 4), (4, 3)].into_iter().all(|(a, b)| {
        let (columns, rows) = (1u64 << a, 3u64.pow(b));
        (0..3).all(|set| {
            let mut cells = vec![0; (columns * rows) as usize];
            for i in 0..columns * rows {
                let p = s.start(8, set * columns * rows + i);
                let (x, y) = (p.get_1d_f64(Dim::FILM), p.get_1d_f64(Dim::FILM.next()));
                cells[interval(x, columns) * rows as usize + interval(y, rows)] += 1;
            }
            cells.iter().all(|&c| c == 1)
        })
    })
}

#[test]
fn halton_has_one_point_in_each_elementary_box() {
    for seed in 0..50 {
        for scrambling in SCRAMBLINGS {
            assert!(
                fills_elementary_boxes(Halton::new(seed, 16).with_scrambling(scrambling)),
                "{scrambling:?}"
            );
        }
    }
    // The test sees what is no net: strata in each coordinate alone.
    assert!(!fills_elementary_boxes(LatinHypercube::new(1, 6)));
}

/// Whether each of a set's `n` intervals in every dimension holds one sample.
fn holds_one_in_each_row<S: Sampler>(s: S, n: u32) -> bool {
    let dims = [
        Dim::FILM,
        Dim::FILM.next(),
        LIGHT,
        Dim::TIME,
        Dim::bounce(3, Slot::Roulette),
        Dim::bounce(900, Slot::Bsdf),
    ];
    dims.into_iter().all(|dim| {
        (0..3).all(|set| {
            let mut rows = vec![0; n as usize];
            (0..n).for_each(|i| {
                rows[interval(
                    s.start(4, set * u64::from(n) + u64::from(i)).get_1d_f64(dim),
                    u64::from(n),
                )] += 1;
            });
            rows.iter().all(|&c| c == 1)
        })
    })
}

#[test]
fn latin_hypercubes_have_one_sample_in_each_row_of_every_dimension() {
    for n in [1, 2, 3, 5, 16, 37, 100, 1000] {
        assert!(holds_one_in_each_row(LatinHypercube::new(7, n), n), "{n}");
        assert!(holds_one_in_each_row(CorrelatedMultiJittered::new(7, n), n), "single draws, {n}");
        if n > 4 {
            assert!(!holds_one_in_each_row(Mutant::new(7, n, with_replacement), n), "mutant, {n}");
        }
    }
    // Each replicate is a set of its own, and the next set is another.
    let s = LatinHypercube::new(7, 30).with_replicates(3);
    for r in 0..3 {
        let mut rows = [0; 10];
        (0..10).for_each(|i| rows[interval(s.start(4, 3 * i + r).get_1d_f64(LIGHT), 10)] += 1);
        assert_eq!(rows, [1; 10]);
    }
    let s = LatinHypercube::new(7, 16);
    let order = |set: u64, d: Dim| {
        (0..16).map(|i| interval(s.start(4, set * 16 + i).get_1d_f64(d), 16)).collect::<Vec<_>>()
    };
    assert_ne!(order(0, LIGHT), order(1, LIGHT));
    assert_ne!(order(0, LIGHT), order(0, BSDF));
}

/// Most samples in a cell, in a column and in a row of the pattern of a set.
fn crowding<S: Sampler>(s: S, dim: Dim, samples: u32, (m, n): (u32, u32)) -> [u32; 3] {
    let count = (m * n) as usize;
    let (mut cells, mut columns, mut rows) = (vec![0; count], vec![0; count], vec![0; count]);
    for i in 0..samples {
        let p = s.start(11, u64::from(i)).get_2d(dim);
        // A float is the true value rounded down to a multiple of 2⁻²⁴.
        let at = |x: f32, n: u32| ((((x * 16_777_216.0) as u64 + 1) * u64::from(n) - 1) >> 24) as usize;
        cells[at(p.y, n) * m as usize + at(p.x, m)] += 1;
        columns[at(p.x, m * n)] += 1;
        rows[at(p.y, m * n)] += 1;
    }
    [cells, columns, rows].map(|v| v.into_iter().max().unwrap_or(0))
}

#[test]
fn multi_jittering_has_one_sample_in_each_cell_column_and_row() {
    for n in [1, 2, 6, 16, 32, 35, 37, 64, 100] {
        for seed in 0..20 {
            let s = CorrelatedMultiJittered::new(seed, n);
            for dim in [Dim::FILM, LIGHT, Dim::bounce(50, Slot::Bsdf)] {
                // As many samples as cells, or fewer: at most one is exactly one where the numbers agree.
                assert_eq!(crowding(s, dim, n, s.cells()), [1; 3], "{n} samples, {:?} cells", s.cells());
            }
        }
    }
    // The test sees patterns that are only one of both.
    let latin = crowding(LatinHypercube::new(1, 64), Dim::FILM, 64, (8, 8));
    let jittered = crowding(etendue_sampling::Stratified::new(1, 64), Dim::FILM, 64, (8, 8));
    assert!(latin[0] > 1 && latin[1] == 1 && latin[2] == 1, "{latin:?}");
    assert!(jittered[0] == 1 && jittered[1] > 1 && jittered[2] > 1, "{jittered:?}");
}
