use std::f32::consts::{PI, TAU};

use etendue_core::{Spectrum, Vec2, Vec3A, math, vector};
use etendue_sampling::warp;

use crate::power_lobe::{self, PowerLobe, power_lobe_bsdf, power_of_rest, sane_exponent, sane_share};
use crate::{Bsdf, BsdfAt, BsdfSample, Lobes, Mode};

/// Blinn's lobe around the half vector as a BRDF, on either side of the surface (Blinn 1977, "Models of light reflection
/// for computer synthesized pictures"): `f = diffuse / π + specular C(n) cosⁿ θh`, with θh between the normal and the
/// half vector of `wi` and `wo`.
///
/// `C(n) = (n + 2)(n + 4) / (8π (n + 2^(−n/2)))` makes the lobe return exactly `specular` at normal incidence
/// (Akenine-Möller, Haines & Hoffman 2008, section 7.6; the often quoted (n + 8) / 8π approximates it). Reciprocal. It
/// returns less elsewhere, down to about `specular cos² θo` of a narrow lobe; the sum of both reflectances is held at 1,
/// so no light is made. Half vectors are drawn with density `(n + 2) / 2π · cosⁿ⁺¹ θh`, hence directions with that over
/// `4 wo·h`; draws below the surface are lost, which the density says by integrating to less than 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlinnPhong {
    diffuse: Spectrum,
    specular: Spectrum,
    exponent: f32,
}

impl BlinnPhong {
    /// `diffuse` is the base's reflectance, `specular` that of the lobe at normal incidence, both in `[0, 1]` per
    /// channel; `specular` is held at `1 − diffuse`. `exponent` is in `[0, 10⁶]`; a lobe of this exponent is about as
    /// wide as that of [`Phong`](crate::Phong) of a quarter of it. What is outside is brought to the range's end, NaN is
    /// 0.
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

    /// C(n), sr⁻¹.
    #[inline]
    fn normalisation(&self) -> f32 {
        let n = self.exponent;
        (n + 2.0) * (n + 4.0) / (8.0 * PI * (n + math::exp2(-0.5 * n)))
    }
}

impl PowerLobe for BlinnPhong {
    fn base(&self) -> Spectrum {
        self.diffuse
    }

    fn factor(&self) -> Spectrum {
        self.specular
    }

    #[inline]
    fn lobe(&self, o: Vec3A, i: Vec3A) -> (f32, f32) {
        let Some(h) = vector::try_normalize(o + i) else { return (0.0, 0.0) };
        let cos = h.dot(o);
        if !(cos > 0.0) {
            return (0.0, 0.0);
        }
        // cosⁿ from the sine where that is the more exact.
        let sin2 = h.x * h.x + h.y * h.y;
        let n = self.exponent;
        let power = if sin2 < 0.5 { power_of_rest(sin2, 0.5 * n) } else { math::pow(h.z, n) };
        (self.normalisation() * power * i.z.clamp(0.0, 1.0), (n + 2.0) / TAU * power * h.z / (4.0 * cos))
    }

    #[inline]
    fn draw(&self, o: Vec3A, u: Vec2) -> Option<Vec3A> {
        let h = warp::power_cosine(u, self.exponent + 1.0);
        let cos = o.dot(h);
        (cos > 0.0).then(|| vector::normalize(h * (2.0 * cos) - o))
    }
}

power_lobe_bsdf!(BlinnPhong);
