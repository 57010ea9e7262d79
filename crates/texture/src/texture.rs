use std::cell::Cell;

use etendue_core::{Fingerprint, Spectrum, Vec2, Vec3A};

/// Where a texture is looked up.
#[derive(Clone, Copy, Debug)]
pub struct TexPoint<'a> {
    /// Texture coordinates, two sets; `v` grows downward in images read top row first, as glTF means it.
    pub uv: [Vec2; 2],
    /// Position, world space (for solid textures).
    pub p: Vec3A,
    /// Look-ups made, for the report.
    pub fetches: &'a Cell<u32>,
}

impl<'a> TexPoint<'a> {
    /// The point of a surface.
    pub fn of(s: &'a etendue_geometry::Surface) -> Self {
        Self { uv: s.uv, p: s.p, fetches: &s.fetches }
    }

    /// Counts one look-up.
    #[inline]
    pub fn count(&self) {
        self.fetches.set(self.fetches.get().wrapping_add(1));
    }
}

/// A colour that varies over a surface. Values are linear Rec.709; their unit is that of the parameter they feed.
/// A scalar parameter reads one channel.
pub trait Texture: Send + Sync {
    /// The value at a point. Implementations call [`TexPoint::count`].
    fn eval(&self, at: &TexPoint<'_>) -> Spectrum;

    /// The average over the unit square, for powers and previews.
    fn mean(&self) -> Spectrum;

    /// A bound that no value exceeds, per channel, so that a light is never dropped by a coarse power estimate.
    fn max(&self) -> Spectrum;

    /// A bound that no value falls below, per channel; 0 where a texture does not tell.
    fn min(&self) -> Spectrum {
        Spectrum::BLACK
    }

    /// What decides the texture, for comparing scenes.
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.opaque();
    }

    /// Bytes held, for the memory report.
    fn bytes(&self) -> usize {
        0
    }
}
