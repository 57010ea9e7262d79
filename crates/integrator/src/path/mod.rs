mod direct;
mod inside;
mod walk;

use etendue_camera::CameraSample;
use etendue_core::Fingerprint;
use etendue_sampling::Sampler;

use crate::{Context, Integrator, Recorder, Sample};

/// How light that reaches a vertex directly is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DirectLight {
    /// By chance only: paths that happen to hit an emitter. Point lights stay dark, which is named as bias.
    None,
    /// By sampling lights only.
    Light,
    /// By sampling the BSDF only; point lights, which no BSDF sample can find, are sampled.
    Bsdf,
    /// By both, weighted with the balance heuristic (Veach & Guibas 1995).
    MisBalance,
    /// By both, weighted with the power heuristic of exponent 2 (Veach & Guibas 1995).
    #[default]
    MisPower,
}

/// When paths are ended early, survivors carrying their weight: unbiased.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Roulette {
    /// As below, but only past 256 scattering events, where a path could otherwise go on for ever.
    Off,
    /// A path of at least `from` scattering events goes on with the probability of its largest throughput channel
    /// (radiance scaling by refraction taken out), at least 5 %.
    Throughput {
        /// Scattering events that are always allowed.
        from: u32,
    },
}

/// Unidirectional path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling.
///
/// Paths have no depth limit unless one is set; a limit is bias and is named so. Past 256 scattering events a path
/// goes on with a probability of at most 1 − 2⁻¹⁵ whatever its throughput, so that light caught between perfect
/// mirrors ends too; survivors carry the weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathTracer {
    /// Most scattering events on a path: 0 shows emitters only, 1 adds direct light. `None` is unlimited.
    pub max_depth: Option<u32>,
    /// How direct light is found.
    pub direct: DirectLight,
    /// When paths end early.
    pub roulette: Roulette,
}

impl Default for PathTracer {
    fn default() -> Self {
        Self { max_depth: None, direct: DirectLight::default(), roulette: Roulette::Throughput { from: 3 } }
    }
}

impl<S: Sampler> Integrator<S> for PathTracer {
    fn li(&self, cx: &Context<'_>, s: &CameraSample, u: S, rec: &mut dyn Recorder) -> Sample {
        self.walk(cx, s, u, rec)
    }

    fn li_plain(&self, cx: &Context<'_>, s: &CameraSample, u: S) -> Sample {
        self.walk(cx, s, u, &mut ())
    }

    fn bias(&self) -> Vec<String> {
        let mut out = Vec::new();
        if let Some(m) = self.max_depth {
            out.push(format!("max_depth={m}: longer paths are cut off"));
        }
        if self.direct == DirectLight::None {
            out.push("direct=none: point lights are not seen".into());
        }
        out
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("path");
        f.tag(&format!("{self:?}"));
    }
}
