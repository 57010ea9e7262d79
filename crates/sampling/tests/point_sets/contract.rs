//! The contract of samplers, for every size, seed and order; fingerprints and bits.

use etendue_core::Fingerprint;
use etendue_core::Vec2;
use etendue_sampling::{
    CorrelatedMultiJittered, Dim, Halton, LatinHypercube, Sampler, Slot, radical_inverse, unit_f32,
};
use proptest::prelude::*;

use crate::{BSDF, LIGHT, SCRAMBLINGS, permuted};

/// Draws of one point in the order given, put back in the order of `dims`.
fn draws<S: Sampler>(s: S, stream: u64, index: u64, dims: &[Dim], backward: bool) -> Vec<(u32, Vec2)> {
    let draw = |d: &Dim| {
        let p = s.start(stream, index);
        (p.bits_1d(*d), p.get_2d(*d))
    };
    if backward {
        let mut all: Vec<_> = dims.iter().rev().map(draw).collect();
        all.reverse();
        all
    } else {
        let p = s.start(index, stream).start(stream, index);
        dims.iter().map(|d| (p.bits_1d(*d), p.get_2d(*d))).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(0x5ee7),
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_order_gives_the_same_numbers_and_none_is_one(
        seed: u64, stream: u64, far: u64, near in 0u64..5000, spp: u32, replicates in 0u32..9, depth: u32,
    ) {
        fn check<S: Sampler>(s: S, stream: u64, index: u64, dims: &[Dim]) -> Result<(), TestCaseError> {
            let forward = draws(s, stream, index, dims, false);
            prop_assert_eq!(&forward, &draws(s, stream, index, dims, true));
            let p = s.start(stream, index);
            for (dim, (bits, pair)) in dims.iter().zip(&forward) {
                prop_assert_eq!(p.get_1d(*dim), unit_f32(*bits));
                prop_assert!((0.0..1.0).contains(&p.get_1d(*dim)) && (0.0..1.0).contains(&p.get_1d_f64(*dim)));
                prop_assert!((0.0..1.0).contains(&pair.x) && (0.0..1.0).contains(&pair.y));
            }
            Ok(())
        }
        let dims = [
            Dim::FILM, Dim::LENS, Dim::TIME, LIGHT, BSDF, Dim::bounce(0, Slot::Lobe), Dim::bounce(depth, Slot::Light),
            Dim::bounce(depth % 50, Slot::Spare1), Dim::bounce(depth % 50, Slot::Bsdf),
        ];
        // All sizes, and the small ones that are used.
        for (index, spp) in [(far, spp), (near, spp % 5000), (u64::from(u32::MAX), u32::MAX)] {
            for scrambling in SCRAMBLINGS {
                let s = Halton::new(seed, spp).with_scrambling(scrambling).with_replicates(replicates);
                check(s, stream, index, &dims)?;
            }
            check(LatinHypercube::new(seed, spp).with_replicates(replicates), stream, index, &dims)?;
            check(CorrelatedMultiJittered::new(seed, spp).with_replicates(replicates), stream, index, &dims)?;
        }
    }

    #[test]
    fn radical_inverses_stay_below_one(base: u32, index: u32, k in 0u32..33) {
        let x = radical_inverse(base, index);
        prop_assert!((0.0..1.0).contains(&x));
        // The largest: all digits b − 1.
        let (base, k) = (base % 1000 + 2, k);
        let top = u64::from(base).checked_pow(k).filter(|p| *p <= 1 << 32).unwrap_or(1) - 1;
        prop_assert!(radical_inverse(base, top as u32) <= 1.0 - 1.0 / 4_294_967_296.0);
    }
}

#[test]
fn fingerprints_tell_point_sets_apart() {
    fn digest<S: Sampler>(s: S) -> u128 {
        let mut f = Fingerprint::default();
        s.fingerprint(&mut f);
        f.value()
    }
    let all = [
        digest(Halton::new(1, 16)),
        digest(Halton::new(2, 16)),
        digest(Halton::new(1, 16).with_replicates(2)),
        digest(permuted(1, 16)),
        digest(Halton::none(16)),
        digest(LatinHypercube::new(1, 16)),
        digest(LatinHypercube::new(2, 16)),
        digest(LatinHypercube::new(1, 17)),
        digest(LatinHypercube::new(1, 16).with_replicates(2)),
        digest(CorrelatedMultiJittered::new(1, 16)),
        digest(CorrelatedMultiJittered::new(2, 16)),
        digest(CorrelatedMultiJittered::new(1, 17)),
        digest(CorrelatedMultiJittered::new(1, 16).with_replicates(2)),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(!all[..i].contains(a), "{i}");
    }
    // More samples of the same sequence are the same point set.
    assert_eq!(all[0], digest(Halton::new(1, 1024)));
}

/// The bits themselves, equal on every target.
#[test]
fn bits_are_the_same_on_every_target() {
    let mut digest = Fingerprint::default();
    for i in 0..2000u64 {
        let (stream, index) = (i >> 4, i * 7);
        for scrambling in SCRAMBLINGS {
            let s = Halton::new(3, 256).with_scrambling(scrambling).with_replicates(4).start(stream, index);
            let b = s.bounce((i & 7) as u32);
            digest.floats(&[b.light.x, b.light.y, b.bsdf.x, b.bsdf.y, b.lobe, b.roulette]);
            digest.floats(&s.fork(5).get_2d(Dim::LENS).to_array());
        }
        digest.floats(&LatinHypercube::new(3, 100).start(stream, index).get_2d(Dim::FILM).to_array());
        let s = CorrelatedMultiJittered::new(3, 100).start(stream, index);
        digest.floats(&[s.get_2d(Dim::FILM).x, s.get_2d(Dim::FILM).y, s.get_1d(Dim::TIME)]);
    }
    assert_eq!(digest.value(), PINNED, "{:#034x}", digest.value());
}

const PINNED: u128 = 0xae15_2e3b_f95b_e997_0628_be43_2280_8720;
