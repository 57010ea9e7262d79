use std::cell::Cell;

use etendue_core::rounding::gamma;
use etendue_core::{Frame, Origin, Transform, Vec2, Vec3A, Vec4, vector};

/// All that traversal keeps of a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter.
    pub t: f32,
    /// Barycentric weights of vertices 1 and 2, or a shape's own parameters.
    pub uv: Vec2,
    /// Instance, or [`Hit::NO_INSTANCE`].
    pub inst: u32,
    /// Geometry (a mesh or a shape) of the scene.
    pub geom: u32,
    /// Triangle within the mesh; 0 for shapes.
    pub prim: u32,
}

impl Hit {
    /// The instance of geometry that stands in the world itself.
    pub const NO_INSTANCE: u32 = u32::MAX;

    /// Whether this hit wins over `other`: nearer, or at the same `t` the lower (inst, geom, prim). A total order,
    /// so the closest hit never depends on the order of visits.
    #[inline]
    pub fn precedes(&self, other: &Hit) -> bool {
        self.t < other.t
            || (self.t == other.t && (self.inst, self.geom, self.prim) < (other.inst, other.geom, other.prim))
    }
}

/// Everything about one point on a surface; made once, for the closest hit.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Position.
    pub p: Vec3A,
    /// Bound on its absolute error per axis.
    pub p_err: Vec3A,
    /// Unit geometric normal of the front side (counter-clockwise), *not* turned toward the ray.
    pub ng: Vec3A,
    /// Shading frame; its `z` is the shading normal, on the same side as `ng`, its `x` follows `dpdu`.
    pub shading: Frame,
    /// Texture coordinates, two sets.
    pub uv: [Vec2; 2],
    /// Vertex colour and alpha, linear; white where there is none.
    pub color: Vec4,
    /// Derivative of the position by `uv[0].x`; zero where unknown.
    pub dpdu: Vec3A,
    /// Derivative of the position by `uv[0].y`; zero where unknown.
    pub dpdv: Vec3A,
    /// Side of the bitangent that the mesh's tangents give: it is `bitangent · (shading.z × shading.x)`, 1 or −1. 0 where
    /// there are no tangents, and texture coordinates decide.
    pub bitangent: f32,
    /// Radius of the ray's cone at the point, metres; 0 turns texture filtering off.
    pub footprint: f32,
    /// Moment in the shutter interval, in `[0, 1)`.
    pub time: f32,
    /// Instance, geometry and triangle, as in [`Hit`].
    pub inst: u32,
    /// Geometry.
    pub geom: u32,
    /// Triangle.
    pub prim: u32,
    /// Texture look-ups made through this surface: statistics only.
    pub fetches: Cell<u32>,
}

impl Surface {
    /// A point with a normal and nothing else known about it.
    pub fn new(p: Vec3A, p_err: Vec3A, ng: Vec3A) -> Self {
        Self {
            p,
            p_err,
            ng,
            shading: Frame::from_normal(ng),
            uv: [Vec2::ZERO; 2],
            color: Vec4::ONE,
            dpdu: Vec3A::ZERO,
            dpdv: Vec3A::ZERO,
            bitangent: 0.0,
            footprint: 0.0,
            time: 0.0,
            inst: Hit::NO_INSTANCE,
            geom: 0,
            prim: 0,
            fetches: Cell::new(0),
        }
    }

    /// The point as rays leave from it.
    #[inline]
    pub fn origin(&self) -> Origin {
        Origin { p: self.p, p_err: self.p_err, ng: self.ng }
    }

    /// The direction that goes up in a normal map (glTF 2.0, section 3.9.3), unit, orthogonal to the shading frame's
    /// normal and tangent: the side that the mesh's tangents give, else the one on which `v`, which grows downward in an
    /// image, falls.
    pub fn up_in_texture(&self) -> Vec3A {
        let side = if self.bitangent != 0.0 { self.bitangent } else { -self.dpdv.dot(self.shading.y) };
        if side < 0.0 { -self.shading.y } else { self.shading.y }
    }

    /// The shading frame around a normal given along tangent, bitangent and shading normal, of any length; the frame as
    /// it is where that normal is none or points into the surface. `(0, 0, z)` changes no bit of it.
    #[must_use]
    pub fn mapped(&self, n: Vec3A) -> Frame {
        if n.x == 0.0 && n.y == 0.0 {
            return self.shading;
        }
        let turned = self.shading.x * n.x + self.up_in_texture() * n.y + self.shading.z * n.z;
        match vector::try_normalize(turned) {
            Some(z) if z.dot(self.ng) > 0.0 => Frame::from_normal_tangent(z, self.shading.x),
            _ => self.shading,
        }
    }

    /// The surface as seen in the space that `transform` maps to; normals keep their side under a mirror.
    ///
    /// The error bound also covers the way back: a ray that leaves the mapped point by [`Surface::origin`] still
    /// starts on the right side of the surface when it is mapped into object space again.
    #[must_use]
    pub fn transformed(mut self, transform: &Transform) -> Self {
        let (p, p_err) = transform.point_with_error(self.p, self.p_err);
        self.p = p;
        self.p_err = p_err + return_error(transform, p);
        self.ng = transform.normal(self.ng);
        self.dpdu = transform.vector(self.dpdu);
        self.dpdv = transform.vector(self.dpdv);
        // Two normals less than a right angle apart may be mapped to more than one.
        let ns = transform.normal(self.shading.z);
        let ns = if ns.dot(self.ng) < 0.0 { -ns } else { ns };
        let up = transform.vector(self.up_in_texture());
        self.shading = Frame::from_normal_tangent(ns, transform.vector(self.shading.x));
        // A mirror changes the sense of the frame, not where the image's upper edge is.
        if self.bitangent != 0.0 {
            self.bitangent = if up.dot(self.shading.y) < 0.0 { -1.0 } else { 1.0 };
        }
        self
    }
}

/// Bound on how far a point near `p` lands from where it was after [`Transform::ray_to_object`], seen from the space
/// that `transform` maps to.
///
/// Mapping back rounds a sum of four terms of matrix entries that were each rounded once themselves: γ(6) of the sum
/// of their magnitudes, which covers the few ulp by which the point may have been moved as well. The forward map then
/// magnifies it.
pub fn return_error(transform: &Transform, p: Vec3A) -> Vec3A {
    let [x, y, z, _] = transform.columns().map(Vec3A::abs);
    let [ix, iy, iz, it] = transform.inverse().columns().map(Vec3A::abs);
    let p = p.abs();
    let object = (ix * p.x + iy * p.y + iz * p.z + it) * gamma(6);
    // The forward matrix was rounded too; point_with_error counts the sum alone.
    (x * object.x + y * object.y + z * object.z) * (1.0 + gamma(6)) + p * gamma(2)
}
