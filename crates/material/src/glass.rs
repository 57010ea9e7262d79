use etendue_bsdf::{BsdfAt, Ggx, Masking, RoughDielectric, SmoothDielectric};
use etendue_core::{Fingerprint, Needs, Spectrum};
use etendue_geometry::Surface;
use etendue_texture::ScalarTex;

use crate::{Material, parameter};

/// Clear glass, water: the smooth boundary of a transparent body. The body is on the back of the surface.
#[derive(Clone, Copy, Debug)]
pub struct Glass {
    /// Refractive index of the inside over that of the outside.
    pub eta: f32,
    /// Absorption inside, m⁻¹.
    pub absorption: Spectrum,
}

impl Glass {
    /// A boundary; 1.5 is window glass, 1.33 water.
    pub fn new(eta: f32) -> Self {
        Self { eta, absorption: Spectrum::BLACK }
    }
}

impl Material for Glass {
    #[inline]
    fn bsdf<'a>(&'a self, _at: &Surface) -> BsdfAt<'a> {
        BsdfAt::SmoothDielectric(SmoothDielectric::new(self.eta))
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn absorption(&self) -> Option<Spectrum> {
        Some(parameter::absorption(self.absorption))
    }

    fn needs(&self) -> Needs {
        Needs::DELTA | Needs::TRANSMISSION | parameter::absorption_needs(self.absorption())
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("glass");
        f.f32(self.eta);
        f.floats(&self.absorption.to_array());
    }
}

/// Frosted glass: the rough boundary of a transparent body. The body is on the back of the surface.
#[derive(Clone, Debug)]
pub struct RoughGlass {
    /// Refractive index of the inside over that of the outside.
    pub eta: f32,
    /// Roughness in `[0, 1]`; the microfacets' alpha is its square.
    pub roughness: ScalarTex,
    /// Shadowing between microfacets.
    pub masking: Masking,
    /// Absorption inside, m⁻¹.
    pub absorption: Spectrum,
}

impl RoughGlass {
    /// A boundary with height-correlated masking.
    pub fn new(eta: f32, roughness: impl Into<ScalarTex>) -> Self {
        Self { eta, roughness: roughness.into(), masking: Masking::default(), absorption: Spectrum::BLACK }
    }
}

impl Material for RoughGlass {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        let ggx = Ggx::from_roughness(parameter::scalar(&self.roughness, at));
        BsdfAt::RoughDielectric(RoughDielectric {
            ggx,
            masking: self.masking,
            ..RoughDielectric::new(0.0, self.eta)
        })
    }

    fn is_delta(&self) -> bool {
        Ggx::from_roughness(self.roughness.max()).is_smooth()
    }

    fn absorption(&self) -> Option<Spectrum> {
        Some(parameter::absorption(self.absorption))
    }

    fn needs(&self) -> Needs {
        let mut needs = Needs::TRANSMISSION | parameter::scalar_needs(&self.roughness);
        // A weak interface is a delta at any roughness; which, the BSDF decides.
        let smooth_somewhere = Ggx::from_roughness(self.roughness.min()).is_smooth();
        let strong = (self.eta - 1.0).abs() > 0.1;
        needs.set(Needs::DELTA, smooth_somewhere || !strong);
        needs | parameter::absorption_needs(self.absorption())
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("rough glass");
        f.f32(self.eta);
        f.u64(self.masking as u64);
        f.floats(&self.absorption.to_array());
        self.roughness.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.roughness.bytes()
    }
}
