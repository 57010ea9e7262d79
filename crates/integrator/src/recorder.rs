use etendue_bsdf::{Bsdf, BsdfAt};
use etendue_camera::{FirstHit, Ids, Planes};
use etendue_core::{Frame, Spectrum, Vec3A};
use etendue_geometry::Surface;
use etendue_light::LightId;

/// A path reached a surface.
pub struct Vertex<'a> {
    /// Scattering events before it.
    pub depth: u32,
    /// The surface.
    pub surface: &'a Surface,
    /// Unit direction back along the path.
    pub wo: Vec3A,
    /// Distance from the previous vertex, metres.
    pub distance: f32,
    /// The frame that the BSDF lives in: `surface.shading`, or the geometric one where the ray came from behind it.
    pub frame: Frame,
    /// The BSDF.
    pub bsdf: &'a BsdfAt<'a>,
    /// Throughput on arrival.
    pub beta: Spectrum,
}

/// How light was found.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ContributionKind {
    /// The path hit an emitting surface.
    Hit,
    /// The path left the scene toward a light at infinity.
    Escape,
    /// A light was sampled.
    LightSample,
}

/// Light added to a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// Scattering events on the way.
    pub depth: u32,
    /// How it was found.
    pub kind: ContributionKind,
    /// Which light.
    pub light: LightId,
    /// What is added: throughput, MIS weight and radiance multiplied out.
    pub value: Spectrum,
    /// The MIS weight in it.
    pub mis_weight: f32,
    /// Density of finding it by light sampling, sr⁻¹, where it was asked for.
    pub light_pdf: f32,
    /// Density of finding it by BSDF sampling, sr⁻¹, where it was asked for.
    pub bsdf_pdf: f32,
}

/// Sees every event of a path. The unit recorder is free; others give auxiliary images, statistics, path expressions
/// and the replay of one sample.
pub trait Recorder {
    /// A surface was reached and its BSDF made.
    fn vertex(&mut self, v: &Vertex<'_>) {
        let _ = v;
    }

    /// Light was added.
    fn contribution(&mut self, c: &Contribution) {
        let _ = c;
    }

    /// Whether anything but radiance is wanted, so that a path without hope of light is still walked to its first
    /// surface.
    fn wants_vertices(&self) -> bool {
        true
    }
}

impl Recorder for () {
    #[inline]
    fn wants_vertices(&self) -> bool {
        false
    }
}

/// Keeps what the film's auxiliary planes want.
#[derive(Clone, Debug, Default)]
pub struct FirstHitRecorder {
    /// What is asked for; the albedo of other planes' samples is not computed and stays black.
    pub planes: Planes,
    /// The first surface, if one was hit.
    pub first: Option<FirstHit>,
}

impl Recorder for FirstHitRecorder {
    fn vertex(&mut self, v: &Vertex<'_>) {
        if v.depth == 0 && self.first.is_none() {
            let s = v.surface;
            self.first = Some(FirstHit {
                albedo: if self.planes.albedo {
                    v.bsdf.albedo(v.frame.to_local(v.wo))
                } else {
                    Spectrum::BLACK
                },
                normal: s.shading.z,
                depth: v.distance,
                ids: Ids { inst: s.inst, geom: s.geom, prim: s.prim },
            });
        }
    }
}
