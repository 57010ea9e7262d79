use std::path::{Path, PathBuf};

use etendue_scene::SceneBuilder;

use crate::{Limits, Loaded};

/// What the numbers of a file's materials mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MaterialMeaning {
    /// glTF's appendix B, to the letter.
    GltfB,
    /// Our energy-preserving reading of it.
    #[default]
    Default,
}

/// How a scene file is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// What it may ask for.
    pub limits: Limits,
    /// What its materials mean.
    pub materials: MaterialMeaning,
    /// Which of its variants to show, by name.
    pub variant: Option<String>,
    /// Leaves out what is broken, with a warning, instead of refusing the file.
    pub lenient: bool,
}

/// Why a file is not a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// Another kind of file.
    #[error("{path}: the ending '{ending}' names no kind of scene; .obj is read")]
    Unknown {
        /// The file.
        path: PathBuf,
        /// Its ending.
        ending: String,
    },
    /// A kind of scene that this build does not read.
    #[error("{path}: '.{ending}' scenes are not built in; convert it to .obj")]
    NotBuilt {
        /// The file.
        path: PathBuf,
        /// Its ending.
        ending: String,
    },
    /// What is wrong with an OBJ file.
    #[cfg(feature = "obj")]
    #[error(transparent)]
    Obj(#[from] crate::obj::ObjError),
}

/// Adds the scene of a file to a builder, by the file's ending.
///
/// # Errors
/// [`LoadError`], naming the file, the place in it, and what to do.
pub fn load_scene(
    path: &Path,
    options: &LoadOptions,
    builder: &mut SceneBuilder,
) -> Result<Loaded, LoadError> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match ending.as_str() {
        "obj" => obj(path, options, builder),
        "gltf" | "glb" | "ply" => Err(LoadError::NotBuilt { path: path.into(), ending }),
        _ => Err(LoadError::Unknown { path: path.into(), ending }),
    }
}

#[cfg(feature = "obj")]
fn obj(path: &Path, options: &LoadOptions, builder: &mut SceneBuilder) -> Result<Loaded, LoadError> {
    Ok(Loaded { cameras: Vec::new(), report: crate::obj::load(path, &options.limits, builder)?.into() })
}

#[cfg(not(feature = "obj"))]
fn obj(path: &Path, _: &LoadOptions, _: &mut SceneBuilder) -> Result<Loaded, LoadError> {
    Err(LoadError::NotBuilt { path: path.into(), ending: "obj".into() })
}
