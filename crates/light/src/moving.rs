use std::sync::Arc;

use etendue_core::math::wide::acos;
use etendue_core::{Fingerprint, Motion, Needs, Ray, Spectrum, Transform, Vec2, Vec3A, vector};
use etendue_geometry::{ReturnBound, Surface};

use crate::emitter::is_behind;
use crate::{Light, LightBounds, LightSample, LitPoint};

/// A light that moves while the shutter is open, of any kind: with the points that ask it.
///
/// Rather than the lamp, the asking point is moved: at the time of the question it is taken back by the motion, the lamp
/// is asked where it stood at time 0, and what it says is carried forward. A rigid motion changes no solid angle, so the
/// densities are the lamp's own. Textures by position move with the lamp.
pub struct MovingLight {
    light: Arc<dyn Light>,
    motion: Motion,
    /// How far a hit on the lamp's geometry may be from the lamp, at any time.
    traced: Option<ReturnBound>,
}

impl MovingLight {
    /// A light that stands where it is at time 0, and moves by `motion`. For a light without a surface that rays meet.
    pub fn new(light: Arc<dyn Light>, motion: Motion) -> Self {
        Self { light, motion, traced: None }
    }

    /// The light of a moving instance: `placement` is that of the geometry at time 0, which `light` already has in it.
    ///
    /// Rays meet the geometry by way of the placement of their time, which rounds otherwise than the light's own; the ends
    /// of shadow rays have to know by how much, or the lamp would shadow itself.
    pub fn of_instance(light: Arc<dyn Light>, placement: &Transform, motion: Motion) -> Self {
        let traced = Some(ReturnBound::new(placement, &motion));
        Self { light, motion, traced }
    }

    /// The light as it is at time 0.
    pub fn light(&self) -> &Arc<dyn Light> {
        &self.light
    }

    /// What it does then.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The displacement at a time.
    fn at(&self, time: f32) -> Placed {
        let forward = self.motion.at(time);
        Placed { forward, back: forward.inverse() }
    }
}

/// The way there and back at one time.
struct Placed {
    forward: Transform,
    back: Transform,
}

impl Placed {
    fn point(&self, at: &LitPoint) -> LitPoint {
        let (p, p_err) = self.back.point_with_error(at.p, at.p_err);
        let turned = |n: Vec3A| if n == Vec3A::ZERO { n } else { self.back.normal(n) };
        LitPoint { p, p_err, ng: turned(at.ng), ns: turned(at.ns), ..*at }
    }

    /// A unit direction of the world, where the lamp is at rest.
    fn direction(&self, d: Vec3A) -> Vec3A {
        vector::normalize(self.back.vector(d))
    }

    fn surface(&self, seen: &Surface) -> Surface {
        seen.clone().transformed(&self.back)
    }
}

impl Light for MovingLight {
    fn parts(&self) -> u32 {
        self.light.parts()
    }

    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
        let placed = self.at(at.time);
        let mut s = self.light.sample(&placed.point(at), part, u)?;
        s.wi = vector::normalize(placed.forward.vector(s.wi));
        // Rounding may carry what grazes the surface across it.
        if is_behind(at, s.wi) {
            return None;
        }
        if let Some(end) = &mut s.end {
            *end = end.transformed(&placed.forward);
            if let Some(traced) = &self.traced {
                end.p_err += Vec3A::splat(traced.at(end.p));
            }
        }
        Some(s)
    }

    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        if is_behind(at, wi) {
            return 0.0;
        }
        let placed = self.at(at.time);
        let seen = seen.map(|s| placed.surface(s));
        self.light.pdf(&placed.point(at), part, placed.direction(wi), seen.as_ref())
    }

    fn power(&self, part: u32, scene_radius: f32) -> Spectrum {
        self.light.power(part, scene_radius)
    }

    /// Around the whole motion: the cone of normals is that at half time, widened by the farthest that the axis turns away
    /// from there.
    fn bounds(&self, part: u32) -> Option<LightBounds> {
        let still = self.light.bounds(part)?;
        let bounds = self.motion.bounds_of(&still.bounds);
        let halfway = vector::normalize(self.motion.at(0.5).vector(still.axis));
        // An arc of a circle of this radius is longer than the angle between its ends.
        let radius = vector::length(self.motion.axis().cross(still.axis));
        let swept = 0.5 * self.motion.angle().abs() * f64::from(radius);
        let normals = acos(f64::from(still.cos_normals).clamp(-1.0, 1.0));
        let cos_normals = if swept == 0.0 {
            still.cos_normals
        } else if normals + swept < std::f64::consts::PI {
            // Rounded outward.
            (etendue_core::math::wide::sin_cos(normals + swept).1 - 1e-6) as f32
        } else {
            -1.0
        };
        Some(LightBounds { bounds, axis: halfway, cos_normals, ..still })
    }

    fn emitted(&self, part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        let placed = self.at(at.time);
        let still = placed.surface(at);
        let le = self.light.emitted(part, &still, placed.direction(wo));
        at.fetches.set(still.fetches.get());
        le
    }

    fn escaped(&self, ray: &Ray) -> Spectrum {
        let placed = self.at(ray.time);
        self.light.escaped(&Ray { o: placed.back.point(ray.o), d: placed.direction(ray.d), ..*ray })
    }

    fn is_infinite(&self) -> bool {
        self.light.is_infinite()
    }

    fn is_delta(&self) -> bool {
        self.light.is_delta()
    }

    fn needs(&self) -> Needs {
        let mut needs = self.light.needs();
        needs.set(Needs::MOTION, needs.contains(Needs::MOTION) || !self.motion.is_still());
        needs
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("moving light");
        self.motion.fingerprint(f);
        self.light.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.light.bytes() + size_of::<Self>()
    }
}
