use std::cell::Cell;
use std::sync::Arc;

use etendue_core::{Fingerprint, Needs, Origin, Ray, Spectrum, Transform, Vec2, Vec3A};
use etendue_geometry::{Shape, ShapeHit, ShapeSample, Surface, return_error};
use etendue_texture::{Tex, TexPoint, Texture};

use crate::emitter::{
    self, floored, is_behind, lambertian_power, per_solid_angle, positive, radiance, toward, wide,
};
use crate::{Light, LightBounds, LightSample, LitPoint};

/// Any shape that can be sampled, shining. Lambertian, from the front or from both sides.
///
/// Sampled by area. [`Shape::sample`] must be uniform over [`Shape::area`], since the density of a point found
/// otherwise is taken to be 1 / area. A shape without area emits when it is hit, but is never chosen.
#[derive(Clone)]
pub struct ShapeLight {
    shape: Arc<dyn Shape>,
    to_world: Option<Transform>,
    radiance: Tex,
    two_sided: bool,
    /// World space, m².
    area: f64,
}

impl ShapeLight {
    /// A shining shape, placed by `to_world` if there is one.
    pub fn new(shape: Arc<dyn Shape>, to_world: Option<Transform>, radiance: Tex, two_sided: bool) -> Self {
        let mut light = Self { shape, to_world, radiance, two_sided, area: 0.0 };
        light.area = light.world_area();
        light
    }

    /// The shape.
    pub fn shape(&self) -> &Arc<dyn Shape> {
        &self.shape
    }

    /// Radiance of the shining side, W·m⁻²·sr⁻¹.
    pub fn radiance(&self) -> &Tex {
        &self.radiance
    }

    /// The area in world space; under a map that stretches unevenly an average over a 16 × 16 grid of samples.
    fn world_area(&self) -> f64 {
        let object = f64::from(self.shape.area());
        if !(object > 0.0 && object.is_finite()) {
            return 0.0;
        }
        if self.to_world.is_none() {
            return object;
        }
        const SIDE: u32 = 16;
        let at = |i: u32| (i as f32 + 0.5) / SIDE as f32;
        let (mut sum, mut count) = (0.0, 0u32);
        for i in 0..SIDE * SIDE {
            if let Some(s) = self.shape.sample(Vec2::new(at(i % SIDE), at(i / SIDE))) {
                sum += self.stretch(s.ng);
                count += 1;
            }
        }
        if count == 0 { 0.0 } else { object * sum / f64::from(count) }
    }

    /// World area over object area where the object normal is `n`.
    fn stretch(&self, n: Vec3A) -> f64 {
        self.to_world.as_ref().map_or(1.0, |m| m.area_scale(n))
    }

    /// The same for a world normal.
    fn stretch_at(&self, world: Vec3A) -> f64 {
        let Some(m) = &self.to_world else {
            return 1.0;
        };
        let [x, y, z, _] = m.columns();
        let n = etendue_core::vector::normalize(Vec3A::new(x.dot(world), y.dot(world), z.dot(world)));
        self.stretch(n)
    }

    fn pdf_area(&self, stretch: f64) -> f64 {
        1.0 / (f64::from(self.shape.area()) * stretch)
    }

    /// The sampled point in world space.
    fn place(&self, s: &ShapeSample) -> Origin {
        let object = Origin { p: s.p, p_err: s.p_err, ng: s.ng };
        match &self.to_world {
            None => object,
            Some(m) => {
                let mut end = object.transformed(m);
                end.p_err += return_error(m, end.p);
                end
            }
        }
    }

    /// Radiance at a sampled point. The coordinates are asked of the shape, as of a ray that fell straight onto it.
    fn radiance_at(&self, s: &ShapeSample, world: Vec3A) -> Spectrum {
        if let Tex::Constant(l) = self.radiance {
            return positive(l);
        }
        let far = self.shape.bounds().radius();
        let above = Ray::new(s.p + s.ng * far, -s.ng);
        let uv = self.shape.surface(&above, &ShapeHit { t: far, uv: s.uv }).uv;
        let fetches = Cell::new(0);
        radiance(&self.radiance, &TexPoint { uv, p: world, fetches: &fetches })
    }
}

impl Light for ShapeLight {
    fn sample(&self, at: &LitPoint, _part: u32, u: Vec2) -> Option<LightSample> {
        if self.area == 0.0 {
            return None;
        }
        let s = self.shape.sample(u)?;
        let end = self.place(&s);
        let seen = toward(at.p, end.p)?;
        let cos = wide(seen.w).dot(wide(end.ng));
        if is_behind(at, seen.w) || !(self.two_sided || cos < 0.0) {
            return None;
        }
        let pdf = per_solid_angle(self.pdf_area(self.stretch(s.ng)), seen.d2, cos)?;
        let li = self.radiance_at(&s, end.p);
        (!li.is_black()).then_some(LightSample { wi: seen.w, li, pdf, end: Some(end), is_delta: false })
    }

    fn pdf(&self, at: &LitPoint, _part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        let Some(seen) = seen.filter(|_| self.area > 0.0 && !is_behind(at, wi)) else {
            return 0.0;
        };
        let cos = wide(wi).dot(wide(seen.ng));
        if !(self.two_sided || cos < 0.0) {
            return 0.0;
        }
        toward(at.p, seen.p)
            .and_then(|v| per_solid_angle(self.pdf_area(self.stretch_at(seen.ng)), v.d2, cos))
            .unwrap_or(0.0)
    }

    fn power(&self, _part: u32, _scene_radius: f32) -> Spectrum {
        lambertian_power(floored(self.radiance.mean(), &self.radiance), self.area, self.two_sided)
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        let bounds = self.shape.bounds();
        Some(LightBounds {
            bounds: self.to_world.as_ref().map_or(bounds, |m| m.aabb(&bounds)),
            axis: Vec3A::Y,
            cos_normals: -1.0,
            cos_emission: 0.0,
            power: self.power(part, 0.0).mean(),
        })
    }

    fn emitted(&self, _part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        emitter::emitted(&self.radiance, self.two_sided, at, wo)
    }

    fn needs(&self) -> Needs {
        emitter::needs(&self.radiance)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("shape light");
        f.u64(u64::from(self.two_sided));
        self.shape.fingerprint(f);
        self.to_world.unwrap_or(Transform::IDENTITY).fingerprint(f);
        self.radiance.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.radiance.bytes()
    }
}
