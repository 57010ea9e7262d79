use etendue_core::{Aabb, Fingerprint, Needs, Origin, Spectrum, Vec2, Vec3A};
use etendue_geometry::Surface;

use crate::emitter::{held_power, is_behind, positive, toward};
use crate::{Light, LightBounds, LightSample, LitPoint};

/// A point that shines equally in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Position.
    pub position: Vec3A,
    /// Radiant intensity, W·sr⁻¹. Negative channels count as 0.
    pub intensity: Spectrum,
}

impl PointLight {
    /// A point light.
    pub fn new(position: Vec3A, intensity: Spectrum) -> Self {
        Self { position, intensity }
    }
}

impl Light for PointLight {
    #[inline]
    fn sample(&self, at: &LitPoint, _part: u32, _u: Vec2) -> Option<LightSample> {
        let seen = toward(at.p, self.position)?;
        let li = positive(self.intensity).map(|i| (f64::from(i) / seen.d2) as f32);
        if is_behind(at, seen.w) || li.is_black() || !li.is_finite() {
            return None;
        }
        let end = Some(Origin::free(self.position));
        Some(LightSample { wi: seen.w, li, pdf: 1.0, end, is_delta: true })
    }

    fn pdf(&self, _at: &LitPoint, _part: u32, _wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        0.0
    }

    fn power(&self, _part: u32, _scene_radius: f32) -> Spectrum {
        held_power(positive(self.intensity), f64::from(4.0 * std::f32::consts::PI))
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        Some(LightBounds {
            bounds: Aabb::of_points([self.position]),
            axis: Vec3A::Y,
            cos_normals: -1.0,
            cos_emission: 0.0,
            power: self.power(part, 0.0).mean(),
        })
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::LIGHTS
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("point light");
        f.floats(&self.position.to_array());
        f.floats(&self.intensity.to_array());
    }
}
