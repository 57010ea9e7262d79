use clap::{Args, ValueEnum};
use etendue::camera::Filter;

use super::values::{self, Threads};

/// How samples are made, whatever the integrator and the sampler.
#[derive(Clone, Debug, Args)]
pub(crate) struct MethodArgs {
    /// Of the random numbers: another seed, another noise
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = values::threads)]
    pub(crate) threads: Option<Threads>,
    /// Most scattering events on a path: 0 shows emitters only, 1 adds direct light; a limit is bias [default: none]
    #[arg(long, value_name = "N")]
    pub(crate) max_depth: Option<u32>,
    /// Pixel filter: box, tent, gaussian or mitchell, with its radius in pixels
    #[arg(long, value_name = "NAME[:RADIUS]", default_value = "gaussian", value_parser = values::filter)]
    pub(crate) filter: Filter,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SamplerName {
    /// Scrambled Sobol points: the least noise
    Sobol,
    /// Jittered strata of --spp samples
    Stratified,
    /// Halton's sequence with Owen's scrambling: any number of samples
    Halton,
    /// Latin hypercubes (N rooks) of --spp samples
    Latin,
    /// Correlated multi-jittered samples, --spp of them
    Cmj,
    /// Plain random numbers
    Independent,
}

impl SamplerName {
    /// Its word on the command line.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Sobol => "sobol",
            Self::Stratified => "stratified",
            Self::Halton => "halton",
            Self::Latin => "latin",
            Self::Cmj => "cmj",
            Self::Independent => "independent",
        }
    }

    /// Whether it divides a number of samples that is known beforehand, so that fewer of them are no set.
    pub(crate) fn divides(self) -> bool {
        matches!(self, Self::Stratified | Self::Latin | Self::Cmj)
    }
}
