use std::sync::Arc;

use etendue_core::{Fingerprint, Spectrum, Vec3A};

use crate::checker::larger;
use crate::gradient::{gradient_noise, octave_seed, shift};
use crate::space::average;
use crate::{Channel, ScalarTex, Tex, TexPoint, TexSpace, Texture};

/// How octaves become a pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NoiseKind {
    /// Their weighted mean, in [−1, 1] with mean 0: fractional Brownian motion (Musgrave, Kolb & Mace 1989); gradient
    /// noise itself with one octave. Clouds, stains.
    #[default]
    Fractal,
    /// The weighted mean of their absolute values, in [0, 1]: turbulence (Perlin 1985), with creases where an octave
    /// changes sign. Marble, flames.
    Turbulence,
}

/// Random patterns without period: octaves of gradient noise (Perlin 1985, 2002), each `lacunarity` times as fine as the
/// one before and `gain` times as strong, as a mixture of two colours. A function of its parameters alone, with the same
/// bits on every machine.
///
/// The features of the first octave have about the size of a cell of `space`. Every octave's lattice is shifted by
/// itself, so that no two of them vanish in the same places.
///
/// ```
/// use etendue_core::Spectrum;
/// use etendue_texture::{Noise, Tex, TexSpace};
///
/// let stains = Noise::fractal(TexSpace::uv(10.0), 5, Spectrum::gray(0.2), Spectrum::gray(0.7));
/// let tex: Tex = stains.with_seed(3).into();
/// # assert!(!tex.is_constant());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Where the cells are.
    pub space: TexSpace,
    /// How octaves become a pattern.
    pub kind: NoiseKind,
    /// How many octaves: 1 to [`Noise::MOST_OCTAVES`]; what is outside counts as the range's end.
    pub octaves: u32,
    /// Ratio of the frequencies of successive octaves; 2 by default.
    pub lacunarity: f32,
    /// Ratio of their strengths, not negative; 1/2 by default.
    pub gain: f32,
    /// Another seed is another pattern of the same kind.
    pub seed: u32,
    /// Colour of −1 (of 0 for turbulence).
    pub low: Spectrum,
    /// Colour of 1.
    pub high: Spectrum,
}

impl Noise {
    /// The most octaves that are added up: the last is 2⁻¹⁵ of a cell fine.
    pub const MOST_OCTAVES: u32 = 16;

    /// The weighted mean of octaves, as a mixture of two colours.
    pub fn fractal(space: TexSpace, octaves: u32, low: Spectrum, high: Spectrum) -> Self {
        Self { space, kind: NoiseKind::Fractal, octaves, lacunarity: 2.0, gain: 0.5, seed: 0, low, high }
    }

    /// The weighted mean of the octaves' absolute values, as a mixture of two colours.
    pub fn turbulence(space: TexSpace, octaves: u32, low: Spectrum, high: Spectrum) -> Self {
        Self { kind: NoiseKind::Turbulence, ..Self::fractal(space, octaves, low, high) }
    }

    /// Another pattern of the same kind.
    #[must_use]
    pub fn with_seed(self, seed: u32) -> Self {
        Self { seed, ..self }
    }

    /// The number at a point of the pattern's space: in [−1, 1] for [`NoiseKind::Fractal`], in [0, 1] for
    /// [`NoiseKind::Turbulence`]. An octave whose coordinates are beyond 2²³, or no numbers, is 0.
    pub fn value(&self, p: Vec3A) -> f32 {
        let gain = if self.gain > 0.0 { self.gain.clamp(0.0, 1e6) } else { 0.0 };
        let (mut sum, mut all, mut weight, mut frequency) = (0.0f32, 0.0f32, 1.0f32, 1.0f32);
        for octave in 0..self.octaves.clamp(1, Self::MOST_OCTAVES) {
            let seed = octave_seed(self.seed, octave);
            let n = gradient_noise(p * frequency + shift(seed), seed);
            sum += weight * if self.kind == NoiseKind::Turbulence { n.abs() } else { n };
            all += weight;
            // Scaled so that no gain overflows.
            if gain > 1.0 {
                (sum, all) = (sum / gain, all / gain);
            } else {
                weight *= gain;
            }
            frequency *= self.lacunarity;
        }
        (sum / all).clamp(-1.0, 1.0)
    }

    /// The share of `high`, in [0, 1].
    #[inline]
    fn share(&self, p: Vec3A) -> f32 {
        let value = self.value(p);
        match self.kind {
            NoiseKind::Fractal => 0.5 + 0.5 * value,
            NoiseKind::Turbulence => value,
        }
    }

    fn color(&self, share: f32) -> Spectrum {
        self.low.lerp(self.high, share)
    }
}

impl Texture for Noise {
    fn eval(&self, at: &TexPoint<'_>) -> Spectrum {
        at.count();
        let c = self.color(self.share(self.space.point(at)));
        // A mixture may be rounded beyond its ends.
        let (least, most) = (self.min(), self.max());
        -larger(-larger(c, least), -most)
    }

    fn mean(&self) -> Spectrum {
        self.color(average(&self.space, |p| self.share(p)))
    }

    fn max(&self) -> Spectrum {
        larger(self.low, self.high)
    }

    fn min(&self) -> Spectrum {
        -larger(-self.low, -self.high)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("noise");
        self.space.fingerprint(f);
        f.u64(self.kind as u64);
        f.u64(u64::from(self.octaves) << 32 | u64::from(self.seed));
        f.floats(&[self.lacunarity, self.gain]);
        f.floats(&self.low.to_array());
        f.floats(&self.high.to_array());
    }

    fn bytes(&self) -> usize {
        size_of::<Self>()
    }
}

impl From<Noise> for Tex {
    fn from(noise: Noise) -> Self {
        Self::Open(Arc::new(noise))
    }
}

impl From<Noise> for ScalarTex {
    /// Its red channel.
    fn from(noise: Noise) -> Self {
        Self::Open { tex: Arc::new(noise), channel: Channel::R, scale: 1.0 }
    }
}
