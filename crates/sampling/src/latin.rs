use etendue_core::{Fingerprint, Vec2};

use crate::strata::jittered;
use crate::stream::{Stream, stands};
use crate::{Dim, Sampler, unit_f32};

/// Latin hypercube sampling, or N rooks: of `spp` samples, every dimension has one in each of `spp` intervals, jittered
/// inside it, and the dimensions are joined at random (McKay, Beckman & Conover 1979).
///
/// *When.* Where the integrand is nearly a sum of functions of one number each: on such a sum the variance falls as
/// N⁻³ in any number of dimensions. What is left of the integrand, its interactions, is sampled as by independent
/// numbers (Stein 1987): there is no grid in two dimensions, so edges and products gain a constant at best.
/// `Stratified` and `Sobol` are better for pictures.
///
/// *Limits.* The number of samples is fixed beforehand: any `spp` will do, but a part of a set is only a random choice
/// of intervals, and samples past `spp` begin another, independent set. Any number of dimensions.
///
/// Each dimension deals its intervals by its own hashed permutation (Kensler 2013), so nothing is tabulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatinHypercube {
    at: Stream,
    /// Points in a set: at least 1.
    points: u32,
}

impl LatinHypercube {
    /// A sampler of the given seed in sets of `spp` samples; 0 counts as 1.
    pub fn new(seed: u64, spp: u32) -> Self {
        Self { at: Stream::new(seed, spp), points: spp.max(1) }
    }

    /// Deals the samples to `r` replicates (see [`Sampler::replicates`]); 0 counts as 1. Each replicate is a hypercube
    /// of its own of `spp / r` samples.
    #[must_use]
    pub fn with_replicates(mut self, r: u32) -> Self {
        self.at.replicates = r.max(1);
        self.points = self.at.points().max(1);
        self
    }
}

impl Sampler for LatinHypercube {
    stands!();

    #[inline]
    fn bits_1d(&self, dim: Dim) -> u32 {
        jittered(self.at, self.points, dim.index())
    }

    /// What the two dimensions hold.
    #[inline]
    fn get_2d(&self, dim: Dim) -> Vec2 {
        Vec2::new(unit_f32(self.bits_1d(dim)), unit_f32(self.bits_1d(dim.next())))
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("latin-hypercube");
        f.u64(self.at.seed);
        f.u64(u64::from(self.at.spp));
        f.u64(u64::from(self.at.replicates));
    }
}
