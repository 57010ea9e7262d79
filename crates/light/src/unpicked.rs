use std::sync::Arc;

use etendue_core::{Fingerprint, Needs, Ray, Spectrum, Vec2, Vec3A};
use etendue_geometry::Surface;

use crate::{Light, LightBounds, LightSample, LitPoint};

/// A light that is found by rays alone: it has no power for a picker, and there is nothing to draw.
///
/// For emitters with holes: a ray decides about the holes where it meets them, so that only what rays find is weighed
/// rightly (with 1).
pub struct Unpicked(pub Arc<dyn Light>);

impl Light for Unpicked {
    fn parts(&self) -> u32 {
        self.0.parts()
    }

    fn sample(&self, _at: &LitPoint, _part: u32, _u: Vec2) -> Option<LightSample> {
        None
    }

    fn pdf(&self, _at: &LitPoint, _part: u32, _wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        0.0
    }

    /// Zero, so that it is never picked, though it shines.
    fn power(&self, _part: u32, _scene_radius: f32) -> Spectrum {
        Spectrum::BLACK
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        self.0.bounds(part).map(|b| LightBounds { power: 0.0, ..b })
    }

    fn emitted(&self, part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        self.0.emitted(part, at, wo)
    }

    fn escaped(&self, ray: &Ray) -> Spectrum {
        self.0.escaped(ray)
    }

    fn is_infinite(&self) -> bool {
        self.0.is_infinite()
    }

    fn needs(&self) -> Needs {
        self.0.needs() - Needs::AREA_LIGHTS
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("unpicked");
        self.0.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}
