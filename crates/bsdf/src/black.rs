use etendue_core::{Spectrum, Vec2, Vec3A};

use crate::{Bsdf, BsdfAt, BsdfSample, Lobes, Mode};

/// Absorbs all light: what a pure emitter is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Black;

impl Bsdf for Black {
    fn lobes(&self) -> Lobes {
        Lobes::RECIPROCAL
    }

    fn eval(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> Spectrum {
        Spectrum::BLACK
    }

    fn pdf(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> f32 {
        0.0
    }

    fn sample(&self, _wo: Vec3A, _u_lobe: f32, _u: Vec2, _mode: Mode) -> Option<BsdfSample> {
        None
    }

    fn albedo(&self, _wo: Vec3A) -> Spectrum {
        Spectrum::BLACK
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Black(*self)
    }
}
