//! Integrators turn camera rays into radiance; [`render`] turns a scene, a camera and an integrator into a film.
//!
//! The picture is a function of its inputs: the same bits from any number of threads, any tile size, and any
//! division of the samples into ranges. [`replay`] gives the contribution of one sample alone.
//!
//! ```
//! use etendue_camera::{Film, Perspective};
//! use etendue_core::{Spectrum, UVec2, Vec3A};
//! use etendue_geometry::Sphere;
//! use etendue_integrator::{PathTracer, RenderOptions, render};
//! use etendue_light::ConstantEnvironment;
//! use etendue_material::Diffuse;
//! use etendue_sampling::Sobol;
//! use etendue_scene::SceneBuilder;
//!
//! let mut b = SceneBuilder::new();
//! let gray = b.material(Diffuse::new(Spectrum::gray(0.5)));
//! b.add(Sphere::new(Vec3A::ZERO, 1.0)?, gray);
//! b.light(ConstantEnvironment::new(Spectrum::ONE));
//! let scene = b.build()?;
//!
//! let size = UVec2::new(8, 8);
//! let camera = Perspective::look_at(Vec3A::Z * 4.0, Vec3A::ZERO, Vec3A::Y, 20.0, size)?;
//! let mut film = Film::new(size, 1)?;
//! let report =
//!     render(&scene, &camera, &PathTracer::default(), Sobol::new(1, 16), &mut film, &RenderOptions::default())?;
//! assert_eq!(report.samples, 8 * 8 * 16);
//! assert_eq!(report.counts.texture_fetches, 0, "there are no textures to look up");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | integrator | what it holds |
//! |---|---|
//! | [`PathTracer`] | all light; by directions alone, by lights, or by both ([`DirectLight`]); [`Roulette`], [`Branching`], cut-offs |
//! | [`AreaForm`] | all light, as an integral over all surfaces; for comparing |
//! | [`Whitted`] | direct light, and all of mirrors and clear glass |
//! | [`RayCaster`] | what the first surface emits and reflects of the lights |
//! | [`AmbientOcclusion`], [`FirstSurface`] | no light: how open the first surface is; its normal, depth, ids, albedo |
//!
//! Limits: surfaces in a vacuum; no media yet. Uses core, sampling, geometry, bsdf, light, camera and scene.

mod ambient_occlusion;
mod area_form;
mod arrival;
mod context;
mod first_surface;
mod inside;
mod integrator;
mod lights;
mod options;
mod path;
mod ray_caster;
mod recorder;
mod render;
mod report;
mod shaded;
mod whitted;

pub use ambient_occlusion::AmbientOcclusion;
pub use area_form::{AreaError, AreaForm};
pub use context::{Context, Counts};
pub use first_surface::{FirstSurface, Show};
pub use integrator::{Integrator, Sample};
pub use options::{RenderError, RenderOptions};
pub use path::{Branching, DirectLight, PathTracer, Roulette};
pub use ray_caster::RayCaster;
pub use recorder::{Contribution, ContributionKind, FirstHitRecorder, Recorder, Vertex};
pub use render::{Replay, render, replay, stream_of};
pub use report::{Ended, Rejected, Report};
pub use whitted::Whitted;
