use std::path::PathBuf;

use clap::{Args, ValueEnum};
use etendue::core::UVec2;

use super::values;

/// What is looked at, and from where.
#[derive(Clone, Debug, Args)]
pub(crate) struct ViewArgs {
    /// Pixels [default: 640 across, and down as the scene's camera wants, else 480]
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub(crate) size: Option<UVec2>,
    /// Camera of the scene, by name or by index from 0 [default: the first]
    #[arg(long, value_name = "NAME|INDEX")]
    pub(crate) camera: Option<String>,
    /// Picture of the surroundings as a light, equirectangular: .exr .hdr .png .jpg
    #[arg(long, value_name = "FILE")]
    pub(crate) env: Option<PathBuf>,
    /// Its radiance is multiplied by this
    #[arg(long, value_name = "X", default_value_t = 1.0, requires = "env", value_parser = values::scale)]
    pub(crate) env_scale: f32,
    /// It is turned around the vertical by this many degrees, counter-clockwise from above
    #[arg(long, value_name = "DEG", default_value_t = 0.0, requires = "env", allow_negative_numbers = true, value_parser = values::finite)]
    pub(crate) env_rotate: f32,
    /// Meaning of glTF materials: appendix B to the letter, or energy-preserving
    #[arg(long, value_enum, default_value_t = Materials::Default)]
    pub(crate) materials: Materials,
    /// Variant of the scene's materials, by name
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
    /// Leave out what is broken in the scene, with a warning, instead of refusing it
    #[arg(long)]
    pub(crate) lenient: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Materials {
    /// glTF's appendix B exactly
    GltfB,
    /// Our energy-preserving reading of it
    Default,
}
