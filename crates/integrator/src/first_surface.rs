use etendue_bsdf::Bsdf;
use etendue_camera::CameraSample;
use etendue_core::{Fingerprint, Spectrum, Vec3A};
use etendue_sampling::Sampler;

use crate::arrival::{Arrival, Cone, follow};
use crate::integrator::calls;
use crate::shaded::{Shaded, bsdf_at};
use crate::{Context, Integrator, Recorder, Sample};

/// What [`FirstSurface`] shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Show {
    /// The shading normal in world space, as the colour (n + 1) / 2.
    #[default]
    Normal,
    /// The geometric normal of the front side, likewise.
    GeometricNormal,
    /// Distance along the ray, metres, in all channels.
    Depth,
    /// A colour for every instance and geometry.
    Ids,
    /// A colour for every triangle.
    Triangles,
    /// Albedo toward the camera.
    Albedo,
    /// The first set of texture coordinates, in red and green.
    Uv,
}

/// The first surface that a ray meets, without any light. Not radiance, and named as that; background is black.
///
/// The film's own planes ([`Planes`](etendue_camera::Planes)) have most of it beside any other picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FirstSurface {
    /// What of it is shown.
    pub show: Show,
}

impl FirstSurface {
    fn look<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        s: &CameraSample,
        u: S,
        rec: &mut R,
    ) -> Sample {
        let (mut out, mut none) = (Sample::default(), Sample::default());
        let cone = Cone { length: 0.0, spread: s.spread };
        let hit = follow(cx, &s.ray, 0, cone, Spectrum::BLACK, &u, &mut none, rec);
        let Some(Arrival { mut surface, distance }) = hit else { return out };
        out.alpha = 1.0;
        let wo = -s.ray.d;
        let Some(bsdf) = bsdf_at(cx, &mut surface) else { return out };
        let here = Shaded::new(&surface, &bsdf, wo);
        rec.vertex(&here.vertex(0, distance, Spectrum::ONE));
        let at = here.surface;
        out.l = match self.show {
            Show::Normal => of_normal(at.shading.z),
            Show::GeometricNormal => of_normal(at.ng),
            Show::Depth => Spectrum::gray(distance),
            Show::Ids => of_ids([at.inst, at.geom, 0]),
            Show::Triangles => of_ids([at.inst, at.geom, at.prim.wrapping_add(1)]),
            Show::Albedo => here.bsdf.albedo(here.frame.to_local(wo)),
            Show::Uv => Spectrum::rgb(at.uv[0].x, at.uv[0].y, 0.0),
        };
        out
    }
}

fn of_normal(n: Vec3A) -> Spectrum {
    Spectrum::rgb(0.5 + 0.5 * n.x, 0.5 + 0.5 * n.y, 0.5 + 0.5 * n.z)
}

/// A colour that looks unlike those of the neighbouring numbers, each channel between 1/16 and 1.
fn of_ids(ids: [u32; 3]) -> Spectrum {
    let hash = ids.iter().fold(0x9e37_79b9u32, |h, &id| {
        let h = (h ^ id).wrapping_mul(0x85eb_ca6b);
        (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35)
    });
    let channel = |shift: u32| ((hash >> shift & 15) + 1) as f32 / 16.0;
    Spectrum::rgb(channel(16), channel(20), channel(24))
}

impl<S: Sampler> Integrator<S> for FirstSurface {
    calls!(look);

    fn bias(&self) -> Vec<String> {
        vec![format!("{:?} of the first surface: not radiance", self.show)]
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("first surface");
        f.tag(&format!("{:?}", self.show));
    }
}
