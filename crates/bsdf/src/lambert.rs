use std::f32::consts::FRAC_1_PI;

use etendue_core::{Spectrum, Vec2, Vec3A};
use etendue_sampling::warp;

use crate::{Bsdf, BsdfAt, BsdfSample, Lobes, Mode};

/// The perfectly diffuse reflector: `f = albedo / π` on either side of the surface (Lambert 1760).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    /// Reflectance, each channel in `[0, 1]`.
    pub albedo: Spectrum,
}

impl Lambert {
    /// A diffuse reflector.
    pub fn new(albedo: Spectrum) -> Self {
        Self { albedo }
    }
}

impl Bsdf for Lambert {
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION | Lobes::DIFFUSE | Lobes::RECIPROCAL
    }

    #[inline]
    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.albedo * self.pdf(wo, wi, mode)
    }

    #[inline]
    fn pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> f32 {
        if wo.z * wi.z > 0.0 { wi.z.abs().clamp(0.0, 1.0) * FRAC_1_PI } else { 0.0 }
    }

    #[inline]
    fn sample(&self, wo: Vec3A, _u_lobe: f32, u: Vec2, _mode: Mode) -> Option<BsdfSample> {
        let mut wi = warp::cosine(u);
        if wo.z < 0.0 {
            wi.z = -wi.z;
        }
        // A direction in the surface has no density; a wo in it sees nothing.
        if !(wo.z * wi.z > 0.0) {
            return None;
        }
        let lobe = Lobes::REFLECTION | Lobes::DIFFUSE;
        Some(BsdfSample { wi, weight: self.albedo, pdf: wi.z.abs() * FRAC_1_PI, lobe, eta: 1.0 })
    }

    #[inline]
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> (Spectrum, f32) {
        let pdf = self.pdf(wo, wi, mode);
        (self.albedo * pdf, pdf)
    }

    fn albedo(&self, _wo: Vec3A) -> Spectrum {
        self.albedo
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Lambert(*self)
    }
}
