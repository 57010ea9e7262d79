use std::cell::Cell;

use etendue_core::{Fingerprint, Needs, Spectrum, Vec2, Vec3A, vector};
use etendue_geometry::{Parallelogram, Shape, Surface};
use etendue_sampling::warp::{RectangleAxes, SphericalRectangle};
use etendue_texture::{Tex, TexPoint, Texture};

use crate::emitter::{
    self, end_on, floored, is_behind, lambertian_power, largest, per_solid_angle, radiance, toward, wide,
};
use crate::{Light, LightBounds, LightSample, LitPoint};

/// A flat parallelogram that shines. Lambertian, from the front or from both sides.
///
/// A rectangle is sampled uniformly in the solid angle it fills (Ureña, Fajardo & King 2013), with the same limits as
/// the triangles of a [`MeshLight`](crate::MeshLight); any other by area.
#[derive(Clone, Debug)]
pub struct ParallelogramLight {
    /// Where it is, world space.
    shape: Parallelogram,
    /// Radiance of the shining side, W·m⁻²·sr⁻¹.
    pub radiance: Tex,
    /// Whether the back shines too.
    pub two_sided: bool,
    /// `None` where the corners are not square to a few ulp: then area sampling is used.
    axes: Option<RectangleAxes>,
}

impl ParallelogramLight {
    /// A one-sided light.
    pub fn new(shape: Parallelogram, radiance: impl Into<Tex>) -> Self {
        let (u, v) = (shape.edge_u(), shape.edge_v());
        let square = vector::normalize(u).dot(vector::normalize(v)).abs() <= 4.0 * f32::EPSILON;
        let axes = if square { RectangleAxes::new(u, v) } else { None };
        Self { shape, radiance: radiance.into(), two_sided: false, axes }
    }

    /// The same light, shining from both sides or from the front alone.
    #[must_use]
    pub fn with_two_sided(mut self, two_sided: bool) -> Self {
        self.two_sided = two_sided;
        self
    }

    #[inline]
    fn shines_on(&self, p: Vec3A) -> bool {
        self.two_sided || (wide(p) - wide(self.shape.origin())).dot(wide(self.shape.normal())) > 0.0
    }

    #[inline]
    fn area(&self) -> f64 {
        let n = wide(self.shape.edge_u()).cross(wide(self.shape.edge_v()));
        n.dot(n).sqrt()
    }

    /// `None` where area sampling is to be used: not a rectangle, or out of the limits.
    #[inline]
    fn solid_angle(&self, p: Vec3A) -> Option<SphericalRectangle> {
        SphericalRectangle::with_axes(self.shape.origin() - p, self.axes.as_ref()?)
    }
}

impl Light for ParallelogramLight {
    #[inline]
    fn sample(&self, at: &LitPoint, _part: u32, u: Vec2) -> Option<LightSample> {
        if !self.shines_on(at.p) {
            return None;
        }
        let (st, drawn) = match self.solid_angle(at.p) {
            Some(spherical) => {
                let s = spherical.sample(u)?;
                (s.st, Some((s.w, s.pdf)))
            }
            None => (u, None),
        };
        let (o, eu, ev) = (self.shape.origin(), self.shape.edge_u(), self.shape.edge_v());
        let p = wide(o) + wide(eu) * f64::from(st.x) + wide(ev) * f64::from(st.y);
        let end = end_on(p, largest(o) + largest(eu) + largest(ev), self.shape.normal());
        let (wi, pdf) = match drawn {
            Some(drawn) => drawn,
            None => {
                let seen = toward(at.p, end.p)?;
                (seen.w, per_solid_angle(1.0 / self.area(), seen.d2, wide(seen.w).dot(wide(end.ng)))?)
            }
        };
        if is_behind(at, wi) {
            return None;
        }
        let fetches = Cell::new(0);
        let li = radiance(&self.radiance, &TexPoint { uv: [st; 2], p: end.p, fetches: &fetches });
        (!li.is_black()).then_some(LightSample { wi, li, pdf, end: Some(end), is_delta: false })
    }

    #[inline]
    fn pdf(&self, at: &LitPoint, _part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        let Some(seen) = seen.filter(|_| !is_behind(at, wi) && self.shines_on(at.p)) else {
            return 0.0;
        };
        match self.solid_angle(at.p) {
            Some(spherical) => spherical.pdf(),
            None => toward(at.p, seen.p)
                .and_then(|v| {
                    per_solid_angle(1.0 / self.area(), v.d2, wide(wi).dot(wide(self.shape.normal())))
                })
                .unwrap_or(0.0),
        }
    }

    fn power(&self, _part: u32, _scene_radius: f32) -> Spectrum {
        lambertian_power(floored(self.radiance.mean(), &self.radiance), self.area(), self.two_sided)
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        Some(LightBounds {
            bounds: self.shape.bounds(),
            axis: self.shape.normal(),
            cos_normals: if self.two_sided { -1.0 } else { 1.0 },
            cos_emission: 0.0,
            power: self.power(part, 0.0).mean(),
        })
    }

    #[inline]
    fn emitted(&self, _part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        emitter::emitted(&self.radiance, self.two_sided, at, wo)
    }

    fn needs(&self) -> Needs {
        emitter::needs(&self.radiance)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("parallelogram light");
        f.u64(u64::from(self.two_sided));
        self.shape.fingerprint(f);
        self.radiance.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.radiance.bytes()
    }
}
