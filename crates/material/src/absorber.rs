use etendue_bsdf::{Black, BsdfAt};
use etendue_core::Fingerprint;
use etendue_geometry::Surface;

use crate::Material;

/// Reflects nothing: what a pure emitter is made of.
#[derive(Clone, Copy, Debug, Default)]
pub struct Absorber;

impl Material for Absorber {
    fn bsdf<'a>(&'a self, _at: &Surface) -> BsdfAt<'a> {
        BsdfAt::Black(Black)
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("absorber");
    }
}
