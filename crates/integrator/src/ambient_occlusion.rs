use etendue_camera::CameraSample;
use etendue_core::{Fingerprint, Ray, Spectrum, vector};
use etendue_sampling::{Dim, Sampler, Slot, warp};

use crate::arrival::{Cone, follow};
use crate::integrator::calls;
use crate::path::cutout_bits;
use crate::shaded::{Shaded, bsdf_at};
use crate::{Context, Integrator, Recorder, Sample};

/// Ambient occlusion (Zhukov, Iones & Kronin 1998; Landis 2002): the part of the hemisphere over the first surface, weighted
/// by the cosine, in which nothing stands within `reach`; 1 is open, 0 closed. Lights do not matter; background is black.
///
/// Not radiance, and named as that. In a white sky of radiance 1 it is what a white surface reflects of the sky directly, if
/// `reach` is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientOcclusion {
    /// How far away something may stand and still count, metres.
    pub reach: f32,
}

impl Default for AmbientOcclusion {
    fn default() -> Self {
        Self { reach: f32::INFINITY }
    }
}

impl AmbientOcclusion {
    fn look<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        s: &CameraSample,
        u: S,
        rec: &mut R,
    ) -> Sample {
        // What lights at infinity would send is not asked for.
        let (mut out, mut none) = (Sample::default(), Sample::default());
        let cone = Cone { length: 0.0, spread: s.spread };
        let Some(mut hit) = follow(cx, &s.ray, 0, cone, Spectrum::BLACK, &u, &mut none, rec) else {
            return out;
        };
        out.alpha = 1.0;
        let wo = -s.ray.d;
        let Some(bsdf) = bsdf_at(cx, &mut hit.surface) else { return out };
        let here = Shaded::new(&hit.surface, &bsdf, wo);
        rec.vertex(&here.vertex(0, hit.distance, Spectrum::ONE));
        cx.count(|c| c.draws_bsdf += 2);
        let up = warp::cosine(u.get_2d(Dim::bounce(0, Slot::Bsdf)));
        let above = if here.frame.to_local(wo).z < 0.0 { -up } else { up };
        let d = here.frame.to_world(above);
        // A direction that is above one normal and below the other goes into the surface.
        if !here.agrees(d) {
            return out;
        }
        cx.count(|c| c.scatter_rays += 1);
        let ray = here.surface.origin().ray(vector::normalize(d), here.surface.time);
        let ray = Ray { t_max: self.reach, ..ray };
        if !cx.scene.occluded(&ray, cutout_bits(cx, cx.scene.needs(), &u, 0, true)) {
            out.l = Spectrum::ONE;
        }
        out
    }
}

impl<S: Sampler> Integrator<S> for AmbientOcclusion {
    calls!(look);

    fn bias(&self) -> Vec<String> {
        vec![format!("ambient occlusion within {} m: not radiance", self.reach)]
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("ambient occlusion");
        f.f32(self.reach);
    }
}
