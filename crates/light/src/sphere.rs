use std::cell::Cell;

use etendue_core::glam::DVec3;
use etendue_core::{Fingerprint, Frame, Needs, Ray, Spectrum, Vec2, Vec3A};
use etendue_geometry::{Shape, Sphere, Surface};
use etendue_sampling::warp;
use etendue_texture::{Tex, TexPoint, Texture};

use crate::emitter::{
    self, end_on, floored, is_behind, lambertian_power, largest, narrow, positive, radiance, wide,
};
use crate::{Light, LightBounds, LightSample, LitPoint, Sides};

/// A sphere that shines. Lambertian, from the outside or from both sides.
///
/// From outside it is sampled uniformly in the cone of directions it fills; from inside, where only a two-sided one
/// shines, uniformly in all directions.
#[derive(Clone, Debug)]
pub struct SphereLight {
    /// Where it is, world space.
    pub sphere: Sphere,
    /// Radiance of the shining side, W·m⁻²·sr⁻¹.
    pub radiance: Tex,
    /// Whether the inside shines too.
    pub two_sided: bool,
}

/// How the sphere looks from a point.
enum View {
    /// From outside: the direction of the centre and 1 − cos of the half angle, which keeps its digits far away.
    Cone { axis: Vec3A, one_minus_cos: f32 },
    /// From inside or from the surface: every direction meets it.
    Within,
}

impl SphereLight {
    /// A light that shines outward.
    pub fn new(sphere: Sphere, radiance: impl Into<Tex>) -> Self {
        Self { sphere, radiance: radiance.into(), two_sided: false }
    }

    /// `None` where the sphere sends nothing.
    #[inline]
    fn view(&self, at: &LitPoint) -> Option<View> {
        let c = wide(self.sphere.center()) - wide(at.p);
        let r = f64::from(self.sphere.radius());
        let (d2, r2) = (c.dot(c), r * r);
        // A point of the sphere itself lies in or out by rounding alone: there the side that light leaves by decides.
        let error = wide(at.p_err);
        let on_it = (d2.sqrt() - r).abs() <= error.dot(error).sqrt();
        let within = if on_it { wide(at.ng).dot(c) > 0.0 || at.sides != Sides::Same } else { !(d2 > r2) };
        if within {
            return self.two_sided.then_some(View::Within);
        }
        if on_it {
            return None;
        }
        let sin2 = r2 / d2;
        // 1 - cos = sin² / (1 + cos).
        let one_minus_cos = (sin2 / (1.0 + (1.0 - sin2).sqrt())) as f32;
        (one_minus_cos > 0.0).then(|| View::Cone { axis: narrow(c / d2.sqrt()), one_minus_cos })
    }

    /// Whether the point lies inside by more than its own error, so that every direction meets the sphere ahead.
    fn holds(&self, at: &LitPoint) -> bool {
        let c = wide(self.sphere.center()) - wide(at.p);
        let error = wide(at.p_err);
        c.dot(c).sqrt() + error.dot(error).sqrt() < f64::from(self.sphere.radius())
    }

    /// The outward direction of the point where a ray from `p` along `w` meets the sphere: the near point from
    /// outside, and for a ray that rounding led past the silhouette the nearest one to it.
    #[inline]
    fn meet(&self, p: Vec3A, w: Vec3A, within: bool) -> Option<DVec3> {
        let (c, w) = (wide(self.sphere.center()) - wide(p), wide(w));
        let along = c.dot(w) / w.dot(w);
        let off = w * along - c;
        let rest = f64::from(self.sphere.radius()) * f64::from(self.sphere.radius()) - off.dot(off);
        let half = if rest > 0.0 { (rest / w.dot(w)).sqrt() } else { 0.0 };
        let n = off + w * if within { half } else { -half };
        let l = n.dot(n).sqrt();
        (l > 0.0).then(|| n / l)
    }

    /// Texture coordinates where the surface faces `n`: asked of the shape by a ray from straight above.
    fn uv(&self, n: DVec3) -> Vec2 {
        let r = f64::from(self.sphere.radius());
        let above = Ray::new(narrow(wide(self.sphere.center()) + n * (2.0 * r)), narrow(-n));
        self.sphere.intersect(&above).map_or(Vec2::ZERO, |hit| hit.uv)
    }

    fn radiance_at(&self, n: DVec3, p: Vec3A) -> Spectrum {
        if let Tex::Constant(l) = self.radiance {
            return positive(l);
        }
        let fetches = Cell::new(0);
        radiance(&self.radiance, &TexPoint { uv: [self.uv(n); 2], p, fetches: &fetches })
    }
}

impl Light for SphereLight {
    #[inline]
    fn sample(&self, at: &LitPoint, _part: u32, u: Vec2) -> Option<LightSample> {
        let (wi, pdf, within) = match self.view(at)? {
            View::Cone { axis, one_minus_cos } => {
                let local = warp::cone(u, one_minus_cos);
                (Frame::from_normal(axis).to_world(local), warp::cone_pdf(one_minus_cos), false)
            }
            View::Within => (warp::sphere(u), warp::SPHERE_PDF, true),
        };
        if is_behind(at, wi) {
            return None;
        }
        if within && wide(wi).dot(wide(self.sphere.center()) - wide(at.p)) <= 0.0 && !self.holds(at) {
            return None;
        }
        let n = self.meet(at.p, wi, within)?;
        let (center, r) = (self.sphere.center(), f64::from(self.sphere.radius()));
        let end = end_on(wide(center) + n * r, largest(center) + r, narrow(n));
        let li = self.radiance_at(n, end.p);
        (!li.is_black()).then_some(LightSample { wi, li, pdf, end: Some(end), is_delta: false })
    }

    #[inline]
    fn pdf(&self, at: &LitPoint, _part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        if seen.is_none() || is_behind(at, wi) {
            return 0.0;
        }
        match self.view(at) {
            Some(View::Cone { one_minus_cos, .. }) => warp::cone_pdf(one_minus_cos),
            Some(View::Within) => warp::SPHERE_PDF,
            None => 0.0,
        }
    }

    fn power(&self, _part: u32, _scene_radius: f32) -> Spectrum {
        let r = f64::from(self.sphere.radius());
        let area = 4.0 * std::f64::consts::PI * r * r;
        lambertian_power(floored(self.radiance.mean(), &self.radiance), area, self.two_sided)
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        Some(LightBounds {
            bounds: self.sphere.bounds(),
            axis: Vec3A::Y,
            cos_normals: -1.0,
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
        f.tag("sphere light");
        f.u64(u64::from(self.two_sided));
        self.sphere.fingerprint(f);
        self.radiance.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.radiance.bytes()
    }
}
