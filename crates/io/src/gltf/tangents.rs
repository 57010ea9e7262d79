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

/// Triangles around one point that the generator is given. It goes from one to the next by recursion and compares
/// them pair by pair: a fan of 50,000 took it 49 s, one of 200,000 the stack.
const AROUND: u32 = 1024;

/// A mesh as the generator sees it: corner by corner.
struct Corners<'a> {
    vertices: &'a Vertices,
    /// The triangles that have three different corners; the others have no tangent and cost it quadratic time.
    sound: Vec<usize>,
    uv: &'a [[f32; 2]],
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn at<T: Copy + Default>(&self, values: &[T], face: usize, corner: usize) -> T {
        let triangle = self.sound.get(face).and_then(|&i| self.vertices.triangles.get(i));
        let index = triangle.and_then(|t| t.get(corner));
        index.and_then(|&i| values.get(i as usize)).copied().unwrap_or_default()
    }
}

impl Geometry<Portable> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.sound.len()
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
        let slot = self.sound.get(face).and_then(|i| i.checked_mul(3)).and_then(|i| i.checked_add(corner));
        if let Some(t) = slot.and_then(|i| self.tangents.get_mut(i)) {
            // glTF counts v downward, the generator upward: the bitangent is on the other side.
            *t = space.unwrap_or_default().tangent_encoded();
            t[3] = -t[3];
        }
    }
}

/// Gives every corner its tangent by the texture coordinates `uv`; a vertex whose corners differ is split. False where
/// too many triangles meet in one point, and nothing is done.
pub(super) fn generate(vertices: &mut Vertices, uv: &[[f32; 2]]) -> bool {
    let place = |i: u32| {
        // Adding zero makes −0 the same place as 0.
        vertices.positions.get(i as usize).copied().unwrap_or_default().map(|c| (c + 0.0).to_bits())
    };
    let mut around: HashMap<[u32; 3], u32> = HashMap::new();
    let mut sound = Vec::new();
    for (i, triangle) in vertices.triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(place);
        if a == b || b == c || c == a {
            continue;
        }
        sound.push(i);
        for corner in [a, b, c] {
            let count = around.entry(corner).or_default();
            *count = count.saturating_add(1);
            if *count > AROUND {
                return false;
            }
        }
    }
    let corners = vertices.triangles.len().saturating_mul(3);
    let mut made = Corners { vertices, sound, uv, tangents: vec![[1.0, 0.0, 0.0, 1.0]; corners] };
    if generate_tangents(&mut made).is_err() {
        return false;
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
    true
}
