//! How much a microfacet lobe reflects in all: the directional albedo of height-correlated GGX with Schlick's Fresnel
//! term, looked up in tables (Kulla & Conty 2017, "Revisiting physically based shading at Imageworks"; the split of
//! Schlick's term is that of Karis 2013).
//!
//! With `w = (1 − v·h)⁵` the reflectance of a facet is `F0 (1 − w) + F90 w`, so that the lobe's albedo is
//! `F0 A + F90 B` with `A + B = E`, the albedo of perfectly reflecting facets. Tabulated are `√(1 − E)` over
//! `√(μ (1 + α) / (μ + α))`, in which the dark rim of nearly smooth surfaces does not shrink with α, and the cosine at
//! which Schlick's weight is `B / E`, over the fourth root of μ. Rows are linear in the fourth root of α.

#[allow(clippy::excessive_precision, reason = "all are printed with the same digits")]
mod tables;

#[cfg(test)]
mod generate;

use crate::Ggx;
use tables::{MISSING, MISSING_MEAN, SCHLICK, SCHLICK_MEAN};

/// Nodes along either axis of a table.
const NODES: usize = 32;
/// Rows of the means: four to a row of the tables.
const MEANS: usize = 4 * (NODES - 1) + 1;
/// Fourth root of the first row's α, which is the first rough one.
const FIRST_ROOT: f32 = 0.1;

/// `(1 − c)⁵`.
#[inline]
pub(super) fn schlick_weight(cos: f32) -> f32 {
    let m = (1.0 - cos.abs()).clamp(0.0, 1.0);
    let m2 = m * m;
    m2 * m2 * m
}

/// The lobe's albedo seen from one direction, or averaged over all with the cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Albedo {
    /// What single scattering loses though every facet reflects all: `1 − E`.
    pub(crate) missing: f32,
    /// Factor of F0: `A`.
    pub(crate) normal: f32,
    /// Factor of F90: `B`.
    pub(crate) grazing: f32,
}

/// The tables at one roughness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AlbedoRow {
    alpha: f32,
    /// Place among the rows, in `[0, NODES − 1]`; `None` where the surface is smooth.
    row: Option<f32>,
}

impl AlbedoRow {
    /// The row of an isotropic surface. Alphas above 1 count as 1.
    #[inline]
    pub(crate) fn new(ggx: Ggx) -> Self {
        let alpha = ggx.alpha_x().clamp(0.0, 1.0);
        let row = (alpha.sqrt().sqrt() - FIRST_ROOT) * ((NODES - 1) as f32 / (1.0 - FIRST_ROOT));
        Self { alpha, row: (!ggx.is_smooth()).then_some(row) }
    }

    /// Seen at the cosine `mu`.
    #[inline]
    pub(crate) fn toward(&self, mu: f32) -> Albedo {
        let mu = mu.abs().clamp(0.0, 1.0);
        let Some(row) = self.row else {
            let w = schlick_weight(mu);
            return Albedo { missing: 0.0, normal: 1.0 - w, grazing: w };
        };
        let row = cell::<NODES>(row);
        let s = (mu * (1.0 + self.alpha) / (mu + self.alpha)).sqrt();
        let root = between(&MISSING, row, s * (NODES - 1) as f32);
        let w = schlick_weight(between(&SCHLICK, row, mu.sqrt().sqrt() * (NODES - 1) as f32));
        let (missing, e) = (root * root, 1.0 - root * root);
        Albedo { missing, normal: e * (1.0 - w), grazing: e * w }
    }

    /// The mean over the hemisphere, weighted with the cosine.
    #[inline]
    pub(crate) fn mean(&self) -> Albedo {
        let Some(row) = self.row else {
            return Albedo { missing: 0.0, normal: 20.0 / 21.0, grazing: 1.0 / 21.0 };
        };
        let (j, y) = cell::<MEANS>(4.0 * row);
        let of = |t: &[f32; MEANS]| t[j] + (t[j + 1] - t[j]) * y;
        // In units of alpha the root of what is missing hardly varies.
        let root = of(&MISSING_MEAN) * self.alpha;
        let (missing, grazing) = (root * root, of(&SCHLICK_MEAN));
        Albedo { missing, normal: 1.0 - missing - grazing, grazing }
    }
}

/// The cell of a coordinate in `[0, N − 1]` and the place in it. NaN is put at 0.
#[inline]
fn cell<const N: usize>(x: f32) -> (usize, f32) {
    let x = if x > 0.0 { x.clamp(0.0, (N - 1) as f32) } else { 0.0 };
    let i = (x as usize).min(N - 2);
    (i, x - i as f32)
}

#[inline]
fn between(table: &[[f32; NODES]; NODES], (j, y): (usize, f32), x: f32) -> f32 {
    let (i, x) = cell::<NODES>(x);
    let of = |row: &[f32; NODES]| row[i] + (row[i + 1] - row[i]) * x;
    let (a, b) = (of(&table[j]), of(&table[j + 1]));
    a + (b - a) * y
}
