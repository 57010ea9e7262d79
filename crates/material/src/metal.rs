use etendue_bsdf::{BsdfAt, Conductor, Ggx, Masking, MetalFresnel};
use etendue_core::{Fingerprint, Needs, Spectrum};
use etendue_geometry::Surface;
use etendue_texture::{ScalarTex, Tex, Texture};

use crate::{Material, parameter};

/// Where a metal's colour comes from.
#[derive(Clone, Debug)]
pub enum MetalColor {
    /// Complex refractive index `eta + i k` per channel.
    Index {
        /// Real part.
        eta: Spectrum,
        /// Imaginary part.
        k: Spectrum,
    },
    /// Reflectance at normal incidence, by Schlick's approximation elsewhere; brought into `[0, 1]` at each point.
    Schlick(Tex),
}

/// A metal of any roughness, two-sided.
#[derive(Clone, Debug)]
pub struct Metal {
    /// Colour.
    pub color: MetalColor,
    /// Roughness in `[0, 1]`; the microfacets' alpha is its square. With `roughness_across`, that along the tangent.
    pub roughness: ScalarTex,
    /// Roughness across the tangent, for brushed metal; `None` where it is the same.
    pub roughness_across: Option<ScalarTex>,
    /// Shadowing between microfacets.
    pub masking: Masking,
    /// Whether the mesh's vertex colours multiply a Schlick colour.
    pub vertex_color: bool,
}

impl Metal {
    /// Isotropic, with height-correlated masking.
    pub fn new(color: MetalColor, roughness: impl Into<ScalarTex>) -> Self {
        Self {
            color,
            roughness: roughness.into(),
            roughness_across: None,
            masking: Masking::default(),
            vertex_color: false,
        }
    }

    /// By the reflectance at normal incidence.
    pub fn schlick(f0: impl Into<Tex>, roughness: impl Into<ScalarTex>) -> Self {
        Self::new(MetalColor::Schlick(f0.into()), roughness)
    }

    fn like(metal: Conductor, roughness: impl Into<ScalarTex>) -> Self {
        let color = match metal.fresnel {
            MetalFresnel::Index { eta, k } => MetalColor::Index { eta, k },
            MetalFresnel::Schlick { f0 } => MetalColor::Schlick(f0.into()),
        };
        Self::new(color, roughness)
    }

    /// Gold; see [`Conductor::gold`].
    pub fn gold(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::gold(0.0), roughness)
    }

    /// Silver; see [`Conductor::silver`].
    pub fn silver(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::silver(0.0), roughness)
    }

    /// Copper; see [`Conductor::copper`].
    pub fn copper(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::copper(0.0), roughness)
    }

    /// Aluminium; see [`Conductor::aluminium`].
    pub fn aluminium(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::aluminium(0.0), roughness)
    }

    /// Chromium; see [`Conductor::chromium`].
    pub fn chromium(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::chromium(0.0), roughness)
    }

    /// Iron; see [`Conductor::iron`].
    pub fn iron(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::iron(0.0), roughness)
    }

    /// Nickel; see [`Conductor::nickel`].
    pub fn nickel(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::nickel(0.0), roughness)
    }

    /// Titanium; see [`Conductor::titanium`].
    pub fn titanium(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::titanium(0.0), roughness)
    }

    /// Platinum; see [`Conductor::platinum`].
    pub fn platinum(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::platinum(0.0), roughness)
    }

    /// Tungsten; see [`Conductor::tungsten`].
    pub fn tungsten(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::tungsten(0.0), roughness)
    }

    /// Brass; see [`Conductor::brass`].
    pub fn brass(roughness: impl Into<ScalarTex>) -> Self {
        Self::like(Conductor::brass(0.0), roughness)
    }
}

fn alpha(roughness: f32) -> f32 {
    Ggx::from_roughness(roughness).alpha_x()
}

impl Material for Metal {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        let along = parameter::scalar(&self.roughness, at);
        let ggx = match &self.roughness_across {
            None => Ggx::from_roughness(along),
            Some(across) => Ggx::anisotropic(alpha(along), alpha(parameter::scalar(across, at))),
        };
        let fresnel = match &self.color {
            MetalColor::Index { eta, k } => MetalFresnel::Index { eta: *eta, k: *k },
            MetalColor::Schlick(f0) => {
                MetalFresnel::Schlick { f0: parameter::reflectance(f0, self.vertex_color, at) }
            }
        };
        BsdfAt::Conductor(Conductor { ggx, fresnel, masking: self.masking })
    }

    fn is_delta(&self) -> bool {
        let smooth = |r: &ScalarTex| Ggx::from_roughness(r.max()).is_smooth();
        smooth(&self.roughness) && self.roughness_across.as_ref().is_none_or(smooth)
    }

    fn needs(&self) -> Needs {
        let mut needs = parameter::scalar_needs(&self.roughness);
        let smooth = |r: &ScalarTex| Ggx::from_roughness(r.min()).is_smooth();
        let mut delta = smooth(&self.roughness);
        if let Some(across) = &self.roughness_across {
            needs |= Needs::TANGENTS | parameter::scalar_needs(across);
            delta &= smooth(across);
        }
        needs.set(Needs::DELTA, delta);
        match &self.color {
            MetalColor::Index { .. } => needs,
            MetalColor::Schlick(f0) => needs | parameter::color_needs(f0, self.vertex_color),
        }
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("metal");
        f.u64(self.masking as u64);
        match &self.color {
            MetalColor::Index { eta, k } => {
                f.floats(&eta.to_array());
                f.floats(&k.to_array());
            }
            MetalColor::Schlick(f0) => {
                f.tag("schlick");
                f.u64(u64::from(self.vertex_color));
                f0.fingerprint(f);
            }
        }
        self.roughness.fingerprint(f);
        f.u64(u64::from(self.roughness_across.is_some()));
        if let Some(across) = &self.roughness_across {
            across.fingerprint(f);
        }
    }

    fn bytes(&self) -> usize {
        let color = match &self.color {
            MetalColor::Index { .. } => 0,
            MetalColor::Schlick(f0) => f0.bytes(),
        };
        color + self.roughness.bytes() + self.roughness_across.as_ref().map_or(0, ScalarTex::bytes)
    }
}
