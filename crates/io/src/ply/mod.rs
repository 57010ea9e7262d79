//! PLY meshes (Greg Turk, "The PLY Polygon File Format", 1994): text and binary, faces as polygons or as strips of
//! triangles.
//!
//! Vertices have `x y z` and may have `nx ny nz`, texture coordinates (`u v`, `s t`, `texture_u texture_v`; `v` grows
//! upward) and colours (`red green blue alpha`). Colours in whole numbers are taken for sRGB, as scanners and modelling
//! programs write them, colours in fractions for linear. Polygons are split as fans. Whatever else a file has is
//! skipped by its declared size.

mod error;
mod header;
mod mesh;
mod source;
mod vertices;

use std::path::Path;

use etendue_scene::SceneBuilder;

pub use error::PlyError;

use crate::resolver::read_file;
use crate::{Limits, Loaded};

/// Adds a PLY file to a scene: one mesh, gray or in the colours of its vertices.
///
/// # Errors
/// [`PlyError`], naming the file and the place in it.
pub fn load(path: &Path, limits: &Limits, builder: &mut SceneBuilder) -> Result<Loaded, PlyError> {
    let name = path.display().to_string();
    let bytes = read_file(path, &name, limits.file_bytes)?;
    read(&name, &bytes, limits, builder)
}

/// Adds a PLY file that is in memory; `name` stands for it in messages.
///
/// # Errors
/// As [`load`].
pub fn read(
    name: &str,
    bytes: &[u8],
    limits: &Limits,
    builder: &mut SceneBuilder,
) -> Result<Loaded, PlyError> {
    mesh::read(name, bytes, limits, builder)
}
