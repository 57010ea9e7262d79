use std::cell::Cell;
use std::sync::Arc;

use etendue_bvh::{HitFilter, World};
use etendue_core::Ray;
use etendue_geometry::Hit;
use etendue_material::{AlphaPoint, Material};

/// Lets a hit count with the probability of its opacity.
///
/// The decision is a hash of the ray's random bits and the hit's ids against the opacity: a function of the hit
/// alone, so the order in which a hierarchy visits candidates cannot change the picture.
pub(crate) struct CutoutFilter<'a> {
    pub(crate) world: &'a World,
    pub(crate) materials: &'a [Arc<dyn Material>],
    pub(crate) geom_materials: &'a [u32],
    pub(crate) cut: &'a [bool],
    pub(crate) bits: u32,
}

impl HitFilter for CutoutFilter<'_> {
    fn keep(&self, _ray_index: u32, ray: &Ray, hit: &Hit) -> bool {
        if !self.cut.get(hit.geom as usize).is_some_and(|&cut| cut) {
            return true;
        }
        let material =
            self.geom_materials.get(hit.geom as usize).and_then(|&m| self.materials.get(m as usize));
        let Some(material) = material else { return true };
        let fetches = Cell::new(0);
        let a = self.world.alpha_attributes(ray, hit);
        let opacity = material.opacity(&AlphaPoint { uv: a.uv, p: a.p, color: a.color, fetches: &fetches });
        uniform(self.bits, hit) < opacity
    }
}

/// A number in `[0, 1)` for this ray and this surface element (the finaliser of MurmurHash3 over the ids).
fn uniform(bits: u32, hit: &Hit) -> f32 {
    let mut h = bits;
    // A ray can meet one shape twice: the place tells the meetings apart. Of the place only the digits count, not
    // the exponent, so that the scale of the scene decides nothing.
    let digits = |x: f32| x.to_bits() & 0x7f_ffff;
    for word in [hit.inst, hit.geom, hit.prim, digits(hit.uv.x), digits(hit.uv.y)] {
        h = (h ^ word).wrapping_mul(0x9e37_79b1).rotate_left(15);
        h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
        h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
        h ^= h >> 16;
    }
    (h >> 8) as f32 * (1.0 / 16_777_216.0)
}
