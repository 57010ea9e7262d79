use etendue_core::Vec2;

use crate::{Dim, Sampler};

/// What a map to a domain takes: one uniform number or a pair of them.
pub trait Uniform: Copy {
    /// Draws it at `dim`, each number in [0, 1).
    fn draw<S: Sampler>(sampler: &S, dim: Dim) -> Self;
}

/// A multiple of 2⁻²⁴.
impl Uniform for f32 {
    #[inline]
    fn draw<S: Sampler>(sampler: &S, dim: Dim) -> Self {
        sampler.get_1d(dim)
    }
}

/// A multiple of 2⁻³².
impl Uniform for f64 {
    #[inline]
    fn draw<S: Sampler>(sampler: &S, dim: Dim) -> Self {
        sampler.get_1d_f64(dim)
    }
}

/// The numbers of `dim` and the next, jointly stratified.
impl Uniform for Vec2 {
    #[inline]
    fn draw<S: Sampler>(sampler: &S, dim: Dim) -> Self {
        sampler.get_2d(dim)
    }
}
