use std::sync::Arc;

use etendue_core::{Fingerprint, Spectrum, Vec2};

use crate::image::color;
use crate::{ImageTexture, TexPoint, Texture, UvTransform};

/// An image as one parameter uses it: which coordinates, mapped how, times what.
#[derive(Clone, Debug)]
pub struct ImageUse {
    /// The image, shared by all its users.
    pub image: Arc<ImageTexture>,
    /// Which set of texture coordinates: 0 or 1.
    pub uv_set: u8,
    /// Map of the coordinates; `None` leaves them.
    pub transform: Option<UvTransform>,
    /// Factor on the colour.
    pub scale: Spectrum,
}

impl ImageUse {
    /// By the first set of coordinates as they are, times 1.
    pub fn new(image: Arc<ImageTexture>) -> Self {
        Self { image, uv_set: 0, transform: None, scale: Spectrum::ONE }
    }

    /// Where in the image a point looks.
    #[inline]
    pub fn uv(&self, at: &TexPoint<'_>) -> Vec2 {
        let uv = if self.uv_set == 0 { at.uv[0] } else { at.uv[1] };
        self.transform.map_or(uv, |t| t.apply(uv))
    }

    /// What decides the look-up, for comparing scenes.
    pub fn fingerprint(&self, f: &mut Fingerprint) {
        f.u64(u64::from(self.uv_set));
        self.transform.unwrap_or_default().fingerprint(f);
        f.floats(&self.scale.to_array());
        self.image.fingerprint(f);
    }
}

/// A colour parameter, by value: the closed set of what is built in, and a door for other textures.
#[derive(Clone)]
pub enum Tex {
    /// The same everywhere; looking it up is free and not counted.
    Constant(Spectrum),
    /// An image.
    Image(ImageUse),
    /// A procedural texture, or a user's.
    Open(Arc<dyn Texture>),
}

impl Tex {
    /// The same gray everywhere.
    pub fn gray(v: f32) -> Self {
        Self::Constant(Spectrum::gray(v))
    }

    /// An image by the first set of texture coordinates.
    pub fn image(image: Arc<ImageTexture>) -> Self {
        Self::Image(ImageUse::new(image))
    }

    /// Whether the value is the same everywhere.
    #[inline]
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// The texture times a colour.
    #[must_use]
    pub fn scaled(self, factor: Spectrum) -> Self {
        match self {
            Self::Constant(c) => Self::Constant(c * factor),
            Self::Image(mut i) => {
                i.scale *= factor;
                Self::Image(i)
            }
            Self::Open(tex) if factor == Spectrum::ONE => Self::Open(tex),
            Self::Open(tex) => Self::Open(Arc::new(Scaled { tex, factor })),
        }
    }
}

impl std::fmt::Debug for Tex {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Constant(c) => write!(f, "Constant({c:?})"),
            Self::Image(i) => i.fmt(f),
            Self::Open(t) => write!(f, "Open(mean {:?})", t.mean()),
        }
    }
}

impl From<Spectrum> for Tex {
    fn from(value: Spectrum) -> Self {
        Self::Constant(value)
    }
}

impl From<ImageUse> for Tex {
    fn from(image: ImageUse) -> Self {
        Self::Image(image)
    }
}

impl Texture for Tex {
    #[inline]
    fn eval(&self, at: &TexPoint<'_>) -> Spectrum {
        match self {
            Self::Constant(c) => *c,
            Self::Image(i) => {
                at.count();
                color(i.image.eval4(i.uv(at))) * i.scale
            }
            Self::Open(t) => t.eval(at),
        }
    }

    fn mean(&self) -> Spectrum {
        match self {
            Self::Constant(c) => *c,
            Self::Image(i) => i.image.mean() * i.scale,
            Self::Open(t) => t.mean(),
        }
    }

    fn max(&self) -> Spectrum {
        match self {
            Self::Constant(c) => *c,
            Self::Image(i) => scaled_max(i.image.min(), i.image.max(), i.scale),
            Self::Open(t) => t.max(),
        }
    }

    fn min(&self) -> Spectrum {
        match self {
            Self::Constant(c) => *c,
            Self::Image(i) => -scaled_max(-i.image.max(), -i.image.min(), i.scale),
            Self::Open(t) => t.min(),
        }
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        match self {
            Self::Constant(c) => {
                f.tag("constant");
                f.floats(&c.to_array());
            }
            Self::Image(i) => i.fingerprint(f),
            Self::Open(t) => t.fingerprint(f),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Constant(_) => 0,
            Self::Image(i) => i.image.bytes(),
            Self::Open(t) => t.bytes(),
        }
    }
}

/// The largest value after scaling; a negative factor turns the smallest into the largest.
fn scaled_max(min: Spectrum, max: Spectrum, scale: Spectrum) -> Spectrum {
    let pick = |lo: f32, hi: f32, s: f32| if s < 0.0 { lo * s } else { hi * s };
    Spectrum::rgb(
        pick(min.r(), max.r(), scale.r()),
        pick(min.g(), max.g(), scale.g()),
        pick(min.b(), max.b(), scale.b()),
    )
}

/// A user's texture times a colour that is not negative.
struct Scaled {
    tex: Arc<dyn Texture>,
    factor: Spectrum,
}

impl Texture for Scaled {
    fn eval(&self, at: &TexPoint<'_>) -> Spectrum {
        self.tex.eval(at) * self.factor
    }

    fn mean(&self) -> Spectrum {
        self.tex.mean() * self.factor
    }

    fn max(&self) -> Spectrum {
        self.tex.max() * self.factor
    }

    fn min(&self) -> Spectrum {
        self.tex.min() * self.factor
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("scaled");
        f.floats(&self.factor.to_array());
        self.tex.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.tex.bytes()
    }
}
