use etendue_core::{Fingerprint, Vec2};

use crate::{Dim, Slot};

/// All numbers of one path vertex, drawn at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BounceDraws {
    /// [`Slot::Light`].
    pub light: Vec2,
    /// [`Slot::Bsdf`].
    pub bsdf: Vec2,
    /// [`Slot::Lobe`].
    pub lobe: f32,
    /// [`Slot::Roulette`].
    pub roulette: f32,
}

/// One point of an infinite-dimensional point set: a pure function of (seed, stream, index, dimension).
///
/// Immutable and passed by value; no cursor is kept anywhere, so samples can be drawn in any order, on any thread,
/// and replayed alone.
pub trait Sampler: Copy + Send + Sync {
    /// Samples per pixel the point set was made for. Drawing more is allowed; the stratification ends there.
    fn spp(&self) -> u32;

    /// How many independent randomisations of the point set the samples are dealt to: index `i` is sample `i / R` of
    /// replicate `i mod R`. The scatter between replicates is the only honest error estimate of a QMC mean.
    fn replicates(&self) -> u32 {
        1
    }

    /// The point of `index` in `stream`. A stream is a pixel, or a light path; streams are independent.
    #[must_use]
    fn start(self, stream: u64, index: u64) -> Self;

    /// An independent point for a walk without a bound, such as one inside a medium. Equal keys give equal forks.
    #[must_use]
    fn fork(self, key: u32) -> Self;

    /// 32 random bits: the primitive from which floats derive.
    fn bits_1d(&self, dim: Dim) -> u32;

    /// Uniform in `[0, 1)`, a multiple of 2⁻²⁴.
    #[inline]
    fn get_1d(&self, dim: Dim) -> f32 {
        unit_f32(self.bits_1d(dim))
    }

    /// Uniform in `[0, 1)`, a multiple of 2⁻³².
    #[inline]
    fn get_1d_f64(&self, dim: Dim) -> f64 {
        f64::from(self.bits_1d(dim)) * (1.0 / 4_294_967_296.0)
    }

    /// Two numbers, jointly stratified: dimension `dim` and the next.
    fn get_2d(&self, dim: Dim) -> Vec2;

    /// The numbers of the vertex at `depth`.
    #[inline]
    fn bounce(&self, depth: u32) -> BounceDraws {
        BounceDraws {
            light: self.get_2d(Dim::bounce(depth, Slot::Light)),
            bsdf: self.get_2d(Dim::bounce(depth, Slot::Bsdf)),
            lobe: self.get_1d(Dim::bounce(depth, Slot::Lobe)),
            roulette: self.get_1d(Dim::bounce(depth, Slot::Roulette)),
        }
    }

    /// What kind of point set this is and its seed, for merging and resuming.
    fn fingerprint(&self, f: &mut Fingerprint);
}

/// The upper 24 bits as a float in `[0, 1)`; never 1, whatever the bits.
#[inline]
pub fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}
