//! OpenEXR. The header is read and judged here, and so is where each block lies; only sound blocks are handed to the
//! `exr` crate to be decompressed.

mod blocks;
mod header;
mod pixels;

pub(super) use pixels::read;

use crate::PictureError;

fn bad(place: impl Into<String>, reason: impl Into<String>) -> PictureError {
    PictureError::Decode { format: "OpenEXR", place: place.into(), reason: reason.into() }
}
