use std::f32::consts::TAU;

use etendue_core::{Frame, Spectrum, Vec2, Vec3A};
use etendue_sampling::warp;

use crate::power_lobe::{self, PowerLobe, power_of_rest, sane_exponent, sane_share};
use crate::{Bsdf, BsdfAt, BsdfSample, Lobes, Mode};

/// Phong's lobe around the mirrored direction as a BRDF, on either side of the surface (Phong 1975; normalised by
/// Lafortune & Willems 1994, "Using the modified Phong reflectance model for physically based rendering", equations 1, 8
/// and 9): `f = diffuse / π + specular (n + 2) / 2π · cosⁿ α`, with α between `wi` and the mirrored `wo`, 0 beyond a
/// right angle.
///
/// Reciprocal. The lobe returns `specular` at normal incidence and less elsewhere, since the surface cuts part of it
/// off; the sum of both reflectances is held at 1, so no light is made. A lobe is drawn by the cosine's power around the
/// mirrored direction; draws below the surface are lost, which the density says by integrating to less than 1 (about
/// half of a narrow lobe's at grazing angles).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    diffuse: Spectrum,
    specular: Spectrum,
    exponent: f32,
}

impl Phong {
    /// `diffuse` is the base's reflectance, `specular` that of the lobe at normal incidence, both in `[0, 1]` per
    /// channel; `specular` is held at `1 − diffuse`. `exponent` is in `[0, 10⁶]`. What is outside is brought to the
    /// range's end, NaN is 0.
    pub fn new(diffuse: Spectrum, specular: Spectrum, exponent: f32) -> Self {
        let diffuse = sane_share(diffuse, Spectrum::ONE);
        let specular = sane_share(specular, Spectrum::ONE - diffuse);
        Self { diffuse, specular, exponent: sane_exponent(exponent) }
    }

    /// Reflectance of the base.
    pub fn diffuse(&self) -> Spectrum {
        self.diffuse
    }

    /// Reflectance of the lobe at normal incidence.
    pub fn specular(&self) -> Spectrum {
        self.specular
    }

    /// Exponent of the lobe.
    pub fn exponent(&self) -> f32 {
        self.exponent
    }
}

impl PowerLobe for Phong {
    fn base(&self) -> Spectrum {
        self.diffuse
    }

    fn factor(&self) -> Spectrum {
        self.specular
    }

    #[inline]
    fn lobe(&self, o: Vec3A, i: Vec3A) -> (f32, f32) {
        // 1 − cos α of unit vectors is half of their squared distance.
        let apart = Vec3A::new(i.x + o.x, i.y + o.y, i.z - o.z);
        let power = power_of_rest(0.5 * apart.dot(apart), self.exponent);
        let cos = i.z.clamp(0.0, 1.0);
        ((self.exponent + 2.0) / TAU * power * cos, (self.exponent + 1.0) / TAU * power)
    }

    #[inline]
    fn draw(&self, o: Vec3A, u: Vec2) -> Option<Vec3A> {
        let around = Frame::from_normal(Vec3A::new(-o.x, -o.y, o.z));
        Some(around.to_world(warp::power_cosine(u, self.exponent)))
    }
}

// Everything is out of line: inlined into `BsdfAt`, big frames slow every other model down.
impl Bsdf for Phong {
    fn lobes(&self) -> Lobes {
        power_lobe::lobes(self)
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> Spectrum {
        self.eval_pdf(wo, wi, mode).0
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, mode: Mode) -> f32 {
        self.eval_pdf(wo, wi, mode).1
    }

    #[inline(never)]
    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, _mode: Mode) -> Option<BsdfSample> {
        power_lobe::sample(self, wo, u_lobe, u)
    }

    #[inline(never)]
    fn eval_pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> (Spectrum, f32) {
        let (base, lobe, pdf) = power_lobe::parts(self, wo, wi);
        (base + lobe, pdf)
    }

    fn eval_classes(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> [Spectrum; 4] {
        let (base, lobe, _) = power_lobe::parts(self, wo, wi);
        [base, lobe, Spectrum::BLACK, Spectrum::BLACK]
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Phong(*self)
    }
}
