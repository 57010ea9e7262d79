use std::path::Path;

use etendue_bsdf::Meaning;
use etendue_core::Progress;
use etendue_scene::SceneBuilder;

use crate::{Limits, Loaded};

/// How a scene file is read.
pub struct LoadOptions<'a> {
    /// What a file may ask for.
    pub limits: Limits,
    /// What glTF's materials mean.
    pub materials: Meaning,
    /// The set of materials to show, by its name in `KHR_materials_variants`; `None` for the file's own.
    pub variant: Option<String>,
    /// Whether faults that do not stop a picture are warnings, and what is broken is left out.
    pub lenient: bool,
    /// May stop the load.
    pub progress: &'a dyn Progress,
}

impl Default for LoadOptions<'_> {
    fn default() -> Self {
        Self {
            limits: Limits::default(),
            materials: Meaning::default(),
            variant: None,
            lenient: false,
            progress: &(),
        }
    }
}

/// Why a file is not a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// An ending that no built-in format has.
    #[error("'{file}': the ending '{ending}' is not one of {known}")]
    Format {
        /// The file.
        file: String,
        /// Its ending.
        ending: String,
        /// The endings that are.
        known: String,
    },
    /// A glTF file.
    #[cfg(feature = "gltf")]
    #[error(transparent)]
    Gltf(#[from] crate::gltf::GltfError),
    /// An OBJ file.
    #[cfg(feature = "obj")]
    #[error(transparent)]
    Obj(#[from] crate::obj::ObjError),
    /// A PLY file.
    #[cfg(feature = "ply")]
    #[error(transparent)]
    Ply(#[from] crate::ply::PlyError),
}

/// The endings of scene files that are built in.
pub fn scene_endings() -> Vec<&'static str> {
    let mut all = Vec::new();
    if cfg!(feature = "gltf") {
        all.extend(["gltf", "glb"]);
    }
    if cfg!(feature = "obj") {
        all.push("obj");
    }
    if cfg!(feature = "ply") {
        all.push("ply");
    }
    all
}

/// Adds a scene file to a builder, by its ending.
///
/// # Errors
/// [`LoadError`], naming file and place.
pub fn load_scene(
    path: &Path,
    options: &LoadOptions<'_>,
    builder: &mut SceneBuilder,
) -> Result<Loaded, LoadError> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    // Which arms there are depends on the features.
    let _ = (&options, &builder);
    match ending.as_str() {
        #[cfg(feature = "gltf")]
        "gltf" | "glb" => Ok(crate::gltf::load(path, options, builder)?),
        #[cfg(feature = "obj")]
        "obj" => {
            let report = crate::obj::load(path, &options.limits, builder)?.into();
            Ok(Loaded { cameras: Vec::new(), report })
        }
        #[cfg(feature = "ply")]
        "ply" => Ok(crate::ply::load(path, &options.limits, builder)?),
        _ => Err(LoadError::Format {
            file: path.display().to_string(),
            ending,
            known: scene_endings().iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(", "),
        }),
    }
}
