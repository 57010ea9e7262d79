use etendue_bsdf::{Bsdf, BsdfAt, Lobes};
use etendue_core::{Frame, Needs, Spectrum, Vec3A};
use etendue_geometry::Surface;
use etendue_light::{LitPoint, Sides};

use crate::{Context, Vertex};

/// The BSDF of a surface; `None` for one of another scene. A normal map turns the surface's shading frame.
pub(crate) fn bsdf_at<'a>(cx: &Context<'a>, surface: &mut Surface) -> Option<BsdfAt<'a>> {
    let material = cx.scene.material(surface)?;
    if cx.scene.needs().contains(Needs::NORMAL_MAPS) {
        surface.shading = material.shading_frame(surface);
    }
    let bsdf = material.bsdf(surface);
    cx.count(|c| c.texture_fetches += u64::from(surface.fetches.get()));
    Some(bsdf)
}

/// A surface as light scatters there on its way out along `wo`. It only borrows the large parts: moved about, they would
/// cost a path a tenth of its instructions.
///
/// Two rules make shading normals harmless. A ray that comes from behind the shading normal sees the geometric one:
/// nothing turns black, and no direction carries more than it should. And shading and geometric normal must agree about
/// which side a direction is on, or light would leak.
pub(crate) struct Shaded<'a> {
    pub(crate) surface: &'a Surface,
    pub(crate) wo: Vec3A,
    /// The frame that the BSDF lives in.
    pub(crate) frame: Frame,
    pub(crate) bsdf: &'a BsdfAt<'a>,
}

impl<'a> Shaded<'a> {
    #[inline(always)]
    pub(crate) fn new(surface: &'a Surface, bsdf: &'a BsdfAt<'a>, wo: Vec3A) -> Self {
        let toward = wo.dot(surface.shading.z);
        let frame = if (toward > 0.0) == (wo.dot(surface.ng) >= 0.0) && toward != 0.0 {
            surface.shading
        } else {
            Frame::from_normal(surface.ng)
        };
        Self { surface, wo, frame, bsdf }
    }

    /// What a recorder hears of it.
    #[inline(always)]
    pub(crate) fn vertex(&'a self, depth: u32, distance: f32, beta: Spectrum) -> Vertex<'a> {
        let Self { surface, wo, frame, bsdf } = self;
        Vertex { depth, surface, frame: *frame, wo: *wo, distance, bsdf, beta }
    }

    /// The point as it asks for light.
    #[inline(always)]
    pub(crate) fn lit(&self, lobes: Lobes) -> LitPoint {
        let side = if self.wo.dot(self.surface.ng) >= 0.0 { 1.0 } else { -1.0 };
        LitPoint {
            p: self.surface.p,
            p_err: self.surface.p_err,
            ng: self.surface.ng * side,
            ns: self.frame.z * side,
            sides: if lobes.contains(Lobes::TRANSMISSION) { Sides::Both } else { Sides::Same },
            time: self.surface.time,
        }
    }

    /// Whether both normals put a direction on the same side; light from any other does not count.
    #[inline(always)]
    pub(crate) fn agrees(&self, wi: Vec3A) -> bool {
        wi.dot(self.frame.z) * wi.dot(self.surface.ng) > 0.0
    }

    #[inline(always)]
    pub(crate) fn lobes(&self) -> Lobes {
        self.bsdf.lobes()
    }
}
