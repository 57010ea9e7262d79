//! PNG and JPEG, decoded by `image` into memory that was asked for here.

use std::io::Cursor;

use image::{ColorType, ImageDecoder, ImageError};

use super::budget::{ImageBudget, filled, probe};
use super::decode::{Decoded, Numbers};
use crate::PictureError;

pub(super) fn png(bytes: &[u8], budget: &ImageBudget) -> Result<Decoded, PictureError> {
    // The header comes first and is fixed; the decoder itself would already ask for a row.
    let side = |at: usize| {
        let field = bytes.get(at..at.saturating_add(4)).and_then(|b| <[u8; 4]>::try_from(b).ok());
        field.map(|b| i64::from(u32::from_be_bytes(b)))
    };
    if bytes.get(12..16) != Some(b"IHDR") {
        return Err(bad("PNG", "its header is missing"));
    }
    let (Some(width), Some(height)) = (side(16), side(20)) else {
        return Err(bad("PNG", "its header is cut off"));
    };
    budget.check(width, height, 1, bytes.len() as u64)?;
    let mut limits = image::Limits::default();
    // Rows and chunks of the decoder's own; pixels go into memory that is asked for below.
    limits.max_alloc = Some(64 << 20);
    let decoder = image::codecs::png::PngDecoder::with_limits(Cursor::new(bytes), limits)
        .map_err(|e| failed("PNG", &e))?;
    finish("PNG", decoder, bytes, budget, 1)
}

#[cfg(any(feature = "gltf", feature = "obj"))]
pub(super) fn jpeg(bytes: &[u8], budget: &ImageBudget) -> Result<Decoded, PictureError> {
    let decoder =
        image::codecs::jpeg::JpegDecoder::new(Cursor::new(bytes)).map_err(|e| failed("JPEG", &e))?;
    // A progressive file keeps 16-bit coefficients of every component beside the pixels.
    finish("JPEG", decoder, bytes, budget, 4)
}

fn finish(
    format: &'static str,
    decoder: impl ImageDecoder,
    bytes: &[u8],
    budget: &ImageBudget,
    scratch: u64,
) -> Result<Decoded, PictureError> {
    let (width, height) = decoder.dimensions();
    let color = decoder.color_type();
    // 16-bit numbers become floats in a texture.
    let kept = u64::from(color.bytes_per_pixel()).saturating_mul(if is_short(color) { 2 } else { 1 });
    budget.check(i64::from(width), i64::from(height), kept, bytes.len() as u64)?;
    let total = decoder.total_bytes();
    if scratch > 1 {
        probe(total.saturating_mul(scratch))?;
    }
    let mut pixels = filled(0u8, usize::try_from(total).unwrap_or(usize::MAX))?;
    decoder.read_image(&mut pixels).map_err(|e| failed(format, &e))?;
    let channels = u32::from(color.channel_count());
    let numbers = if is_short(color) {
        let mut shorts = super::budget::room(pixels.len().div_ceil(2))?;
        shorts.extend(pixels.chunks_exact(2).map(|b| b.try_into().map_or(0, u16::from_ne_bytes)));
        Numbers::Shorts(shorts)
    } else {
        Numbers::Bytes(pixels)
    };
    let names: &[&str] = match channels {
        1 => &["Y"],
        2 => &["Y", "A"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    };
    let layers = names.iter().map(|&n| n.to_owned()).collect();
    let metadata = vec![("format".into(), format.into())];
    Ok(Decoded { width, height, channels, numbers, layers, metadata })
}

fn is_short(color: ColorType) -> bool {
    matches!(color, ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16)
}

fn bad(format: &'static str, reason: &str) -> PictureError {
    PictureError::Decode { format, place: "at its beginning".into(), reason: reason.into() }
}

fn failed(format: &'static str, e: &ImageError) -> PictureError {
    PictureError::Decode { format, place: "decoding".into(), reason: e.to_string() }
}
