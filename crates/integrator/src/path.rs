use etendue_bsdf::{Bsdf, Lobes, Mode};
use etendue_camera::CameraSample;
use etendue_core::{Fingerprint, Frame, Needs, Ray, Segment, Spectrum, Vec3A};
use etendue_geometry::Surface;
use etendue_light::{LightId, LitPoint, Sides};
use etendue_sampling::{Dim, Sampler, Slot, mis};
use etendue_scene::{LightDraw, Scene};

use crate::{Context, Contribution, ContributionKind, Integrator, Recorder, Sample, Vertex};

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

/// Scattering events after which even a lossless path may end.
const LONG_PATH: u32 = 256;
/// The most probable survival of a long path.
const LONG_SURVIVAL: f32 = 1.0 - 1.0 / 32_768.0;
/// The least probable survival: rarer survivors would be fireflies.
const LEAST_SURVIVAL: f32 = 0.05;

/// What the last scattering event left for weighing emission that the next ray finds.
#[derive(Clone, Copy)]
struct Scattered {
    at: LitPoint,
    pdf: f32,
    /// Light sampling could not have found it: a delta lobe, or the camera itself.
    only_way: bool,
}

impl PathTracer {
    fn weigh(&self, cx: &Context<'_>, p: f32, other: f32) -> f32 {
        cx.count(|c| c.mis_weights += 1);
        match self.direct {
            DirectLight::MisBalance => mis::balance(p, other),
            _ => mis::power(p, other),
        }
    }

    /// MIS weight of emission found by following the path, and the light-sampling density it was weighed against.
    fn weight_of_found(
        &self,
        cx: &Context<'_>,
        from: &Scattered,
        id: LightId,
        wi: Vec3A,
        seen: Option<&Surface>,
    ) -> (f32, f32) {
        if from.only_way {
            return (1.0, 0.0);
        }
        match self.direct {
            DirectLight::None | DirectLight::Bsdf => (1.0, 0.0),
            // What light sampling cannot draw from there (a picker that skips it, a light too far to fill an angle)
            // would be lost.
            DirectLight::Light => {
                let light_pdf = cx.scene.light_pdf(&from.at, id, wi, seen);
                (if light_pdf > 0.0 { 0.0 } else { 1.0 }, light_pdf)
            }
            DirectLight::MisBalance | DirectLight::MisPower => {
                let light_pdf = cx.scene.light_pdf(&from.at, id, wi, seen);
                (self.weigh(cx, from.pdf, light_pdf), light_pdf)
            }
        }
    }

    /// MIS weight of a light sample whose direction the BSDF draws with `bsdf_pdf`.
    fn weight_of_drawn(&self, cx: &Context<'_>, draw: &LightDraw, bsdf_pdf: f32) -> f32 {
        match self.direct {
            _ if draw.only_way => 1.0,
            DirectLight::MisBalance | DirectLight::MisPower => self.weigh(cx, draw.sample.pdf, bsdf_pdf),
            _ => 1.0,
        }
    }

    /// Draws a light for a vertex, if this way of finding light uses it.
    fn draw_light<S: Sampler>(
        &self,
        cx: &Context<'_>,
        at: &LitPoint,
        lobes: Lobes,
        depth: u32,
        u: &S,
    ) -> Option<LightDraw> {
        if self.direct == DirectLight::None || !lobes.intersects(Lobes::DIFFUSE | Lobes::GLOSSY) {
            return None;
        }
        // Lights that BSDF samples find are left to them.
        if self.direct == DirectLight::Bsdf && !cx.scene.has_hidden_lights() {
            return None;
        }
        cx.count(|c| {
            c.light_picks += 1;
            c.draws_light += 2;
        });
        let draw = cx.scene.sample_light(at, u.get_2d(Dim::bounce(depth, Slot::Light)))?;
        (draw.only_way || self.direct != DirectLight::Bsdf).then_some(draw)
    }

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

    fn walk<S: Sampler, R: Recorder + ?Sized>(
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
        loop {
            let Some(hit) = scene.intersect(&ray, cutout_bits(cx, needs, &u, depth, false)) else {
                self.escape(cx, &ray, beta, depth, &from, &mut out, rec);
                return out;
            };
            if depth == 0 {
                out.alpha = 1.0;
            }
            length += hit.t;
            let footprint = if needs.contains(Needs::TEXTURES) { length * s.spread } else { 0.0 };
            let surface = scene.surface(&ray, &hit, footprint);
            let wo = -ray.d;

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
                self.add_light(
                    cx,
                    needs,
                    &u,
                    depth,
                    &at,
                    &d,
                    beta * scatter.eval,
                    scatter.pdf,
                    &mut out,
                    rec,
                );
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

    /// Adds a light sample if nothing is in between.
    #[allow(clippy::too_many_arguments)]
    fn add_light<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        needs: Needs,
        u: &S,
        depth: u32,
        at: &LitPoint,
        draw: &LightDraw,
        throughput: Spectrum,
        bsdf_pdf: f32,
        out: &mut Sample,
        rec: &mut R,
    ) {
        let l = &draw.sample;
        let segment = Segment { from: at.origin(), d: l.wi, to: l.end, time: at.time };
        cx.count(|c| c.shadow_rays += 1);
        let through = cx.scene.transmittance(&segment, cutout_bits(cx, needs, u, depth, true));
        if through.is_black() {
            return;
        }
        let mis_weight = self.weight_of_drawn(cx, draw, bsdf_pdf);
        let value = throughput * through * l.li * (mis_weight / l.pdf);
        out.l += value;
        rec.contribution(&Contribution {
            depth: depth + 1,
            kind: ContributionKind::LightSample,
            light: draw.id,
            value,
            mis_weight,
            light_pdf: l.pdf,
            bsdf_pdf,
        });
    }

    /// Adds what lights at infinity send along a ray that left the scene.
    #[allow(clippy::too_many_arguments)]
    fn escape<R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        ray: &Ray,
        beta: Spectrum,
        depth: u32,
        from: &Scattered,
        out: &mut Sample,
        rec: &mut R,
    ) {
        let scene: &Scene = cx.scene;
        for (id, light) in scene.infinite_lights() {
            cx.count(|c| c.escapes += 1);
            let le = light.escaped(ray);
            if le.is_black() {
                continue;
            }
            let (mis_weight, light_pdf) = self.weight_of_found(cx, from, id, ray.d, None);
            let value = beta * le * mis_weight;
            out.l += value;
            rec.contribution(&Contribution {
                depth,
                kind: ContributionKind::Escape,
                light: id,
                value,
                mis_weight,
                light_pdf,
                bsdf_pdf: from.pdf,
            });
        }
    }
}

/// Random bits for partly opaque surfaces along a path's ray, or along its shadow ray.
fn cutout_bits<S: Sampler>(cx: &Context<'_>, needs: Needs, u: &S, depth: u32, shadow: bool) -> u32 {
    if !needs.contains(Needs::CUTOUTS) {
        return 0;
    }
    cx.count(|c| c.draws_cutout += 1);
    let slot = if shadow { Slot::Spare0 } else { Slot::Cutout };
    u.bits_1d(Dim::bounce(depth, slot))
}

/// Takes out the rounding that frames add, so that it does not build up from bounce to bounce.
fn renormalized(d: Vec3A) -> Vec3A {
    etendue_core::vector::normalize(d)
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
