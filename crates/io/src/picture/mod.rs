//! Pictures in: textures, environments, and pictures to compare. Whatever a file claims, nothing is allocated that
//! its length and the limits do not allow.

mod budget;
mod decode;
mod error;
#[cfg(feature = "exr")]
mod exr;
mod format;
#[cfg(feature = "hdr")]
mod hdr;
#[cfg(any(feature = "gltf", feature = "obj", feature = "png"))]
mod raster;

use std::path::Path;

use etendue_texture::{Encoding, ImageTexture};

pub use budget::ImageBudget;
pub use error::PictureError;

use crate::Limits;
use crate::resolver::read_file;
use decode::decode;

/// A picture in linear Rec.709 radiance, top row first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green, blue of every pixel; not clamped, and what was no number in the file is none here.
    pub rgb: Vec<[f32; 3]>,
    /// Every channel of the file, those that are not colour too: `R`, `albedo.G`, `depth.Z`.
    pub layers: Vec<String>,
    /// What the file says about itself, as (name, value), in the order of the file.
    pub metadata: Vec<(String, String)>,
}

/// Decodes a picture as a texture: PNG, JPEG, Radiance HDR or OpenEXR by their first bytes, as far as their features
/// are built in. 8-bit pictures stay 8-bit with the channels they have (1 to 4); 16-bit ones become linear floats.
/// `encoding` says what the integers of PNG and JPEG mean; HDR and EXR are linear anyway.
///
/// # Errors
/// [`PictureError`]; sizes are checked against the budget before anything is allocated.
pub fn decode_texture(
    bytes: &[u8],
    encoding: Encoding,
    budget: &mut ImageBudget,
) -> Result<ImageTexture, PictureError> {
    decode(bytes, budget)?.into_texture(encoding, budget)
}

/// Reads a picture from a file (see [`read_picture_bytes`]).
///
/// # Errors
/// [`PictureError`], naming the file.
pub fn read_picture(path: &Path, limits: &Limits) -> Result<Picture, PictureError> {
    let name = path.display().to_string();
    let bytes = read_file(path, &name, limits.file_bytes)?;
    read_picture_bytes(&bytes, limits).map_err(|e| e.in_file(&name))
}

/// Reads a picture that is in memory: EXR (`R`, `G`, `B` under any prefix, or `Y`; the pixels of the data window),
/// HDR, and PNG or JPEG, whose integers are taken for sRGB.
///
/// # Errors
/// [`PictureError`].
pub fn read_picture_bytes(bytes: &[u8], limits: &Limits) -> Result<Picture, PictureError> {
    decode(bytes, &ImageBudget::new(limits))?.into_picture()
}
