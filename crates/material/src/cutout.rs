use etendue_bsdf::BsdfAt;
use etendue_core::{Fingerprint, Frame, Needs, Spectrum};
use etendue_geometry::Surface;
use etendue_texture::{ScalarTex, TexPoint};

use crate::{AlphaPoint, Material, MediumId, parameter};

/// Any material with holes: rays pass it as if it were not there, by its opacity.
#[derive(Clone, Debug)]
pub struct Cutout<M> {
    /// What is there where it is solid. An `Arc<dyn Material>` serves too.
    pub base: M,
    /// Fraction of rays stopped; brought into `[0, 1]` at each point.
    pub opacity: ScalarTex,
    /// With a threshold, opacity from it on is 1 and below it 0: sharp edges (glTF's `MASK`).
    pub threshold: Option<f32>,
    /// Whether the mesh's vertex alpha multiplies the opacity.
    pub vertex_alpha: bool,
}

impl<M: Material> Cutout<M> {
    /// A material of varying opacity.
    pub fn new(base: M, opacity: impl Into<ScalarTex>) -> Self {
        Self { base, opacity: opacity.into(), threshold: None, vertex_alpha: false }
    }

    /// The same with sharp edges.
    #[must_use]
    pub fn with_threshold(self, threshold: f32) -> Self {
        Self { threshold: Some(threshold), ..self }
    }

    fn has_holes(&self) -> bool {
        self.vertex_alpha || self.solid(self.opacity.min()) < 1.0
    }

    fn solid(&self, alpha: f32) -> f32 {
        match self.threshold {
            Some(threshold) => f32::from(u8::from(alpha >= threshold)),
            None if alpha > 0.0 => alpha.clamp(0.0, 1.0),
            None => 0.0,
        }
    }
}

impl<M: Material> Material for Cutout<M> {
    #[inline]
    fn bsdf<'a>(&'a self, at: &Surface) -> BsdfAt<'a> {
        self.base.bsdf(at)
    }

    fn opacity(&self, at: &AlphaPoint<'_>) -> f32 {
        let alpha = self.opacity.eval(&TexPoint { uv: at.uv, p: at.p, fetches: at.fetches });
        self.solid(if self.vertex_alpha { alpha * at.color.w } else { alpha }) * self.base.opacity(at)
    }

    fn shading_frame(&self, at: &Surface) -> Frame {
        self.base.shading_frame(at)
    }

    fn absorption(&self) -> Option<Spectrum> {
        // A ray through a hole would come or go unseen; a body that leaks is none.
        if self.has_holes() { None } else { self.base.absorption() }
    }

    fn interior(&self) -> Option<MediumId> {
        self.base.interior()
    }

    fn is_delta(&self) -> bool {
        self.base.is_delta()
    }

    fn needs(&self) -> Needs {
        let mut needs = self.base.needs();
        // What is solid everywhere has no holes to look for.
        if self.has_holes() {
            needs |= Needs::CUTOUTS | parameter::scalar_needs(&self.opacity);
            needs.set(Needs::VERTEX_COLORS, self.vertex_alpha || needs.contains(Needs::VERTEX_COLORS));
        }
        needs
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("cutout");
        f.u64(u64::from(self.vertex_alpha));
        f.u64(u64::from(self.threshold.is_some()));
        f.f32(self.threshold.unwrap_or(0.0));
        self.opacity.fingerprint(f);
        self.base.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.base.bytes() + self.opacity.bytes()
    }
}
