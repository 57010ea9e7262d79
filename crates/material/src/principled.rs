use etendue_bsdf::{self as bsdf, BsdfAt, Ggx, Meaning};
use etendue_core::{Fingerprint, Needs, Spectrum};
use etendue_geometry::Surface;
use etendue_texture::{ScalarTex, Tex, TexPoint, Texture};

use crate::{Material, parameter};

/// glTF 2.0's metallic-roughness material with KHR_materials_specular, _ior, _transmission and _volume; see
/// [`bsdf::Principled`] for what the numbers mean.
///
/// Numbers and colours are brought into `[0, 1]` at each point, but for `specular_color`, which may be more.
#[derive(Clone, Debug)]
pub struct Principled {
    /// Reflectance of the base, or of the metal at normal incidence; tint of what gets through.
    pub base_color: Tex,
    /// Whether the mesh's vertex colours multiply the base colour.
    pub vertex_color: bool,
    /// Share of metal.
    pub metallic: ScalarTex,
    /// Roughness; the microfacets' alpha is its square.
    pub roughness: ScalarTex,
    /// Refractive index of the inside over that of the outside; 0 makes the dielectric reflect all at normal incidence.
    pub ior: f32,
    /// Strength of the dielectric's reflection.
    pub specular: ScalarTex,
    /// Colour of the dielectric's reflection at normal incidence.
    pub specular_color: Tex,
    /// Share of the light entering the dielectric that goes through.
    pub transmission: ScalarTex,
    /// Whether it is a wall without thickness rather than the boundary of a body.
    pub thin: bool,
    /// Absorption inside of the body, m⁻¹.
    pub absorption: Spectrum,
    /// By which formulas.
    pub meaning: Meaning,
}

impl Principled {
    /// Opaque, of ior 1.5, with full specular reflection, by the energy-preserving formulas.
    pub fn new(
        base_color: impl Into<Tex>,
        metallic: impl Into<ScalarTex>,
        roughness: impl Into<ScalarTex>,
    ) -> Self {
        Self {
            base_color: base_color.into(),
            vertex_color: false,
            metallic: metallic.into(),
            roughness: roughness.into(),
            ior: 1.5,
            specular: 1.0.into(),
            specular_color: Spectrum::ONE.into(),
            transmission: 0.0.into(),
            thin: false,
            absorption: Spectrum::BLACK,
            meaning: Meaning::default(),
        }
    }

    fn scalars(&self) -> [&ScalarTex; 4] {
        [&self.metallic, &self.roughness, &self.specular, &self.transmission]
    }

    /// Whether some point may let light through.
    fn transmits(&self) -> bool {
        self.ior > 0.0 && self.transmission.max() > 0.0 && self.metallic.min() < 1.0
    }

    /// Whether some point may have a base or a dielectric's reflection.
    fn has_opaque_dielectric(&self) -> bool {
        self.metallic.min() < 1.0 && (self.transmission.min() < 1.0 || !self.transmits())
    }
}

/// A number in `[0, 1]`; NaN is 0.
#[inline]
fn share(tex: &ScalarTex, at: &Surface) -> f32 {
    let v = parameter::scalar(tex, at);
    if v > 0.0 { v.clamp(0.0, 1.0) } else { 0.0 }
}

impl Material for Principled {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        let specular_color = self.specular_color.eval(&TexPoint::of(at));
        BsdfAt::Principled(bsdf::Principled {
            base_color: parameter::reflectance(&self.base_color, self.vertex_color, at),
            specular_color: specular_color.map(|c| if c > 0.0 { c.clamp(0.0, 1e6) } else { 0.0 }),
            ggx: Ggx::from_roughness(parameter::scalar(&self.roughness, at)),
            metallic: share(&self.metallic, at),
            ior: self.ior,
            specular: share(&self.specular, at),
            transmission: share(&self.transmission, at),
            thin: self.thin,
            meaning: self.meaning,
        })
    }

    fn is_delta(&self) -> bool {
        let smooth = Ggx::from_roughness(self.roughness.max()).is_smooth();
        smooth && !self.has_opaque_dielectric()
    }

    fn absorption(&self) -> Option<Spectrum> {
        (!self.thin && self.transmits()).then(|| parameter::absorption(self.absorption))
    }

    fn needs(&self) -> Needs {
        let mut needs = parameter::color_needs(&self.base_color, self.vertex_color)
            | parameter::color_needs(&self.specular_color, false);
        for tex in self.scalars() {
            needs |= parameter::scalar_needs(tex);
        }
        let smooth_somewhere = Ggx::from_roughness(self.roughness.min()).is_smooth();
        // Appendix B knows no smooth surface that is not all metal.
        let mirrors = match self.meaning {
            Meaning::GltfB => self.metallic.max() >= 1.0,
            Meaning::EnergyPreserving => {
                self.metallic.max() > 0.0 || (self.specular.max() > 0.0 && self.has_opaque_dielectric())
            }
        };
        // A weak interface is a delta at any roughness; which, the BSDF decides.
        let weak = !self.thin && (self.ior - 1.0).abs() <= 0.1;
        let passes = self.transmits() && (smooth_somewhere || weak);
        needs.set(Needs::DELTA, (smooth_somewhere && mirrors) || passes);
        needs.set(Needs::TRANSMISSION, self.transmits());
        needs | parameter::absorption_needs(self.absorption())
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("principled");
        f.u64(u64::from(self.vertex_color) | u64::from(self.thin) << 1 | (self.meaning as u64) << 2);
        f.f32(self.ior);
        f.floats(&self.absorption.to_array());
        self.base_color.fingerprint(f);
        self.specular_color.fingerprint(f);
        for tex in self.scalars() {
            tex.fingerprint(f);
        }
    }

    fn bytes(&self) -> usize {
        let scalars: usize = self.scalars().iter().map(|t| t.bytes()).sum();
        self.base_color.bytes() + self.specular_color.bytes() + scalars
    }
}
