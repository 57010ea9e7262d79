use std::path::Path;

use etendue_camera::Film;
use etendue_core::Spectrum;
use image::ImageEncoder;

use crate::{ToneMap, WriteError, write_atomically};

/// Why pixels are not a PNG.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PngError {
    /// More or fewer pixels than the size says.
    #[error("{given} pixels for a picture of {}x{}", .size[0], .size[1])]
    Pixels {
        /// Width and height.
        size: [u32; 2],
        /// Pixels handed over.
        given: usize,
    },
    /// The encoder refused; a side of 0 or of more than 2³¹ − 1 is one reason.
    #[error("{0}")]
    Encode(String),
}

/// Writes a film's means as an 8-bit sRGB PNG.
///
/// # Errors
/// [`WriteError`]; the target is then as it was.
pub fn write_png(path: &Path, film: &Film, tone: &ToneMap) -> Result<(), WriteError> {
    let size = film.size();
    let pixels: Vec<[u8; 3]> = film.to_rgb().into_iter().map(|c| tone.bytes(Spectrum::from(c))).collect();
    write_png_pixels(path, [size.x, size.y], &pixels)
}

/// Writes sRGB pixels, row by row from the top, as an 8-bit PNG of `size` (width, height).
///
/// # Errors
/// [`WriteError`], [`WriteError::Encode`] where the pixels do not fill the size; the target is then as it was.
pub fn write_png_pixels(path: &Path, size: [u32; 2], rgb: &[[u8; 3]]) -> Result<(), WriteError> {
    let bytes =
        png_bytes(size, rgb).map_err(|e| WriteError::Encode { path: path.into(), reason: e.to_string() })?;
    write_atomically(path, &bytes)
}

/// The bytes of such a PNG file.
///
/// # Errors
/// The pixels do not fill the size, or the encoder refuses.
pub fn png_bytes(size: [u32; 2], rgb: &[[u8; 3]]) -> Result<Vec<u8>, PngError> {
    let [width, height] = size;
    // The encoder takes the number of bytes for granted.
    if u64::from(width).checked_mul(u64::from(height)) != u64::try_from(rgb.len()).ok() {
        return Err(PngError::Pixels { size, given: rgb.len() });
    }
    let mut bytes = Vec::new();
    image::codecs::png::PngEncoder::new(&mut bytes)
        .write_image(rgb.as_flattened(), width, height, image::ExtendedColorType::Rgb8)
        .map_err(|e| PngError::Encode(e.to_string()))?;
    Ok(bytes)
}
