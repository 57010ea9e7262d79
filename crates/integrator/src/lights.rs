//! Light that comes to a surface straight from its source, drawn and not weighed against anything: for integrators that
//! have no other way of finding it.

use etendue_bsdf::{Bsdf, Lobes, Mode};
use etendue_core::{Needs, Segment, Spectrum, Vec2};
use etendue_light::{LightId, LitPoint};
use etendue_sampling::{Dim, Sampler, Slot};
use etendue_scene::LightDraw;

use crate::inside::Inside;
use crate::path::cutout_bits;
use crate::shaded::Shaded;
use crate::{Context, Contribution, ContributionKind, Recorder, Sample};

/// A surface that asks for light, and what its light is worth.
pub(crate) struct Receiver<'a, S> {
    pub(crate) here: &'a Shaded<'a>,
    /// Scattering events before it.
    pub(crate) depth: u32,
    pub(crate) beta: Spectrum,
    pub(crate) inside: Option<Inside>,
    pub(crate) u: S,
    /// Whether what stands in between takes the light away.
    pub(crate) shadows: bool,
}

impl<S: Sampler> Receiver<'_, S> {
    /// Adds every light's if they are `most` parts or fewer, else that of one of them.
    pub(crate) fn all_or_one<R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        most: u32,
        out: &mut Sample,
        rec: &mut R,
    ) {
        let lobes = self.here.lobes();
        if !lobes.intersects(Lobes::DIFFUSE | Lobes::GLOSSY) || !cx.scene.needs().contains(Needs::LIGHTS) {
            return;
        }
        let at = self.here.lit(lobes);
        let lights = cx.scene.lights();
        let mut left = most;
        if !lights.iter().all(|l| {
            let fits = l.parts() <= left;
            left = left.saturating_sub(l.parts());
            fits
        }) {
            self.one(cx, &at, |_| true, out, rec);
            return;
        }
        let mut nth = 0;
        for (light, l) in lights.iter().enumerate() {
            for part in 0..l.parts() {
                // The first takes the path's own numbers, so that a single light is as well stratified as anywhere.
                let u = if nth == 0 { self.u } else { self.u.fork(nth) };
                nth += 1;
                let draw =
                    cx.scene.sample_part(&at, LightId { light: light as u32, part }, self.draw(cx, &u));
                if let Some(d) = draw {
                    self.add(cx, &at, &d, out, rec);
                }
            }
        }
    }

    /// Adds the light of one that the scene's picker chooses, if it is `wanted`.
    pub(crate) fn one<R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        at: &LitPoint,
        wanted: impl Fn(&LightDraw) -> bool,
        out: &mut Sample,
        rec: &mut R,
    ) {
        cx.count(|c| c.light_picks += 1);
        if let Some(d) = cx.scene.sample_light(at, self.draw(cx, &self.u)).filter(wanted) {
            self.add(cx, at, &d, out, rec);
        }
    }

    /// Adds that of every light at infinity that rays can find, and of one other that they cannot.
    pub(crate) fn no_surface<R: Recorder + ?Sized>(&self, cx: &Context<'_>, out: &mut Sample, rec: &mut R) {
        let at = self.here.lit(self.here.lobes());
        for (nth, (id, _)) in (1..).zip(cx.scene.infinite_lights()) {
            let draw = cx.scene.sample_part(&at, id, self.draw(cx, &self.u.fork(nth)));
            if let Some(d) = draw.filter(|d| !d.only_way) {
                self.add(cx, &at, &d, out, rec);
            }
        }
        if cx.scene.has_hidden_lights() {
            self.one(cx, &at, |d| d.only_way, out, rec);
        }
    }

    fn draw(&self, cx: &Context<'_>, u: &S) -> Vec2 {
        cx.count(|c| c.draws_light += 2);
        u.get_2d(Dim::bounce(self.depth, Slot::Light))
    }

    fn add<R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        at: &LitPoint,
        draw: &LightDraw,
        out: &mut Sample,
        rec: &mut R,
    ) {
        let (here, l) = (self.here, &draw.sample);
        if !here.agrees(l.wi) {
            return;
        }
        let f = here.bsdf.eval(here.frame.to_local(here.wo), here.frame.to_local(l.wi), Mode::Radiance);
        let needs = cx.scene.needs();
        let mut value = self.beta * f * l.li * (1.0 / l.pdf);
        if let Some(inside) = self.inside {
            let body = cx.scene.body(here.surface);
            value *= inside.on_the_way(here.surface, body, here.wo, l.wi, l.end.map(|e| e.p));
        }
        if value.is_black() {
            return;
        }
        if self.shadows {
            let segment = Segment { from: at.origin(), d: l.wi, to: l.end, time: at.time };
            cx.count(|c| c.shadow_rays += 1);
            value *= cx.scene.transmittance(&segment, cutout_bits(cx, needs, &self.u, self.depth, true));
            if value.is_black() {
                return;
            }
        }
        out.l += value;
        rec.contribution(&Contribution {
            depth: self.depth + 1,
            kind: ContributionKind::LightSample,
            light: draw.id,
            value,
            mis_weight: 1.0,
            light_pdf: l.pdf,
            bsdf_pdf: 0.0,
        });
    }
}
