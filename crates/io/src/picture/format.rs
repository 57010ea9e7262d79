use crate::PictureError;

/// Kinds of pictures, told by their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Png,
    Jpeg,
    Hdr,
    Exr,
}

impl Format {
    pub(super) fn of(bytes: &[u8]) -> Result<Self, PictureError> {
        let webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
        match bytes {
            b if b.starts_with(b"\x89PNG\r\n\x1a\n") => Ok(Self::Png),
            b if b.starts_with(b"\xff\xd8\xff") => Ok(Self::Jpeg),
            b if b.starts_with(b"#?RADIANCE") || b.starts_with(b"#?RGBE") => Ok(Self::Hdr),
            b if b.starts_with(b"\x76\x2f\x31\x01") => Ok(Self::Exr),
            [] => Err(PictureError::Unknown("the file is empty")),
            _ if webp => Err(PictureError::Unknown("this is a WebP picture")),
            b if b.starts_with(b"\xabKTX") => Err(PictureError::Unknown("this is a KTX texture")),
            b if b.starts_with(b"GIF8") => Err(PictureError::Unknown("this is a GIF picture")),
            b if b.starts_with(b"II*\0") || b.starts_with(b"MM\0*") => {
                Err(PictureError::Unknown("this is a TIFF picture"))
            }
            b if b.starts_with(b"version https://git-lfs") => {
                Err(PictureError::Unknown("this is a Git LFS pointer, not the picture itself"))
            }
            _ => Err(PictureError::Unknown("its first bytes are those of no known picture")),
        }
    }
}
