use std::cell::Cell;
use std::sync::Arc;

use etendue_core::glam::DVec3;
use etendue_core::{Aabb, Fingerprint, Needs, Spectrum, Transform, Vec2, Vec3A, vector};
use etendue_geometry::{Surface, TriangleMesh, return_error};
use etendue_sampling::warp::{self, SphericalTriangle};
use etendue_texture::{Tex, TexPoint, Texture};

use crate::emitter::{
    self, DOUBLE, end_on, floored, is_behind, lambertian_power, largest, narrow, per_solid_angle, positive,
    radiance, toward, wide,
};
use crate::{Light, LightBounds, LightSample, LitPoint};

/// A mesh that shines, each of its triangles a part. Lambertian, from the front or from both sides.
///
/// A triangle is sampled uniformly in the solid angle it fills (Arvo 1995) where that lies between
/// [`warp::MIN_SOLID_ANGLE`] and [`warp::MAX_SOLID_ANGLE`], and by area otherwise; which, is a function of the receiving
/// point and the triangle alone, so that the density of a direction found otherwise is the same.
pub struct MeshLight {
    mesh: Arc<TriangleMesh>,
    to_world: Option<Transform>,
    radiance: Tex,
    two_sided: bool,
    parts: Vec<Part>,
}

/// One triangle in world space.
#[derive(Clone, Copy)]
struct Part {
    corners: [Vec3A; 3],
    /// Unit normal of the front; zero where the triangle is degenerate.
    ng: Vec3A,
    /// Bound on the error of any point of it beyond its own last rounding.
    err: Vec3A,
    /// m², 0 where degenerate.
    area: f64,
    power: Spectrum,
}

impl Part {
    const DARK: Self = Self {
        corners: [Vec3A::ZERO; 3],
        ng: Vec3A::ZERO,
        err: Vec3A::ZERO,
        area: 0.0,
        power: Spectrum::BLACK,
    };

    fn new(mesh: &TriangleMesh, prim: u32, to_world: Option<&Transform>) -> Self {
        let object = mesh.triangle(prim);
        let Some(normal) = mesh.normal(prim).filter(|_| !mesh.is_degenerate(prim)) else {
            return Self::DARK;
        };
        let (corners, ng, err) = match to_world {
            None => {
                let reach = object.into_iter().map(largest).fold(0.0, |a: f64, b| if a > b { a } else { b });
                (object, normal, Vec3A::splat((reach * DOUBLE) as f32))
            }
            Some(m) => {
                let [x, y, z, t] = m.columns().map(wide);
                let place =
                    |v: Vec3A| narrow(x * f64::from(v.x) + y * f64::from(v.y) + z * f64::from(v.z) + t);
                // The hit this end has to agree with was mapped back to object space and forth again.
                let err = object.into_iter().fold(Vec3A::ZERO, |e, v| {
                    let (p, forth) = m.point_with_error(v, Vec3A::ZERO);
                    vector::max(e, forth + return_error(m, p))
                });
                (object.map(place), m.normal(normal), err)
            }
        };
        let [a, b, c] = corners.map(wide);
        let n = (b - a).cross(c - a);
        let area = 0.5 * n.dot(n).sqrt();
        if !(area > 0.0 && area.is_finite() && ng != Vec3A::ZERO) {
            return Self::DARK;
        }
        Self { corners, ng, err, area, power: Spectrum::BLACK }
    }

    #[inline]
    fn point(&self, barycentrics: Vec2) -> DVec3 {
        let [a, b, c] = self.corners.map(wide);
        let (u, v) = (f64::from(barycentrics.x), f64::from(barycentrics.y));
        a * (1.0 - u - v) + b * u + c * v
    }

    /// Whether a point sees the shining side.
    #[inline]
    fn shines_on(&self, p: Vec3A, two_sided: bool) -> bool {
        two_sided || (wide(p) - wide(self.corners[0])).dot(wide(self.ng)) > 0.0
    }

    #[inline]
    fn solid_angle(&self, p: Vec3A) -> Option<SphericalTriangle> {
        let [a, b, c] = self.corners;
        SphericalTriangle::new(a - p, b - p, c - p)
    }
}

impl MeshLight {
    /// A shining mesh, placed by `to_world` if there is one. Triangles without area get no power.
    ///
    /// Powers of textured triangles come from an 8 × 8 grid of points on each.
    pub fn new(mesh: Arc<TriangleMesh>, to_world: Option<Transform>, radiance: Tex, two_sided: bool) -> Self {
        let count = mesh.triangle_count() as u32;
        let mut light = Self { mesh, to_world, radiance, two_sided, parts: Vec::new() };
        light.parts = (0..count)
            .map(|prim| {
                let part = Part::new(&light.mesh, prim, light.to_world.as_ref());
                let mean = light.mean_radiance(prim, &part);
                Part { power: lambertian_power(mean, part.area, two_sided), ..part }
            })
            .collect();
        light
    }

    /// The mesh.
    pub fn mesh(&self) -> &Arc<TriangleMesh> {
        &self.mesh
    }

    /// Where it is placed.
    pub fn to_world(&self) -> Option<&Transform> {
        self.to_world.as_ref()
    }

    /// Radiance of the shining side, W·m⁻²·sr⁻¹.
    pub fn radiance(&self) -> &Tex {
        &self.radiance
    }

    /// Whether the back shines too.
    pub fn two_sided(&self) -> bool {
        self.two_sided
    }

    fn mean_radiance(&self, prim: u32, part: &Part) -> Spectrum {
        if let Tex::Constant(l) = self.radiance {
            return positive(l);
        }
        const SIDE: u32 = 8;
        let at = |i: u32| (i as f32 + 0.5) / SIDE as f32;
        let sum = (0..SIDE * SIDE).fold(Spectrum::BLACK, |sum, i| {
            let b = warp::triangle(Vec2::new(at(i % SIDE), at(i / SIDE)));
            sum + self.radiance_at(prim, b, narrow(part.point(b)))
        });
        floored(sum / (SIDE * SIDE) as f32, &self.radiance)
    }

    #[inline]
    fn radiance_at(&self, prim: u32, barycentrics: Vec2, p: Vec3A) -> Spectrum {
        if let Tex::Constant(l) = self.radiance {
            return positive(l);
        }
        let fetches = Cell::new(0);
        let uv = self.mesh.alpha_attributes(prim, barycentrics).uv;
        radiance(&self.radiance, &TexPoint { uv, p, fetches: &fetches })
    }
}

impl Light for MeshLight {
    fn parts(&self) -> u32 {
        self.parts.len() as u32
    }

    #[inline]
    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
        let t = self.parts.get(part as usize)?;
        if t.area == 0.0 || !t.shines_on(at.p, self.two_sided) {
            return None;
        }
        let (barycentrics, drawn) = match t.solid_angle(at.p) {
            Some(spherical) => {
                let s = spherical.sample(u)?;
                (s.barycentrics, Some((s.w, s.pdf)))
            }
            None => (warp::triangle(u), None),
        };
        let mut end = end_on(t.point(barycentrics), 0.0, t.ng);
        end.p_err += t.err;
        let (wi, pdf) = match drawn {
            Some(drawn) => drawn,
            None => {
                let seen = toward(at.p, end.p)?;
                (seen.w, per_solid_angle(1.0 / t.area, seen.d2, wide(seen.w).dot(wide(t.ng)))?)
            }
        };
        if is_behind(at, wi) {
            return None;
        }
        let li = self.radiance_at(part, barycentrics, end.p);
        (!li.is_black()).then_some(LightSample { wi, li, pdf, end: Some(end), is_delta: false })
    }

    #[inline]
    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        let (Some(t), Some(seen)) = (self.parts.get(part as usize), seen) else {
            return 0.0;
        };
        if t.area == 0.0 || is_behind(at, wi) || !t.shines_on(at.p, self.two_sided) {
            return 0.0;
        }
        match t.solid_angle(at.p) {
            Some(spherical) => spherical.pdf(),
            None => toward(at.p, seen.p)
                .and_then(|v| per_solid_angle(1.0 / t.area, v.d2, wide(wi).dot(wide(t.ng))))
                .unwrap_or(0.0),
        }
    }

    fn power(&self, part: u32, _scene_radius: f32) -> Spectrum {
        self.parts.get(part as usize).map_or(Spectrum::BLACK, |t| t.power)
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        let t = self.parts.get(part as usize)?;
        Some(LightBounds {
            bounds: if t.area > 0.0 { Aabb::of_points(t.corners) } else { Aabb::EMPTY },
            axis: if t.area > 0.0 { t.ng } else { Vec3A::Y },
            cos_normals: if self.two_sided { -1.0 } else { 1.0 },
            cos_emission: 0.0,
            power: t.power.mean(),
        })
    }

    #[inline]
    fn emitted(&self, _part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        emitter::emitted(&self.radiance, self.two_sided, at, wo)
    }

    fn needs(&self) -> Needs {
        let mut needs = emitter::needs(&self.radiance);
        needs.set(Needs::MANY_LIGHTS, self.parts.len() > 1);
        needs
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("mesh light");
        f.u64(u64::from(self.two_sided));
        self.mesh.fingerprint(f);
        self.to_world.unwrap_or(Transform::IDENTITY).fingerprint(f);
        self.radiance.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.parts.capacity() * size_of::<Part>() + self.radiance.bytes()
    }
}
