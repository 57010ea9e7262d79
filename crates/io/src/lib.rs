//! Bytes to scenes and films to bytes: the only crate that knows file formats.
//!
//! Features: `obj` (OBJ and MTL in), `ply` (PLY meshes in), `png` and `exr` (pictures out). A file can be wrong in any way and yields an
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
//! Limits: MTL's specular highlights (`Ks`, `Ns`) have no physical meaning and are dropped with a warning. Concave
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
#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects)]
mod exr_out;
#[allow(clippy::arithmetic_side_effects)]
pub mod fallback;
#[cfg(feature = "gltf")]
mod gltf;
mod limits;
mod loaded;
#[cfg(feature = "obj")]
pub mod obj;
#[cfg(feature = "ply")]
pub mod ply;
#[cfg(feature = "png")]
mod png;
mod resolver;
#[allow(clippy::arithmetic_side_effects)]
mod tonemap;

pub use atomic::{WriteError, write_atomically};
#[cfg(feature = "exr")]
pub use exr_out::{ExrInfo, write_exr};
pub use limits::Limits;
pub use loaded::{LoadReport, Loaded, SceneCamera, View};
#[cfg(feature = "png")]
pub use png::write_png;
pub use resolver::{FolderResolver, NoFiles, ResolveError, Resolver};
pub use tonemap::ToneMap;
