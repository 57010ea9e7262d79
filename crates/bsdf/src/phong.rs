use std::f32::consts::TAU;

use etendue_core::{Frame, Spectrum, Vec2, Vec3A};
use etendue_sampling::warp;

use crate::power_lobe::{self, PowerLobe, power_lobe_bsdf, power_of_rest, sane_exponent, sane_share};
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

power_lobe_bsdf!(Phong);
