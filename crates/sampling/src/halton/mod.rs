mod hammersley;
mod radical;

use etendue_core::{Fingerprint, Vec2};

pub use hammersley::Hammersley;
pub use radical::radical_inverse;

use crate::block::{FIRST_LOBE, Source};
use crate::hash::{keyed, mix};
use crate::permutation::permute_octaves;
use crate::stream::Stream;
use crate::{Dim, Sampler, unit_f32};

/// How the digits of a [`Halton`] sequence are randomised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scrambling {
    /// Not at all: the sequence as defined, the same in every pixel. For studying the sequence.
    None,
    /// A random permutation of the digits for each place, base and pixel (Matoušek 1998; Kollig & Keller 2002).
    /// Variance falls about as N⁻² on smooth functions.
    DigitPermutation,
    /// Nested: a digit's permutation also depends on the digits before it (Owen 1995). Variance falls as N⁻³ on smooth
    /// functions of one number where N is a power of its base, and about as N⁻²·⁵ in the film's two where N is one of
    /// 6; at powers of two in several dimensions it is that of digit permutations. The default.
    #[default]
    Owen,
}

/// The Halton sequence (Halton 1960): dimension d is the radical inverse of the index in the d-th prime, scrambled.
///
/// *When.* For sample counts that are no powers of two: every prefix of the sequence is good, and the best are
/// products of powers of the bases, such as 2ᵃ · 3ᵇ for the film. At powers of two [`Sobol`](crate::Sobol) is better,
/// and always more than ten times as fast: a number costs some ten divisions and hashes.
///
/// *Limits.* As for `Sobol`, film, first light, lens, first BSDF sample, time and first lobe are ten dimensions of one
/// sequence, the bases being the primes up to 29 (film 2, 3; light 5, 7; BSDF 11, 13; lens 17, 19; time 23; lobe 29).
/// A base says after how many samples a dimension is stratified at all, a product of two when a pair is: the lens
/// wants hundreds of samples. Every later vertex has a sequence of its own in the bases up to 11, freshly scrambled and
/// with the index permuted at random within each range [2^k, 2^(k+1)); there, between powers of two, the last
/// samples are a random choice. Roulette, cut-outs and spares are plain hashes. Past 2³² samples the
/// sequence begins again, scrambled anew.
///
/// Digits are integers: the radical inverse is exact, and rounded down to 32 bits.
///
/// ```
/// use etendue_sampling::{Dim, Halton, Sampler};
/// // One sample in each of 4 · 9 cells, whatever the pixel.
/// let sampler = Halton::new(7, 36);
/// let mut cells = [0; 36];
/// for index in 0..36 {
///     let p = sampler.start(1234, index).get_2d(Dim::FILM);
///     cells[(p.y * 9.0) as usize * 4 + (p.x * 4.0) as usize] += 1;
/// }
/// assert_eq!(cells, [1; 36]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Halton {
    at: Stream,
    scrambling: Scrambling,
}

/// Names of keyed hashes; the first block is block 0, the vertex at depth d is block d + 1.
const SEEDS: u32 = 0;
const SHUFFLE: u32 = 1 << 16;

impl Halton {
    /// A sampler of the given seed with [`Scrambling::Owen`], intended for `spp` samples a pixel.
    pub fn new(seed: u64, spp: u32) -> Self {
        Self { at: Stream::new(seed, spp), scrambling: Scrambling::Owen }
    }

    /// The sequence as defined, for studying it: the first block's ten dimensions are un-scrambled and *the same in
    /// every stream and for every seed*. It does not keep the contract that streams are independent: the errors of
    /// neighbouring pixels are equal, the picture shows patterns instead of noise, and its error cannot be estimated. The
    /// later vertices are randomised as by [`Scrambling::Owen`]. A fork is the same sequence in a random order.
    pub fn none(spp: u32) -> Self {
        Self::new(0, spp).with_scrambling(Scrambling::None)
    }

    /// The same with another scrambling. [`Scrambling::None`] has one replicate only; see [`Halton::none`].
    #[must_use]
    pub fn with_scrambling(mut self, scrambling: Scrambling) -> Self {
        self.scrambling = scrambling;
        self.with_replicates(self.at.replicates)
    }

    /// Deals the samples to `r` independently scrambled replicates (see [`Sampler::replicates`]); 0 counts as 1.
    /// Without scrambling there are no replicates, and `r` counts as 1.
    #[must_use]
    pub fn with_replicates(mut self, r: u32) -> Self {
        self.at.replicates = if self.scrambling == Scrambling::None { 1 } else { r.max(1) };
        self
    }

    /// How the digits are randomised.
    pub fn scrambling(&self) -> Scrambling {
        self.scrambling
    }

    /// The number of a dimension of a block's sequence.
    #[inline(always)]
    fn number(&self, index: u32, block: u32, dimension: u32, scrambling: Scrambling) -> u32 {
        let base = radical::PRIMES[dimension as usize];
        let key = keyed(self.at.key, block, SEEDS | dimension);
        match scrambling {
            Scrambling::None => radical::plain(index, base),
            Scrambling::DigitPermutation => radical::permuted(index, base, key),
            Scrambling::Owen => radical::nested(index, base, key),
        }
    }

    /// The index of this point in a block that is joined at random.
    #[inline(always)]
    fn shuffled(&self, block: u32) -> u32 {
        permute_octaves(self.at.index, keyed(self.at.key, block, SHUFFLE))
    }
}

// Every dimension a `Source` names has a base.
const _: () = assert!(radical::PRIMES.len() > FIRST_LOBE as usize);

impl Sampler for Halton {
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
        // The fork's first block would follow this one's index: join it at random too.
        let at = self.at.fork(key);
        let index = permute_octaves(at.index, mix(at.key));
        Self { at: Stream { index, ..at }, ..self }
    }

    #[inline]
    fn bits_1d(&self, dim: Dim) -> u32 {
        match Source::of(dim) {
            Source::First(d) => self.number(self.at.index, 0, d, self.scrambling),
            Source::Later { depth, dimension } => {
                let block = depth.wrapping_add(1);
                let scrambling = match self.scrambling {
                    Scrambling::None => Scrambling::Owen,
                    other => other,
                };
                self.number(self.shuffled(block), block, dimension, scrambling)
            }
            Source::Hash => (self.at.hash(dim.index()) >> 32) as u32,
        }
    }

    /// What the two dimensions hold.
    #[inline]
    fn get_2d(&self, dim: Dim) -> Vec2 {
        Vec2::new(unit_f32(self.bits_1d(dim)), unit_f32(self.bits_1d(dim.next())))
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag(match self.scrambling {
            Scrambling::None => "halton",
            Scrambling::DigitPermutation => "halton-permuted",
            Scrambling::Owen => "halton-owen",
        });
        f.u64(self.at.seed);
        f.u64(u64::from(self.at.replicates));
    }
}
