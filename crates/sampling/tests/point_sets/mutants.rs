//! Deliberately wrong samplers that the tests must reject.

use etendue_core::Fingerprint;
use etendue_core::Vec2;
use etendue_sampling::{Dim, Independent, Sampler, mix, mix2};

/// A deliberately wrong sampler: an independent one whose single draws go through a function of (bits, sampler, dim).
#[derive(Clone, Copy)]
pub(crate) struct Mutant {
    inner: Independent,
    key: u64,
    index: u64,
    draw: fn(&Mutant, Dim) -> u32,
}

impl Mutant {
    pub(crate) fn new(seed: u64, spp: u32, draw: fn(&Mutant, Dim) -> u32) -> Self {
        Self { inner: Independent::new(seed, spp), key: seed, index: 0, draw }
    }
}

impl Sampler for Mutant {
    fn spp(&self) -> u32 {
        self.inner.spp()
    }
    fn start(self, stream: u64, index: u64) -> Self {
        Self { inner: self.inner.start(stream, index), key: mix2(self.key, stream), index, ..self }
    }
    fn fork(self, key: u32) -> Self {
        Self { inner: self.inner.fork(key), ..self }
    }
    fn bits_1d(&self, dim: Dim) -> u32 {
        (self.draw)(self, dim)
    }
    fn get_2d(&self, dim: Dim) -> Vec2 {
        Vec2::new(self.get_1d(dim), self.get_1d(dim.next()))
    }
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("mutant");
    }
}

/// Strata drawn with replacement, then jittered.
pub(crate) fn with_replacement(s: &Mutant, dim: Dim) -> u32 {
    let n = u64::from(s.inner.spp());
    let stratum = mix2(mix(s.key) ^ s.index, u64::from(dim.index())) % n;
    ((stratum << 32 | u64::from(s.inner.bits_1d(dim))) / n) as u32
}

/// Digits shifted by random amounts that are the same in every dimension.
pub(crate) fn blind_to_dimension(s: &Mutant, dim: Dim) -> u32 {
    let base: u32 = [2, 3, 5, 7, 17, 19, 11, 13, 23][dim.index() as usize % 9];
    let (mut rest, mut x, mut scale, mut shifts) = (s.index as u32, 0.0, 1.0, s.key);
    while scale > 1e-11 {
        let wide = u128::from(shifts) * u128::from(base);
        shifts = wide as u64;
        scale /= f64::from(base);
        x += scale * f64::from((rest % base + (wide >> 64) as u32) % base);
        rest /= base;
    }
    (x * 4_294_967_296.0) as u32
}
