mod values;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use etendue::camera::Filter;
use etendue::core::UVec2;

pub(crate) use values::{Shard, Threads};

/// Physically based light transport.
#[derive(Debug, Parser)]
#[command(name = "etendue", version, about, max_term_width = 110)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to pictures and films
    Render(Box<RenderArgs>),
    /// Add up parts of one picture, exactly
    Merge(MergeArgs),
    /// Compare a picture with a reference
    Compare(CompareArgs),
    /// Say what is in a scene, a picture or a film
    Info(InfoArgs),
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// The scene: .gltf .glb .obj .ply
    pub(crate) scene: PathBuf,
    /// Output by ending: .exr .png .hdr .film; may repeat [default: SCENE's name with .png, in the working folder]
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) output: Vec<PathBuf>,
    /// Pixels [default: 640 across, and down as the scene's camera wants, else 480]
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub(crate) size: Option<UVec2>,
    /// Samples per pixel [default: 64, or no limit with --time]
    #[arg(long, value_name = "N", value_parser = values::spp)]
    pub(crate) spp: Option<u32>,
    /// Of the random numbers: another seed, another noise
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = values::threads)]
    pub(crate) threads: Option<Threads>,
    /// Camera of the scene, by name or by index from 0 [default: the first]
    #[arg(long, value_name = "NAME|INDEX")]
    pub(crate) camera: Option<String>,
    /// Most scattering events on a path: 0 shows emitters only, 1 adds direct light; a limit is bias [default: none]
    #[arg(long, value_name = "N")]
    pub(crate) max_depth: Option<u32>,
    /// How light is followed
    #[arg(long, value_enum, default_value_t = IntegratorName::Path)]
    pub(crate) integrator: IntegratorName,
    /// Where the random numbers come from
    #[arg(long, value_enum, default_value_t = SamplerName::Sobol)]
    pub(crate) sampler: SamplerName,
    /// Pixel filter: box, tent, gaussian or mitchell, with its radius in pixels
    #[arg(long, value_name = "NAME[:RADIUS]", default_value = "gaussian", value_parser = values::filter)]
    pub(crate) filter: Filter,
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
    /// No option that trades truth for looks
    #[arg(long)]
    pub(crate) reference: bool,
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
    /// Variant of the scene's materials, by name
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
    /// Leave out what is broken in the scene, with a warning, instead of refusing it
    #[arg(long)]
    pub(crate) lenient: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntegratorName {
    /// All light, along paths from the camera
    Path,
    /// Light that scatters once: emitters and what they light directly
    Direct,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SamplerName {
    /// Scrambled Sobol points: the least noise
    Sobol,
    /// Jittered strata of --spp samples
    Stratified,
    /// Plain random numbers
    Independent,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Materials {
    /// glTF's appendix B exactly
    GltfB,
    /// Our energy-preserving reading of it
    Default,
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

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// Films of one picture
    #[arg(required = true, value_name = "PART.film")]
    pub(crate) parts: Vec<PathBuf>,
    /// Output by ending: .exr .png .hdr .film; may repeat
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub(crate) output: Vec<PathBuf>,
    /// Radiance is multiplied by 2 to the power of this in .png
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true, value_parser = values::exposure)]
    pub(crate) exposure: f32,
    /// How bright values are shown in .png
    #[arg(long, value_enum, default_value_t = Tone::Clip)]
    pub(crate) tone_map: Tone,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The picture: .exr .hdr .png .jpg .film
    pub(crate) a: PathBuf,
    /// What it should be
    #[arg(value_name = "REF")]
    pub(crate) reference: PathBuf,
    /// Write the numbers to a file
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// A scene, a picture or a film, by ending
    pub(crate) file: PathBuf,
    /// Write what is said to a file
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}
