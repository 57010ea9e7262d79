//! Halton, Hammersley, Latin hypercubes and correlated multi-jittering: their definitions, what they stratify, and how
//! fast their errors fall.

mod contract;
mod definitions;
mod means;
mod mutants;
mod rates;
mod strata;

use etendue_sampling::{Dim, Halton, Scrambling, Slot};

pub(crate) const LIGHT: Dim = Dim::bounce(0, Slot::Light);
pub(crate) const BSDF: Dim = Dim::bounce(0, Slot::Bsdf);
pub(crate) const SCRAMBLINGS: [Scrambling; 3] =
    [Scrambling::None, Scrambling::DigitPermutation, Scrambling::Owen];

pub(crate) fn permuted(seed: u64, spp: u32) -> Halton {
    Halton::new(seed, spp).with_scrambling(Scrambling::DigitPermutation)
}
