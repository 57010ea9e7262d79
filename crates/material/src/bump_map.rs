use etendue_bsdf::BsdfAt;
use etendue_core::{Fingerprint, Frame, Needs, Spectrum, Vec2, Vec3A};
use etendue_geometry::Surface;
use etendue_texture::{ScalarTex, TexPoint};

use crate::{AlphaPoint, Material, MediumId};

/// Any material whose shading normal is that of the surface raised by a height texture along its normal (Blinn 1978,
/// "Simulation of wrinkled surfaces"): `(∂p/∂u + h_u n) × (∂p/∂v + h_v n)`, heights taken as small. The surface itself
/// stays where it is.
///
/// Slopes are forward differences over `step` along the first set of texture coordinates. So the texture may be an image
/// by that set or a pattern, on the surface or in the world; one by the second set does not change along the first and
/// counts as flat, and so does a surface without texture coordinates. A height that is the same everywhere changes nothing,
/// to the last bit. Where the raised normal would point into the surface, the interpolated one stays, as with
/// [`NormalMapped`](crate::NormalMapped). A base's own normal map is not used beside it.
#[derive(Clone, Debug)]
pub struct BumpMapped<M> {
    /// What the surface is made of. An `Arc<dyn Material>` serves too.
    pub base: M,
    /// Height, outward from the front.
    pub height: ScalarTex,
    /// Metres for a height of 1; a negative one turns ridges into grooves.
    pub scale: f32,
    /// How far along u and along v the second and third height are looked up, in texture coordinates, not 0. Half a texel
    /// is right for an image.
    pub step: Vec2,
}

impl<M: Material> BumpMapped<M> {
    /// Raised by `scale` metres for a height of 1. The step is half a texel of an image under its map of coordinates, and
    /// 1/1024 for other textures.
    pub fn new(base: M, height: impl Into<ScalarTex>, scale: f32) -> Self {
        let height = height.into();
        let step = match &height {
            ScalarTex::Image { image, .. } => {
                let t = image.transform.unwrap_or_default();
                // Texels that one unit of u, or of v, goes across.
                let size = Vec2::new(image.image.width() as f32, image.image.height() as f32);
                let across = |u: f32, v: f32| (u * size.x).abs() + (v * size.y).abs();
                Vec2::new(half_texel(across(t.u_row.x, t.v_row.x)), half_texel(across(t.u_row.y, t.v_row.y)))
            }
            _ => Vec2::splat(STEP),
        };
        Self { base, height, scale, step }
    }

    /// The slopes of the heights in metres along u and along v.
    fn slopes(&self, at: &Surface) -> Vec2 {
        let here = TexPoint::of(at);
        let base = self.height.eval(&here);
        let along = |step: Vec2, dp: Vec3A| {
            let uv = at.uv[0] + step;
            // By what the coordinate really changed, rounding included.
            let moved = uv - at.uv[0];
            let length = moved.x + moved.y;
            let there = TexPoint { uv: [uv, at.uv[1]], p: at.p + dp * length, ..here };
            (self.height.eval(&there) - base) / length * self.scale
        };
        Vec2::new(along(Vec2::new(self.step.x, 0.0), at.dpdu), along(Vec2::new(0.0, self.step.y), at.dpdv))
    }
}

/// The step where no image gives one.
const STEP: f32 = 1.0 / 1024.0;

fn half_texel(across: f32) -> f32 {
    if across > 0.0 && across.is_finite() { 0.5 / across } else { STEP }
}

impl<M: Material> Material for BumpMapped<M> {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        self.base.bsdf(at)
    }

    fn shading_frame(&self, at: &Surface) -> Frame {
        let n = at.shading.z;
        // The plane through the surface as the shading normal has it: (∂p/∂u × ∂p/∂v)·n.
        let (across_u, across_v) = (at.dpdv.cross(n), n.cross(at.dpdu));
        let area = at.dpdu.dot(across_u);
        if self.height.is_constant() || area == 0.0 {
            return at.shading;
        }
        let slopes = self.slopes(at);
        // The cross product, divided by that: the normal less the gradient on the surface (Mikkelsen 2010).
        let gradient = (across_u * slopes.x + across_v * slopes.y) / area;
        at.mapped(Vec3A::new(-gradient.dot(at.shading.x), -gradient.dot(at.up_in_texture()), 1.0))
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
        if self.height.is_constant() {
            return self.base.needs();
        }
        self.base.needs() | Needs::NORMAL_MAPS | Needs::TANGENTS | Needs::TEXTURES
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("bump map");
        f.floats(&[self.scale, self.step.x, self.step.y]);
        self.height.fingerprint(f);
        self.base.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.base.bytes() + self.height.bytes()
    }
}
