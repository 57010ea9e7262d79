use std::f64::consts::TAU;

use etendue_core::{Aabb, Fingerprint, Needs, Origin, Spectrum, Vec2, Vec3A, math, vector};
use etendue_geometry::Surface;

use crate::emitter::{held_power, is_behind, positive, toward};
use crate::{Light, LightBounds, LightSample, LitPoint};

/// A point that shines into a cone, as KHR_lights_punctual means it: with `c` the cosine to the axis, the intensity is
/// multiplied by `clamp((c − cos outer) / max(0.001, cos inner − cos outer), 0, 1)²`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    position: Vec3A,
    /// Unit.
    axis: Vec3A,
    intensity: Spectrum,
    cos_outer: f32,
    /// Over how much of the cosine the light falls off.
    width: f32,
}

impl SpotLight {
    /// A spot at `position` that shines along `direction` (of any length; none shines nowhere) with `intensity` on its
    /// axis, W·sr⁻¹ (negative channels count as 0): all of it within `inner` radians of the axis, nothing beyond `outer`.
    /// Angles are held in `[0, π]`.
    pub fn new(position: Vec3A, direction: Vec3A, intensity: Spectrum, inner: f32, outer: f32) -> Self {
        let axis = vector::try_normalize(direction);
        let cos =
            |angle: f32| math::cos(if angle > 0.0 { angle.clamp(0.0, std::f32::consts::PI) } else { 0.0 });
        let (cos_inner, cos_outer) = (cos(inner), cos(outer));
        let width = cos_inner - cos_outer;
        Self {
            position,
            axis: axis.unwrap_or(Vec3A::NEG_Z),
            intensity: if axis.is_some() { positive(intensity) } else { Spectrum::BLACK },
            cos_outer,
            width: if width > 1e-3 { width } else { 1e-3 },
        }
    }

    /// Where it stands.
    pub fn position(&self) -> Vec3A {
        self.position
    }

    /// Unit direction that it shines along.
    pub fn axis(&self) -> Vec3A {
        self.axis
    }

    /// Fraction of the intensity at the cosine `c` to the axis.
    #[inline]
    fn falloff(&self, c: f32) -> f32 {
        let x = ((c - self.cos_outer) / self.width).clamp(0.0, 1.0);
        x * x
    }

    /// The falloff integrated over all directions, sr.
    fn solid_angle(&self) -> f64 {
        let (outer, width) = (f64::from(self.cos_outer), f64::from(self.width));
        let full = if outer + width < 1.0 { outer + width } else { 1.0 };
        let slope = full - outer;
        TAU * ((1.0 - full) + slope * slope * slope / (3.0 * width * width))
    }
}

impl Light for SpotLight {
    #[inline]
    fn sample(&self, at: &LitPoint, _part: u32, _u: Vec2) -> Option<LightSample> {
        let seen = toward(at.p, self.position)?;
        let falloff = self.falloff(-seen.w.dot(self.axis));
        let li = (self.intensity * falloff).map(|i| (f64::from(i) / seen.d2) as f32);
        if is_behind(at, seen.w) || li.is_black() || !li.is_finite() {
            return None;
        }
        let end = Some(Origin::free(self.position));
        Some(LightSample { wi: seen.w, li, pdf: 1.0, end, is_delta: true })
    }

    fn pdf(&self, _at: &LitPoint, _part: u32, _wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        0.0
    }

    /// In closed form: `2π I (1 − cos i + (cos i − cos o) / 3)` for cones wide enough.
    fn power(&self, _part: u32, _scene_radius: f32) -> Spectrum {
        held_power(self.intensity, self.solid_angle())
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        Some(LightBounds {
            bounds: Aabb::of_points([self.position]),
            axis: self.axis,
            cos_normals: 1.0,
            cos_emission: self.cos_outer,
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
        f.tag("spot light");
        f.floats(&self.position.to_array());
        f.floats(&self.axis.to_array());
        f.floats(&self.intensity.to_array());
        f.floats(&[self.cos_outer, self.width]);
    }
}
