use etendue_core::{Vec2, Vec3};

use super::{assembled, noise};
use crate::TriangleMesh;

/// Height of the terrain at a grid point: four octaves of value noise between -0.2 and 0.2.
fn height(n: u32, seed: u32, i: u32, j: u32) -> f32 {
    let mut sum = 0.0;
    let mut size = 0.2;
    for octave in 0..4u32 {
        let cells = 4 << octave;
        let (x, y) = (i as f32 / n as f32 * cells as f32, j as f32 / n as f32 * cells as f32);
        let (xi, yi) = (x.floor(), y.floor());
        let (fx, fy) = (x - xi, y - yi);
        let at = |dx: u32, dy: u32| noise(seed ^ octave, xi as u32 + dx, yi as u32 + dy) - 0.5;
        let near = at(0, 0) * (1.0 - fx) + at(1, 0) * fx;
        let far = at(0, 1) * (1.0 - fx) + at(1, 1) * fx;
        sum += size * (near * (1.0 - fy) + far * fy);
        size *= 0.5;
    }
    sum
}

fn grid_point(n: u32, seed: u32, i: u32, j: u32) -> Vec3 {
    let x = |k: u32| k as f32 / n as f32 * 2.0 - 1.0;
    Vec3::new(x(i), height(n, seed, i, j), x(j))
}

/// An open landscape over `[-1, 1]²` in x and z: `2 n²` triangles that face +Y.
pub fn terrain(n: u32, seed: u32) -> TriangleMesh {
    let n = n.clamp(1, 8192);
    let mut positions = Vec::new();
    let mut uv = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            positions.push(grid_point(n, seed, i, j));
            uv.push(Vec2::new(i as f32 / n as f32, 1.0 - j as f32 / n as f32));
        }
    }
    let mut indices = Vec::new();
    push_grid(&mut indices, n, |i, j| j * (n + 1) + i);
    assembled(positions, indices, Vec::new(), uv)
}

/// Two triangles for each cell of a grid, facing +Y where `i` runs along +X and `j` along +Z.
fn push_grid(indices: &mut Vec<[u32; 3]>, n: u32, at: impl Fn(u32, u32) -> u32) {
    for j in 0..n {
        for i in 0..n {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
            indices.push([a, c, b]);
            indices.push([b, c, d]);
        }
    }
}

/// A closed block of `2 n² + 12 n` triangles whose top is the landscape of [`terrain`]; it reaches down to
/// y = −1.
pub fn block(n: u32, seed: u32) -> TriangleMesh {
    let n = n.clamp(1, 8192);
    let side = n + 1;
    let mut positions = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            positions.push(grid_point(n, seed, i, j));
        }
    }
    let mut indices = Vec::new();
    push_grid(&mut indices, n, |i, j| j * side + i);
    // The border seen from above, clockwise: the order in which outward walls have their top edge.
    let mut border = Vec::new();
    border.extend(0..n);
    border.extend((0..n).map(|j| j * side + n));
    border.extend((0..n).map(|i| n * side + n - i));
    border.extend((0..n).map(|j| (n - j) * side));
    let foot = positions.len() as u32;
    for &b in &border {
        if let Some(top) = positions.get(b as usize).copied() {
            positions.push(Vec3::new(top.x, -1.0, top.z));
        }
    }
    let middle = positions.len() as u32;
    positions.push(Vec3::new(0.0, -1.0, 0.0));
    let count = border.len() as u32;
    for (k, &top) in border.iter().enumerate() {
        let k = k as u32;
        let next = (k + 1) % count;
        let next_top = border.get(next as usize).copied().unwrap_or(top);
        indices.push([top, next_top, foot + k]);
        indices.push([next_top, foot + next, foot + k]);
        indices.push([foot + k, foot + next, middle]);
    }
    assembled(positions, indices, Vec::new(), Vec::new())
}
