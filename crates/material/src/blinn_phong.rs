use etendue_bsdf::{self as bsdf, BsdfAt};
use etendue_core::{Fingerprint, Needs};
use etendue_geometry::Surface;
use etendue_texture::{ScalarTex, Tex, Texture};

use crate::{Material, parameter};

/// A matte base under Blinn's lobe around the half vector, two-sided; see [`bsdf::BlinnPhong`].
///
/// For pictures and files that were made with it; [`Metal`](crate::Metal) and [`Principled`](crate::Principled) are nearer
/// to real surfaces.
#[derive(Clone, Debug)]
pub struct BlinnPhong {
    /// Reflectance of the base; brought into `[0, 1]` at each point.
    pub diffuse: Tex,
    /// Reflectance of the lobe at normal incidence; brought into `[0, 1 − diffuse]` at each point.
    pub specular: Tex,
    /// Exponent of the lobe; brought into `[0, 10⁶]` at each point.
    pub exponent: ScalarTex,
    /// Whether the mesh's vertex colours multiply the base's reflectance.
    pub vertex_color: bool,
}

impl BlinnPhong {
    /// A base, a lobe and how narrow it is.
    pub fn new(diffuse: impl Into<Tex>, specular: impl Into<Tex>, exponent: impl Into<ScalarTex>) -> Self {
        Self {
            diffuse: diffuse.into(),
            specular: specular.into(),
            exponent: exponent.into(),
            vertex_color: false,
        }
    }
}

impl Material for BlinnPhong {
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        let diffuse = parameter::reflectance(&self.diffuse, self.vertex_color, at);
        let specular = parameter::reflectance(&self.specular, false, at);
        BsdfAt::BlinnPhong(bsdf::BlinnPhong::new(diffuse, specular, parameter::scalar(&self.exponent, at)))
    }

    fn needs(&self) -> Needs {
        parameter::color_needs(&self.diffuse, self.vertex_color)
            | parameter::color_needs(&self.specular, false)
            | parameter::scalar_needs(&self.exponent)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("blinn-phong");
        f.u64(u64::from(self.vertex_color));
        self.diffuse.fingerprint(f);
        self.specular.fingerprint(f);
        self.exponent.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.diffuse.bytes() + self.specular.bytes() + self.exponent.bytes()
    }
}
