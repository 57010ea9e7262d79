use etendue_camera::CameraSample;
use etendue_core::{Fingerprint, Spectrum};
use etendue_sampling::Sampler;

use crate::arrival::{Cone, add_emission, follow};
use crate::inside::Inside;
use crate::integrator::calls;
use crate::lights::Receiver;
use crate::shaded::{Shaded, bsdf_at};
use crate::{Context, Integrator, Recorder, Sample};

/// Ray casting (Appel 1968): the first surface that a ray meets, with what it emits and what it reflects of light that comes
/// straight from its source. What a rasteriser shows, for any shape and BSDF.
///
/// Biased: all other light is left out, and so are lights that only rays find (mirrored ones, emitters
/// with holes, lights that the scene's picker never picks where it is asked).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCaster {
    /// Whether other surfaces cast shadows, as in Appel's pictures; else every light reaches every surface that faces it.
    pub shadows: bool,
    /// With as many parts of lights or fewer (triangles of a lamp count one by one) each is asked, else one that the
    /// scene's picker chooses. 0 always picks.
    pub each_light: u32,
}

impl Default for RayCaster {
    fn default() -> Self {
        Self { shadows: true, each_light: 16 }
    }
}

impl RayCaster {
    fn cast<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        s: &CameraSample,
        u: S,
        rec: &mut R,
    ) -> Sample {
        let mut out = Sample::default();
        let cone = Cone { length: 0.0, spread: s.spread };
        let Some(mut hit) = follow(cx, &s.ray, 0, cone, Spectrum::ONE, &u, &mut out, rec) else { return out };
        let wo = -s.ray.d;
        add_emission(cx, &hit.surface, wo, 0, Spectrum::ONE, &mut out, rec);
        let Some(bsdf) = bsdf_at(cx, &mut hit.surface) else { return out };
        let here = Shaded::new(&hit.surface, &bsdf, wo);
        rec.vertex(&here.vertex(0, hit.distance, Spectrum::ONE));
        let inside = Inside::of(cx.scene.needs());
        Receiver { here: &here, depth: 0, beta: Spectrum::ONE, inside, u, shadows: self.shadows }.all_or_one(
            cx,
            self.each_light,
            &mut out,
            rec,
        );
        out
    }
}

impl<S: Sampler> Integrator<S> for RayCaster {
    calls!(cast);

    fn bias(&self) -> Vec<String> {
        let what = if self.shadows { "" } else { ", and no shadows" };
        vec![format!(
            "raycast: only light that is reflected once, straight from a source that can be drawn{what}"
        )]
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("raycast");
        f.tag(&format!("{self:?}"));
    }
}
