use etendue_camera::{Camera, CameraError, Orthographic, Perspective};
use etendue_core::{Transform, UVec2};

/// What came out of a scene file, and what did not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadReport {
    /// Meshes added.
    pub meshes: u64,
    /// Triangles added, each mesh counted once however often it is instanced.
    pub triangles: u64,
    /// Instances added.
    pub instances: u64,
    /// Materials added.
    pub materials: u64,
    /// Images decoded.
    pub images: u64,
    /// Point, spot and directional lights added.
    pub lights: u64,
    /// Whether anything in the file emits light.
    pub has_light: bool,
    /// What was dropped, changed or not understood, each with its place.
    pub warnings: Vec<String>,
    /// What was left unread because nothing uses it; not a fault of the file.
    pub skipped: Vec<String>,
}

/// How a camera of a file looks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum View {
    /// A pinhole.
    Perspective {
        /// Vertical field of view, degrees.
        vertical_fov_deg: f32,
    },
    /// Parallel rays. A picture of another shape than the extent has pixels that are not square.
    Orthographic {
        /// Half of the width that is seen, metres (glTF's `xmag`).
        half_width: f32,
        /// Half of the height that is seen, metres (glTF's `ymag`).
        half_height: f32,
    },
}

/// A camera of a file, without a picture size.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneCamera {
    /// Its name, or that of its node; may be empty.
    pub name: String,
    /// Width over height that its author framed, if the file says.
    pub aspect: Option<f32>,
    /// Camera space to world.
    pub to_world: Transform,
    /// Projection.
    pub view: View,
}

impl SceneCamera {
    /// The camera for a picture of this size.
    ///
    /// # Errors
    /// What the camera refuses: no pixels, an impossible field of view or extent.
    pub fn at_size(&self, size: UVec2) -> Result<Box<dyn Camera>, CameraError> {
        match self.view {
            View::Perspective { vertical_fov_deg } => {
                Ok(Box::new(Perspective::new(self.to_world, vertical_fov_deg, size)?))
            }
            View::Orthographic { half_width, half_height } => {
                Ok(Box::new(Orthographic::stretched(self.to_world, half_width, half_height, size)?))
            }
        }
    }
}

/// A scene file that has been added to a builder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loaded {
    /// Its cameras, in the order of the file.
    pub cameras: Vec<SceneCamera>,
    /// What came out of it.
    pub report: LoadReport,
}
