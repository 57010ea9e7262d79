use etendue_core::glam::DVec3;
use etendue_core::{Aabb, Fingerprint, Frame, Ray, Vec2, Vec3A};

use crate::double::{Rounded, direction, largest, loss, rounded, wide};
use crate::triangle::TriangleRay;
use crate::{Shape, ShapeError, ShapeHit, ShapeSample, Surface};

/// A flat parallelogram `origin + u edge_u + v edge_v` with `u`, `v` in `[0, 1]`. Its front is the side that
/// `edge_u × edge_v` points to.
///
/// It is tested as two watertight triangles, so that parallelograms with the same corners leave no gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallelogram {
    origin: Vec3A,
    edge_u: Vec3A,
    edge_v: Vec3A,
    normal: Vec3A,
}

impl Parallelogram {
    /// A parallelogram from a corner and the two edges that leave it.
    ///
    /// # Errors
    /// [`ShapeError`] where a number is not finite or the edges span no area.
    pub fn new(origin: Vec3A, edge_u: Vec3A, edge_v: Vec3A) -> Result<Self, ShapeError> {
        for (v, parameter) in [(origin, "the origin"), (edge_u, "edge u"), (edge_v, "edge v")] {
            if !v.is_finite() {
                return Err(ShapeError::NotFinite { shape: "parallelogram", parameter });
            }
        }
        let normal = direction(wide(edge_u).cross(wide(edge_v))).ok_or(ShapeError::NoArea)?;
        Ok(Self { origin, edge_u, edge_v, normal })
    }

    /// The corner at `u = v = 0`.
    pub fn origin(&self) -> Vec3A {
        self.origin
    }

    /// The edge along which `u` grows.
    pub fn edge_u(&self) -> Vec3A {
        self.edge_u
    }

    /// The edge along which `v` grows.
    pub fn edge_v(&self) -> Vec3A {
        self.edge_v
    }

    /// Unit normal of the front.
    pub fn normal(&self) -> Vec3A {
        self.normal
    }

    fn corners(&self) -> [DVec3; 4] {
        let (o, u, v) = (wide(self.origin), wide(self.edge_u), wide(self.edge_v));
        [o, o + u, o + u + v, o + v]
    }

    fn point(&self, uv: Vec2) -> Rounded {
        let (o, u, v) = (wide(self.origin), wide(self.edge_u), wide(self.edge_v));
        let p = o + u * f64::from(uv.x) + v * f64::from(uv.y);
        rounded(p, (largest(o) + largest(u) + largest(v)) * loss(u, v))
    }
}

impl Shape for Parallelogram {
    fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for c in self.corners() {
            // The corner itself may lie between two single-precision numbers.
            let outward = |x: f64, up: bool| {
                let r = x as f32;
                match f64::from(r) {
                    exact if exact < x && up => r.next_up(),
                    exact if exact > x && !up => r.next_down(),
                    _ => r,
                }
            };
            bounds = bounds
                .grown(Vec3A::new(outward(c.x, false), outward(c.y, false), outward(c.z, false)))
                .grown(Vec3A::new(outward(c.x, true), outward(c.y, true), outward(c.z, true)));
        }
        bounds
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let query = TriangleRay::new(ray);
        let [a, b, c, d] = self.corners();
        // Weights of (b, c) in the lower triangle and of (c, d) in the upper one.
        let lower = query.intersect_wide([a, b, c]);
        let hit = match lower {
            Some(h) => ShapeHit { t: h.t, uv: Vec2::new(h.uv.x + h.uv.y, h.uv.y) },
            None => {
                let h = query.intersect_wide([a, c, d])?;
                ShapeHit { t: h.t, uv: Vec2::new(h.uv.x, h.uv.x + h.uv.y) }
            }
        };
        ray.accepts(hit.t).then_some(hit)
    }

    fn surface(&self, _ray: &Ray, hit: &ShapeHit) -> Surface {
        let at = self.point(hit.uv);
        let mut surface = Surface::new(at.p, at.p_err, self.normal);
        surface.uv = [hit.uv; 2];
        surface.dpdu = self.edge_u;
        surface.dpdv = self.edge_v;
        surface.shading = Frame::from_normal_tangent(self.normal, self.edge_u);
        surface
    }

    fn area(&self) -> f32 {
        let n = wide(self.edge_u).cross(wide(self.edge_v));
        n.dot(n).sqrt() as f32
    }

    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let pdf_area = 1.0 / self.area();
        let at = self.point(u);
        (pdf_area.is_finite() && pdf_area > 0.0).then_some(ShapeSample {
            p: at.p,
            p_err: at.p_err,
            ng: self.normal,
            uv: u,
            pdf_area,
        })
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("parallelogram");
        for v in [self.origin, self.edge_u, self.edge_v] {
            f.floats(&v.to_array());
        }
    }
}
