//! The samplers through their check suite.

use etendue_sampling::{
    CorrelatedMultiJittered, Halton, Independent, LatinHypercube, Sampler, Scrambling, Sobol, Stratified,
};
use etendue_testkit::{Budget, check_sampler};

/// Samplers and seeds that share one level.
const CALLS: usize = 51;

fn check<S: Sampler>(name: &str, make: impl Fn(u64) -> S) {
    for seed in 1..=3 {
        let budget = Budget::default().shared(CALLS).seed(seed);
        if let Err(failure) = check_sampler(&make, &budget) {
            panic!("{name}, seed {seed}: {failure}");
        }
    }
}

#[test]
fn every_sampler_keeps_the_contract() {
    check("independent", |seed| Independent::new(seed, 16));
    check("independent in 4 replicates", |seed| Independent::new(seed, 16).with_replicates(4));
    check("stratified in a square", |seed| Stratified::new(seed, 64));
    check("stratified, odd", |seed| Stratified::new(seed, 35));
    check("sobol", |seed| Sobol::new(seed, 64));
    check("sobol, odd", |seed| Sobol::new(seed, 100));
    check("sobol in 4 replicates", |seed| Sobol::new(seed, 64).with_replicates(4));
    check("halton", |seed| Halton::new(seed, 64));
    check("halton, odd", |seed| Halton::new(seed, 100));
    check("halton in 4 replicates", |seed| Halton::new(seed, 64).with_replicates(4));
    check("halton, permuted", |seed| Halton::new(seed, 100).with_scrambling(Scrambling::DigitPermutation));
    check("latin hypercube", |seed| LatinHypercube::new(seed, 64));
    check("latin hypercube, odd", |seed| LatinHypercube::new(seed, 37));
    check("latin hypercube in 4 replicates", |seed| LatinHypercube::new(seed, 44).with_replicates(4));
    check("multi-jittered", |seed| CorrelatedMultiJittered::new(seed, 64));
    check("multi-jittered, odd", |seed| CorrelatedMultiJittered::new(seed, 37));
    check("multi-jittered in 4 replicates", |seed| CorrelatedMultiJittered::new(seed, 44).with_replicates(4));
}
