mod bench;
mod integrator;
mod integrator_words;
mod method;
mod render;
mod values;
mod view;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

pub(crate) use bench::{BenchArgs, ReferenceArgs};
pub(crate) use integrator::{Method, Ready};
pub(crate) use integrator_words::IntegratorChoice;
pub(crate) use method::{MethodArgs, SamplerName};
pub(crate) use render::{Aov, RenderArgs, Tone};
pub(crate) use values::Threads;
pub(crate) use view::{Materials, ViewArgs};

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
    /// Measure error against time: scenes by integrators by samplers, in turns
    Bench(Box<BenchArgs>),
    /// Make or lengthen a reference, and say how wrong it still is
    Reference(Box<ReferenceArgs>),
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
    /// Write where the two look different, in false colours
    #[arg(long, value_name = "OUT.png")]
    pub(crate) flip: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// A scene, a picture or a film, by ending
    pub(crate) file: PathBuf,
    /// Write what is said to a file
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}
