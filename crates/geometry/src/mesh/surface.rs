use etendue_core::glam::DVec2;
use etendue_core::{Frame, Vec2, Vec3A, vector};

use super::TriangleMesh;
use crate::Surface;
use crate::double::{Rounded, direction, largest, loss, narrow, rounded, wide};

/// How the position changes with the first set of texture coordinates.
#[derive(Clone, Copy)]
struct Derivatives {
    dpdu: Vec3A,
    dpdv: Vec3A,
}

impl TriangleMesh {
    /// Everything about the point with the barycentric weights `uv` of vertices 1 and 2, object space.
    ///
    /// The position is interpolated in double precision and rounded once, so its error bound is half an ulp per axis.
    pub fn surface(&self, prim: u32, uv: Vec2) -> Surface {
        let at = self.point(prim, uv);
        let ng = self.normal(prim).unwrap_or(Vec3A::Z);
        let (ns, turned) = self.shading_normal(prim, uv, ng);
        let mut surface = Surface::new(at.p, at.p_err, ng);
        surface.prim = prim;
        surface.uv = [self.uv_at(0, prim, uv), self.uv_at(1, prim, uv)];
        surface.color = self.color_at(prim, uv);

        let tangent = self.corners_of(&self.tangents, prim).map(|[a, b, c]| {
            let t = a * (1.0 - uv.x - uv.y) + b * uv.x + c * uv.y;
            (Vec3A::new(t.x, t.y, t.z), t.w)
        });
        let along = self.derivatives(prim);
        if let Some(d) = along {
            surface.dpdu = d.dpdu;
            surface.dpdv = d.dpdv;
        }
        surface.shading = match (tangent, along) {
            (Some((t, side)), _) if t != Vec3A::ZERO => {
                if along.is_none() {
                    surface.dpdu = t;
                    surface.dpdv = ns.cross(t) * if side < 0.0 { -1.0 } else { 1.0 };
                }
                // The bitangent is w (n × t) of the normal as the mesh has it, which may have been turned over.
                surface.bitangent = if (side < 0.0) != turned { -1.0 } else { 1.0 };
                Frame::from_normal_tangent(ns, t)
            }
            (_, Some(d)) => Frame::from_normal_tangent(ns, d.dpdu),
            _ => Frame::from_normal(ns),
        };
        surface
    }

    /// Unit geometric normal of the front side; `None` where the triangle has no area.
    pub fn normal(&self, prim: u32) -> Option<Vec3A> {
        let [a, b, c] = self.triangle(prim).map(wide);
        direction((b - a).cross(c - a))
    }

    pub(super) fn point(&self, prim: u32, uv: Vec2) -> Rounded {
        let [a, b, c] = self.triangle(prim).map(wide);
        let (u, v) = (f64::from(uv.x), f64::from(uv.y));
        let p = a * (1.0 - u - v) + b * u + c * v;
        let [ra, rb, rc] = [a, b, c].map(largest);
        let reach = if ra > rb { ra } else { rb };
        let reach = if reach > rc { reach } else { rc };
        // The intersection test must not take the point for one on the other side.
        rounded(p, reach * loss(b - a, c - a))
    }

    /// On the side of `ng`, and whether it had to be turned over for that.
    fn shading_normal(&self, prim: u32, uv: Vec2, ng: Vec3A) -> (Vec3A, bool) {
        let interpolated = self.corners_of(&self.normals, prim).and_then(|n| {
            let [a, b, c] = n.map(Vec3A::from);
            vector::try_normalize(a * (1.0 - uv.x - uv.y) + b * uv.x + c * uv.y)
        });
        match interpolated {
            Some(n) if n.dot(ng) < 0.0 => (-n, true),
            Some(n) => (n, false),
            None => (ng, false),
        }
    }

    /// `None` where there are no texture coordinates or they span no area.
    fn derivatives(&self, prim: u32) -> Option<Derivatives> {
        let [ta, tb, tc] =
            self.corners_of(&self.uv[0], prim)?.map(|t| DVec2::new(f64::from(t.x), f64::from(t.y)));
        let [a, b, c] = self.triangle(prim).map(wide);
        let (e1, e2) = (b - a, c - a);
        let (t1, t2) = (tb - ta, tc - ta);
        let det = t1.x * t2.y - t1.y * t2.x;
        if det == 0.0 {
            return None;
        }
        let dpdu = narrow((e1 * t2.y - e2 * t1.y) / det);
        let dpdv = narrow((e2 * t1.x - e1 * t2.x) / det);
        (dpdu.is_finite() && dpdv.is_finite() && dpdu != Vec3A::ZERO).then_some(Derivatives { dpdu, dpdv })
    }
}
