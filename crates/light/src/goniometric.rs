use std::sync::Arc;

use etendue_core::{Aabb, Fingerprint, Frame, Needs, Origin, Spectrum, Transform, Vec2, Vec3A, vector};
use etendue_geometry::Surface;

use crate::emitter::{held_power, is_behind, positive, toward};
use crate::{IntensityTable, Light, LightBounds, LightSample, LitPoint};

/// A point that shines as a lamp was measured to: by a table of intensities, such as an IES file holds.
///
/// In its own space `y` is up, so that the vertical angle 0 shines along `−y`, and horizontal angles go from `x` toward
/// `−z`: counter-clockwise as seen from above.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    position: Vec3A,
    /// Its z is the lamp's up, its x the horizontal angle 0.
    frame: Frame,
    table: Arc<IntensityTable>,
    /// W·sr⁻¹ for each unit of the table.
    scale: Spectrum,
    integral: f64,
}

impl GoniometricLight {
    /// A lamp placed by `to_world` (its scale and shear are ignored; a mirror is not followed), with the intensity in
    /// W·sr⁻¹ that one unit of the table stands for: 1/683 of each channel for candelas of a white lamp. Negative
    /// channels count as 0.
    pub fn new(to_world: &Transform, table: Arc<IntensityTable>, scale: Spectrum) -> Self {
        let [x, y, _, position] = to_world.columns();
        let frame = Frame::from_normal_tangent(vector::normalize(y), x);
        let integral = table.integral();
        Self { position, frame, table, scale: positive(scale), integral }
    }

    /// Where it stands.
    pub fn position(&self) -> Vec3A {
        self.position
    }

    /// The intensities.
    pub fn table(&self) -> &Arc<IntensityTable> {
        &self.table
    }
}

impl Light for GoniometricLight {
    fn sample(&self, at: &LitPoint, _part: u32, _u: Vec2) -> Option<LightSample> {
        let seen = toward(at.p, self.position)?;
        let factor = f64::from(self.table.along(self.frame.to_local(-seen.w)));
        let li = self.scale.map(|i| (f64::from(i) * factor / seen.d2) as f32);
        if is_behind(at, seen.w) || li.is_black() || !li.is_finite() {
            return None;
        }
        let end = Some(Origin::free(self.position));
        Some(LightSample { wi: seen.w, li, pdf: 1.0, end, is_delta: true })
    }

    fn pdf(&self, _at: &LitPoint, _part: u32, _wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        0.0
    }

    /// The table's integral in closed form.
    fn power(&self, _part: u32, _scene_radius: f32) -> Spectrum {
        held_power(self.scale, self.integral)
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
        f.tag("goniometric light");
        f.floats(&self.position.to_array());
        f.floats(&self.frame.x.to_array());
        f.floats(&self.frame.z.to_array());
        f.floats(&self.scale.to_array());
        self.table.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }
}
