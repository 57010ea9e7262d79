use std::str::FromStr;

use clap::{Args, ValueEnum};
use etendue::camera::Filter;
use etendue::integrator::{DirectLight, PathTracer, Roulette};

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
    /// Plain random numbers
    Independent,
}

/// How light is followed: a name, and what differs from its defaults.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IntegratorChoice {
    /// As it was written.
    pub(crate) word: String,
    /// Stops after one scattering event because that is what it is.
    pub(crate) direct_only: bool,
    tracer: PathTracer,
}

impl IntegratorChoice {
    /// With the limit of the flag, if it is the lower one.
    pub(crate) fn tracer(&self, max_depth: Option<u32>) -> PathTracer {
        let lower = [self.tracer.max_depth, max_depth].into_iter().flatten().min();
        PathTracer { max_depth: lower, ..self.tracer }
    }
}

impl FromStr for IntegratorChoice {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let mut parts = word.split(':');
        let mut tracer = PathTracer::default();
        let direct_only = match parts.next() {
            Some("path") => false,
            Some("direct") => true,
            _ => return Err("write path (all light) or direct (light that scatters once)".into()),
        };
        if direct_only {
            tracer.max_depth = Some(1);
        }
        for part in parts {
            let number = |n: &str| n.parse().map_err(|_| format!("'{part}': write a whole number"));
            match part.split_once('=') {
                Some(("light", how)) => tracer.direct = direct_light(how)?,
                Some(("depth", n)) if !direct_only => tracer.max_depth = Some(number(n)?),
                Some(("roulette", "off")) => tracer.roulette = Roulette::Off,
                Some(("roulette", n)) => tracer.roulette = Roulette::Throughput { from: number(n)? },
                _ => {
                    return Err(format!(
                        "'{part}': write light=none, light=lights, light=bsdf, light=balance, light=power, depth=N, roulette=off or roulette=N"
                    ));
                }
            }
        }
        Ok(Self { word: word.to_owned(), direct_only, tracer })
    }
}

fn direct_light(word: &str) -> Result<DirectLight, String> {
    match word {
        "none" => Ok(DirectLight::None),
        "lights" => Ok(DirectLight::Light),
        "bsdf" => Ok(DirectLight::Bsdf),
        "balance" => Ok(DirectLight::MisBalance),
        "power" => Ok(DirectLight::MisPower),
        _ => {
            Err(format!("'light={word}': write none (by chance), lights, bsdf, or both as balance or power"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrators() {
        let tracer = |w: &str, limit| w.parse::<IntegratorChoice>().map(|c| c.tracer(limit));
        assert_eq!(tracer("path", None), Ok(PathTracer::default()));
        assert_eq!(tracer("direct", Some(7)).map(|t| t.max_depth), Ok(Some(1)));
        assert_eq!(tracer("direct", Some(0)).map(|t| t.max_depth), Ok(Some(0)));
        assert_eq!(tracer("path:depth=3", Some(7)).map(|t| t.max_depth), Ok(Some(3)));
        assert_eq!(
            tracer("path:light=bsdf:roulette=off", None),
            Ok(PathTracer { direct: DirectLight::Bsdf, roulette: Roulette::Off, ..PathTracer::default() })
        );
        for bad in ["", "magic", "path:", "path:light", "path:light=x", "path:depth=-1", "direct:depth=2"] {
            assert!(tracer(bad, None).is_err(), "{bad}");
        }
    }
}
