//! What rays can meet: triangle meshes, a few exact shapes, the door for others, and all that is known of a point on
//! them.
//!
//! Positions that leave this crate carry a bound on their error, so that the rays that start there need no epsilon.
//!
//! ```
//! use etendue_core::{Ray, Vec3A};
//! use etendue_geometry::{Shape, Sphere};
//!
//! let ball = Sphere::new(Vec3A::ZERO, 2.0)?;
//! let ray = Ray::new(Vec3A::Z * 10.0, -Vec3A::Z);
//! let hit = ball.intersect(&ray).expect("straight at it");
//! assert_eq!(hit.t, 8.0);
//! assert_eq!(ball.surface(&ray, &hit).ng, Vec3A::Z);
//! # Ok::<(), etendue_geometry::ShapeError>(())
//! ```
//!
//! Limits: a shape does not move in its own space (its instances may); no curves or subdivision surfaces. Triangles beyond 2⁶⁰ are not
//! hit.
//!
//! Uses `etendue-core`; the hierarchies over it are in `etendue-bvh`.

mod double;
mod error;
mod exact;
mod geometry;
mod mesh;
pub mod presets;
mod return_bound;
mod shape;
mod shapes;
mod surface;
pub mod triangle;

pub use error::{MeshError, ShapeError};
pub use geometry::Geometry;
pub use mesh::{AlphaAttributes, MeshReport, TriangleMesh};
pub use return_bound::ReturnBound;
pub use shape::{Shape, ShapeHit, ShapeSample};
pub use shapes::{Cylinder, Disc, Parallelogram, Plane, Sphere};
pub use surface::{Hit, Surface, return_error};
