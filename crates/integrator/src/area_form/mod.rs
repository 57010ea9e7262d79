mod surfaces;

use etendue_bsdf::{Bsdf, Lobes, Mode};
use etendue_camera::CameraSample;
use etendue_core::{Fingerprint, Ray, Segment, Spectrum, Vec3A, vector};
use etendue_sampling::{Dim, Sampler, Slot};
use etendue_scene::Scene;

pub use surfaces::AreaError;
use surfaces::{AreaNumbers, AreaSample, Surfaces};

use crate::arrival::{Arrival, Cone, add_emission, follow};
use crate::inside::Inside;
use crate::integrator::calls;
use crate::lights::Receiver;
use crate::path::{Roulette, cutout_bits};
use crate::shaded::{Shaded, bsdf_at};
use crate::{Context, Integrator, Recorder, Sample};

/// Reflected radiance as an integral over all surfaces (Kajiya 1986):
/// L(x → Θ) = L_e + ∫ L(y → x) f cos θx cos θy / |x − y|² V(x, y) dA, with y drawn evenly over the area of *everything* that
/// is there, lit or not.
///
/// Unbiased, and for comparing: its variance is as large as areas are far and corners are near. Where surfaces touch it has no
/// bound, and means of few samples look better than they are: mostly a little low, rarely far too high. Surfaces that
/// coincide count twice, where a ray sees one of them.
///
/// What has no area is met in its own way: a mirrored or refracted ray is followed, a light at infinity is drawn, a lamp
/// without extent is drawn by the scene's picker.
pub struct AreaForm {
    /// Most scattering events on a path. `None` is unlimited. Bias.
    pub max_depth: Option<u32>,
    /// When paths end early.
    pub roulette: Roulette,
    surfaces: Surfaces,
}

impl AreaForm {
    /// For one scene; in another its pictures would be wrong.
    ///
    /// # Errors
    /// A geometry that no point can be drawn on.
    pub fn new(scene: &Scene) -> Result<Self, AreaError> {
        let surfaces = Surfaces::new(scene)?;
        Ok(Self { max_depth: None, roulette: Roulette::Throughput { from: 3 }, surfaces })
    }

    fn walk<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        s: &CameraSample,
        u: S,
        rec: &mut R,
    ) -> Sample {
        let mut out = Sample::default();
        let mut w = Walk {
            beta: Spectrum::ONE,
            eta_scale: 1.0,
            depth: 0,
            cone: Cone { length: 0.0, spread: s.spread },
            inside: Inside::of(cx.scene.needs()),
            u,
        };
        let mut way = Way::Ray(s.ray);
        loop {
            let (mut at, wo) = match way {
                Way::Ray(ray) => {
                    let beyond = w.inside.map_or(w.beta, |i| w.beta * i.transmittance(f32::INFINITY));
                    match follow(cx, &ray, w.depth, w.cone, beyond, &w.u, &mut out, rec) {
                        Some(at) => (at, -ray.d),
                        None => return out,
                    }
                }
                Way::Point(at, wo) => (at, wo),
            };
            if let Some(inside) = &w.inside {
                w.beta *= inside.transmittance(at.distance);
            }
            w.cone = w.cone.after(at.distance);
            add_emission(cx, &at.surface, wo, w.depth, w.beta, &mut out, rec);
            let Some(bsdf) = bsdf_at(cx, &mut at.surface) else { return out };
            let here = Shaded::new(&at.surface, &bsdf, wo);
            rec.vertex(&here.vertex(w.depth, at.distance, w.beta));
            if self.max_depth.is_some_and(|m| w.depth >= m) {
                return out;
            }
            let lobes = here.lobes();
            if lobes.intersects(Lobes::DIFFUSE | Lobes::GLOSSY) {
                let Walk { depth, beta, inside, u, .. } = w;
                Receiver { here: &here, depth, beta, inside, u, shadows: true }.no_surface(cx, &mut out, rec);
            }
            let next = self.onward(cx, &here, lobes, &mut w);
            // No number any more: handed on as it is, so that the film refuses the sample and says where.
            if !w.beta.is_finite() {
                out.l += w.beta;
                return out;
            }
            match next {
                Some(next) if self.survives(cx, &here, &mut w) => way = next,
                _ => return out,
            }
        }
    }

    /// Where the path goes on, its weight multiplied in.
    fn onward<S: Sampler>(
        &self,
        cx: &Context<'_>,
        here: &Shaded<'_>,
        lobes: Lobes,
        w: &mut Walk<S>,
    ) -> Option<Way> {
        let delta = lobes.contains(Lobes::DELTA);
        let spread = lobes.intersects(Lobes::DIFFUSE | Lobes::GLOSSY);
        // Where a surface has both, a coin says which is followed.
        let both = delta && spread;
        let follows_ray = if both { w.u.get_1d(Dim::bounce(w.depth, Slot::Spare1)) < 0.5 } else { delta };
        if both {
            w.beta *= 2.0;
        }
        if follows_ray { self.mirrored(cx, here, w).map(Way::Ray) } else { self.elsewhere(cx, here, w) }
    }

    /// The ray of a delta lobe; `None` too where another lobe was drawn.
    fn mirrored<S: Sampler>(&self, cx: &Context<'_>, here: &Shaded<'_>, w: &mut Walk<S>) -> Option<Ray> {
        cx.count(|c| c.draws_bsdf += 3);
        let u_lobe = w.u.get_1d(Dim::bounce(w.depth, Slot::Lobe));
        let u = w.u.get_2d(Dim::bounce(w.depth, Slot::Bsdf));
        let sample = here.bsdf.sample(here.frame.to_local(here.wo), u_lobe, u, Mode::Radiance)?;
        let wi = here.frame.to_world(sample.wi);
        if !sample.lobe.contains(Lobes::DELTA) || !here.agrees(wi) {
            return None;
        }
        w.beta *= sample.weight;
        if sample.lobe.contains(Lobes::TRANSMISSION) {
            w.eta_scale *= sample.eta * sample.eta;
        }
        w.cross(cx, here, wi);
        cx.count(|c| c.scatter_rays += 1);
        Some(here.surface.origin().ray(vector::normalize(wi), here.surface.time))
    }

    /// A point somewhere in the scene, if it is seen.
    fn elsewhere<S: Sampler>(&self, cx: &Context<'_>, here: &Shaded<'_>, w: &mut Walk<S>) -> Option<Way> {
        let own = w.u.fork(w.depth);
        let number = |slot| own.get_1d_f64(Dim::bounce(w.depth, slot));
        let numbers = AreaNumbers {
            geometry: number(Slot::Lobe),
            triangle: number(Slot::Roulette),
            point: own.get_2d(Dim::bounce(w.depth, Slot::Bsdf)),
        };
        cx.count(|c| c.draws_bsdf += 4);
        let AreaSample { mut surface, pdf_area } =
            self.surfaces.sample(cx.scene, &numbers, here.surface.time)?;
        let (from, end) = (here.surface.origin(), surface.origin());
        let span = end.p - from.p;
        let d = vector::try_normalize(span)?;
        if !here.agrees(d) {
            return None;
        }
        let distance = vector::length(span);
        let squared = f64::from(distance) * f64::from(distance);
        let change = f64::from(d.dot(surface.ng).abs()) / (squared * pdf_area);
        let f = here.bsdf.eval(here.frame.to_local(here.wo), here.frame.to_local(d), Mode::Radiance);
        w.beta *= f * change as f32;
        if w.beta.is_black() {
            return None;
        }
        let segment = Segment { from, d, to: Some(end), time: here.surface.time };
        cx.count(|c| c.shadow_rays += 1);
        let bits = cutout_bits(cx, cx.scene.needs(), &w.u, w.depth, true);
        w.beta *= cx.scene.transmittance(&segment, bits) * cx.scene.opacity(&surface);
        if w.beta.is_black() {
            return None;
        }
        w.cross(cx, here, d);
        surface.footprint = w.cone.radius(distance);
        Some(Way::Point(Arrival { surface, distance }, -d))
    }

    /// One scattering event more; false where the path ends.
    fn survives<S: Sampler>(&self, cx: &Context<'_>, here: &Shaded<'_>, w: &mut Walk<S>) -> bool {
        w.depth += 1;
        let carried = w.beta.max_channel() * w.eta_scale;
        let albedo = || here.bsdf.albedo(here.frame.to_local(here.wo));
        let survival = self.roulette.survival(w.depth, carried, albedo);
        if survival < 1.0 {
            cx.count(|c| c.draws_roulette += 1);
            if w.u.get_1d(Dim::bounce(w.depth - 1, Slot::Roulette)) >= survival {
                cx.count(|c| c.roulette_ends += 1);
                return false;
            }
            w.beta = w.beta / survival;
        }
        !w.beta.is_black()
    }
}

/// How a path goes on.
enum Way {
    Ray(Ray),
    /// To a point that is seen, with the direction back from it.
    Point(Arrival, Vec3A),
}

/// What a path carries.
#[derive(Clone, Copy)]
struct Walk<S> {
    beta: Spectrum,
    eta_scale: f32,
    depth: u32,
    cone: Cone,
    inside: Option<Inside>,
    u: S,
}

impl<S> Walk<S> {
    /// To the side of the surface on which `wi` is.
    fn cross(&mut self, cx: &Context<'_>, here: &Shaded<'_>, wi: Vec3A) {
        if let (Some(inside), Some(body)) = (&mut self.inside, cx.scene.body(here.surface)) {
            *inside = inside.beyond(body, here.wo.dot(here.surface.ng), wi.dot(here.surface.ng));
        }
    }
}

impl<S: Sampler> Integrator<S> for AreaForm {
    calls!(walk);

    fn bias(&self) -> Vec<String> {
        self.max_depth.map(|m| format!("max_depth={m}: longer paths are cut off")).into_iter().collect()
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("area form");
        f.tag(&format!("{:?} {:?}", self.max_depth, self.roulette));
    }
}
