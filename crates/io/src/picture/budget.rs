use crate::{Limits, PictureError};

/// Decoded bytes from which the ratio of pixels to file is looked at.
const RATIO_FROM: u64 = 16 << 20;

/// What the pictures of one scene may still take. Everything is checked before memory is asked for.
#[derive(Clone, Copy, Debug)]
pub struct ImageBudget {
    limits: Limits,
    left: u64,
}

impl ImageBudget {
    /// All that the limits allow.
    pub fn new(limits: &Limits) -> Self {
        Self { limits: *limits, left: limits.all_image_bytes }
    }

    /// What is left of `Limits::all_image_bytes`.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Decoded bytes that a picture may have, with what its file's length allows.
    pub(crate) fn check(
        &self,
        width: i64,
        height: i64,
        bytes_per_pixel: u64,
        file: u64,
    ) -> Result<u64, PictureError> {
        if width <= 0 || height <= 0 {
            return Err(PictureError::Empty { width, height });
        }
        let limit = self.limits.image_side;
        if width > i64::from(limit) || height > i64::from(limit) {
            return Err(PictureError::Side { width, height, limit });
        }
        let pixels = width.unsigned_abs().saturating_mul(height.unsigned_abs());
        let bytes = pixels.saturating_mul(bytes_per_pixel);
        if bytes > self.limits.image_bytes {
            return Err(PictureError::Bytes { width, height, bytes, limit: self.limits.image_bytes });
        }
        self.ratio(bytes, file)?;
        if bytes > self.left {
            return Err(PictureError::All { bytes, left: self.left });
        }
        Ok(bytes)
    }

    /// Whether `file` bytes can honestly be so many when decoded.
    pub(crate) fn ratio(&self, bytes: u64, file: u64) -> Result<(), PictureError> {
        let limit = self.limits.image_ratio;
        if bytes > RATIO_FROM && bytes > file.saturating_mul(limit) {
            return Err(PictureError::Ratio { bytes, file, limit });
        }
        Ok(())
    }

    /// Takes what a decoded picture keeps.
    pub(crate) fn spend(&mut self, bytes: u64) {
        self.left = self.left.saturating_sub(bytes);
    }
}

/// `n` times `value`, or an error where the memory cannot be had.
pub(crate) fn filled<T: Clone>(value: T, n: usize) -> Result<Vec<T>, PictureError> {
    let mut out = room(n)?;
    out.resize(n, value);
    Ok(out)
}

/// Room for `n` values, or an error where the memory cannot be had.
pub(crate) fn room<T>(n: usize) -> Result<Vec<T>, PictureError> {
    let mut out = Vec::new();
    out.try_reserve_exact(n)
        .map_err(|_| PictureError::Memory { bytes: (n as u64).saturating_mul(size_of::<T>() as u64) })?;
    Ok(out)
}

/// Whether a decoder that asks for memory without being able to fail will get this much.
#[cfg(any(feature = "exr", feature = "gltf", feature = "obj", feature = "png"))]
pub(crate) fn probe(bytes: u64) -> Result<(), PictureError> {
    room::<u8>(usize::try_from(bytes).unwrap_or(usize::MAX)).map(drop)
}
