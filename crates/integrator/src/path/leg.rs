use etendue_core::{Needs, Ray, Spectrum, Vec3A};
use etendue_light::{LitPoint, Sides};
use etendue_sampling::Sampler;

use crate::inside::Inside;

/// What the last scattering event left for weighing emission that the next ray finds.
#[derive(Clone, Copy)]
pub(super) struct Scattered {
    pub(super) at: LitPoint,
    pub(super) pdf: f32,
    /// Light sampling could not have found it: a delta lobe, or the camera itself.
    pub(super) only_way: bool,
}

/// A path that is about to be followed along `ray`.
#[derive(Clone, Copy)]
pub(super) struct Leg<S> {
    pub(super) ray: Ray,
    pub(super) from: Scattered,
    pub(super) carried: Carried,
    pub(super) u: S,
}

/// What a path carries along.
#[derive(Clone, Copy)]
pub(super) struct Carried {
    pub(super) beta: Spectrum,
    /// Product of the squared relative indices crossed: what refraction scales radiance by, the other way round.
    pub(super) eta_scale: f32,
    /// Metres from the camera.
    pub(super) length: f32,
    /// Scattering events so far.
    pub(super) depth: u32,
    /// `None` in a scene where nothing absorbs.
    pub(super) inside: Option<Inside>,
}

/// The parts of a leg, apart: what is called with the address of one then does not pin the others to memory, which
/// costs a path 2 % of its instructions.
pub(super) struct Parts<'p, S> {
    pub(super) ray: &'p mut Ray,
    pub(super) from: &'p mut Scattered,
    pub(super) carried: &'p mut Carried,
    pub(super) u: &'p mut S,
}

impl Scattered {
    /// The camera, from which a ray comes.
    #[inline(always)]
    pub(super) fn nowhere(ray: &Ray) -> Self {
        let at = LitPoint {
            p: ray.o,
            p_err: Vec3A::ZERO,
            ng: Vec3A::ZERO,
            ns: Vec3A::ZERO,
            sides: Sides::Free,
            time: ray.time,
        };
        Self { at, pdf: 0.0, only_way: true }
    }
}

impl Carried {
    /// Away from the camera.
    #[inline(always)]
    pub(super) fn first(needs: Needs) -> Self {
        Self { beta: Spectrum::ONE, eta_scale: 1.0, length: 0.0, depth: 0, inside: Inside::of(needs) }
    }
}

impl<S> Leg<S> {
    #[inline(always)]
    pub(super) fn parts(&mut self) -> Parts<'_, S> {
        Parts { ray: &mut self.ray, from: &mut self.from, carried: &mut self.carried, u: &mut self.u }
    }
}

impl<S: Sampler> Parts<'_, S> {
    /// A copy with random numbers of its own.
    pub(super) fn branch(&self, way: u32) -> Leg<S> {
        let u = self.u.fork(self.carried.depth << 16 ^ way);
        Leg { ray: *self.ray, from: *self.from, carried: *self.carried, u }
    }
}
