use etendue_core::{Spectrum, Vec2, Vec3A};

use crate::bsdf::delta_lobes_among;
use crate::{Bsdf, BsdfAt, BsdfSample, Lobes, Mode};

/// A perfect mirror of constant reflectance, on either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// Reflectance, each channel in `[0, 1]`.
    pub reflectance: Spectrum,
}

impl Mirror {
    /// A mirror.
    pub fn new(reflectance: Spectrum) -> Self {
        Self { reflectance }
    }
}

/// The one sample of a delta reflection; `None` for a direction in the surface, or one that is not finite.
#[inline]
pub(crate) fn reflect_about_z(wo: Vec3A, weight: Spectrum, pdf: f32) -> Option<BsdfSample> {
    if !(wo.z.abs() > 0.0 && wo.is_finite()) {
        return None;
    }
    let wi = Vec3A::new(-wo.x, -wo.y, wo.z);
    Some(BsdfSample { wi, weight, pdf, lobe: Lobes::REFLECTION | Lobes::DELTA, eta: 1.0 })
}

impl Bsdf for Mirror {
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION | Lobes::DELTA | Lobes::RECIPROCAL
    }

    #[inline]
    fn eval(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> Spectrum {
        Spectrum::BLACK
    }

    #[inline]
    fn pdf(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> f32 {
        0.0
    }

    #[inline]
    fn sample(&self, wo: Vec3A, _u_lobe: f32, _u: Vec2, _mode: Mode) -> Option<BsdfSample> {
        reflect_about_z(wo, self.reflectance, 1.0)
    }

    fn albedo(&self, _wo: Vec3A) -> Spectrum {
        self.reflectance
    }

    fn delta_lobes(&self, wo: Vec3A, mode: Mode) -> [Option<BsdfSample>; 2] {
        delta_lobes_among(self, wo, mode, [0.0])
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Mirror(*self)
    }
}
