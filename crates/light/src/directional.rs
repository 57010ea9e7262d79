use etendue_core::{Fingerprint, Needs, Spectrum, Vec2, Vec3A, vector};
use etendue_geometry::Surface;

use crate::emitter::{infinite_power, is_behind, positive};
use crate::{Light, LightBounds, LightSample, LitPoint};

/// Light from infinitely far away, all of one direction: a sun without a disc. No ray can meet it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Unit direction toward the light.
    toward: Vec3A,
    irradiance: Spectrum,
}

impl DirectionalLight {
    /// A light that shines along `direction` (of any length; none shines nowhere) with an `irradiance` on a plane that
    /// faces it, W·m⁻². Negative channels count as 0.
    pub fn new(direction: Vec3A, irradiance: Spectrum) -> Self {
        match vector::try_normalize(-direction) {
            Some(toward) => Self { toward, irradiance: positive(irradiance) },
            None => Self { toward: Vec3A::Y, irradiance: Spectrum::BLACK },
        }
    }

    /// Unit direction that it shines along.
    pub fn direction(&self) -> Vec3A {
        -self.toward
    }

    /// Irradiance on a plane that faces it, W·m⁻².
    pub fn irradiance(&self) -> Spectrum {
        self.irradiance
    }
}

impl Light for DirectionalLight {
    #[inline]
    fn sample(&self, at: &LitPoint, _part: u32, _u: Vec2) -> Option<LightSample> {
        if is_behind(at, self.toward) || self.irradiance.is_black() {
            return None;
        }
        Some(LightSample { wi: self.toward, li: self.irradiance, pdf: 1.0, end: None, is_delta: true })
    }

    fn pdf(&self, _at: &LitPoint, _part: u32, _wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        0.0
    }

    /// What passes the disc that the scene's sphere shows it: π R² E.
    fn power(&self, _part: u32, scene_radius: f32) -> Spectrum {
        infinite_power(self.irradiance, scene_radius)
    }

    fn bounds(&self, _part: u32) -> Option<LightBounds> {
        None
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::LIGHTS
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("directional light");
        f.floats(&self.toward.to_array());
        f.floats(&self.irradiance.to_array());
    }
}
