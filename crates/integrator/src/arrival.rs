use etendue_core::{Needs, Ray, Spectrum};
use etendue_geometry::Surface;
use etendue_light::LightId;
use etendue_sampling::Sampler;

use crate::path::cutout_bits;
use crate::{Context, Contribution, ContributionKind, Recorder, Sample};

/// Where a ray that nothing else competes with ends: all the emission that it meets counts.
pub(crate) struct Arrival {
    pub(crate) surface: Surface,
    pub(crate) distance: f32,
}

/// Follows a ray to the closest surface; adds what lights at infinity send along one that leaves the scene.
///
/// `length` is that of the path before it, `beyond` what is left of light from infinitely far.
#[allow(clippy::too_many_arguments)]
pub(crate) fn follow<S: Sampler, R: Recorder + ?Sized>(
    cx: &Context<'_>,
    ray: &Ray,
    depth: u32,
    cone: Cone,
    beyond: Spectrum,
    u: &S,
    out: &mut Sample,
    rec: &mut R,
) -> Option<Arrival> {
    let needs = cx.scene.needs();
    let Some(hit) = cx.scene.intersect(ray, cutout_bits(cx, needs, u, depth, false)) else {
        for (light, l) in cx.scene.infinite_lights() {
            cx.count(|c| c.escapes += 1);
            let value = beyond * l.escaped(ray);
            if !value.is_black() {
                out.l += value;
                rec.contribution(&alone(ContributionKind::Escape, depth, light, value));
            }
        }
        return None;
    };
    if depth == 0 {
        out.alpha = 1.0;
    }
    let footprint = if needs.contains(Needs::TEXTURES) { cone.radius(hit.t) } else { 0.0 };
    Some(Arrival { surface: cx.scene.surface(ray, &hit, footprint), distance: hit.t })
}

/// Adds what a surface sends toward where the path comes from.
pub(crate) fn add_emission<R: Recorder + ?Sized>(
    cx: &Context<'_>,
    surface: &Surface,
    wo: etendue_core::Vec3A,
    depth: u32,
    beta: Spectrum,
    out: &mut Sample,
    rec: &mut R,
) {
    let Some(light) = cx.scene.light_at(surface) else { return };
    let value = beta * cx.scene.emitted(light, surface, wo);
    if value.is_black() {
        return;
    }
    out.l += value;
    rec.contribution(&alone(ContributionKind::Hit, depth, light, value));
}

/// Light that was weighed against nothing.
fn alone(kind: ContributionKind, depth: u32, light: LightId, value: Spectrum) -> Contribution {
    Contribution { depth, kind, light, value, mis_weight: 1.0, light_pdf: 0.0, bsdf_pdf: 0.0 }
}

/// The cone of a camera ray, for what textures are averaged over.
#[derive(Clone, Copy)]
pub(crate) struct Cone {
    /// Metres from the camera to where the ray begins.
    pub(crate) length: f32,
    /// Radians.
    pub(crate) spread: f32,
}

impl Cone {
    pub(crate) fn radius(self, t: f32) -> f32 {
        (self.length + t) * self.spread
    }

    /// After `t` metres more.
    pub(crate) fn after(self, t: f32) -> Self {
        Self { length: self.length + t, ..self }
    }
}
