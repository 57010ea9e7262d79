//! Tangents by MikkTSpace (Mikkelsen 2008), which glTF prescribes where a file brings none.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use etendue_core::math;

use super::mesh::Vertices;

/// The same bits on every target.
struct Portable;

impl Ops for Portable {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }
    fn acos(x: f32) -> f32 {
        math::acos(x)
    }
}

/// A mesh as the generator sees it: corner by corner.
struct Corners<'a> {
    vertices: &'a Vertices,
    uv: &'a [[f32; 2]],
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn at<T: Copy + Default>(&self, values: &[T], face: usize, corner: usize) -> T {
        let index = self.vertices.triangles.get(face).and_then(|t| t.get(corner));
        index.and_then(|&i| values.get(i as usize)).copied().unwrap_or_default()
    }
}

impl Geometry<Portable> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.vertices.triangles.len()
    }
    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }
    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.at(&self.vertices.positions, face, corner)
    }
    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.at(&self.vertices.normals, face, corner)
    }
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.at(self.uv, face, corner)
    }
    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let slot = face.checked_mul(3).and_then(|i| i.checked_add(corner));
        if let Some(t) = slot.and_then(|i| self.tangents.get_mut(i)) {
            // glTF counts v downward, the generator upward: the bitangent is on the other side.
            *t = space.unwrap_or_default().tangent_encoded();
            t[3] = -t[3];
        }
    }
}

/// Gives every corner its tangent by the texture coordinates `uv`; a vertex whose corners differ is split.
pub(super) fn generate(vertices: &mut Vertices, uv: &[[f32; 2]]) {
    let corners = vertices.triangles.len().saturating_mul(3);
    let mut made = Corners { vertices, uv, tangents: vec![[1.0, 0.0, 0.0, 1.0]; corners] };
    if generate_tangents(&mut made).is_err() {
        return;
    }
    let tangents = made.tangents;
    let mut known: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    let mut sources: Vec<u32> = Vec::new();
    let mut out = Vec::new();
    for (triangle, corner_tangents) in vertices.triangles.iter_mut().zip(tangents.chunks_exact(3)) {
        for (index, tangent) in triangle.iter_mut().zip(corner_tangents) {
            let next = u32::try_from(sources.len()).unwrap_or(u32::MAX);
            let place = *known.entry((*index, tangent.map(f32::to_bits))).or_insert(next);
            if place == next {
                sources.push(*index);
                out.push(*tangent);
            }
            *index = place;
        }
    }
    vertices.gather(&sources);
    vertices.tangents = out;
}
