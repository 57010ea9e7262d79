use std::cell::Cell;
use std::f64::consts::PI;

use etendue_core::{Fingerprint, Needs, Spectrum, Vec2, Vec3A};
use etendue_geometry::{Disc, Shape, Surface};
use etendue_sampling::warp::SphericalDisc;
use etendue_texture::{Tex, TexPoint, Texture};

use crate::emitter::{
    self, end_on, floored, is_behind, lambertian_power, largest, per_solid_angle, radiance, toward, wide,
};
use crate::{Light, LightBounds, LightSample, LitPoint};

/// A flat disc that shines. Lambertian, from the front or from both sides.
///
/// Sampled nearly uniformly in the solid angle it fills ([`SphericalDisc`]), so that coming close to it adds no noise;
/// by area where it is seen edge-on.
#[derive(Clone, Debug)]
pub struct DiscLight {
    /// Where it is, world space.
    pub disc: Disc,
    /// Radiance of the shining side, W·m⁻²·sr⁻¹.
    pub radiance: Tex,
    /// Whether the back shines too.
    pub two_sided: bool,
}

impl DiscLight {
    /// A one-sided light.
    pub fn new(disc: Disc, radiance: impl Into<Tex>) -> Self {
        Self { disc, radiance: radiance.into(), two_sided: false }
    }

    #[inline]
    fn shines_on(&self, p: Vec3A) -> bool {
        self.two_sided || (wide(p) - wide(self.disc.center())).dot(wide(self.disc.normal())) > 0.0
    }

    fn area(&self) -> f64 {
        let r = f64::from(self.disc.radius());
        PI * r * r
    }

    /// `None` where area sampling is to be used.
    #[inline]
    fn solid_angle(&self, p: Vec3A) -> Option<SphericalDisc> {
        SphericalDisc::new(wide(self.disc.center()) - wide(p), self.disc.normal(), self.disc.radius())
    }

    /// The density by area of a point found along `wi`.
    #[inline]
    fn pdf_by_area(&self, from: Vec3A, p: Vec3A, wi: Vec3A) -> Option<f32> {
        let seen = toward(from, p)?;
        per_solid_angle(1.0 / self.area(), seen.d2, wide(wi).dot(wide(self.disc.normal())))
    }
}

impl Light for DiscLight {
    #[inline]
    fn sample(&self, at: &LitPoint, _part: u32, u: Vec2) -> Option<LightSample> {
        if !self.shines_on(at.p) {
            return None;
        }
        let normal = self.disc.normal();
        let (wi, pdf, end, uv) = match self.solid_angle(at.p) {
            Some(seen) => {
                let s = seen.sample(u)?;
                let center = self.disc.center();
                let reach = largest(center) + f64::from(self.disc.radius());
                let end = end_on(wide(center) + s.from_center, reach, normal);
                (s.w, s.pdf, end, self.disc.parameters(s.from_center))
            }
            None => {
                let s = self.disc.sample(u)?;
                let end = etendue_core::Origin { p: s.p, p_err: s.p_err, ng: normal };
                let wi = toward(at.p, s.p)?.w;
                (wi, self.pdf_by_area(at.p, s.p, wi)?, end, s.uv)
            }
        };
        if is_behind(at, wi) {
            return None;
        }
        let fetches = Cell::new(0);
        let li = radiance(&self.radiance, &TexPoint { uv: [uv; 2], p: end.p, fetches: &fetches });
        (!li.is_black()).then_some(LightSample { wi, li, pdf, end: Some(end), is_delta: false })
    }

    #[inline]
    fn pdf(&self, at: &LitPoint, _part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        let Some(seen) = seen.filter(|_| !is_behind(at, wi) && self.shines_on(at.p)) else {
            return 0.0;
        };
        match self.solid_angle(at.p) {
            Some(cone) => cone.pdf(wi),
            None => self.pdf_by_area(at.p, seen.p, wi).unwrap_or(0.0),
        }
    }

    fn power(&self, _part: u32, _scene_radius: f32) -> Spectrum {
        lambertian_power(floored(self.radiance.mean(), &self.radiance), self.area(), self.two_sided)
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        Some(LightBounds {
            bounds: self.disc.bounds(),
            axis: self.disc.normal(),
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
        f.tag("disc light");
        f.u64(u64::from(self.two_sided));
        self.disc.fingerprint(f);
        self.radiance.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.radiance.bytes()
    }
}
