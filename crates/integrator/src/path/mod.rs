mod branching;
mod direct;
mod leg;
mod roulette;
mod walk;

use etendue_camera::CameraSample;
use etendue_core::Fingerprint;
use etendue_sampling::Sampler;

pub use branching::Branching;
pub(crate) use direct::cutout_bits;
pub use roulette::Roulette;
pub(crate) use roulette::survival_in_tree;

use crate::integrator::calls;
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

/// Unidirectional path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling.
///
/// Paths have no depth limit unless one is set; a limit is bias and is named so. Past 256 scattering events a path
/// goes on with a probability of at most 1 − 2⁻¹⁵ whatever its throughput, so that light caught between perfect
/// mirrors ends too; survivors carry the weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathTracer {
    /// Most scattering events on a path: 0 shows emitters only, 1 adds direct light. `None` is unlimited. Bias.
    pub max_depth: Option<u32>,
    /// Paths whose throughput's largest channel falls below this are dropped; 0 drops none. Bias: for comparing with
    /// [`Roulette`], which does the same without.
    pub threshold: f32,
    /// How direct light is found.
    pub direct: DirectLight,
    /// When paths end early.
    pub roulette: Roulette,
    /// How many ways paths go on.
    pub branching: Branching,
}

impl Default for PathTracer {
    fn default() -> Self {
        Self {
            max_depth: None,
            threshold: 0.0,
            direct: DirectLight::default(),
            roulette: Roulette::Throughput { from: 3 },
            branching: Branching::NONE,
        }
    }
}

impl PathTracer {
    /// Light that scatters once at most, all of it: what is left out is named as a limit of depth.
    pub fn direct_only() -> Self {
        Self { max_depth: Some(1), ..Self::default() }
    }

    /// Reflected radiance by directions alone: L(x → Θ) = L_e + ∫ L(x ← Ψ) f cos θ dω over the sphere (Kajiya 1986;
    /// Immel et al. 1986), Ψ drawn from the BSDF. Light is found where a path happens to meet it.
    pub fn hemisphere_form() -> Self {
        Self { direct: DirectLight::None, ..Self::default() }
    }

    /// Reflected radiance in two parts: L_d over the lights, L_i over directions in which no emission counts, since L_d has
    /// it. After a delta lobe, for which no light can be drawn, it counts: nothing twice and nothing lost.
    pub fn split_form() -> Self {
        Self { direct: DirectLight::Light, ..Self::default() }
    }
}

impl<S: Sampler> Integrator<S> for PathTracer {
    calls!(walk);

    fn bias(&self) -> Vec<String> {
        let mut out = Vec::new();
        if let Some(m) = self.max_depth {
            out.push(format!("max_depth={m}: longer paths are cut off"));
        }
        if self.threshold > 0.0 {
            out.push(format!("threshold={}: paths that carry less are cut off", self.threshold));
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
