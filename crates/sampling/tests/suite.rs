//! The samplers through their check suite.

use etendue_sampling::{Independent, Sampler, Sobol, Stratified};
use etendue_testkit::{Budget, check_sampler};

/// Samplers and seeds that share one level.
const CALLS: usize = 21;

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
}
