//! Net properties, exact t-values and reference points of the Sobol sampler.

use etendue_core::Vec2;
use etendue_sampling::{Dim, Sampler, Slot, Sobol};

/// The ten dimensions of the first block in the order of the sequence.
fn first_block() -> [Dim; 10] {
    let light = Dim::bounce(0, Slot::Light);
    let bsdf = Dim::bounce(0, Slot::Bsdf);
    [
        Dim::FILM,
        Dim::FILM.next(),
        light,
        light.next(),
        bsdf,
        bsdf.next(),
        Dim::LENS,
        Dim::LENS.next(),
        Dim::TIME,
        Dim::bounce(0, Slot::Lobe),
    ]
}

/// The smallest t for which the points are a (t, m, s)-net in base 2: every elementary interval of volume 2^(t-m)
/// holds 2^t of them. `points[i][k]` are the 24-bit coordinates.
fn t_value(points: &[Vec<u32>]) -> u32 {
    let m = points.len().ilog2();
    let dims = points[0].len();
    (0..=m)
        .find(|&t| {
            compositions(m - t, dims).iter().all(|split| {
                let mut counts = vec![0u32; 1 << (m - t)];
                for p in points {
                    let cell = p
                        .iter()
                        .zip(split)
                        .fold(0, |c, (x, k)| c << k | (u64::from(*x) >> (24 - k)) as usize);
                    counts[cell] += 1;
                }
                counts.iter().all(|&c| c == 1 << t)
            })
        })
        .unwrap()
}

/// All ways to write `sum` as `parts` ordered numbers.
fn compositions(sum: u32, parts: usize) -> Vec<Vec<u32>> {
    if parts == 1 {
        return vec![vec![sum]];
    }
    (0..=sum)
        .flat_map(|k| {
            compositions(sum - k, parts - 1).into_iter().map(move |mut rest| {
                rest.push(k);
                rest
            })
        })
        .collect()
}

/// Coordinates in f32, as rendering uses them, back as 24-bit integers.
fn points(dims: &[Dim], start: u64, n: u64, seed: u64, stream: u64) -> Vec<Vec<u32>> {
    let s = Sobol::new(seed, n as u32);
    (start..start + n)
        .map(|i| dims.iter().map(|&d| (s.start(stream, i).get_1d(d) * 16_777_216.0) as u32).collect())
        .collect()
}

#[test]
fn leading_pair_is_a_net_for_every_prefix_and_aligned_block() {
    for m in 0..=10 {
        let n = 1 << m;
        for (seed, block) in [(1, 0), (2, 1), (3, 5)] {
            assert_eq!(
                t_value(&points(&first_block()[..2], block * n, n, seed, 77)),
                0,
                "2^{m}, block {block}"
            );
        }
    }
}

#[test]
fn scrambling_keeps_the_t_values_of_joe_and_kuo() {
    // Exact values for m = 4, 6, 8, 10 from the ranks of the generator matrices.
    let table: [(&[usize], [u32; 4]); 11] = [
        (&[0, 2], [0, 1, 1, 1]),
        (&[0, 3], [2, 1, 1, 2]),
        (&[1, 2], [1, 1, 1, 1]),
        (&[1, 3], [1, 0, 2, 1]),
        (&[2, 3], [0, 1, 1, 1]),
        (&[4, 5], [0, 1, 3, 1]),
        (&[6, 7], [2, 1, 2, 1]),
        (&[0, 1, 2], [1, 1, 1, 1]),
        (&[1, 2, 3], [1, 1, 3, 2]),
        (&[0, 1, 2, 3], [2, 2, 3, 2]),
        (&[0, 1], [0, 0, 0, 0]),
    ];
    for (which, want) in table {
        let dims: Vec<Dim> = which.iter().map(|&d| first_block()[d]).collect();
        for (k, want) in want.into_iter().enumerate() {
            let m = 4 + 2 * k as u32;
            assert_eq!(t_value(&points(&dims, 0, 1 << m, 11, 5)), want, "dimensions {which:?}, m = {m}");
        }
    }
}

#[test]
fn every_single_dimension_is_stratified() {
    let later = [Slot::Light, Slot::Bsdf, Slot::Lobe].map(|s| Dim::bounce(3, s));
    for d in first_block().into_iter().chain(later) {
        assert_eq!(t_value(&points(&[d], 0, 1024, 4, 9)), 0, "{d:?}");
    }
}

#[test]
fn later_vertices_are_nets_for_every_power_of_two_prefix() {
    for depth in [1, 2, 7] {
        let light = Dim::bounce(depth, Slot::Light);
        let bsdf = Dim::bounce(depth, Slot::Bsdf);
        for m in 1..=10 {
            assert_eq!(t_value(&points(&[light, light.next()], 0, 1 << m, 6, 2)), 0, "depth {depth}, 2^{m}");
        }
        let four = [light, light.next(), bsdf, bsdf.next()];
        assert_eq!(t_value(&points(&four, 0, 256, 6, 2)), 3);
    }
}

#[test]
fn replicates_are_nets_of_their_own() {
    let s = Sobol::new(5, 64).with_replicates(4);
    assert_eq!(s.replicates(), 4);
    for r in 0..4 {
        let p: Vec<Vec<u32>> = (0..16)
            .map(|i| {
                let Vec2 { x, y } = s.start(3, i * 4 + r).get_2d(Dim::FILM);
                vec![(x * 16_777_216.0) as u32, (y * 16_777_216.0) as u32]
            })
            .collect();
        assert_eq!(t_value(&p), 0, "replicate {r}");
    }
    assert_ne!(s.start(3, 0).get_2d(Dim::FILM), s.start(3, 1).get_2d(Dim::FILM));
    // One replicate is the sampler without.
    assert_eq!(Sobol::new(5, 64).with_replicates(0), Sobol::new(5, 64));
}

#[test]
fn indices_past_the_sequence_go_on_under_another_key() {
    let s = Sobol::new(1, 16);
    let p = |i: u64| s.start(0, i).get_2d(Dim::FILM);
    assert_ne!(p(0), p(1 << 32));
    let again: Vec<Vec<u32>> = points(&first_block()[..2], 1 << 32, 64, 1, 0);
    assert_eq!(t_value(&again), 0);
    assert!(p(u64::MAX).is_finite());
}
