use etendue_bsdf::{self as bsdf, BsdfAt};
use etendue_core::{Fingerprint, Needs};
use etendue_geometry::Surface;
use etendue_texture::{ScalarTex, Tex, Texture};

use crate::{Material, parameter};

/// A rough matte surface, two-sided: clay, plaster, cloth, the moon; see [`bsdf::OrenNayar`].
#[derive(Clone, Debug)]
pub struct OrenNayar {
    /// Reflectance of one facet; brought into `[0, 1]` at each point. With roughness a colour gets more saturated.
    pub rho: Tex,
    /// Roughness; brought into `[0, 1]` at each point.
    pub roughness: ScalarTex,
    /// Whether the mesh's vertex colours multiply `rho`.
    pub vertex_color: bool,
}

impl OrenNayar {
    /// Matte, of the given colour or texture and roughness.
    pub fn new(rho: impl Into<Tex>, roughness: impl Into<ScalarTex>) -> Self {
        Self { rho: rho.into(), roughness: roughness.into(), vertex_color: false }
    }
}

impl Material for OrenNayar {
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        let rho = parameter::reflectance(&self.rho, self.vertex_color, at);
        BsdfAt::OrenNayar(bsdf::OrenNayar::new(rho, parameter::scalar(&self.roughness, at)))
    }

    fn needs(&self) -> Needs {
        parameter::color_needs(&self.rho, self.vertex_color) | parameter::scalar_needs(&self.roughness)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("oren-nayar");
        f.u64(u64::from(self.vertex_color));
        self.rho.fingerprint(f);
        self.roughness.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.rho.bytes() + self.roughness.bytes()
    }
}
