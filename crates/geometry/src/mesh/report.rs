use etendue_core::{Aabb, Vec3A};

use super::TriangleMesh;
use crate::exact;

/// What of a mesh cannot be hit, and why.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshReport {
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Triangles of exactly zero area.
    pub degenerate: usize,
    /// Triangles with a corner that is NaN, infinite or beyond 2⁶⁰.
    pub non_finite: usize,
    /// Triangles with the same three corners as an earlier one, in any order.
    pub duplicate: usize,
    /// Vertices that are NaN or infinite, used or not.
    pub non_finite_vertices: usize,
}

/// Why a triangle cannot be hit.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Flaw {
    ZeroArea,
    OutOfRange,
}

/// 2⁶⁰: beyond it, products of three coordinates differences leave single precision.
const LIMIT: f32 = 1_152_921_504_606_846_976.0;

impl TriangleMesh {
    /// What was found wrong with the triangles when the mesh was made.
    pub fn report(&self) -> MeshReport {
        self.report
    }

    /// Whether a triangle can never be hit: exactly zero area, a corner that is not finite or beyond 2⁶⁰, the same
    /// corners as an earlier triangle (which wins every tie), or no such triangle. Exact; no tolerance is involved.
    pub fn is_degenerate(&self, prim: u32) -> bool {
        flaw(self.triangle(prim)).is_some() || self.duplicates.binary_search(&prim).is_ok()
    }

    /// Fills in the report and the bounds.
    pub(super) fn inspect(&mut self) {
        let mut report = MeshReport { triangles: self.indices.len(), ..MeshReport::default() };
        report.non_finite_vertices = self.positions.iter().filter(|p| !p.is_finite()).count();
        let mut bounds = Aabb::EMPTY;
        let mut sound: Vec<(u64, u32)> = Vec::with_capacity(self.indices.len());
        for prim in 0..self.indices.len() as u32 {
            let v = self.triangle(prim);
            match flaw(v) {
                None => {
                    bounds = v.into_iter().fold(bounds, Aabb::grown);
                    sound.push((key(v), prim));
                }
                Some(Flaw::ZeroArea) => report.degenerate += 1,
                Some(Flaw::OutOfRange) => report.non_finite += 1,
            }
        }
        self.duplicates = self.find_duplicates(&mut sound);
        report.duplicate = self.duplicates.len();
        self.report = report;
        self.bounds = bounds;
    }

    /// Triangles, in ascending order, whose corners an earlier one has. `keyed` holds the sound triangles.
    fn find_duplicates(&self, keyed: &mut [(u64, u32)]) -> Vec<u32> {
        keyed.sort_unstable();
        let mut out = Vec::new();
        for run in keyed.chunk_by(|a, b| a.0 == b.0).filter(|run| run.len() > 1) {
            // Equal keys are nearly always equal corners; sorting by corners tells, the lowest number first.
            let mut run: Vec<_> = run.iter().map(|&(_, prim)| (corners(self.triangle(prim)), prim)).collect();
            run.sort_unstable();
            out.extend(run.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[1].1));
        }
        out.sort_unstable();
        out
    }
}

/// The corners' bits in an order that does not depend on where the triangle begins or how it winds.
fn corners(v: [Vec3A; 3]) -> [[u32; 3]; 3] {
    // Adding zero makes −0 the same corner as 0.
    let mut bits = v.map(|p| (p + Vec3A::ZERO).to_array().map(f32::to_bits));
    bits.sort_unstable();
    bits
}

/// A number that triangles of the same corners share: a sum over the corners, so that their order does not matter.
fn key(v: [Vec3A; 3]) -> u64 {
    v.into_iter().fold(0, |sum, p| {
        let [x, y, z] = (p + Vec3A::ZERO).to_array().map(|c| u64::from(c.to_bits()));
        sum.wrapping_add(etendue_sampling::mix2(x << 32 | y, z))
    })
}

fn flaw(v: [Vec3A; 3]) -> Option<Flaw> {
    let fits = |p: Vec3A| p.abs().cmple(Vec3A::splat(LIMIT)).all();
    if !v.into_iter().all(fits) {
        Some(Flaw::OutOfRange)
    } else if exact::is_flat(v) {
        Some(Flaw::ZeroArea)
    } else {
        None
    }
}
