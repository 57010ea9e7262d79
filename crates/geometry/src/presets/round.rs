use std::collections::BTreeMap;
use std::f32::consts::{PI, TAU};

use etendue_core::{Vec2, Vec3, Vec3A, math, vector};

use super::{assembled, noise};
use crate::TriangleMesh;

struct Icosphere {
    directions: Vec<Vec3A>,
    indices: Vec<[u32; 3]>,
}

fn subdivided_icosahedron(subdivisions: u32) -> Icosphere {
    const G: f32 = 1.618_034;
    let mut directions: Vec<Vec3A> = [
        [-1.0, G, 0.0],
        [1.0, G, 0.0],
        [-1.0, -G, 0.0],
        [1.0, -G, 0.0],
        [0.0, -1.0, G],
        [0.0, 1.0, G],
        [0.0, -1.0, -G],
        [0.0, 1.0, -G],
        [G, 0.0, -1.0],
        [G, 0.0, 1.0],
        [-G, 0.0, -1.0],
        [-G, 0.0, 1.0],
    ]
    .map(|v| vector::normalize(Vec3A::from_array(v)))
    .to_vec();
    let mut indices: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..subdivisions.min(10) {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::with_capacity(indices.len() * 4);
        for [a, b, c] in indices {
            let mut middle = |a: u32, b: u32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let at = |i: u32| directions.get(i as usize).copied().unwrap_or(Vec3A::ZERO);
                    directions.push(vector::normalize(at(a) + at(b)));
                    directions.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        indices = finer;
    }
    Icosphere { directions, indices }
}

/// A closed sphere of `20 · 4^subdivisions` nearly equal triangles with smooth normals (at most 10 subdivisions).
pub fn icosphere(subdivisions: u32, radius: f32) -> TriangleMesh {
    let sphere = subdivided_icosahedron(subdivisions);
    let positions = sphere.directions.iter().map(|&d| Vec3::from(d * radius)).collect();
    let normals = sphere.directions.iter().map(|&d| Vec3::from(d)).collect();
    assembled(positions, sphere.indices, normals, Vec::new())
}

/// A closed icosphere of radius 1 whose vertices are pushed out by up to `spike`: needles and deep valleys, flat
/// shading.
pub fn spiky_sphere(subdivisions: u32, spike: f32, seed: u32) -> TriangleMesh {
    let sphere = subdivided_icosahedron(subdivisions);
    let positions = sphere
        .directions
        .iter()
        .enumerate()
        .map(|(i, &d)| Vec3::from(d * (1.0 + spike * noise(seed, i as u32, 0))))
        .collect();
    assembled(positions, sphere.indices, Vec::new(), Vec::new())
}

/// Vertices of a closed grid of rings, with seams where texture coordinates jump.
struct Lattice {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uv: Vec<Vec2>,
}

/// A closed sphere of parallels and meridians around +Y with smooth normals and texture coordinates:
/// `2 · segments · (rings − 1)` triangles, long slivers at the poles.
pub fn uv_sphere(segments: u32, rings: u32, radius: f32) -> TriangleMesh {
    let (segments, rings) = (segments.clamp(3, 16384), rings.clamp(2, 16384));
    let mut l = Lattice { positions: Vec::new(), normals: Vec::new(), uv: Vec::new() };
    for j in 0..=rings {
        // From the south pole up. The poles and the seam are given their exact values, so that the mesh is closed.
        let (sin, cos) = match j {
            0 => (0.0, -1.0),
            _ if j == rings => (0.0, 1.0),
            _ => {
                let (s, c) = math::sin_cos(PI * j as f32 / rings as f32);
                (s, -c)
            }
        };
        for i in 0..=segments {
            let (s, c) = math::sin_cos(TAU * (i % segments) as f32 / segments as f32);
            let n = Vec3::new(sin * c, cos, -sin * s);
            l.positions.push(n * radius);
            l.normals.push(n);
            l.uv.push(Vec2::new(i as f32 / segments as f32, j as f32 / rings as f32));
        }
    }
    let at = |i: u32, j: u32| j * (segments + 1) + i;
    let mut indices = Vec::new();
    for j in 0..rings {
        for i in 0..segments {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
            if j > 0 {
                indices.push([a, b, d]);
            }
            if j + 1 < rings {
                indices.push([a, d, c]);
            }
        }
    }
    assembled(l.positions, indices, l.normals, l.uv)
}

/// A closed torus around +Y with smooth normals and texture coordinates: `2 · around · across` triangles.
pub fn torus(major: f32, minor: f32, around: u32, across: u32) -> TriangleMesh {
    let (around, across) = (around.clamp(3, 16384), across.clamp(3, 16384));
    let mut l = Lattice { positions: Vec::new(), normals: Vec::new(), uv: Vec::new() };
    for j in 0..=across {
        let (sin, cos) = math::sin_cos(TAU * (j % across) as f32 / across as f32);
        for i in 0..=around {
            let (s, c) = math::sin_cos(TAU * (i % around) as f32 / around as f32);
            let n = Vec3::new(cos * c, sin, -cos * s);
            l.positions.push(Vec3::new(c, 0.0, -s) * major + n * minor);
            l.normals.push(n);
            l.uv.push(Vec2::new(i as f32 / around as f32, j as f32 / across as f32));
        }
    }
    let at = |i: u32, j: u32| j * (around + 1) + i;
    let mut indices = Vec::new();
    for j in 0..across {
        for i in 0..around {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
            indices.push([a, b, d]);
            indices.push([a, d, c]);
        }
    }
    assembled(l.positions, indices, l.normals, l.uv)
}
