use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::integrator_words::{IntegratorChoice, WORDS};
use super::method::{MethodArgs, SamplerName};
use super::values::{self, Shard};
use super::view::ViewArgs;

#[derive(Clone, Debug, Args)]
pub(crate) struct RenderArgs {
    /// The scene: .gltf .glb .obj .ply, or builtin:NAME
    // The parser does not require it: see `scene`.
    #[arg(required_unless_present = "reference", value_name = "SCENE")]
    pub(crate) first: Option<PathBuf>,
    /// Output by ending: .exr .png .hdr .film; may repeat [default: SCENE's name with .png, in the working folder]
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) output: Vec<PathBuf>,
    /// Samples per pixel [default: 64, or no limit with --time]
    #[arg(long, value_name = "N", value_parser = values::spp)]
    pub(crate) spp: Option<u32>,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    #[command(flatten)]
    pub(crate) method: MethodArgs,
    #[arg(long, help = format!("How light is followed: {WORDS}"), value_name = "NAME", default_value = "path")]
    pub(crate) integrator: IntegratorChoice,
    /// Where the random numbers come from
    #[arg(long, value_enum, default_value_t = SamplerName::Sobol)]
    pub(crate) sampler: SamplerName,
    /// No option that trades truth for looks; with a picture, also what '--curve' measures against
    #[arg(long, value_name = "REF", num_args = 0..=1)]
    pub(crate) reference: Option<Option<PathBuf>>,
    /// Write error against cost while rendering, as a table
    #[arg(long, value_name = "OUT.csv")]
    pub(crate) curve: Option<PathBuf>,
    /// Stop after this long, at the end of a pass: 10s, 500ms, 2m, 1h
    #[arg(long, value_name = "TIME", value_parser = values::time)]
    pub(crate) time: Option<f64>,
    /// Only the I-th of N parts of the samples, I from 1
    #[arg(long, value_name = "I/N", value_parser = values::shard)]
    pub(crate) shard: Option<Shard>,
    /// Go on with the samples that this film does not have
    #[arg(long, value_name = "FILE.film")]
    pub(crate) resume: Option<PathBuf>,
    /// Write a report of the render
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Radiance is multiplied by 2 to the power of this in .png
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true, value_parser = values::exposure)]
    pub(crate) exposure: f32,
    /// How bright values are shown in .png
    #[arg(long, value_enum, default_value_t = Tone::Clip)]
    pub(crate) tone_map: Tone,
    /// Auxiliary pictures, in .exr and .film
    #[arg(long, value_enum, value_delimiter = ',')]
    pub(crate) aov: Vec<Aov>,
    /// Independent parts of the point set, whose scatter tells the error.
    #[arg(skip = 1u32)]
    pub(crate) replicates: u32,
}

impl RenderArgs {
    /// The scene, and what to measure against. '--reference SCENE' is the flag and the scene, since the flag came first.
    pub(crate) fn scene_and_reference(&self) -> Option<(&PathBuf, Option<&PathBuf>)> {
        let named = self.reference.as_ref().and_then(Option::as_ref);
        match (&self.first, named) {
            (Some(scene), reference) => Some((scene, reference)),
            (None, Some(scene)) => Some((scene, None)),
            (None, None) => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Tone {
    /// Cut off at white
    Clip,
    /// Rolled off toward white
    Filmic,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Aov {
    /// Albedo of the first surface
    Albedo,
    /// Shading normal of the first surface
    Normal,
    /// Distance to the first surface
    Depth,
    /// Instance, geometry and triangle
    Ids,
    /// Fraction of samples that met a surface
    Alpha,
}
