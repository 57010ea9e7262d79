use etendue_bsdf::{Bsdf, Lobes, Mode};
use etendue_camera::CameraSample;
use etendue_core::{Frame, Needs, Spectrum, Vec3A, vector};
use etendue_light::{LitPoint, Sides};
use etendue_sampling::{Dim, Sampler, Slot};

use super::direct::{Scattered, cutout_bits};
use super::inside::Inside;
use super::{PathTracer, Roulette};
use crate::{Context, Contribution, ContributionKind, Recorder, Sample, Vertex};

/// Scattering events after which even a lossless path may end.
const LONG_PATH: u32 = 256;
/// The most probable survival of a long path.
const LONG_SURVIVAL: f32 = 1.0 - 1.0 / 32_768.0;
/// The least probable survival: rarer survivors would be fireflies.
const LEAST_SURVIVAL: f32 = 0.05;

impl PathTracer {
    /// Probability of going on after `depth` scattering events; 1 draws no random number.
    fn survival(&self, depth: u32, beta: Spectrum, eta_scale: f32) -> f32 {
        let from = match self.roulette {
            Roulette::Throughput { from } => from.min(LONG_PATH),
            Roulette::Off => LONG_PATH,
        };
        if depth < from {
            return 1.0;
        }
        let p = (beta.max_channel() * eta_scale).clamp(LEAST_SURVIVAL, 1.0);
        if depth >= LONG_PATH && p > LONG_SURVIVAL { LONG_SURVIVAL } else { p }
    }

    pub(super) fn walk<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        s: &CameraSample,
        u: S,
        rec: &mut R,
    ) -> Sample {
        let scene = cx.scene;
        let needs = scene.needs();
        let mut out = Sample::default();
        if !needs.contains(Needs::LIGHTS) && !rec.wants_vertices() {
            let hit = scene.intersect(&s.ray, cutout_bits(cx, needs, &u, 0, false));
            out.alpha = if hit.is_some() { 1.0 } else { 0.0 };
            return out;
        }
        let mut ray = s.ray;
        let (mut beta, mut eta_scale) = (Spectrum::ONE, 1.0f32);
        let mut length = 0.0;
        let nowhere = LitPoint {
            p: ray.o,
            p_err: Vec3A::ZERO,
            ng: Vec3A::ZERO,
            ns: Vec3A::ZERO,
            sides: Sides::Free,
            time: ray.time,
        };
        let mut from = Scattered { at: nowhere, pdf: 0.0, only_way: true };
        let mut depth = 0;
        let absorbs = needs.contains(Needs::ABSORPTION);
        let mut inside = Inside::nothing();
        loop {
            let Some(hit) = scene.intersect(&ray, cutout_bits(cx, needs, &u, depth, false)) else {
                let beta = if absorbs { beta * inside.transmittance(f32::INFINITY) } else { beta };
                self.escape(cx, &ray, beta, depth, &from, &mut out, rec);
                return out;
            };
            if depth == 0 {
                out.alpha = 1.0;
            }
            length += hit.t;
            let footprint = if needs.contains(Needs::TEXTURES) { length * s.spread } else { 0.0 };
            let mut surface = scene.surface(&ray, &hit, footprint);
            let wo = -ray.d;
            if absorbs {
                beta *= inside.transmittance(hit.t);
                if beta.is_black() {
                    return out;
                }
            }

            if let Some(id) = scene.light_at(&surface) {
                let le = scene.emitted(id, &surface, wo);
                if !le.is_black() {
                    let (weight, light_pdf) = self.weight_of_found(cx, &from, id, ray.d, Some(&surface));
                    let value = beta * le * weight;
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
                return out;
            }

            let Some(material) = scene.material(&surface) else { return out };
            if needs.contains(Needs::NORMAL_MAPS) {
                surface.shading = material.shading_frame(&surface);
            }
            let bsdf = material.bsdf(&surface);
            // A ray that comes from behind the shading normal sees the geometric one: nothing turns black, and no
            // direction carries more than it should.
            let front = wo.dot(surface.ng) >= 0.0;
            let frame = if (wo.dot(surface.shading.z) > 0.0) == front && wo.dot(surface.shading.z) != 0.0 {
                surface.shading
            } else {
                Frame::from_normal(surface.ng)
            };
            cx.count(|c| c.texture_fetches += u64::from(surface.fetches.get()));
            rec.vertex(&Vertex { depth, surface: &surface, frame, wo, distance: hit.t, bsdf: &bsdf, beta });
            let lobes = bsdf.lobes();
            if self.max_depth.is_some_and(|m| depth >= m)
                || !needs.contains(Needs::LIGHTS)
                || !lobes.intersects(Lobes::REFLECTION | Lobes::TRANSMISSION)
            {
                return out;
            }

            let side = if front { 1.0 } else { -1.0 };
            let at = LitPoint {
                p: surface.p,
                p_err: surface.p_err,
                ng: surface.ng * side,
                ns: frame.z * side,
                sides: if lobes.contains(Lobes::TRANSMISSION) { Sides::Both } else { Sides::Same },
                time: surface.time,
            };
            // Shading and geometric normal must agree about which side a direction is on, or light would leak.
            let agrees = |wi: Vec3A| wi.dot(frame.z) * wi.dot(surface.ng) > 0.0;

            let body = if absorbs { scene.body(&surface) } else { None };
            let draw = self
                .draw_light(cx, &at, lobes, depth, &u)
                .filter(|d| agrees(d.sample.wi) && !d.sample.li.is_black());
            let toward_light = draw.map(|d| frame.to_local(d.sample.wi));
            cx.count(|c| c.draws_bsdf += 3);
            let u_lobe = u.get_1d(Dim::bounce(depth, Slot::Lobe));
            let u_bsdf = u.get_2d(Dim::bounce(depth, Slot::Bsdf));
            let scatter = bsdf.scatter(frame.to_local(wo), toward_light, u_lobe, u_bsdf, Mode::Radiance);

            if let Some(d) = draw
                && !scatter.eval.is_black()
            {
                let mut throughput = beta * scatter.eval;
                if absorbs {
                    let there = match body {
                        Some(b) => inside.beyond(b, wo.dot(surface.ng), d.sample.wi.dot(surface.ng)),
                        None => inside,
                    };
                    let end = d.sample.end.map_or(f32::INFINITY, |e| vector::length(e.p - surface.p));
                    throughput *= there.transmittance(end);
                }
                self.add_light(cx, needs, &u, depth, &at, &d, throughput, scatter.pdf, &mut out, rec);
            }

            let Some(sample) = scatter.sample else { return out };
            let wi = frame.to_world(sample.wi);
            if sample.weight.is_black() || !agrees(wi) {
                return out;
            }
            beta *= sample.weight;
            // No number any more: handed on as it is, so that the film refuses the sample and says where.
            if !beta.is_finite() {
                out.l += beta;
                return out;
            }
            if beta.is_black() {
                return out;
            }
            if sample.lobe.contains(Lobes::TRANSMISSION) {
                if let Some(b) = body {
                    inside = inside.beyond(b, wo.dot(surface.ng), wi.dot(surface.ng));
                }
                eta_scale *= sample.eta * sample.eta;
            }
            depth += 1;
            let survival = self.survival(depth, beta, eta_scale);
            if survival < 1.0 {
                cx.count(|c| c.draws_roulette += 1);
                if u.get_1d(Dim::bounce(depth - 1, Slot::Roulette)) >= survival {
                    cx.count(|c| c.roulette_ends += 1);
                    return out;
                }
                beta = beta / survival;
            }
            from = Scattered { at, pdf: sample.pdf, only_way: sample.lobe.contains(Lobes::DELTA) };
            cx.count(|c| c.scatter_rays += 1);
            ray = surface.origin().ray(renormalized(wi), surface.time);
        }
    }
}

/// Takes out the rounding that frames add, so that it does not build up from bounce to bounce.
fn renormalized(d: Vec3A) -> Vec3A {
    vector::normalize(d)
}
