use std::sync::Arc;

use etendue_core::{Fingerprint, Spectrum};

use crate::{Channel, ImageUse, TexPoint, Texture};

/// A number that varies over a surface: one channel of a texture, times a factor. Roughness, opacity.
#[derive(Clone)]
pub enum ScalarTex {
    /// The same everywhere; looking it up is free and not counted.
    Constant(f32),
    /// One channel of an image times `scale` (the image's own colour factor is not applied).
    Image {
        /// Image and coordinates.
        image: ImageUse,
        /// Channel read.
        channel: Channel,
        /// Factor, not negative.
        scale: f32,
    },
    /// One channel of a procedural texture or a user's, which has no alpha (it reads as 1).
    Open {
        /// The texture.
        tex: Arc<dyn Texture>,
        /// Channel read.
        channel: Channel,
        /// Factor, not negative.
        scale: f32,
    },
}

fn channel_of(s: Spectrum, channel: Channel) -> f32 {
    match channel {
        Channel::R => s.r(),
        Channel::G => s.g(),
        Channel::B => s.b(),
        Channel::A => 1.0,
    }
}

impl ScalarTex {
    /// One channel of an image as it is.
    pub fn image(image: ImageUse, channel: Channel) -> Self {
        Self::Image { image, channel, scale: 1.0 }
    }

    /// The same times a factor, which must not be negative.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        match self {
            Self::Constant(v) => Self::Constant(v * factor),
            Self::Image { image, channel, scale } => Self::Image { image, channel, scale: scale * factor },
            Self::Open { tex, channel, scale } => Self::Open { tex, channel, scale: scale * factor },
        }
    }

    /// Whether the value is the same everywhere.
    #[inline]
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// The value at a point.
    #[inline]
    pub fn eval(&self, at: &TexPoint<'_>) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Image { image, channel, scale } => {
                at.count();
                image.image.eval_channel(image.uv(at), *channel) * scale
            }
            Self::Open { tex, channel, scale } => channel_of(tex.eval(at), *channel) * scale,
        }
    }

    /// The average over the unit square.
    pub fn mean(&self) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Image { image, channel, scale } => image.image.mean4()[*channel as usize] * scale,
            Self::Open { tex, channel, scale } => channel_of(tex.mean(), *channel) * scale,
        }
    }

    /// A bound that no value falls below.
    pub fn min(&self) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Image { image, channel, scale } => image.image.min4()[*channel as usize] * scale,
            Self::Open { tex, channel, scale } => channel_of(tex.min(), *channel) * scale,
        }
    }

    /// A bound that no value exceeds.
    pub fn max(&self) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Image { image, channel, scale } => image.image.max4()[*channel as usize] * scale,
            Self::Open { tex, channel, scale } => channel_of(tex.max(), *channel) * scale,
        }
    }

    /// What decides the value, for comparing scenes.
    pub fn fingerprint(&self, f: &mut Fingerprint) {
        match self {
            Self::Constant(v) => {
                f.tag("number");
                f.f32(*v);
            }
            Self::Image { image, channel, scale } => {
                f.u64(*channel as u64);
                f.f32(*scale);
                image.fingerprint(f);
            }
            Self::Open { tex, channel, scale } => {
                f.u64(*channel as u64);
                f.f32(*scale);
                tex.fingerprint(f);
            }
        }
    }

    /// Bytes held, for the memory report; an image is counted by each of its users.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Constant(_) => 0,
            Self::Image { image, .. } => image.image.bytes(),
            Self::Open { tex, .. } => tex.bytes(),
        }
    }
}

impl std::fmt::Debug for ScalarTex {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Constant(v) => write!(f, "Constant({v})"),
            Self::Image { image, channel, scale } => write!(f, "{image:?}.{channel:?} * {scale}"),
            Self::Open { tex, channel, scale } => {
                write!(f, "Open(mean {:?}).{channel:?} * {scale}", tex.mean())
            }
        }
    }
}

impl From<f32> for ScalarTex {
    fn from(value: f32) -> Self {
        Self::Constant(value)
    }
}
