use etendue_core::{Fingerprint, Spectrum, Vec2, Vec4};

use crate::lookup::{Filter, Wrap};
use crate::texels::{Encoding, Texels};
use crate::{TexPoint, Texture, TextureError};

/// One number of a texel. Gray images have it as red, green and blue alike; where there is no alpha it is 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// Red.
    R,
    /// Green.
    G,
    /// Blue.
    B,
    /// Alpha, never decoded by a curve.
    A,
}

/// An image as a texture. `u` runs along rows, `v` down columns, the corner of the first texel is (0, 0).
///
/// Values are decoded before they are filtered. Looking up any coordinate, even NaN, gives a value between
/// [`ImageTexture::min4`] and [`ImageTexture::max4`].
pub struct ImageTexture {
    width: u32,
    height: u32,
    channels: u32,
    texels: Texels,
    wrap: [Wrap; 2],
    filter: Filter,
    mean: Vec4,
    min: Vec4,
    max: Vec4,
}

impl std::fmt::Debug for ImageTexture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "ImageTexture({} x {} x {}, {:?}, {:?})",
            self.width, self.height, self.channels, self.wrap, self.filter
        )
    }
}

impl ImageTexture {
    /// The longest side accepted.
    pub const MAX_SIDE: u32 = 1 << 16;

    /// From 8-bit numbers, top row first, `channels` (1 to 4) a pixel; they stay 8-bit in memory. Repeats, bilinear.
    ///
    /// # Errors
    /// [`TextureError`] where a side is 0 or beyond [`ImageTexture::MAX_SIDE`], or the count of numbers does not fit.
    pub fn from_u8(
        width: u32,
        height: u32,
        channels: u32,
        data: Vec<u8>,
        encoding: Encoding,
    ) -> Result<Self, TextureError> {
        check_size(width, height, channels, data.len())?;
        Ok(Self::new(width, height, channels, Texels::bytes(data, encoding)))
    }

    /// From linear floats, top row first, `channels` (1 to 4) a pixel. Repeats, bilinear.
    ///
    /// # Errors
    /// As [`ImageTexture::from_u8`], and where a number is not finite.
    pub fn from_f32(width: u32, height: u32, channels: u32, data: Vec<f32>) -> Result<Self, TextureError> {
        check_size(width, height, channels, data.len())?;
        if let Some(i) = data.iter().position(|v| !v.is_finite()) {
            let (pixel, channel) = (i as u64 / u64::from(channels), i as u64 % u64::from(channels));
            let (x, y) = (pixel % u64::from(width), pixel / u64::from(width));
            return Err(TextureError::NotFinite { x: x as u32, y: y as u32, channel: channel as u32 });
        }
        Ok(Self::new(width, height, channels, Texels::Floats(data.into_boxed_slice())))
    }

    fn new(width: u32, height: u32, channels: u32, texels: Texels) -> Self {
        let mut image = Self {
            width,
            height,
            channels,
            texels,
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Bilinear,
            mean: Vec4::ZERO,
            min: Vec4::INFINITY,
            max: Vec4::NEG_INFINITY,
        };
        let (mut sum, mut min, mut max) = ([0.0f64; 4], image.min, image.max);
        for y in 0..height {
            for x in 0..width {
                let t = image.texel(x, y);
                min = Vec4::select(t.cmplt(min), t, min);
                max = Vec4::select(t.cmpgt(max), t, max);
                for (s, v) in sum.iter_mut().zip(t.to_array()) {
                    *s += f64::from(v);
                }
            }
        }
        let count = f64::from(width) * f64::from(height);
        image.mean = Vec4::from_array(sum.map(|s| (s / count) as f32));
        (image.min, image.max) = (min, max);
        image
    }

    /// The same image with other borders, along `u` and along `v`.
    #[must_use]
    pub fn with_wrap(mut self, u: Wrap, v: Wrap) -> Self {
        self.wrap = [u, v];
        self
    }

    /// The same image with another filter.
    #[must_use]
    pub fn with_filter(mut self, filter: Filter) -> Self {
        self.filter = filter;
        self
    }

    /// Texels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Texels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Numbers a texel.
    pub fn channels(&self) -> u32 {
        self.channels
    }

    /// Red, green, blue and alpha of one texel, decoded; black and transparent outside the image.
    #[inline]
    pub fn texel(&self, x: u32, y: u32) -> Vec4 {
        if x >= self.width || y >= self.height {
            return Vec4::ZERO;
        }
        let [texel] = self.texels.texels([self.offset(x, y)], self.channels as usize);
        texel
    }

    #[inline]
    fn offset(&self, x: u32, y: u32) -> usize {
        (y as usize * self.width as usize + x as usize) * self.channels as usize
    }

    /// Red, green, blue and alpha at a point, decoded and filtered.
    #[inline]
    pub fn eval4(&self, uv: Vec2) -> Vec4 {
        if self.filter == Filter::Nearest {
            return self
                .texel(self.wrap[0].nearest(uv.x, self.width), self.wrap[1].nearest(uv.y, self.height));
        }
        let (x, y) = (self.wrap[0].pair(uv.x, self.width), self.wrap[1].pair(uv.y, self.height));
        // Written so that equal neighbours give themselves exactly, and nothing beyond the larger one.
        let mix = |a: Vec4, b: Vec4, t: f32| a + (b - a) * t;
        let places = [(x.lo, y.lo), (x.hi, y.lo), (x.lo, y.hi), (x.hi, y.hi)].map(|(x, y)| self.offset(x, y));
        let [a, b, c, d] = self.texels.texels(places, self.channels as usize);
        let (top, bottom) = (mix(a, b, x.t), mix(c, d, x.t));
        mix(top, bottom, y.t)
    }

    /// One channel at a point, decoded and filtered.
    #[inline]
    pub fn eval_channel(&self, uv: Vec2, channel: Channel) -> f32 {
        let (place, is_alpha) = match (channel, self.channels) {
            (Channel::A, 1 | 3) => return 1.0,
            (Channel::A, n) => (n as usize - 1, true),
            (_, 1 | 2) | (Channel::R, _) => (0, false),
            (Channel::G, _) => (1, false),
            (Channel::B, _) => (2, false),
        };
        let at = |x: u32, y: u32| self.texels.number(self.offset(x, y) + place, is_alpha);
        if self.filter == Filter::Nearest {
            return at(self.wrap[0].nearest(uv.x, self.width), self.wrap[1].nearest(uv.y, self.height));
        }
        let (x, y) = (self.wrap[0].pair(uv.x, self.width), self.wrap[1].pair(uv.y, self.height));
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let top = mix(at(x.lo, y.lo), at(x.hi, y.lo), x.t);
        mix(top, mix(at(x.lo, y.hi), at(x.hi, y.hi), x.t), y.t)
    }

    /// The average over the unit square; the same for every wrap and filter.
    pub fn mean4(&self) -> Vec4 {
        self.mean
    }

    /// The smallest value of each channel.
    pub fn min4(&self) -> Vec4 {
        self.min
    }

    /// The largest value of each channel.
    pub fn max4(&self) -> Vec4 {
        self.max
    }
}

/// The colour of four channels.
#[inline]
pub(crate) fn color(v: Vec4) -> Spectrum {
    Spectrum::rgb(v.x, v.y, v.z)
}

impl Texture for ImageTexture {
    #[inline]
    fn eval(&self, at: &TexPoint<'_>) -> Spectrum {
        at.count();
        color(self.eval4(at.uv[0]))
    }

    fn mean(&self) -> Spectrum {
        color(self.mean)
    }

    fn max(&self) -> Spectrum {
        color(self.max)
    }

    fn min(&self) -> Spectrum {
        color(self.min)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("image");
        for v in [self.width, self.height, self.channels] {
            f.u64(u64::from(v));
        }
        for w in self.wrap {
            f.u64(w as u64);
        }
        f.u64(self.filter as u64);
        self.texels.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        size_of::<Self>() + self.texels.size()
    }
}

fn check_size(width: u32, height: u32, channels: u32, found: usize) -> Result<(), TextureError> {
    if width == 0 || height == 0 {
        return Err(TextureError::Empty { width, height });
    }
    let max = ImageTexture::MAX_SIDE;
    if width > max || height > max {
        return Err(TextureError::TooLarge { width, height, max });
    }
    if !(1..=4).contains(&channels) {
        return Err(TextureError::Channels { channels });
    }
    let (expected, found) = (u64::from(width) * u64::from(height) * u64::from(channels), found as u64);
    if expected != found {
        return Err(TextureError::SizeMismatch { width, height, channels, expected, found });
    }
    Ok(())
}
