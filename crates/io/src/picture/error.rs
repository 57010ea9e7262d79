use etendue_texture::TextureError;

use crate::ResolveError;

/// Why bytes are not a picture that can be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The file itself cannot be read.
    #[error(transparent)]
    File(#[from] ResolveError),
    /// What is wrong with a named file.
    #[error("{file}: {source}")]
    In {
        /// The file.
        file: String,
        /// What is wrong.
        source: Box<Self>,
    },
    /// Another kind of file.
    #[error("{0}; PNG, JPEG, Radiance HDR and OpenEXR are read: convert it")]
    Unknown(&'static str),
    /// A kind of picture that this build does not read.
    #[error("{format} pictures are not built in; build with the feature '{feature}' or convert it")]
    NotBuilt {
        /// The kind.
        format: &'static str,
        /// What would build it in.
        feature: &'static str,
    },
    /// No pixels.
    #[error("{width} x {height} pixels are none")]
    Empty {
        /// Pixels across.
        width: i64,
        /// Pixels down.
        height: i64,
    },
    /// A side beyond the limit.
    #[error("{width} x {height} pixels; at most {limit} are allowed each way: scale it down")]
    Side {
        /// Pixels across.
        width: i64,
        /// Pixels down.
        height: i64,
        /// `Limits::image_side`.
        limit: u32,
    },
    /// A picture larger than allowed.
    #[error(
        "{width} x {height} pixels need {bytes} bytes, more than the {limit} allowed for one picture: scale it down"
    )]
    Bytes {
        /// Pixels across.
        width: i64,
        /// Pixels down.
        height: i64,
        /// Bytes they need.
        bytes: u64,
        /// `Limits::image_bytes`.
        limit: u64,
    },
    /// More than all pictures together may take.
    #[error(
        "its {bytes} bytes are more than the {left} that are left for all pictures together: scale some down"
    )]
    All {
        /// Bytes it needs.
        bytes: u64,
        /// What is left of `Limits::all_image_bytes`.
        left: u64,
    },
    /// Far more pixels than the file can hold.
    #[error(
        "{bytes} bytes of pixels out of a file of {file} are more than {limit} for one: it is damaged or made to fill memory"
    )]
    Ratio {
        /// Bytes of pixels.
        bytes: u64,
        /// Bytes of the file, or of one compressed block.
        file: u64,
        /// `Limits::image_ratio`.
        limit: u64,
    },
    /// More memory than can be had.
    #[error("{bytes} bytes for its pixels do not fit in memory")]
    Memory {
        /// What was asked for.
        bytes: u64,
    },
    /// Damage, or something that the decoder does not know.
    #[error("{format}, {place}: {reason}")]
    Decode {
        /// The kind.
        format: &'static str,
        /// Where in the file.
        place: String,
        /// What is wrong.
        reason: String,
    },
    /// Channels, but no colour among them.
    #[error("there is neither R, G, B nor Y among its channels ({channels}); name them so")]
    NoColour {
        /// The channels.
        channels: String,
    },
    /// Pixels that do not make a texture.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

impl PictureError {
    /// The same with the file's name before it.
    pub(crate) fn in_file(self, file: &str) -> Self {
        match self {
            // They name it already.
            Self::File(_) | Self::In { .. } => self,
            other => Self::In { file: file.into(), source: Box::new(other) },
        }
    }
}
