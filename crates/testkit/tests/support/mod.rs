//! Runs a suite over seeds and counts the verdicts.
#![allow(dead_code, unreachable_pub)]
#![allow(clippy::disallowed_methods)] // Tests may read the clock; they do not run in wasm.

use etendue_testkit::{Budget, Outcome};

/// A part under test with the suite that belongs to it.
pub struct Case<'a> {
    pub name: String,
    pub check: Box<dyn Fn(&Budget) -> Outcome + 'a>,
}

impl<'a> Case<'a> {
    pub fn new(name: impl Into<String>, check: impl Fn(&Budget) -> Outcome + 'a) -> Self {
        Self { name: name.into(), check: Box::new(check) }
    }
}

/// Seeds of the ordinary run and of the long one.
pub const FEW: u64 = 3;
pub const MANY: u64 = 100;

/// Every case passes on every seed, and its p-values are no smaller than chance makes them.
///
/// The second is the sharper one: of `seeds` right runs one in a hundred has p < 0.01. Among 100 runs nine such have a
/// probability of 10⁻⁶, so a suite whose numbers lean by one standard error is found out.
pub fn accept(cases: &[Case<'_>], seeds: u64, effort: f64) {
    let mut wrong = Vec::new();
    for case in cases {
        let started = std::time::Instant::now();
        let (mut small, mut smallest, mut failures) = (0, 1.0f64, Vec::new());
        for seed in 1..=seeds {
            match (case.check)(&Budget::default().seed(seed).effort(effort)) {
                Ok(passed) => {
                    small += u64::from(passed.p() < 0.01);
                    smallest = smallest.min(passed.p());
                }
                Err(f) => failures.push(format!("seed {seed}: {f}")),
            }
        }
        println!(
            "{}: {} of {seeds} accepted, {small} with p < 0.01 (least {smallest:.1e}), {:.2} s",
            case.name,
            seeds - failures.len() as u64,
            started.elapsed().as_secs_f64()
        );
        if let Some(first) = failures.first() {
            wrong.push(format!("{}: {} failures, first {first}", case.name, failures.len()));
        } else if small > 2 + seeds / 15 {
            wrong.push(format!("{}: {small} of {seeds} runs have p < 0.01", case.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every case fails on at least 99 of 100 seeds (on all of fewer).
pub fn reject(cases: &[Case<'_>], seeds: u64, effort: f64) {
    let mut unseen = Vec::new();
    for case in cases {
        let started = std::time::Instant::now();
        let mut tests: std::collections::BTreeMap<&'static str, u64> = std::collections::BTreeMap::new();
        for seed in 1..=seeds {
            if let Err(f) = (case.check)(&Budget::default().seed(seed).effort(effort)) {
                *tests.entry(f.test).or_default() += 1;
            }
        }
        let rejected: u64 = tests.values().sum();
        println!(
            "{}: {rejected} of {seeds} rejected by {tests:?}, {:.2} s",
            case.name,
            started.elapsed().as_secs_f64()
        );
        if rejected + seeds / 100 < seeds {
            unseen.push(format!("{}: only {rejected} of {seeds} rejected", case.name));
        }
    }
    assert!(unseen.is_empty(), "{}", unseen.join("\n"));
}
