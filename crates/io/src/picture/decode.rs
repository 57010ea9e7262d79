use etendue_core::math;
use etendue_texture::{Encoding, ImageTexture};

use super::budget::{ImageBudget, filled, room};
use super::format::Format;
use crate::{Picture, PictureError};

/// Numbers as they stand in the file.
#[allow(dead_code)] // Which of them occur depends on the features.
pub(super) enum Numbers {
    Bytes(Vec<u8>),
    Shorts(Vec<u16>),
    /// Linear.
    Floats(Vec<f32>),
}

/// A picture out of its file: row by row, 1 (gray), 2 (gray, alpha), 3 or 4 numbers a pixel.
pub(super) struct Decoded {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) channels: u32,
    pub(super) numbers: Numbers,
    pub(super) layers: Vec<String>,
    pub(super) metadata: Vec<(String, String)>,
}

pub(super) fn decode(bytes: &[u8], budget: &ImageBudget) -> Result<Decoded, PictureError> {
    match Format::of(bytes)? {
        #[cfg(any(feature = "gltf", feature = "obj", feature = "png"))]
        Format::Png => super::raster::png(bytes, budget),
        #[cfg(not(any(feature = "gltf", feature = "obj", feature = "png")))]
        Format::Png => Err(PictureError::NotBuilt { format: "PNG", feature: "png" }),
        #[cfg(any(feature = "gltf", feature = "obj"))]
        Format::Jpeg => super::raster::jpeg(bytes, budget),
        #[cfg(not(any(feature = "gltf", feature = "obj")))]
        Format::Jpeg => Err(PictureError::NotBuilt { format: "JPEG", feature: "gltf" }),
        #[cfg(feature = "hdr")]
        Format::Hdr => super::hdr::read(bytes, budget),
        #[cfg(not(feature = "hdr"))]
        Format::Hdr => Err(PictureError::NotBuilt { format: "Radiance HDR", feature: "hdr" }),
        #[cfg(feature = "exr")]
        Format::Exr => super::exr::read(bytes, budget),
        #[cfg(not(feature = "exr"))]
        Format::Exr => Err(PictureError::NotBuilt { format: "OpenEXR", feature: "exr" }),
    }
}

/// IEC 61966-2-1.
fn linear(v: f32) -> f32 {
    if v <= 0.040_45 { v / 12.92 } else { math::pow((v + 0.055) / 1.055, 2.4) }
}

/// What each integer from 0 to `most` means.
fn table(encoding: Encoding, most: u16) -> Vec<f32> {
    (0..=most)
        .map(|i| {
            let v = f32::from(i) / f32::from(most);
            if encoding == Encoding::Srgb { linear(v) } else { v }
        })
        .collect()
}

impl Decoded {
    fn has_alpha(&self) -> bool {
        matches!(self.channels, 2 | 4)
    }

    pub(super) fn into_texture(
        self,
        encoding: Encoding,
        budget: &mut ImageBudget,
    ) -> Result<ImageTexture, PictureError> {
        let (w, h, channels) = (self.width, self.height, self.channels);
        let has_alpha = self.has_alpha();
        let texture = match self.numbers {
            Numbers::Bytes(bytes) => {
                budget.spend(bytes.len() as u64);
                ImageTexture::from_u8(w, h, channels, bytes, encoding)?
            }
            Numbers::Shorts(shorts) => {
                let mut floats = room(shorts.len())?;
                let (color, plain) = (table(encoding, u16::MAX), table(Encoding::Linear, u16::MAX));
                for pixel in shorts.chunks_exact((channels as usize).max(1)) {
                    for (c, &v) in (1..).zip(pixel) {
                        let meaning = if has_alpha && c == channels { &plain } else { &color };
                        floats.push(meaning.get(usize::from(v)).copied().unwrap_or(0.0));
                    }
                }
                budget.spend((floats.len() as u64).saturating_mul(4));
                ImageTexture::from_f32(w, h, channels, floats)?
            }
            Numbers::Floats(floats) => {
                budget.spend((floats.len() as u64).saturating_mul(4));
                ImageTexture::from_f32(w, h, channels, floats)?
            }
        };
        Ok(texture)
    }

    pub(super) fn into_picture(self) -> Result<Picture, PictureError> {
        let channels = self.channels as usize;
        let rgb = match &self.numbers {
            Numbers::Bytes(v) => {
                let table = table(Encoding::Srgb, 255);
                spread(v, channels, |v| table.get(usize::from(v)).copied().unwrap_or(0.0))?
            }
            Numbers::Shorts(v) => {
                let table = table(Encoding::Srgb, u16::MAX);
                spread(v, channels, |v| table.get(usize::from(v)).copied().unwrap_or(0.0))?
            }
            Numbers::Floats(v) => spread(v, channels, |v| v)?,
        };
        let (layers, metadata) = (self.layers, self.metadata);
        Ok(Picture { width: self.width, height: self.height, rgb, layers, metadata })
    }
}

/// Gray three times, colour as it is, alpha left out.
fn spread<T: Copy>(
    numbers: &[T],
    channels: usize,
    meaning: impl Fn(T) -> f32,
) -> Result<Vec<[f32; 3]>, PictureError> {
    let channels = channels.max(1);
    let mut out = filled([0.0; 3], numbers.len().checked_div(channels).unwrap_or(0))?;
    for (to, from) in out.iter_mut().zip(numbers.chunks_exact(channels)) {
        *to = match *from {
            [y] | [y, _] => [meaning(y); 3],
            [r, g, b, ..] => [meaning(r), meaning(g), meaning(b)],
            [] => [0.0; 3],
        };
    }
    Ok(out)
}
