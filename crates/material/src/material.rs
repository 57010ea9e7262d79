use std::cell::Cell;
use std::sync::Arc;

use etendue_bsdf::BsdfAt;
use etendue_core::{Fingerprint, Frame, Needs, Spectrum, Vec2, Vec3A, Vec4};
use etendue_geometry::Surface;

/// A medium filling the inside of a closed surface. No media exist yet; the type is the door for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MediumId(pub u32);

/// The little that a cut-out needs to know of a candidate hit.
#[derive(Clone, Copy, Debug)]
pub struct AlphaPoint<'a> {
    /// Texture coordinates, two sets.
    pub uv: [Vec2; 2],
    /// Position, world space.
    pub p: Vec3A,
    /// Vertex colour and alpha, linear.
    pub color: Vec4,
    /// Look-ups made, for the report.
    pub fetches: &'a Cell<u32>,
}

/// How a surface scatters: textures and constants that become a BSDF at a point. Lives as long as the scene.
pub trait Material: Send + Sync {
    /// The BSDF at a point.
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a>;

    /// The fraction of rays that the surface stops at all, in `[0, 1]`. Asked only if [`Material::needs`] says
    /// [`Needs::CUTOUTS`].
    fn opacity(&self, at: &AlphaPoint<'_>) -> f32 {
        let _ = at;
        1.0
    }

    /// The frame that the BSDF lives in: `at.shading`, unless a texture turns the normal, which has to stay on the side
    /// of `at.ng`. Asked only if [`Material::needs`] says [`Needs::NORMAL_MAPS`].
    fn shading_frame(&self, at: &Surface) -> Frame {
        at.shading
    }

    /// What the body behind the surface absorbs of light on its way, m⁻¹ per channel (Beer–Lambert), each channel finite
    /// or infinite but not negative; black for clear glass. `None` where there is no body that transmitted light enters:
    /// an opaque surface, a wall without thickness. Asked only if some material [`needs`](Material::needs)
    /// [`Needs::ABSORPTION`].
    fn absorption(&self) -> Option<Spectrum> {
        None
    }

    /// The medium inside.
    fn interior(&self) -> Option<MediumId> {
        None
    }

    /// Whether every lobe of every point is delta, so that sampling lights toward it is pointless.
    fn is_delta(&self) -> bool {
        false
    }

    /// What the material asks of the renderer.
    fn needs(&self) -> Needs {
        Needs::empty()
    }

    /// What decides the material, for comparing scenes.
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.opaque();
    }

    /// Bytes held by textures, for the memory report.
    fn bytes(&self) -> usize {
        0
    }
}

impl<M: Material + ?Sized> Material for Arc<M> {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        (**self).bsdf(at)
    }

    fn opacity(&self, at: &AlphaPoint<'_>) -> f32 {
        (**self).opacity(at)
    }

    fn shading_frame(&self, at: &Surface) -> Frame {
        (**self).shading_frame(at)
    }

    fn absorption(&self) -> Option<Spectrum> {
        (**self).absorption()
    }

    fn interior(&self) -> Option<MediumId> {
        (**self).interior()
    }

    fn is_delta(&self) -> bool {
        (**self).is_delta()
    }

    fn needs(&self) -> Needs {
        (**self).needs()
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        (**self).fingerprint(f);
    }

    fn bytes(&self) -> usize {
        (**self).bytes()
    }
}
