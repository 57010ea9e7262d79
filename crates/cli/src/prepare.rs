use std::path::Path;

use etendue::bsdf::Meaning;
use etendue::camera::{Camera, Perspective};
use etendue::core::{UVec2, Vec3A};
use etendue::io::{
    ImageBudget, Limits, LoadOptions, Loaded, PictureError, SceneCamera, decode_texture, fallback, load_scene,
};
use etendue::light::ImageEnvironment;
use etendue::scene::presets::{self, Preset};
use etendue::scene::{Scene, SceneBuilder};
use etendue::texture::Encoding;

use crate::args::{Materials, ViewArgs};
use crate::error::CliError;
use crate::session::Interrupt;

/// What a built-in scene's name begins with.
const BUILT_IN: &str = "builtin:";
/// Pixels across where nobody says how many, and down where no camera does.
const SIZE: UVec2 = UVec2::new(640, 480);

/// A scene with its camera and lights, to be built.
pub(crate) struct Prepared {
    pub(crate) builder: SceneBuilder,
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) camera_name: String,
    /// The scene's file, without its folder.
    pub(crate) scene_name: String,
    pub(crate) environment: Option<String>,
    pub(crate) variant: Option<String>,
    pub(crate) warnings: Vec<String>,
    pub(crate) skipped: Vec<String>,
}

/// A scene to be rendered, and its camera.
pub(crate) struct Built {
    pub(crate) scene: Scene,
    pub(crate) prepared: Prepared,
}

/// Reads the scene that is asked for. `size` is that of the picture where no flag says.
pub(crate) fn load(
    path: &Path,
    view: &ViewArgs,
    size: Option<UVec2>,
    interrupt: &Interrupt,
) -> Result<Prepared, CliError> {
    let size = view.size.or(size);
    if let Some(name) = path.to_str().and_then(|p| p.strip_prefix(BUILT_IN)) {
        return built_in(name, view, size);
    }
    let mut builder = SceneBuilder::new();
    let options = LoadOptions {
        limits: Limits::default(),
        materials: match view.materials {
            Materials::GltfB => Meaning::GltfB,
            Materials::Default => Meaning::default(),
        },
        variant: view.variant.clone(),
        lenient: view.lenient,
        progress: interrupt,
    };
    let Loaded { cameras, report } = load_scene(path, &options, &mut builder)?;
    let mut warnings = report.warnings;
    // Before any light is added: an environment has no bounds, but a user's light may.
    let (camera, camera_name) = camera(view, size, &cameras, &builder, &mut warnings)?;
    let environment = add_environment(view, &mut builder)?;
    if environment.is_none() && builder.has_no_light() {
        fallback::light(&mut builder);
        warnings
            .push("the scene has no light: a soft sky stands in for it; bring one with '--env FILE'".into());
    }
    let scene_name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Prepared {
        builder,
        camera,
        camera_name,
        scene_name,
        environment,
        variant: view.variant.clone(),
        warnings,
        skipped: report.skipped,
    })
}

/// A scene that needs no file.
fn built_in(name: &str, view: &ViewArgs, size: Option<UVec2>) -> Result<Prepared, CliError> {
    let Preset { mut builder, eye, target, vertical_fov_deg } = match name {
        "cornell" => presets::cornell_box(),
        "empty-cornell" => presets::empty_cornell_box(),
        "veach-mis" => presets::veach_mis(),
        _ => {
            let there = "there are builtin:cornell, builtin:empty-cornell and builtin:veach-mis";
            return Err(CliError::Usage(format!("'{BUILT_IN}{name}': no such scene is built in; {there}")));
        }
    };
    if view.camera.is_some() || view.variant.is_some() {
        let why = "has one camera and no variants; leave '--camera' and '--variant' out";
        return Err(CliError::Usage(format!("'{BUILT_IN}{name}' {why}")));
    }
    let environment = add_environment(view, &mut builder)?;
    let size = size.unwrap_or(SIZE);
    let camera = Perspective::look_at(eye, target, Vec3A::Y, vertical_fov_deg, size)?;
    Ok(Prepared {
        builder,
        camera: Box::new(camera),
        camera_name: "of the built-in scene".into(),
        scene_name: format!("{BUILT_IN}{name}"),
        environment,
        variant: None,
        warnings: Vec::new(),
        skipped: Vec::new(),
    })
}

/// Adds the picture of the surroundings that the flags name, and gives its words.
fn add_environment(view: &ViewArgs, builder: &mut SceneBuilder) -> Result<Option<String>, CliError> {
    let Some(path) = &view.env else { return Ok(None) };
    builder.light(environment(path, view.env_scale, view.env_rotate)?);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Ok(Some(format!("{name} scale {} turned {}", view.env_scale, view.env_rotate)))
}

/// Builds what was read; `path` is for messages.
pub(crate) fn build(mut prepared: Prepared, path: &Path, interrupt: &Interrupt) -> Result<Built, CliError> {
    let builder = std::mem::take(&mut prepared.builder);
    let scene = builder
        .build_with_progress(interrupt)
        .map_err(|source| CliError::Scene { path: path.to_owned(), source })?;
    Ok(Built { scene, prepared })
}

fn camera(
    view: &ViewArgs,
    size: Option<UVec2>,
    cameras: &[SceneCamera],
    builder: &SceneBuilder,
    warnings: &mut Vec<String>,
) -> Result<(Box<dyn Camera>, String), CliError> {
    let chosen = match &view.camera {
        None => cameras.first().map(|c| (0, c)),
        Some(wanted) => Some(find(wanted, cameras)?),
    };
    let Some((index, chosen)) = chosen else {
        let size = size.unwrap_or(SIZE);
        warnings.push("the scene has no camera: one is placed in front of it".into());
        return Ok((Box::new(fallback::camera(&builder.bounds(), size)?), "in front of the scene".into()));
    };
    let asked = size.is_some();
    let size = size.unwrap_or_else(|| default_size(chosen.aspect));
    if let (Some(aspect), true) = (chosen.aspect, asked) {
        let ratio = size.x as f32 / size.y as f32;
        if (ratio / aspect - 1.0).abs() > 0.02 {
            let name = label(index, chosen);
            warnings.push(format!(
                "camera {name} was framed for a width of {aspect:.3} times the height, and the picture has {ratio:.3}; its height is kept"
            ));
        }
    }
    Ok((chosen.at_size(size)?, label(index, chosen)))
}

fn default_size(aspect: Option<f32>) -> UVec2 {
    match aspect {
        Some(a) if a > 0.01 && a < 100.0 => UVec2::new(SIZE.x, (SIZE.x as f32 / a + 0.5).max(1.0) as u32),
        _ => SIZE,
    }
}

/// By name first: a camera may be called '1'.
fn find<'a>(wanted: &str, cameras: &'a [SceneCamera]) -> Result<(usize, &'a SceneCamera), CliError> {
    let named = cameras.iter().enumerate().find(|(_, c)| c.name == wanted);
    let indexed = || {
        let index = wanted.parse::<usize>().ok()?;
        Some((index, cameras.get(index)?))
    };
    named.or_else(indexed).ok_or_else(|| {
        let there = if cameras.is_empty() {
            "the scene has none; leave '--camera' out to look at it from the front".to_owned()
        } else {
            let list: Vec<String> = cameras.iter().enumerate().map(|(i, c)| label(i, c)).collect();
            format!("the scene has {}", list.join(", "))
        };
        CliError::Usage(format!("'--camera {wanted}': there is no such camera; {there}"))
    })
}

fn label(index: usize, camera: &SceneCamera) -> String {
    if camera.name.is_empty() { format!("{index}") } else { format!("{index} '{}'", camera.name) }
}

fn environment(path: &Path, scale: f32, rotate_deg: f32) -> Result<ImageEnvironment, CliError> {
    let failed = |source: PictureError| CliError::EnvironmentFile { path: path.into(), source };
    let limits = Limits::default();
    let bytes = etendue::io::read_bytes(path, &limits).map_err(|e| failed(e.into()))?;
    let image = decode_texture(&bytes, Encoding::Srgb, &mut ImageBudget::new(&limits)).map_err(failed)?;
    ImageEnvironment::new(image, scale, rotate_deg.to_radians())
        .map_err(|source| CliError::Environment { path: path.into(), source })
}
