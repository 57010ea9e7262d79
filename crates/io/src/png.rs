use std::path::Path;

use etendue_camera::Film;
use etendue_core::Spectrum;
use image::ImageEncoder;

use crate::{ToneMap, WriteError, write_atomically};

/// Writes a film's means as an 8-bit sRGB PNG.
///
/// # Errors
/// [`WriteError`]; the target is then as it was.
pub fn write_png(path: &Path, film: &Film, tone: &ToneMap) -> Result<(), WriteError> {
    let size = film.size();
    let pixels: Vec<u8> = film.to_rgb().into_iter().flat_map(|c| tone.bytes(Spectrum::from(c))).collect();
    let mut bytes = Vec::new();
    image::codecs::png::PngEncoder::new(&mut bytes)
        .write_image(&pixels, size.x, size.y, image::ExtendedColorType::Rgb8)
        .map_err(|e| WriteError::Encode { path: path.into(), reason: e.to_string() })?;
    write_atomically(path, &bytes)
}
