//! Meshes made by formula: for examples, tests and benchmarks.
//!
//! All are wound counter-clockwise seen from outside. Where one is called closed, every edge is shared by exactly two
//! triangles whose corners agree bit by bit.

mod ground;
mod round;

pub use ground::{block, terrain};
pub use round::{icosphere, spiky_sphere, torus, uv_sphere};

use etendue_core::{Aabb, Vec2, Vec3, Vec3A};

use crate::TriangleMesh;

/// A mesh from arrays that are right by construction; should they not be, the mesh is empty rather than wrong.
fn assembled(
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    normals: Vec<Vec3>,
    uv: Vec<Vec2>,
) -> TriangleMesh {
    TriangleMesh::new(positions, indices)
        .and_then(|m| if normals.is_empty() { Ok(m) } else { m.with_normals(normals) })
        .and_then(|m| if uv.is_empty() { Ok(m) } else { m.with_uv(0, uv) })
        .unwrap_or_else(|_| TriangleMesh::empty())
}

/// Noise in `[0, 1)` from a few integers: the finaliser of Appleby's MurmurHash3 over their mixture.
fn noise(seed: u32, x: u32, y: u32) -> f32 {
    let mut h = seed ^ x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77).rotate_left(13);
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^= h >> 16;
    (h >> 8) as f32 / (1 << 24) as f32
}

/// Two triangles that fill the parallelogram at `origin`; the front is the side of `edge_u × edge_v`.
pub fn quad(origin: Vec3A, edge_u: Vec3A, edge_v: Vec3A) -> TriangleMesh {
    let corners = [origin, origin + edge_u, origin + edge_u + edge_v, origin + edge_v];
    assembled(
        corners.map(Vec3::from).to_vec(),
        vec![[0, 1, 2], [0, 2, 3]],
        Vec::new(),
        vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
    )
}

/// A closed box of 12 triangles with its own corners for each face, so that it has flat shading and texture
/// coordinates.
pub fn cuboid(lo: Vec3A, hi: Vec3A) -> TriangleMesh {
    let corners = Aabb { lo, hi }.corners();
    // Corner i has x, y, z high where its bits 0, 1, 2 are set.
    const FACES: [[usize; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut positions = Vec::with_capacity(24);
    let mut indices = Vec::with_capacity(12);
    let mut uv = Vec::with_capacity(24);
    for face in FACES {
        let first = positions.len() as u32;
        positions.extend(face.map(|i| Vec3::from(corners[i])));
        uv.extend([Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]);
        indices.push([first, first + 1, first + 2]);
        indices.push([first, first + 2, first + 3]);
    }
    assembled(positions, indices, Vec::new(), uv)
}
