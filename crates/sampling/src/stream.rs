//! What every built-in sampler knows about where it stands.

use crate::hash::{GOLDEN, keyed, mix, mix2};

/// Where a sampler stands: which randomisation, which point of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stream {
    /// Hash of the user's seed.
    pub(crate) seed: u64,
    /// Hash of seed, stream, replicate and forks: one randomisation of the point set.
    pub(crate) key: u64,
    /// Number of the point within the randomisation.
    pub(crate) index: u32,
    pub(crate) spp: u32,
    pub(crate) replicates: u32,
}

impl Stream {
    pub(crate) fn new(seed: u64, spp: u32) -> Self {
        let seed = mix2(seed, 0);
        Self { seed, key: mix(seed), index: 0, spp: spp.max(1), replicates: 1 }
    }

    /// Point `index` of `stream`: of replicate `index mod R` it is point `index / R`. Past 2³² points of a replicate
    /// the numbering begins again under another key.
    #[inline(always)]
    pub(crate) fn start(self, stream: u64, index: u64) -> Self {
        let mut key = mix(self.seed.wrapping_add(stream.wrapping_mul(GOLDEN)));
        let (mut point, mut which) = (index, 0);
        if self.replicates > 1 {
            let r = u64::from(self.replicates);
            (point, which) = (index / r, index % r);
        }
        which |= (point >> 32) << 32;
        if which != 0 {
            key = mix2(key, which);
        }
        Self { key, index: point as u32, ..self }
    }

    /// An independent randomisation for a walk.
    #[inline(always)]
    pub(crate) fn fork(self, name: u32) -> Self {
        Self { key: mix2(self.key, u64::from(name) | 1 << 63), ..self }
    }

    /// Points of each replicate.
    #[inline(always)]
    pub(crate) fn points(self) -> u32 {
        self.spp.div_ceil(self.replicates.max(1))
    }

    /// 64 plain random bits for (point, what).
    #[inline(always)]
    pub(crate) fn hash(self, what: u32) -> u64 {
        keyed(self.key, self.index, what)
    }
}

/// What a sampler that stands at `at`, a [`Stream`], answers about where it stands.
macro_rules! stands {
    () => {
        fn spp(&self) -> u32 {
            self.at.spp
        }

        fn replicates(&self) -> u32 {
            self.at.replicates
        }

        #[inline]
        fn start(self, stream: u64, index: u64) -> Self {
            Self { at: self.at.start(stream, index), ..self }
        }

        #[inline]
        fn fork(self, key: u32) -> Self {
            Self { at: self.at.fork(key), ..self }
        }
    };
}
pub(crate) use stands;
