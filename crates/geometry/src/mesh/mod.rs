//! Indexed triangle meshes.

mod attributes;
mod report;
mod surface;

pub use attributes::AlphaAttributes;
pub use report::MeshReport;

use etendue_core::{Aabb, Fingerprint, Vec2, Vec3, Vec3A, Vec4};
use etendue_sampling::warp;

use crate::double::wide;
use crate::{MeshError, ShapeSample};

/// An indexed triangle mesh in object space. Front faces are counter-clockwise.
///
/// Invariant: every index names a vertex, and every attribute array is empty or has one entry per vertex. Vertices
/// may be anything, even NaN: a triangle that cannot be hit is counted by [`TriangleMesh::report`] and left out of
/// [`TriangleMesh::bounds`].
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    normals: Vec<Vec3>,
    tangents: Vec<Vec4>,
    uv: [Vec<Vec2>; 2],
    colors: Vec<Vec4>,
    bounds: Aabb,
    report: MeshReport,
    /// Ascending.
    duplicates: Vec<u32>,
}

impl TriangleMesh {
    /// A mesh from its vertices and the three corners of each triangle.
    ///
    /// # Errors
    /// [`MeshError::IndexOutOfRange`] names the first triangle with a wrong index; [`MeshError::TooMany`] where
    /// 32 bits do not suffice.
    pub fn new(positions: Vec<Vec3>, indices: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        for (what, count) in [("vertices", positions.len()), ("triangles", indices.len())] {
            if count >= u32::MAX as usize {
                return Err(MeshError::TooMany { what, count });
            }
        }
        for (triangle, corners) in indices.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&i| i as usize >= positions.len()) {
                return Err(MeshError::IndexOutOfRange { triangle, index, vertices: positions.len() });
            }
        }
        let mut mesh = Self { positions, indices, ..Self::empty() };
        mesh.inspect();
        Ok(mesh)
    }

    /// A mesh without anything in it.
    pub fn empty() -> Self {
        Self {
            positions: Vec::new(),
            indices: Vec::new(),
            normals: Vec::new(),
            tangents: Vec::new(),
            uv: [Vec::new(), Vec::new()],
            colors: Vec::new(),
            bounds: Aabb::EMPTY,
            report: MeshReport::default(),
            duplicates: Vec::new(),
        }
    }

    /// How many triangles there are, degenerate ones included.
    pub fn triangle_count(&self) -> usize {
        self.indices.len()
    }

    /// Vertex positions.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The vertices of each triangle.
    pub fn indices(&self) -> &[[u32; 3]] {
        &self.indices
    }

    /// The corners of a triangle; not-a-number where there is no such triangle.
    #[inline]
    pub fn triangle(&self, prim: u32) -> [Vec3A; 3] {
        match self.indices.get(prim as usize) {
            Some(corners) => corners.map(|i| match self.positions.get(i as usize) {
                Some(&p) => Vec3A::from(p),
                None => Vec3A::NAN,
            }),
            None => [Vec3A::NAN; 3],
        }
    }

    /// Area of a triangle in m².
    pub fn area(&self, prim: u32) -> f32 {
        (0.5 * self.doubled_area(prim)) as f32
    }

    fn doubled_area(&self, prim: u32) -> f64 {
        let [a, b, c] = self.triangle(prim).map(wide);
        let n = (b - a).cross(c - a);
        n.dot(n).sqrt()
    }

    /// The box around every triangle that can be hit.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// A point uniform over the area of one triangle; `None` where it has no area in single precision.
    pub fn sample(&self, prim: u32, u: Vec2) -> Option<ShapeSample> {
        let uv = warp::triangle(u);
        let pdf_area = (2.0 / self.doubled_area(prim)) as f32;
        let at = self.point(prim, uv);
        let ng = self.normal(prim)?;
        (pdf_area.is_finite() && pdf_area > 0.0).then_some(ShapeSample {
            p: at.p,
            p_err: at.p_err,
            ng,
            uv,
            pdf_area,
        })
    }

    /// Bytes held on the heap.
    pub fn bytes(&self) -> usize {
        fn of<T>(v: &Vec<T>) -> usize {
            v.capacity() * size_of::<T>()
        }
        of(&self.positions)
            + of(&self.indices)
            + of(&self.normals)
            + of(&self.tangents)
            + of(&self.uv[0])
            + of(&self.uv[1])
            + of(&self.colors)
    }

    /// Everything that decides how the mesh looks.
    pub fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("mesh");
        f.u64(self.indices.len() as u64);
        for &[a, b, c] in &self.indices {
            f.u64(u64::from(a) << 32 | u64::from(b));
            f.u64(u64::from(c));
        }
        let mut array = |name: &str, count: usize, values: &mut dyn Iterator<Item = f32>| {
            f.tag(name);
            f.u64(count as u64);
            for v in values {
                f.f32(v);
            }
        };
        array("p", self.positions.len(), &mut self.positions.iter().flat_map(|v| v.to_array()));
        array("n", self.normals.len(), &mut self.normals.iter().flat_map(|v| v.to_array()));
        array("t", self.tangents.len(), &mut self.tangents.iter().flat_map(|v| v.to_array()));
        array("uv0", self.uv[0].len(), &mut self.uv[0].iter().flat_map(|v| v.to_array()));
        array("uv1", self.uv[1].len(), &mut self.uv[1].iter().flat_map(|v| v.to_array()));
        array("c", self.colors.len(), &mut self.colors.iter().flat_map(|v| v.to_array()));
    }
}
