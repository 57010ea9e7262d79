use etendue_bsdf::{Bsdf, BsdfSample, Lobes, Mode};
use etendue_camera::CameraSample;
use etendue_core::{Fingerprint, Ray, Spectrum, vector};
use etendue_sampling::{Dim, Sampler, Slot};

use crate::arrival::{Cone, add_emission, follow};
use crate::inside::Inside;
use crate::integrator::calls;
use crate::lights::Receiver;
use crate::path::survival_in_tree;
use crate::shaded::{Shaded, bsdf_at};
use crate::{Context, Integrator, Recorder, Sample};

/// Whitted's ray tracing (1980): at every surface a ray to each light, and *both* the reflected and the refracted ray where the
/// surface has them. Nothing is drawn but points on lights that have an extent, and faint rays, which roulette ends.
///
/// Biased: light that matte and glossy surfaces send to each other is left out; what it holds is L(D|G)?S*E. Left out is also
/// what such surfaces reflect of lights that only rays find (emitters with holes, lights that the scene's picker never picks
/// where it is asked). In a scene of mirrors and clear glass nothing is missing.
///
/// Roulette ends faint rays, and deep in the tree all but one of them on average; between perfect mirrors a ray may still take
/// long, as a path does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    /// Most scattering events: 0 shows emitters only, 1 adds direct light and mirrored emitters. `None` is unlimited. Bias.
    pub max_depth: Option<u32>,
    /// Rays whose largest channel carries less are dropped; 0 drops none. Bias.
    pub threshold: f32,
    /// As for [`RayCaster`](crate::RayCaster).
    pub each_light: u32,
}

impl Default for Whitted {
    fn default() -> Self {
        Self { max_depth: None, threshold: 0.0, each_light: 16 }
    }
}

/// Marks the random numbers of a second ray, which no light's are ([`Receiver`] counts those from 1).
const SECOND: u32 = 1 << 31;

/// A ray of the tree that has not been followed yet.
#[derive(Clone, Copy)]
struct Waiting<S> {
    ray: Ray,
    beta: Spectrum,
    /// As in the path tracer: refraction scales radiance, which says nothing about how much a ray is worth.
    eta_scale: f32,
    depth: u32,
    cone: Cone,
    inside: Option<Inside>,
    u: S,
}

impl Whitted {
    fn trace<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        s: &CameraSample,
        u: S,
        rec: &mut R,
    ) -> Sample {
        let mut out = Sample::default();
        let cone = Cone { length: 0.0, spread: s.spread };
        let (beta, inside) = (Spectrum::ONE, Inside::of(cx.scene.needs()));
        // Depth first: the list is never longer than the tree is deep.
        let mut waiting = vec![Waiting { ray: s.ray, beta, eta_scale: 1.0, depth: 0, cone, inside, u }];
        while let Some(mut w) = waiting.pop() {
            let beyond = w.inside.map_or(w.beta, |i| w.beta * i.transmittance(f32::INFINITY));
            let Some(mut hit) = follow(cx, &w.ray, w.depth, w.cone, beyond, &w.u, &mut out, rec) else {
                continue;
            };
            if let Some(inside) = &w.inside {
                w.beta *= inside.transmittance(hit.distance);
            }
            w.cone = w.cone.after(hit.distance);
            let wo = -w.ray.d;
            add_emission(cx, &hit.surface, wo, w.depth, w.beta, &mut out, rec);
            let Some(bsdf) = bsdf_at(cx, &mut hit.surface) else { continue };
            let here = Shaded::new(&hit.surface, &bsdf, wo);
            rec.vertex(&here.vertex(w.depth, hit.distance, w.beta));
            if self.max_depth.is_some_and(|m| w.depth >= m) {
                continue;
            }
            let Waiting { depth, beta, inside, u, .. } = w;
            Receiver { here: &here, depth, beta, inside, u, shadows: true }.all_or_one(
                cx,
                self.each_light,
                &mut out,
                rec,
            );
            let lobes = here.bsdf.delta_lobes(here.frame.to_local(wo), Mode::Radiance);
            for (nth, sample) in lobes.into_iter().flatten().enumerate() {
                let u = if nth == 0 { w.u } else { w.u.fork(SECOND | w.depth) };
                waiting.extend(self.onward(cx, &here, &Waiting { u, ..w }, &sample, &mut out));
            }
        }
        out
    }

    /// The ray into one of the single directions; `None` if it is not followed.
    fn onward<S: Sampler>(
        &self,
        cx: &Context<'_>,
        here: &Shaded<'_>,
        w: &Waiting<S>,
        sample: &BsdfSample,
        out: &mut Sample,
    ) -> Option<Waiting<S>> {
        let wi = here.frame.to_world(sample.wi);
        let mut beta = w.beta * sample.weight;
        if beta.is_black() || !here.agrees(wi) {
            return None;
        }
        // No number any more: handed on as it is, so that the film refuses the sample and says where.
        if !beta.is_finite() {
            out.l += beta;
            return None;
        }
        let (mut inside, mut eta_scale) = (w.inside, w.eta_scale);
        if sample.lobe.contains(Lobes::TRANSMISSION) {
            eta_scale *= sample.eta * sample.eta;
            if let (Some(i), Some(body)) = (&mut inside, cx.scene.body(here.surface)) {
                *i = i.beyond(body, here.wo.dot(here.surface.ng), wi.dot(here.surface.ng));
            }
        }
        let carried = beta.max_channel() * eta_scale;
        if carried < self.threshold {
            return None;
        }
        let survival = survival_in_tree(w.depth + 1, carried);
        if survival < 1.0 {
            cx.count(|c| c.draws_roulette += 1);
            if w.u.get_1d(Dim::bounce(w.depth, Slot::Roulette)) >= survival {
                cx.count(|c| c.roulette_ends += 1);
                return None;
            }
            beta = beta / survival;
        }
        cx.count(|c| c.scatter_rays += 1);
        let ray = here.surface.origin().ray(vector::normalize(wi), here.surface.time);
        Some(Waiting { ray, beta, eta_scale, depth: w.depth + 1, inside, ..*w })
    }
}

impl<S: Sampler> Integrator<S> for Whitted {
    calls!(trace);

    fn bias(&self) -> Vec<String> {
        let mut out = vec!["whitted: light between surfaces that are no mirrors is left out, and that of lights found by rays alone".to_owned()];
        out.extend(self.max_depth.map(|m| format!("max_depth={m}: longer paths are cut off")));
        if self.threshold > 0.0 {
            out.push(format!("threshold={}: rays that carry less are cut off", self.threshold));
        }
        out
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("whitted");
        f.tag(&format!("{self:?}"));
    }
}
