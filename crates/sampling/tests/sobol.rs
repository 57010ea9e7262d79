//! Net properties, exact t-values and reference points of the Sobol sampler.

use etendue_core::Vec2;
use etendue_sampling::quality::{net_t_by_counting, net_t_by_rank};
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

/// The strength of points as a net.
fn t_value<const D: usize>(points: &[[u32; D]]) -> u32 {
    net_t_by_counting(points, points.len().ilog2()).unwrap()
}

/// Coordinates in f32, as rendering uses them, in units of 2⁻³².
fn points<const D: usize>(dims: [Dim; D], start: u64, n: u64, seed: u64, stream: u64) -> Vec<[u32; D]> {
    let s = Sobol::new(seed, n as u32);
    (start..start + n).map(|i| dims.map(|d| digits(s.start(stream, i).get_1d(d)))).collect()
}

fn digits(x: f32) -> u32 {
    (x * 4_294_967_296.0) as u32
}

#[test]
fn leading_pair_is_a_net_for_every_prefix_and_aligned_block() {
    let pair = [first_block()[0], first_block()[1]];
    for m in 0..=10 {
        let n = 1 << m;
        for (seed, block) in [(1, 0), (2, 1), (3, 5)] {
            assert_eq!(t_value(&points(pair, block * n, n, seed, 77)), 0, "2^{m}, block {block}");
        }
    }
}

/// The strengths of some dimensions for m = 4, 6, 8, 10, as they are drawn.
fn drawn_t_values<const D: usize>(which: [usize; D]) -> [u32; 4] {
    let dims = which.map(|d| first_block()[d]);
    [4, 6, 8, 10].map(|m| t_value(&points(dims, 0, 1 << m, 11, 5)))
}

#[test]
fn scrambling_keeps_the_t_values_of_joe_and_kuo() {
    // Exact values from the ranks of the generator matrices.
    assert_eq!(drawn_t_values([0, 1]), [0, 0, 0, 0]);
    assert_eq!(drawn_t_values([0, 2]), [0, 1, 1, 1]);
    assert_eq!(drawn_t_values([0, 3]), [2, 1, 1, 2]);
    assert_eq!(drawn_t_values([1, 2]), [1, 1, 1, 1]);
    assert_eq!(drawn_t_values([1, 3]), [1, 0, 2, 1]);
    assert_eq!(drawn_t_values([2, 3]), [0, 1, 1, 1]);
    assert_eq!(drawn_t_values([4, 5]), [0, 1, 3, 1]);
    assert_eq!(drawn_t_values([6, 7]), [2, 1, 2, 1]);
    assert_eq!(drawn_t_values([0, 1, 2]), [1, 1, 1, 1]);
    assert_eq!(drawn_t_values([1, 2, 3]), [1, 1, 3, 2]);
    assert_eq!(drawn_t_values([0, 1, 2, 3]), [2, 2, 3, 2]);
}

#[test]
fn all_dimensions_together_are_as_strong_as_their_matrices() {
    let matrices: Vec<_> = (0..10).filter_map(Sobol::direction_numbers).collect();
    assert_eq!(matrices.len(), 10);
    for m in 0..=8 {
        let drawn = t_value(&points(first_block(), 0, 1 << m, 11, 5));
        assert_eq!(Ok(drawn), net_t_by_rank(&matrices, m), "2^{m}");
    }
}

#[test]
fn every_single_dimension_is_stratified() {
    let later = [Slot::Light, Slot::Bsdf, Slot::Lobe].map(|s| Dim::bounce(3, s));
    for d in first_block().into_iter().chain(later) {
        assert_eq!(t_value(&points([d], 0, 1024, 4, 9)), 0, "{d:?}");
    }
}

#[test]
fn later_vertices_are_nets_for_every_power_of_two_prefix() {
    for depth in [1, 2, 7] {
        let light = Dim::bounce(depth, Slot::Light);
        let bsdf = Dim::bounce(depth, Slot::Bsdf);
        for m in 1..=10 {
            assert_eq!(t_value(&points([light, light.next()], 0, 1 << m, 6, 2)), 0, "depth {depth}, 2^{m}");
        }
        let four = [light, light.next(), bsdf, bsdf.next()];
        assert_eq!(t_value(&points(four, 0, 256, 6, 2)), 3);
    }
}

#[test]
fn replicates_are_nets_of_their_own() {
    let s = Sobol::new(5, 64).with_replicates(4);
    assert_eq!(s.replicates(), 4);
    for r in 0..4 {
        let p: Vec<[u32; 2]> = (0..16)
            .map(|i| {
                let Vec2 { x, y } = s.start(3, i * 4 + r).get_2d(Dim::FILM);
                [digits(x), digits(y)]
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
    let pair = [first_block()[0], first_block()[1]];
    assert_eq!(t_value(&points(pair, 1 << 32, 64, 1, 0)), 0);
    assert!(p(u64::MAX).is_finite());
}
