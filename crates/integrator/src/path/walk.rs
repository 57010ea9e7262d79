use etendue_bsdf::{Bsdf, Lobes, Mode};
use etendue_camera::CameraSample;
use etendue_core::{Needs, vector};
use etendue_sampling::{Dim, Sampler, Slot};

use super::PathTracer;
use super::direct::cutout_bits;
use super::leg::{Carried, Leg, Parts, Scattered};
use crate::shaded::Shaded;
use crate::{Context, Contribution, ContributionKind, Recorder, Sample};

impl PathTracer {
    /// One path from the camera on, or a tree of them.
    pub(super) fn walk<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        s: &CameraSample,
        u: S,
        rec: &mut R,
    ) -> Sample {
        let needs = cx.scene.needs();
        let mut out = Sample::default();
        if !needs.contains(Needs::LIGHTS) && !rec.wants_vertices() {
            let hit = cx.scene.intersect(&s.ray, cutout_bits(cx, needs, &u, 0, false));
            out.alpha = if hit.is_some() { 1.0 } else { 0.0 };
            return out;
        }
        if self.branching.factor > 1 {
            self.follow::<S, R, true>(cx, s, u, &mut out, rec);
        } else {
            self.follow::<S, R, false>(cx, s, u, &mut out, rec);
        }
        out
    }

    /// Compiled once for trees and once for single paths, which then have no list and no copies: 2 % of the walk.
    #[inline(always)]
    fn follow<S: Sampler, R: Recorder + ?Sized, const BRANCHES: bool>(
        &self,
        cx: &Context<'_>,
        s: &CameraSample,
        u: S,
        out: &mut Sample,
        rec: &mut R,
    ) {
        let (mut ray, mut u) = (s.ray, u);
        let (mut from, mut carried) = (Scattered::nowhere(&ray), Carried::first(cx.scene.needs()));
        // Branches that are not yet followed.
        let mut waiting: Vec<Leg<S>> = Vec::new();
        loop {
            let leg = Parts { ray: &mut ray, from: &mut from, carried: &mut carried, u: &mut u };
            let on = self.arrive(cx, leg, s.spread, out, rec, |here, leg, out, rec| {
                if BRANCHES {
                    let ways = self.branching.ways(leg.carried.depth);
                    *leg.carried = leg.carried.shared(ways);
                    for way in 1..ways {
                        let mut branch = leg.branch(way);
                        if self.scatter(cx, here, branch.parts(), out, rec) {
                            waiting.push(branch);
                        }
                    }
                }
                self.scatter(cx, here, leg, out, rec)
            });
            if on {
                continue;
            }
            match waiting.pop() {
                Some(next) if BRANCHES => Leg { ray, from, carried, u } = next,
                _ => return,
            }
        }
    }

    /// Follows the ray and adds the light that it finds. The surface goes to `then` if the path may scatter there, whose
    /// answer is whether it goes on; it is not handed back, because moving it costs a twelfth of the whole walk.
    #[inline(always)]
    pub(super) fn arrive<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        leg: Parts<'_, S>,
        spread: f32,
        out: &mut Sample,
        rec: &mut R,
        then: impl FnOnce(&Shaded<'_>, Parts<'_, S>, &mut Sample, &mut R) -> bool,
    ) -> bool {
        let scene = cx.scene;
        let needs = scene.needs();
        let Parts { ray, from, carried, u } = leg;
        let depth = carried.depth;
        let Some(hit) = scene.intersect(ray, cutout_bits(cx, needs, u, depth, false)) else {
            let beyond = carried.inside.as_ref().map(|i| i.transmittance(f32::INFINITY));
            let beta = beyond.map_or(carried.beta, |t| carried.beta * t);
            self.escape(cx, ray, beta, depth, from, out, rec);
            return false;
        };
        if depth == 0 {
            out.alpha = 1.0;
        }
        carried.length += hit.t;
        let footprint = if needs.contains(Needs::TEXTURES) { carried.length * spread } else { 0.0 };
        let mut surface = scene.surface(ray, &hit, footprint);
        let wo = -ray.d;
        if let Some(inside) = &carried.inside {
            carried.beta *= inside.transmittance(hit.t);
            if carried.beta.is_black() {
                return false;
            }
        }

        if let Some(id) = scene.light_at(&surface) {
            let le = scene.emitted(id, &surface, wo);
            if !le.is_black() {
                let (weight, light_pdf) = self.weight_of_found(cx, from, id, ray.d, Some(&surface));
                let value = carried.beta * le * weight;
                out.l += value;
                rec.contribution(&Contribution {
                    depth,
                    kind: ContributionKind::Hit,
                    light: id,
                    value,
                    mis_weight: weight,
                    light_pdf,
                    bsdf_pdf: from.pdf,
                });
            }
        }
        if !needs.contains(Needs::LIGHTS) && depth > 0 {
            return false;
        }
        // As `bsdf_at`, without moving the BSDF out of an option: half a percent of all instructions.
        let Some(material) = scene.material(&surface) else { return false };
        if needs.contains(Needs::NORMAL_MAPS) {
            surface.shading = material.shading_frame(&surface);
        }
        let bsdf = material.bsdf(&surface);
        cx.count(|c| c.texture_fetches += u64::from(surface.fetches.get()));
        let here = Shaded::new(&surface, &bsdf, wo);
        rec.vertex(&here.vertex(depth, hit.t, carried.beta));
        let ends = self.max_depth.is_some_and(|m| depth >= m)
            || !needs.contains(Needs::LIGHTS)
            || !here.lobes().intersects(Lobes::REFLECTION | Lobes::TRANSMISSION);
        !ends && then(&here, Parts { ray, from, carried, u }, out, rec)
    }

    /// Adds the light that a light sample brings, and scatters the path; false where it ends.
    #[inline(always)]
    pub(super) fn scatter<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        here: &Shaded<'_>,
        leg: Parts<'_, S>,
        out: &mut Sample,
        rec: &mut R,
    ) -> bool {
        let scene = cx.scene;
        let needs = scene.needs();
        let Shaded { surface, wo, frame, bsdf } = here;
        let Parts { ray, from, carried, u } = leg;
        let depth = carried.depth;
        let lobes = bsdf.lobes();
        let at = here.lit(lobes);
        let body = if carried.inside.is_some() { scene.body(surface) } else { None };
        let draw = self
            .draw_light(cx, &at, lobes, depth, u)
            .filter(|d| here.agrees(d.sample.wi) && !d.sample.li.is_black());
        let toward_light = draw.map(|d| frame.to_local(d.sample.wi));
        cx.count(|c| c.draws_bsdf += 3);
        let u_lobe = u.get_1d(Dim::bounce(depth, Slot::Lobe));
        let u_bsdf = u.get_2d(Dim::bounce(depth, Slot::Bsdf));
        let scatter = bsdf.scatter(frame.to_local(*wo), toward_light, u_lobe, u_bsdf, Mode::Radiance);

        if let Some(d) = draw
            && !scatter.eval.is_black()
        {
            let mut throughput = carried.beta * scatter.eval;
            if let Some(inside) = &carried.inside {
                let end = d.sample.end.map(|e| e.p);
                throughput *= inside.on_the_way(surface, body, *wo, d.sample.wi, end);
            }
            self.add_light(cx, needs, u, depth, &at, &d, throughput, scatter.pdf, out, rec);
        }

        let Some(sample) = scatter.sample else { return false };
        let wi = frame.to_world(sample.wi);
        if sample.weight.is_black() || !here.agrees(wi) {
            return false;
        }
        carried.beta *= sample.weight;
        // No number any more: handed on as it is, so that the film refuses the sample and says where.
        if !carried.beta.is_finite() {
            out.l += carried.beta;
            return false;
        }
        if carried.beta.is_black() {
            return false;
        }
        if sample.lobe.contains(Lobes::TRANSMISSION) {
            if let (Some(b), Some(inside)) = (body, &mut carried.inside) {
                *inside = inside.beyond(b, wo.dot(surface.ng), wi.dot(surface.ng));
            }
            carried.eta_scale *= sample.eta * sample.eta;
        }
        carried.depth += 1;
        let most = carried.beta.max_channel() * carried.eta_scale;
        if most < self.threshold {
            return false;
        }
        let survival = self.roulette.survival(carried.depth, most, || bsdf.albedo(frame.to_local(*wo)));
        if survival < 1.0 {
            cx.count(|c| c.draws_roulette += 1);
            if u.get_1d(Dim::bounce(depth, Slot::Roulette)) >= survival {
                cx.count(|c| c.roulette_ends += 1);
                return false;
            }
            carried.beta = carried.beta / survival;
        }
        *from = Scattered { at, pdf: sample.pdf, only_way: sample.lobe.contains(Lobes::DELTA) };
        cx.count(|c| c.scatter_rays += 1);
        // Normalised: what frames round must not build up from bounce to bounce.
        *ray = surface.origin().ray(vector::normalize(wi), surface.time);
        true
    }
}
