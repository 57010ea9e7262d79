/// What a file may ask for. Checked before anything is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest file, bytes.
    pub file_bytes: u64,
    /// Longest line of a text format, bytes.
    pub line_bytes: usize,
    /// Longest side of a texture, pixels.
    pub image_side: u32,
    /// Decoded bytes of one texture.
    pub image_bytes: u64,
    /// Decoded bytes of all textures together.
    pub all_image_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 2 << 30,
            line_bytes: 1 << 20,
            image_side: 1 << 15,
            image_bytes: 1 << 30,
            all_image_bytes: 4 << 30,
        }
    }
}
