use std::f32::consts::PI;

use etendue_core::{Fingerprint, Frame, Needs, Ray, Spectrum, Vec2, Vec3A};
use etendue_geometry::Surface;
use etendue_sampling::warp;

use crate::emitter::{infinite_power, is_behind, positive};
use crate::{Light, LightBounds, LightSample, LitPoint, Sides};

/// The same radiance from every direction: an overcast world, a furnace.
///
/// A point that uses one side of its surface gets directions in proportion to the cosine there, any other uniform ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantEnvironment {
    /// Radiance, W·m⁻²·sr⁻¹. Negative channels count as 0.
    pub radiance: Spectrum,
}

impl ConstantEnvironment {
    /// A world of one colour.
    pub fn new(radiance: Spectrum) -> Self {
        Self { radiance }
    }

    #[inline]
    fn is_cosine(at: &LitPoint) -> bool {
        at.sides == Sides::Same && at.ns != Vec3A::ZERO
    }

    #[inline]
    fn density(at: &LitPoint, wi: Vec3A) -> f32 {
        if is_behind(at, wi) {
            0.0
        } else if Self::is_cosine(at) {
            warp::cosine_pdf(at.ns.dot(wi))
        } else {
            warp::SPHERE_PDF
        }
    }
}

impl Light for ConstantEnvironment {
    #[inline]
    fn sample(&self, at: &LitPoint, _part: u32, u: Vec2) -> Option<LightSample> {
        let wi = if Self::is_cosine(at) {
            Frame::from_normal(at.ns).to_world(warp::cosine(u))
        } else {
            warp::sphere(u)
        };
        let (pdf, li) = (Self::density(at, wi), positive(self.radiance));
        (pdf > 0.0 && !li.is_black()).then_some(LightSample { wi, li, pdf, end: None, is_delta: false })
    }

    #[inline]
    fn pdf(&self, at: &LitPoint, _part: u32, wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        if positive(self.radiance).is_black() { 0.0 } else { Self::density(at, wi) }
    }

    /// π L on every point of the sphere's surface 4π R².
    fn power(&self, _part: u32, scene_radius: f32) -> Spectrum {
        infinite_power(positive(self.radiance) * (4.0 * PI), scene_radius)
    }

    fn bounds(&self, _part: u32) -> Option<LightBounds> {
        None
    }

    #[inline]
    fn escaped(&self, _ray: &Ray) -> Spectrum {
        positive(self.radiance)
    }

    fn is_infinite(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::LIGHTS | Needs::ENVIRONMENT | Needs::AREA_LIGHTS
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("constant environment");
        f.floats(&self.radiance.to_array());
    }
}
