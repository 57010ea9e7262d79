/// Why pixels do not make a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A side of length zero.
    #[error("the image is {width} x {height} pixels: it needs at least one each way")]
    Empty {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// A side beyond [`ImageTexture::MAX_SIDE`](crate::ImageTexture::MAX_SIDE).
    #[error(
        "the image is {width} x {height} pixels: at most {max} are allowed each way; scale it down or split it"
    )]
    TooLarge {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// The limit.
        max: u32,
    },
    /// Something else than one to four numbers a pixel.
    #[error(
        "{channels} channels a pixel: 1 (gray), 2 (gray, alpha), 3 (RGB) or 4 (RGB, alpha) are understood"
    )]
    Channels {
        /// Channels given.
        channels: u32,
    },
    /// More or fewer numbers than the size says.
    #[error(
        "{width} x {height} pixels of {channels} channels are {expected} numbers, but {found} were given"
    )]
    SizeMismatch {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Numbers a pixel.
        channels: u32,
        /// Numbers that makes.
        expected: u64,
        /// Numbers given.
        found: u64,
    },
    /// A NaN or an infinity.
    #[error("pixel ({x}, {y}), channel {channel} is not a finite number; clamp the image before loading it")]
    NotFinite {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// Channel within the pixel.
        channel: u32,
    },
}
