use std::path::PathBuf;

use clap::Args;

use super::integrator_words::{IntegratorChoice, WORDS};
use super::method::{MethodArgs, SamplerName};
use super::values;
use super::view::ViewArgs;

#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    /// Scenes: .gltf .glb .obj .ply, or builtin:NAME
    #[arg(required = true, value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    #[arg(long, help = format!("Integrators, separated by commas: {WORDS}"), value_name = "LIST", value_delimiter = ',', default_value = "path")]
    pub(crate) integrator: Vec<IntegratorChoice>,
    /// Samplers, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', default_value = "sobol")]
    pub(crate) sampler: Vec<SamplerName>,
    /// Most samples per pixel of one run [default: 64, or no limit with --time]
    #[arg(long, value_name = "N", value_parser = values::spp)]
    pub(crate) spp: Option<u32>,
    /// Most seconds of one run; numbers of samples double as long as they fit: 10s, 500ms, 2m, 1h
    #[arg(long, value_name = "TIME", value_parser = values::time)]
    pub(crate) time: Option<f64>,
    /// Independent runs of every contender, from whose scatter all intervals come; below 3 there are none for bias
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub(crate) runs: u32,
    /// What is right: a .film of 'etendue reference', a picture, or a folder with one named like each scene
    #[arg(long, value_name = "REF")]
    pub(crate) reference: Option<PathBuf>,
    /// Write the report as one page
    #[arg(long, value_name = "OUT")]
    pub(crate) html: Option<PathBuf>,
    /// Write all numbers
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    #[command(flatten)]
    pub(crate) method: MethodArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ReferenceArgs {
    /// The scene: .gltf .glb .obj .ply, or builtin:NAME
    pub(crate) scene: PathBuf,
    /// Output by ending: .film .exr .png .hdr; may repeat. A .film that is there is lengthened [default: SCENE's name with .film]
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) output: Vec<PathBuf>,
    /// Render for this long: 10m, 2h
    #[arg(long, value_name = "TIME", value_parser = values::time, required_unless_present = "spp")]
    pub(crate) time: Option<f64>,
    /// Samples per pixel that it shall have in the end
    #[arg(long, value_name = "N", value_parser = values::spp)]
    pub(crate) spp: Option<u32>,
    /// How light is followed
    #[arg(long, value_name = "NAME", default_value = "path")]
    pub(crate) integrator: IntegratorChoice,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    #[command(flatten)]
    pub(crate) method: MethodArgs,
    /// Write a report
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}
