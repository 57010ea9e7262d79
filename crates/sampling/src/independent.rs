use etendue_core::{Fingerprint, Vec2};

use crate::stream::Stream;
use crate::{BounceDraws, Dim, Sampler, Slot, unit_f32};

/// Independent uniform numbers: a hash of (seed, stream, index, dimension). The yardstick for every other sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Independent {
    at: Stream,
}

impl Independent {
    /// A sampler of the given seed; `spp` is only what [`Sampler::spp`] answers.
    pub fn new(seed: u64, spp: u32) -> Self {
        Self { at: Stream::new(seed, spp) }
    }

    /// Deals the samples to `r` replicates (see [`Sampler::replicates`]); 0 counts as 1.
    #[must_use]
    pub fn with_replicates(mut self, r: u32) -> Self {
        self.at.replicates = r.max(1);
        self
    }

    /// Two numbers from one hash, for an even dimension and the next.
    #[inline(always)]
    fn pair(&self, even: u32) -> (u32, u32) {
        let h = self.at.hash(even);
        (h as u32, (h >> 32) as u32)
    }
}

impl Sampler for Independent {
    fn spp(&self) -> u32 {
        self.at.spp
    }

    fn replicates(&self) -> u32 {
        self.at.replicates
    }

    #[inline]
    fn start(self, stream: u64, index: u64) -> Self {
        Self { at: self.at.start(stream, index) }
    }

    #[inline]
    fn fork(self, key: u32) -> Self {
        Self { at: self.at.fork(key) }
    }

    #[inline]
    fn bits_1d(&self, dim: Dim) -> u32 {
        let (low, high) = self.pair(dim.index() & !1);
        if dim.index() & 1 == 0 { low } else { high }
    }

    #[inline]
    fn get_2d(&self, dim: Dim) -> Vec2 {
        let d = dim.index();
        let (a, b) =
            if d & 1 == 0 { self.pair(d) } else { (self.pair(d - 1).1, self.pair(d.wrapping_add(1)).0) };
        Vec2::new(unit_f32(a), unit_f32(b))
    }

    #[inline]
    fn bounce(&self, depth: u32) -> BounceDraws {
        BounceDraws {
            light: self.get_2d(Dim::bounce(depth, Slot::Light)),
            bsdf: self.get_2d(Dim::bounce(depth, Slot::Bsdf)),
            lobe: self.get_1d(Dim::bounce(depth, Slot::Lobe)),
            roulette: self.get_1d(Dim::bounce(depth, Slot::Roulette)),
        }
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("independent");
        f.u64(self.at.seed);
        f.u64(u64::from(self.at.replicates));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_is_the_two_single_draws() {
        let s = Independent::new(1, 4).start(5, 6);
        for d in 0..40 {
            let dim =
                Dim::bounce(d / 4, [Slot::Light, Slot::Bsdf, Slot::Roulette, Slot::Cutout][d as usize % 4]);
            let p = s.get_2d(dim);
            assert_eq!(p.x, s.get_1d(dim));
        }
        let film = s.get_2d(Dim::FILM);
        assert_eq!(film, s.get_2d(Dim::FILM));
        assert_ne!(film.x, film.y);
    }
}
