use etendue_core::{Vec2, Vec3, Vec3A, Vec4};

use super::TriangleMesh;
use crate::MeshError;

/// The little that a cut-out needs to know of a point on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlphaAttributes {
    /// Position, object space.
    pub p: Vec3A,
    /// Texture coordinates, two sets; zero where there are none.
    pub uv: [Vec2; 2],
    /// Vertex colour and alpha, linear; white where there is none.
    pub color: Vec4,
}

fn checked<T>(values: Vec<T>, attribute: &'static str, expected: usize) -> Result<Vec<T>, MeshError> {
    if values.len() == expected {
        Ok(values)
    } else {
        Err(MeshError::CountMismatch { attribute, found: values.len(), expected })
    }
}

impl TriangleMesh {
    /// With shading normals, one per vertex. They need not be unit; a zero or non-finite one falls back to the
    /// geometric normal.
    ///
    /// # Errors
    /// [`MeshError::CountMismatch`].
    pub fn with_normals(mut self, normals: Vec<Vec3>) -> Result<Self, MeshError> {
        self.normals = checked(normals, "normals", self.positions.len())?;
        Ok(self)
    }

    /// With tangents, one per vertex: the direction of growing `u` in `xyz`, the side of the bitangent
    /// `w · (n × t)` in `w`.
    ///
    /// # Errors
    /// [`MeshError::CountMismatch`].
    pub fn with_tangents(mut self, tangents: Vec<Vec4>) -> Result<Self, MeshError> {
        self.tangents = checked(tangents, "tangents", self.positions.len())?;
        Ok(self)
    }

    /// With texture coordinates, one per vertex, as set 0 or 1.
    ///
    /// # Errors
    /// [`MeshError::NoSuchUvSet`], [`MeshError::CountMismatch`].
    pub fn with_uv(mut self, set: usize, uv: Vec<Vec2>) -> Result<Self, MeshError> {
        let place = self.uv.get_mut(set).ok_or(MeshError::NoSuchUvSet { set })?;
        *place = checked(uv, "texture coordinates", self.positions.len())?;
        Ok(self)
    }

    /// With linear colours and alpha, one per vertex.
    ///
    /// # Errors
    /// [`MeshError::CountMismatch`].
    pub fn with_colors(mut self, colors: Vec<Vec4>) -> Result<Self, MeshError> {
        self.colors = checked(colors, "colours", self.positions.len())?;
        Ok(self)
    }

    /// The same mesh with flat shading.
    #[must_use]
    pub fn without_normals(mut self) -> Self {
        self.normals = Vec::new();
        self
    }

    /// Shading normals; empty where there are none.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Tangents; empty where there are none.
    pub fn tangents(&self) -> &[Vec4] {
        &self.tangents
    }

    /// Texture coordinates of a set; empty where there are none.
    pub fn uv(&self, set: usize) -> &[Vec2] {
        self.uv.get(set).map_or(&[], Vec::as_slice)
    }

    /// Colours; empty where there are none.
    pub fn colors(&self) -> &[Vec4] {
        &self.colors
    }

    /// What a cut-out needs at the barycentric weights `uv` of vertices 1 and 2.
    #[inline]
    pub fn alpha_attributes(&self, prim: u32, uv: Vec2) -> AlphaAttributes {
        AlphaAttributes {
            p: self.point(prim, uv).p,
            uv: [self.uv_at(0, prim, uv), self.uv_at(1, prim, uv)],
            color: self.color_at(prim, uv),
        }
    }

    /// One attribute at the three corners; `None` where the mesh does not have it.
    #[inline]
    pub(super) fn corners_of<T: Copy>(&self, values: &[T], prim: u32) -> Option<[T; 3]> {
        let [a, b, c] = *self.indices.get(prim as usize)?;
        Some([*values.get(a as usize)?, *values.get(b as usize)?, *values.get(c as usize)?])
    }

    pub(super) fn uv_at(&self, set: usize, prim: u32, uv: Vec2) -> Vec2 {
        self.corners_of(self.uv(set), prim)
            .map_or(Vec2::ZERO, |[a, b, c]| a * (1.0 - uv.x - uv.y) + b * uv.x + c * uv.y)
    }

    pub(super) fn color_at(&self, prim: u32, uv: Vec2) -> Vec4 {
        self.corners_of(&self.colors, prim)
            .map_or(Vec4::ONE, |[a, b, c]| a * (1.0 - uv.x - uv.y) + b * uv.x + c * uv.y)
    }
}
