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

    /// Whether a triangle can never be hit: exactly zero area, a corner that is not finite or beyond 2⁶⁰, or no such
    /// triangle. Exact; no tolerance is involved.
    pub fn is_degenerate(&self, prim: u32) -> bool {
        flaw(self.triangle(prim)).is_some()
    }

    /// Fills in the report and the bounds.
    pub(super) fn inspect(&mut self) {
        let mut report = MeshReport { triangles: self.indices.len(), ..MeshReport::default() };
        report.non_finite_vertices = self.positions.iter().filter(|p| !p.is_finite()).count();
        let mut bounds = Aabb::EMPTY;
        for prim in 0..self.indices.len() as u32 {
            let v = self.triangle(prim);
            match flaw(v) {
                None => bounds = v.into_iter().fold(bounds, Aabb::grown),
                Some(Flaw::ZeroArea) => report.degenerate += 1,
                Some(Flaw::OutOfRange) => report.non_finite += 1,
            }
        }
        self.report = report;
        self.bounds = bounds;
    }
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
