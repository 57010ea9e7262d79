//! A small film and what can be put into it.

use etendue_camera::{FirstHit, Ids, TileRect};
use etendue_core::{Spectrum, UVec2, Vec3A};

pub(crate) const SIZE: UVec2 = UVec2::new(4, 3);

pub(crate) fn pixels(size: UVec2) -> impl Iterator<Item = UVec2> {
    TileRect { lo: UVec2::ZERO, hi: size }.iter()
}

pub(crate) fn first_hit(index: u64) -> FirstHit {
    let k = index as f32;
    let ids = Ids { inst: u32::MAX, geom: index as u32, prim: 7 };
    FirstHit { albedo: Spectrum::rgb(0.1, 0.2, k), normal: Vec3A::new(0.0, 0.6, 0.8), depth: 1.5 + k, ids }
}
