//! Every built-in model through its check suite, over random parameters.

use etendue_testkit::{Budget, check_bsdf, strategies};
use proptest::prelude::*;

const CASES: u32 = 96;

proptest! {
    #![proptest_config(ProptestConfig {
        cases: CASES,
        rng_seed: prop::test_runner::RngSeed::Fixed(11),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn every_model_keeps_the_contract(bsdf in strategies::bsdf(), seed in any::<u64>()) {
        let budget = Budget::default().shared(CASES as usize).seed(seed).effort(0.1);
        let verdict = check_bsdf(&bsdf, &budget);
        prop_assert!(verdict.is_ok(), "{bsdf:?}: {}", verdict.unwrap_err());
    }
}
