/// What a file may ask for. Checked before anything is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest file, bytes.
    pub file_bytes: u64,
    /// Longest line of a text format, bytes.
    pub line_bytes: usize,
    /// Longest side of a picture, pixels.
    pub image_side: u32,
    /// Decoded bytes of one picture.
    pub image_bytes: u64,
    /// Decoded bytes of all pictures of a scene together.
    pub all_image_bytes: u64,
    /// Decoded bytes for each byte of a compressed picture that needs more than 16 MiB: beyond it the file is a bomb.
    pub image_ratio: u64,
    /// Numbers, strings, arrays and objects of a JSON text.
    pub json_values: usize,
    /// Longest chain of nodes from a root of a scene.
    pub node_depth: usize,
    /// Placements of meshes, after expansion.
    pub instances: u64,
    /// Vertices and indices that are read, each reading counted.
    pub vertices: u64,
    /// Triangles that emit light, those of an instance counted again.
    pub emitters: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 2 << 30,
            line_bytes: 1 << 20,
            image_side: 1 << 15,
            image_bytes: 1 << 30,
            all_image_bytes: 4 << 30,
            image_ratio: 1000,
            json_values: 1 << 23,
            node_depth: 4096,
            instances: 1 << 24,
            vertices: 1 << 31,
            emitters: 1 << 22,
        }
    }
}
