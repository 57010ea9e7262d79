use etendue_bsdf::BsdfAt;
use etendue_core::{Fingerprint, Frame, Needs, Spectrum, Vec3A};
use etendue_geometry::Surface;
use etendue_texture::{ImageUse, TexPoint, Texture};

use crate::{AlphaPoint, Material, MediumId};

/// Any material with a normal map as glTF 2.0 means it: the shading normal is `(2 rgb − 1) · (scale, scale, 1)`, with
/// `x` along the tangent, `y` along the bitangent (upward in the image) and `z` along the interpolated normal.
///
/// The image holds numbers, not colours: its encoding has to be linear, and its colour factor is not applied. A texel
/// of exactly (0.5, 0.5, 1) changes nothing, to the last bit; eight bits have no such texel, (128, 128, 255) leans by
/// 0.3°. Where the mapped normal would point into the surface, the interpolated one stays.
#[derive(Clone, Debug)]
pub struct NormalMapped<M> {
    /// What the surface is made of. An `Arc<dyn Material>` serves too.
    pub base: M,
    /// The map.
    pub map: ImageUse,
    /// Factor on the slopes.
    pub scale: f32,
}

impl<M: Material> NormalMapped<M> {
    /// With the slopes that the map has.
    pub fn new(base: M, map: ImageUse) -> Self {
        Self { base, map, scale: 1.0 }
    }
}

impl<M: Material> Material for NormalMapped<M> {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        self.base.bsdf(at)
    }

    fn shading_frame(&self, at: &Surface) -> Frame {
        let point = TexPoint::of(at);
        point.count();
        let texel = self.map.image.eval4(self.map.uv(&point));
        let slope = |c: f32| (2.0 * c - 1.0) * self.scale;
        at.mapped(Vec3A::new(slope(texel.x), slope(texel.y), 2.0 * texel.z - 1.0))
    }

    fn opacity(&self, at: &AlphaPoint<'_>) -> f32 {
        self.base.opacity(at)
    }

    fn interior(&self) -> Option<MediumId> {
        self.base.interior()
    }

    fn absorption(&self) -> Option<Spectrum> {
        self.base.absorption()
    }

    fn is_delta(&self) -> bool {
        self.base.is_delta()
    }

    fn needs(&self) -> Needs {
        self.base.needs() | Needs::NORMAL_MAPS | Needs::TANGENTS | Needs::TEXTURES
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("normal map");
        f.f32(self.scale);
        self.map.fingerprint(f);
        self.base.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.base.bytes() + self.map.image.bytes()
    }
}
