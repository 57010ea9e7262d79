//! Bytes to scenes and films to bytes: the only crate that knows file formats.
//!
//! Films as `.film` files, which keep every bit, name the samples they hold, and can be added up ([`FilmFile`]);
//! pictures in ([`read_picture`], [`decode_texture`]) and out.
//!
//! Features: `gltf` (glTF 2.0 in), `obj` (OBJ and MTL in), `ply` (PLY meshes in), `ies` (measured lamps in), `png`, `hdr` and `exr` (pictures in and out).
//! A file can be wrong in any way and yields an
//! error that says where and what, or a picture with warnings in its report; it cannot crash the program, make it
//! take memory that the file merely claims, or read outside the scene's folder. Pictures are written beside the
//! target and renamed, so a target is old or new, never half.
//!
//! ```
//! use etendue_io::fallback;
//! use etendue_scene::SceneBuilder;
//!
//! // A scene without camera or light can be looked at all the same.
//! let mut b = SceneBuilder::new();
//! fallback::light(&mut b);
//! let camera = fallback::camera(&b.bounds(), etendue_core::UVec2::new(64, 64));
//! # let _ = (camera, b);
//! ```
//!
//! Limits: deep and subsampled EXR is refused. MTL's specular highlights (`Ks`, `Ns`) have no physical meaning and are dropped with a warning. Concave
//! polygons are split as fans. Uses scene, camera, material, light, texture, bsdf, geometry and core.

#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::arithmetic_side_effects
    )
)]

mod atomic;
#[cfg(feature = "exr")]
mod exr_out;
pub mod fallback;
mod film;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(feature = "hdr")]
mod hdr_out;
#[cfg(feature = "ies")]
pub mod ies;
mod limits;
mod load;
mod loaded;
#[cfg(feature = "obj")]
pub mod obj;
#[cfg(any(feature = "gltf", feature = "obj", feature = "png", feature = "hdr", feature = "exr"))]
mod picture;
#[cfg(feature = "ply")]
pub mod ply;
#[cfg(feature = "png")]
mod png;
mod resolver;
mod tonemap;

pub use atomic::{WriteError, write_atomically};
#[cfg(feature = "exr")]
pub use exr_out::{ExrInfo, write_exr};
pub use film::{
    Digest, FilmFile, FilmInfo, FilmMergeError, FilmReadError, IndexRanges, SamplesError, film_bytes,
    read_film, read_film_bytes, write_film,
};
#[cfg(feature = "hdr")]
pub use hdr_out::write_hdr;
pub use limits::Limits;
pub use load::{LoadError, LoadOptions, load_scene, scene_endings};
pub use loaded::{LoadReport, Loaded, SceneCamera, View};
#[cfg(any(feature = "gltf", feature = "obj", feature = "png", feature = "hdr", feature = "exr"))]
pub use picture::{ImageBudget, Picture, PictureError, decode_texture, read_picture, read_picture_bytes};
#[cfg(feature = "png")]
pub use png::{PngError, png_bytes, write_png, write_png_pixels};
pub use resolver::{FolderResolver, NoFiles, ResolveError, Resolver, read_bytes};
pub use tonemap::ToneMap;
