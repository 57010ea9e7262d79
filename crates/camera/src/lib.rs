//! From the scene to the picture: cameras that make rays, filters that place samples inside pixels, and the exact
//! film that adds them up.
//!
//! A filter is sampled, not splatted, so a sample touches its own pixel only; the film sums in fixed point, so the
//! order of additions cannot matter.
//!
//! ```
//! use etendue_camera::{Camera, Film, Perspective};
//! use etendue_core::{Spectrum, UVec2, Vec2, Vec3A};
//!
//! let size = UVec2::new(64, 48);
//! let camera = Perspective::look_at(Vec3A::new(0.0, 1.0, 5.0), Vec3A::Y, Vec3A::Y, 40.0, size)?;
//! let sample = camera.ray(Vec2::new(32.0, 24.0), Vec2::ZERO, 0.0).expect("the middle of the picture");
//! assert!((sample.ray.d - Vec3A::NEG_Z).length() < 1e-6);
//!
//! let mut film = Film::new(size, 1)?;
//! film.add(UVec2::new(3, 4), 0, Spectrum::gray(0.5));
//! assert_eq!(film.mean(UVec2::new(3, 4)), Spectrum::gray(0.5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Perspective`] has a pinhole or a thin lens, round or with blades; [`Orthographic`] has parallel rays; [`Panorama`] sees in all
//! directions. A [`Shutter`] around any of them says when it looks, and moves it.
//!
//! Limits: radiance above 2⁴⁰ is refused (and counted); 2²² samples of that size would fill a pixel's sum.
//! Uses core, sampling and geometry; a scene knows no camera, since it is viewed by many.

mod camera;
mod film;
mod filter;
mod fixed;
mod moving;
mod orthographic;
mod panorama;
mod parts;
mod perspective;
mod planes;
mod tile;

pub use camera::{Camera, CameraSample, Connect};
pub use film::{Film, FilmError, MergeError};
pub use filter::{Filter, FilterSample, FilterSampler};
pub use fixed::LIMIT;
pub use moving::{Shutter, ShutterError};
pub use orthographic::Orthographic;
pub use panorama::{Panorama, PanoramaMap};
pub use parts::{FilmParts, FilmView};
pub use perspective::{CameraError, Perspective};
pub use planes::{FirstHit, Ids, Planes};
pub use tile::{Tile, TileRect};
