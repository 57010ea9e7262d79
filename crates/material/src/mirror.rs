use etendue_bsdf::{BsdfAt, Mirror};
use etendue_core::{Fingerprint, Needs};
use etendue_geometry::Surface;
use etendue_texture::{Tex, Texture};

use crate::{Material, parameter};

/// A perfect mirror, two-sided.
#[derive(Clone, Debug)]
pub struct MirrorMaterial {
    /// Reflectance, the same at every angle; brought into `[0, 1]` at each point.
    pub reflectance: Tex,
}

impl MirrorMaterial {
    /// A mirror.
    pub fn new(reflectance: impl Into<Tex>) -> Self {
        Self { reflectance: reflectance.into() }
    }
}

impl Material for MirrorMaterial {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        BsdfAt::Mirror(Mirror { reflectance: parameter::reflectance(&self.reflectance, false, at) })
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::DELTA | parameter::color_needs(&self.reflectance, false)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("mirror");
        self.reflectance.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.reflectance.bytes()
    }
}
