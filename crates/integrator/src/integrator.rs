use etendue_camera::CameraSample;
use etendue_core::{Fingerprint, Spectrum};
use etendue_sampling::Sampler;

use crate::{Context, Recorder};

/// What one camera ray found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Radiance arriving along the ray, W·m⁻²·sr⁻¹, before the camera's weight.
    pub l: Spectrum,
    /// 1 where a surface was hit, 0 where the ray left the scene.
    pub alpha: f32,
}

/// An estimator of the radiance along a camera ray.
///
/// The type parameter sits on the trait, so that `&dyn Integrator<Sobol>` exists: one indirect call per camera
/// sample, everything under it compiled for the sampler. `check_integrator` of `etendue-testkit` tests any
/// implementation.
pub trait Integrator<S: Sampler>: Send + Sync {
    /// Estimates the radiance and tells the recorder every event. All that a user's integrator must write.
    fn li(&self, cx: &Context<'_>, s: &CameraSample, u: S, rec: &mut dyn Recorder) -> Sample;

    /// The same bits without a recorder.
    fn li_plain(&self, cx: &Context<'_>, s: &CameraSample, u: S) -> Sample {
        self.li(cx, s, u, &mut ())
    }

    /// Many independent samples; the same bits as one by one. `out` is as long as `paths`.
    fn li_batch(&self, cx: &Context<'_>, paths: &[(CameraSample, S)], out: &mut [Sample]) {
        for ((s, u), o) in paths.iter().zip(out) {
            *o = self.li_plain(cx, s, *u);
        }
    }

    /// The biased options in force, each named with its value; empty for an unbiased estimator. Goes into the
    /// report and the picture's metadata.
    fn bias(&self) -> Vec<String> {
        Vec::new()
    }

    /// What decides the estimate, for comparing renders.
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.opaque();
    }
}

/// The two ways of calling an integrator of ours, by one function of its that is generic in the recorder: with a recorder
/// behind a pointer, and without one, compiled for nothing to hear.
macro_rules! calls {
    ($walk:ident) => {
        fn li(&self, cx: &Context<'_>, s: &CameraSample, u: S, rec: &mut dyn Recorder) -> Sample {
            self.$walk(cx, s, u, rec)
        }

        fn li_plain(&self, cx: &Context<'_>, s: &CameraSample, u: S) -> Sample {
            self.$walk(cx, s, u, &mut ())
        }
    };
}
pub(crate) use calls;
