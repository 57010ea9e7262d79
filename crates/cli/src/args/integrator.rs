use etendue::integrator::{
    AmbientOcclusion, AreaForm, FirstSurface, Integrator, PathTracer, RayCaster, Roulette, Whitted,
};
use etendue::sampling::{Sampler, Sobol};
use etendue::scene::Scene;

use crate::error::CliError;

/// An integrator that needs no scene to be known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Method {
    Path(PathTracer),
    /// Stops after one scattering event because that is what it is.
    Direct(PathTracer),
    Area {
        max_depth: Option<u32>,
        roulette: Roulette,
    },
    Whitted(Whitted),
    RayCast(RayCaster),
    Occlusion(AmbientOcclusion),
    First(FirstSurface),
}

impl Method {
    /// With the limit of the flag, if it is the lower one. What looks at first surfaces only has no depth.
    pub(crate) fn limited(self, flag: Option<u32>) -> Self {
        let lower = |own: Option<u32>| [own, flag].into_iter().flatten().min();
        match self {
            Self::Path(t) => Self::Path(PathTracer { max_depth: lower(t.max_depth), ..t }),
            Self::Direct(t) => Self::Direct(PathTracer { max_depth: lower(t.max_depth), ..t }),
            Self::Area { max_depth, roulette } => Self::Area { max_depth: lower(max_depth), roulette },
            Self::Whitted(w) => Self::Whitted(Whitted { max_depth: lower(w.max_depth), ..w }),
            other => other,
        }
    }

    pub(crate) fn max_depth(self) -> Option<u32> {
        match self {
            Self::Path(PathTracer { max_depth, .. })
            | Self::Direct(PathTracer { max_depth, .. })
            | Self::Area { max_depth, .. }
            | Self::Whitted(Whitted { max_depth, .. }) => max_depth,
            _ => None,
        }
    }

    /// Ready for a scene.
    pub(crate) fn on(self, scene: &Scene) -> Result<Ready, CliError> {
        Ok(match self {
            Self::Path(t) => Ready::Path(t),
            Self::Direct(t) => Ready::Direct(t),
            Self::Area { max_depth, roulette } => {
                let mut form = AreaForm::new(scene).map_err(|e| CliError::Usage(format!("'area': {e}")))?;
                (form.max_depth, form.roulette) = (max_depth, roulette);
                Ready::Area(Box::new(form))
            }
            Self::Whitted(w) => Ready::Whitted(w),
            Self::RayCast(r) => Ready::RayCast(r),
            Self::Occlusion(a) => Ready::Occlusion(a),
            Self::First(f) => Ready::First(f),
        })
    }
}

/// An integrator for one scene.
pub(crate) enum Ready {
    Path(PathTracer),
    Direct(PathTracer),
    Area(Box<AreaForm>),
    Whitted(Whitted),
    RayCast(RayCaster),
    Occlusion(AmbientOcclusion),
    First(FirstSurface),
}

impl Ready {
    pub(crate) fn integrator<S: Sampler>(&self) -> &dyn Integrator<S> {
        match self {
            Self::Path(i) | Self::Direct(i) => i,
            Self::Area(i) => &**i,
            Self::Whitted(i) => i,
            Self::RayCast(i) => i,
            Self::Occlusion(i) => i,
            Self::First(i) => i,
        }
    }
}

impl Ready {
    /// What is biased; not that `direct` stops after one scattering event.
    pub(crate) fn bias(&self) -> Vec<String> {
        let mut named = self.integrator::<Sobol>().bias();
        if let Self::Direct(PathTracer { max_depth: Some(1), .. }) = self {
            named.retain(|b| !b.starts_with("max_depth="));
        }
        named
    }
}
