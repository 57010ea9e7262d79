use etendue_bsdf::{BsdfAt, Lambert};
use etendue_core::{Fingerprint, Needs};
use etendue_geometry::Surface;
use etendue_texture::{Tex, Texture};

use crate::{Material, parameter};

/// A matte surface, two-sided.
#[derive(Clone, Debug)]
pub struct Diffuse {
    /// Reflectance; brought into `[0, 1]` at each point.
    pub albedo: Tex,
    /// Whether the mesh's vertex colours multiply the albedo.
    pub vertex_color: bool,
}

impl Diffuse {
    /// Matte, of the given colour or texture.
    pub fn new(albedo: impl Into<Tex>) -> Self {
        Self { albedo: albedo.into(), vertex_color: false }
    }
}

impl Material for Diffuse {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        BsdfAt::Lambert(Lambert { albedo: parameter::reflectance(&self.albedo, self.vertex_color, at) })
    }

    fn needs(&self) -> Needs {
        parameter::color_needs(&self.albedo, self.vertex_color)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("diffuse");
        f.u64(u64::from(self.vertex_color));
        self.albedo.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.albedo.bytes()
    }
}
