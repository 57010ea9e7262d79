//! A virtual gonioreflectometer: the BRDF by its definition, of any material and of any micro-geometry.
//!
//! f_r(wi, wo) = dL_r(wo) / dE_i(wi), reflected radiance over the irradiance that makes it (Nicodemus et al. 1977,
//! "Geometrical Considerations and Nomenclature for Reflectance"; sr⁻¹). A source far away lights a [`Specimen`]; a
//! detector far away sees a [`Spot`] of its macroscopic surface. What it reads is the radiance averaged over the spot,
//! light scattered by the specimen any number of times, with all masking and shadowing; divided by the irradiance that
//! the source makes *on the macroscopic plane*, cosine included.
//!
//! * [`measure_brdf`]: one pair of directions. [`measure_lobe`]: many exitant directions under one light.
//! * [`measure_albedo`]: what part of the light comes back at all.
//!
//! ```
//! use std::sync::Arc;
//! use etendue_core::{Spectrum, Vec3A};
//! use etendue_material::Diffuse;
//! use etendue_measure::gonio::{Gonioreflectometer, Specimen, measure_brdf};
//!
//! let paper = Specimen::flat(Arc::new(Diffuse::new(Spectrum::gray(0.8))));
//! let (wi, wo) = (Vec3A::new(0.6, 0.0, 0.8), Vec3A::new(0.0, -0.6, 0.8));
//! let reading = measure_brdf(&paper, wi, wo, &Gonioreflectometer::default())?;
//! assert!((reading.rgb[1].value - 0.8 / std::f64::consts::PI).abs() < 1e-6);
//! # Ok::<(), etendue_measure::gonio::GonioError>(())
//! ```
//!
//! Source and detector are collimated, or cones of a half angle. A mirror is measured with cones only: under a source
//! of half angle a, seen by a smaller detector within its reflection, it reads albedo / (π sin² a cos θ).
//!
//! How: the detector's rays are followed by the [`PathTracer`], so every BSDF, shading normal and cut-out counts as it
//! does in pictures. They begin outside of everything bounded in the scene; a shape without bounds must not reach above
//! the spot. Samples are independent, not of a low-discrepancy sequence: where a shadow's edge crosses the spot, all runs
//! of a sequence can count the same points and agree on a wrong value, so that their scatter would not be the error.
//!
//! Limits: reflection only; what is transmitted is lost. Nothing moves. One thread a reading: readings are independent
//! of each other, and a caller may make several at once.

mod cone;
mod error;
mod specimen;

use etendue_camera::CameraSample;
use etendue_core::{Ray, Spectrum, Vec3A, vector};
use etendue_integrator::{Context, Integrator, PathTracer};
use etendue_sampling::{Dim, Independent, Sampler};
use etendue_scene::{Scene, SceneBuilder};

pub use error::GonioError;
pub use specimen::{Outline, Specimen, Spot};

use crate::{Measured, jackknife};
use cone::Cone;

/// The instrument's settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gonioreflectometer {
    /// Detector rays of one run.
    pub samples: u32,
    /// Independent runs, whose scatter gives the interval; one has none.
    pub runs: u32,
    /// Seed of the random numbers. Readings of one seed share them: neighbours on a curve err alike.
    pub seed: u64,
    /// Half angle of the source, radians: 0 for a collimated beam, π/2 around the normal for a uniform sky.
    pub source: f32,
    /// Half angle of the detector, radians, likewise. What it reads is Φ_r / (E_i · ∫ cos θ dω): the mean over the cone,
    /// weighted by the cosine.
    pub detector: f32,
    /// Most scattering events: 1 is single scattering. `None` counts all; a limit is bias.
    pub max_depth: Option<u32>,
}

impl Default for Gonioreflectometer {
    fn default() -> Self {
        Self { samples: 1024, runs: 16, seed: 1, source: 0.0, detector: 0.0, max_depth: None }
    }
}

/// What the instrument reads for one pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Unit direction toward the source, in the spot's frame.
    pub wi: Vec3A,
    /// Unit direction toward the detector, in the spot's frame.
    pub wo: Vec3A,
    /// The BRDF, sr⁻¹, of the linear Rec.709 channels.
    pub rgb: [Measured; 3],
    /// The part of the detector's rays that met nothing and count as black: the spot's edge seen aslant, holes.
    pub missed: f64,
}

/// Measures the BRDF for light from `wi` that leaves along `wo`; both in the spot's frame, away from the surface, of
/// any length.
///
/// # Errors
/// [`GonioError`]: directions that are none or not above the surface, half angles out of range, no samples, a spot
/// without area, a specimen with lights or one that cannot be built, radiance that is not finite.
pub fn measure_brdf(
    specimen: &Specimen<'_>,
    wi: Vec3A,
    wo: Vec3A,
    by: &Gonioreflectometer,
) -> Result<Reading, GonioError> {
    let bench = Bench::new(specimen, wi, by)?;
    bench.reading(wo)
}

/// The same for many exitant directions under one light; the scene is built once.
///
/// # Errors
/// As [`measure_brdf`], at the first direction with a fault.
pub fn measure_lobe(
    specimen: &Specimen<'_>,
    wi: Vec3A,
    wo: &[Vec3A],
    by: &Gonioreflectometer,
) -> Result<Vec<Reading>, GonioError> {
    let bench = Bench::new(specimen, wi, by)?;
    wo.iter().map(|&wo| bench.reading(wo)).collect()
}

/// Measures the albedo: under a uniform sky of radiance 1, the radiance that leaves along `wo`, that is
/// ∫ f_r(wi, wo) cos θi dωi. By reciprocity it is also the part of a beam *from* `wo` that is reflected at all. Delta
/// lobes count. `by.source` is not used, and `by.detector` widens `wo`.
///
/// The same without reciprocity: π times the reading along the normal of a detector of half angle π/2.
///
/// # Errors
/// As [`measure_brdf`].
pub fn measure_albedo(
    specimen: &Specimen<'_>,
    wo: Vec3A,
    by: &Gonioreflectometer,
) -> Result<[Measured; 3], GonioError> {
    let sky = Gonioreflectometer { source: std::f32::consts::FRAC_PI_2, ..*by };
    let bench = Bench::new(specimen, Vec3A::Z, &sky)?;
    bench.reading(wo).map(|r| r.rgb.map(|m| m.times(std::f64::consts::PI)))
}

/// A lit specimen.
struct Bench<'a> {
    by: &'a Gonioreflectometer,
    spot: Spot,
    scene: Scene,
    wi: Vec3A,
    /// On the macroscopic plane.
    irradiance: f64,
}

impl<'a> Bench<'a> {
    fn new(specimen: &Specimen<'_>, wi: Vec3A, by: &'a Gonioreflectometer) -> Result<Self, GonioError> {
        if by.samples == 0 || by.runs == 0 {
            return Err(GonioError::NoSamples { runs: by.runs, samples: by.samples });
        }
        let spot = specimen.spot;
        spot.check()?;
        let source = Cone::new("incident", wi, by.source)?;
        let mut b = SceneBuilder::new();
        (specimen.place)(&mut b);
        if !b.has_no_light() {
            return Err(GonioError::Lit);
        }
        source.light(&mut b, &spot.frame);
        Ok(Self { by, spot, scene: b.build()?, wi: source.axis, irradiance: source.projected() })
    }

    /// A ray of the detector from outside of the scene to a point of the spot.
    fn ray(&self, p: Vec3A, wo: Vec3A) -> Ray {
        let (bounds, mut distance) = (self.scene.bounds(), self.spot.radius());
        if bounds.is_finite() && !bounds.is_empty() {
            // From p along any direction, what is further than this is outside of the sphere around the box.
            distance += 1.001 * (vector::length(p - bounds.center()) + bounds.radius());
        }
        Ray::new(p + wo * distance, -wo)
    }

    fn reading(&self, wo: Vec3A) -> Result<Reading, GonioError> {
        let detector = Cone::new("exitant", wo, self.by.detector)?;
        let path = PathTracer { max_depth: self.by.max_depth, ..PathTracer::default() };
        let cx = Context::new(&self.scene);
        let sampler = Independent::new(self.by.seed, self.by.samples);
        let (mut means, mut missed) = (Vec::new(), 0u64);
        for run in 0..self.by.runs {
            let mut sum = [0.0f64; 3];
            for sample in 0..self.by.samples {
                let u = sampler.start(u64::from(run), u64::from(sample));
                let local = detector.draw(u.get_2d(Dim::LENS));
                let wo = vector::normalize(self.spot.frame.to_world(local));
                let ray = self.ray(self.spot.point(u.get_2d(Dim::FILM)), wo);
                let seen = path.li_plain(&cx, &CameraSample { ray, weight: 1.0, spread: 0.0 }, u);
                if seen.alpha == 0.0 {
                    missed += 1;
                    continue;
                }
                if !seen.l.is_finite() {
                    return Err(GonioError::NotFinite { run, sample, wo: local });
                }
                let l: Spectrum = seen.l;
                for (sum, l) in sum.iter_mut().zip([l.r(), l.g(), l.b()]) {
                    *sum += f64::from(l);
                }
            }
            means.push(sum.map(|s| s / (f64::from(self.by.samples) * self.irradiance)));
        }
        let of = |channel: usize| {
            let mean = |kept: &[usize]| {
                let sum: f64 = kept.iter().map(|&k| means[k][channel]).sum();
                (!kept.is_empty()).then(|| sum / kept.len() as f64)
            };
            jackknife(means.len(), mean).unwrap_or(Measured::without_interval(f64::NAN))
        };
        Ok(Reading {
            wi: self.wi,
            wo: detector.axis,
            rgb: [of(0), of(1), of(2)],
            missed: missed as f64 / (u64::from(self.by.runs) * u64::from(self.by.samples)) as f64,
        })
    }
}
