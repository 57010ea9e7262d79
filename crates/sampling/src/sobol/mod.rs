mod matrices;
mod owen;

use etendue_core::{Fingerprint, Vec2};

use crate::block::{FIRST_LOBE, LATER_LOBE, Source};
use crate::hash::{self, keyed};
use crate::permutation::permute_octaves;
use crate::stream::Stream;
use crate::{BounceDraws, Dim, Sampler, Slot, unit_f32};

/// The Sobol sequence with Owen scrambling: the default.
///
/// *First block.* Film, first light, lens and first BSDF sample (and time and the first choice of a lobe) are ten
/// dimensions of *one* sequence of Joe & Kuo (2008) with one index, each nested-uniformly scrambled (Owen 1995, by
/// the hash of Laine & Karras 2011, Burley 2020 and Vegdahl 2021). The pairs that couple most stand first: film,
/// light, BSDF, lens. Any 2^m consecutive aligned samples form a net in every dimension and pair.
///
/// *Later vertices.* Light, BSDF and lobe of one vertex are five dimensions of a sequence of their own, with fresh
/// scrambles and a permuted index. Joining blocks by a nested shuffle of the index (Burley 2020) correlates the
/// blocks' leading digits and is *worse* than independent sampling where blocks couple; instead, each range
/// [2^k, 2^(k+1)) of indices is permuted within itself, uniformly at random. Every power-of-two prefix is then still
/// a net in each block, without the penalty (`tests/convergence.rs` measures both).
///
/// Roulette, cut-outs and spares are plain hashes. Sample counts need not be powers of two, but pay off there.
///
/// ```
/// use etendue_sampling::{Dim, Sampler, Sobol};
/// let sampler = Sobol::new(7, 16);
/// // One sample in each of 16 cells, whatever the pixel.
/// let mut cells = [0; 16];
/// for index in 0..16 {
///     let p = sampler.start(1234, index).get_2d(Dim::FILM);
///     cells[(p.y * 4.0) as usize * 4 + (p.x * 4.0) as usize] += 1;
/// }
/// assert_eq!(cells, [1; 16]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sobol {
    at: Stream,
}

/// Names of keyed hashes; the first block is block 0, the vertex at depth d is block d + 1.
const SEEDS: u32 = 0;
const SHUFFLE: u32 = 1 << 16;

impl Sobol {
    /// A sampler of the given seed, intended for `spp` samples a pixel (best a power of two).
    pub fn new(seed: u64, spp: u32) -> Self {
        Self { at: Stream::new(seed, spp) }
    }

    /// Deals the samples to `r` independently scrambled replicates (see [`Sampler::replicates`]); 0 counts as 1.
    /// Best a power of two: each replicate has `spp / r` samples.
    #[must_use]
    pub fn with_replicates(mut self, r: u32) -> Self {
        self.at.replicates = r.max(1);
        self
    }

    /// The generator matrix of one dimension of Joe & Kuo's sequence, before it is scrambled, as direction numbers:
    /// entry `k` is the coordinate that bit `k` of the index contributes by exclusive or, in units of 2⁻³². `None`
    /// from dimension 10 on. Coordinates are drawn in the order film, first light, first BSDF, lens (two each), time,
    /// first lobe; [`net_t_by_rank`](crate::quality::net_t_by_rank) has the strength of any of them together.
    pub fn direction_numbers(dimension: u32) -> Option<[u32; 32]> {
        (dimension < matrices::DIMENSIONS)
            .then(|| std::array::from_fn(|k| matrices::dimension(1 << k, dimension).reverse_bits()))
    }

    /// Scramble seeds of dimensions 2 `pair` and 2 `pair` + 1 of a block.
    #[inline(always)]
    fn seeds(&self, block: u32, pair: u32) -> (u32, u32) {
        let h = keyed(self.at.key, block, SEEDS | pair);
        (h as u32, (h >> 32) as u32)
    }

    #[inline(always)]
    fn seed(&self, block: u32, dimension: u32) -> u32 {
        let (even, odd) = self.seeds(block, dimension >> 1);
        if dimension & 1 == 0 { even } else { odd }
    }

    #[inline(always)]
    fn scrambled_pair(&self, block: u32, pair: u32, raw: [u32; 2]) -> Vec2 {
        let (a, b) = self.seeds(block, pair);
        let [x, y] = owen::scrambled_pair(raw, [a, b]);
        Vec2::new(unit_f32(x), unit_f32(y))
    }

    /// The index of this point in a block that is joined at random.
    #[inline(always)]
    fn shuffled(&self, block: u32) -> u32 {
        permute_octaves(self.at.index, keyed(self.at.key, block, SHUFFLE))
    }
}

impl Sampler for Sobol {
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
        // The fork's first block would follow this one's index: join it at random too.
        let at = self.at.fork(key);
        let index = permute_octaves(at.index, hash::mix(at.key));
        Self { at: Stream { index, ..at } }
    }

    #[inline]
    fn bits_1d(&self, dim: Dim) -> u32 {
        match Source::of(dim) {
            Source::First(d) => owen::scrambled(matrices::dimension(self.at.index, d), self.seed(0, d)),
            Source::Later { depth, dimension: d } => {
                let block = depth.wrapping_add(1);
                owen::scrambled(matrices::dimension(self.shuffled(block), d), self.seed(block, d))
            }
            Source::Hash => (self.at.hash(dim.index()) >> 32) as u32,
        }
    }

    #[inline]
    fn get_2d(&self, dim: Dim) -> Vec2 {
        let i = self.at.index;
        match Source::of(dim) {
            Source::First(0) => self.scrambled_pair(0, 0, [i, matrices::pascal(i)]),
            Source::First(2) => self.scrambled_pair(0, 1, matrices::tabulated::<0, 2>(i)),
            Source::First(4) => self.scrambled_pair(0, 2, matrices::tabulated::<2, 2>(i)),
            Source::First(6) => self.scrambled_pair(0, 3, matrices::tabulated::<4, 2>(i)),
            Source::Later { depth, dimension: 0 } => {
                let i = self.shuffled(depth.wrapping_add(1));
                self.scrambled_pair(depth.wrapping_add(1), 0, [i, matrices::pascal(i)])
            }
            Source::Later { depth, dimension: 2 } => {
                let i = self.shuffled(depth.wrapping_add(1));
                self.scrambled_pair(depth.wrapping_add(1), 1, matrices::tabulated::<0, 2>(i))
            }
            // Not one of the named pairs: what the two dimensions hold.
            _ => Vec2::new(self.get_1d(dim), self.get_1d(dim.next())),
        }
    }

    #[inline]
    fn bounce(&self, depth: u32) -> BounceDraws {
        let roulette = self.get_1d(Dim::bounce(depth, Slot::Roulette));
        if depth == 0 {
            let rest: [u32; 8] = matrices::tabulated::<0, 8>(self.at.index);
            return BounceDraws {
                light: self.scrambled_pair(0, 1, [rest[0], rest[1]]),
                bsdf: self.scrambled_pair(0, 2, [rest[2], rest[3]]),
                lobe: unit_f32(owen::scrambled(rest[7], self.seed(0, FIRST_LOBE))),
                roulette,
            };
        }
        let block = depth.wrapping_add(1);
        let i = self.shuffled(block);
        let rest: [u32; 3] = matrices::tabulated::<0, 3>(i);
        BounceDraws {
            light: self.scrambled_pair(block, 0, [i, matrices::pascal(i)]),
            bsdf: self.scrambled_pair(block, 1, [rest[0], rest[1]]),
            lobe: unit_f32(owen::scrambled(rest[2], self.seed(block, LATER_LOBE))),
            roulette,
        }
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("sobol");
        f.u64(self.at.seed);
        f.u64(u64::from(self.at.replicates));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_ways_to_draw_agree() {
        for index in [0, 1, 2, 77, 255, 256, 65_535, 65_536, 0xffff_ffff, 1 << 40] {
            let s = Sobol::new(3, 64).start(9, index);
            for depth in 0..6 {
                let b = s.bounce(depth);
                let (light, bsdf) = (Dim::bounce(depth, Slot::Light), Dim::bounce(depth, Slot::Bsdf));
                assert_eq!(b.light, s.get_2d(light));
                assert_eq!(b.bsdf, s.get_2d(bsdf));
                assert_eq!(b.lobe, s.get_1d(Dim::bounce(depth, Slot::Lobe)));
                assert_eq!(b.roulette, s.get_1d(Dim::bounce(depth, Slot::Roulette)));
                for (pair, dim) in [(b.light, light), (b.bsdf, bsdf), (s.get_2d(Dim::LENS), Dim::LENS)] {
                    assert_eq!(pair, Vec2::new(s.get_1d(dim), s.get_1d(dim.next())));
                }
            }
        }
    }
}
