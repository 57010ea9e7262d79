use etendue_bsdf::Lobes;
use etendue_core::{Needs, Ray, Segment, Spectrum, Vec3A};
use etendue_geometry::Surface;
use etendue_light::{LightId, LitPoint};
use etendue_sampling::{Dim, Sampler, Slot, mis};
use etendue_scene::{LightDraw, Scene};

use super::leg::Scattered;
use super::{DirectLight, PathTracer};
use crate::{Context, Contribution, ContributionKind, Recorder, Sample};

impl PathTracer {
    fn weigh(&self, cx: &Context<'_>, p: f32, other: f32) -> f32 {
        cx.count(|c| c.mis_weights += 1);
        match self.direct {
            DirectLight::MisBalance => mis::balance(p, other),
            _ => mis::power(p, other),
        }
    }

    /// MIS weight of emission found by following the path, and the light-sampling density it was weighed against.
    pub(super) fn weight_of_found(
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
    #[inline(always)]
    pub(super) fn draw_light<S: Sampler>(
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

    /// Adds a light sample if nothing is in between.
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    pub(super) fn add_light<S: Sampler, R: Recorder + ?Sized>(
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
    pub(super) fn escape<R: Recorder + ?Sized>(
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
#[inline(always)]
pub(crate) fn cutout_bits<S: Sampler>(
    cx: &Context<'_>,
    needs: Needs,
    u: &S,
    depth: u32,
    shadow: bool,
) -> u32 {
    if !needs.contains(Needs::CUTOUTS) {
        return 0;
    }
    cx.count(|c| c.draws_cutout += 1);
    let slot = if shadow { Slot::Spare0 } else { Slot::Cutout };
    u.bits_1d(Dim::bounce(depth, slot))
}
