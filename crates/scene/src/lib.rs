//! A scene: geometry, materials and lights behind one hierarchy, looked over once (the census) and then immutable.
//!
//! ```
//! use etendue_core::{Needs, Ray, Spectrum, Vec3A};
//! use etendue_geometry::Sphere;
//! use etendue_light::PointLight;
//! use etendue_material::Diffuse;
//! use etendue_scene::SceneBuilder;
//!
//! let mut b = SceneBuilder::new();
//! let gray = b.material(Diffuse::new(Spectrum::gray(0.5)));
//! b.add(Sphere::new(Vec3A::ZERO, 1.0)?, gray);
//! b.light(PointLight::new(Vec3A::new(0.0, 3.0, 0.0), Spectrum::gray(10.0)));
//! let scene = b.build()?;
//!
//! assert!(scene.needs().contains(Needs::LIGHTS) && !scene.needs().contains(Needs::TEXTURES));
//! let hit = scene.intersect(&Ray::new(Vec3A::new(0.0, 0.0, 5.0), Vec3A::NEG_Z), 0).expect("the sphere is there");
//! assert!((hit.t - 4.0).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Limits: geometry does not change after building; while the shutter is open only whole instances move, rigidly. A scene knows no camera, since it is viewed by many. Uses core,
//! geometry, bvh, bsdf, texture, material and light.

mod builder;
mod census;
mod cutout;
mod emitters;
mod error;
pub mod presets;
mod report;
mod scene;

pub use builder::{Emission, GeomId, GroupId, InstanceId, MaterialId, SceneBuilder};
pub use error::SceneError;
pub use report::{MemoryReport, SceneReport};
pub use scene::{Body, LightDraw, Scene};
