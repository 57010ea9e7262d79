//! Ray queries over meshes, shapes and instances.
//!
//! ```
//! use etendue_bvh::{Accel, BuildOptions, TreeAccel, World};
//! use etendue_core::{Ray, Vec3A};
//! use etendue_geometry::{Sphere, presets};
//!
//! let mut world = World::default();
//! let ground = world.add(presets::terrain(64, 1));
//! let ball = world.add(Sphere::new(Vec3A::new(0.0, 1.0, 0.0), 0.25)?);
//!
//! let accel = TreeAccel::build(&world, &BuildOptions::default(), &|| false)?;
//! let down = Ray::new(Vec3A::new(0.0, 3.0, 0.0), -Vec3A::Y);
//! let hit = accel.intersect(&down).expect("the ball is in the way");
//! assert_eq!((hit.geom, hit.t), (ball, 1.75));
//!
//! // A ray that leaves the point of a hit needs no epsilon.
//! let surface = world.surface(&down, &hit);
//! assert!(!accel.occluded(&surface.origin().ray(Vec3A::Y, 0.0)));
//! let through = accel.intersect(&surface.origin().ray(-Vec3A::Y, 0.0)).expect("the other side of the ball");
//! assert_eq!(through.geom, ball);
//! # let _ = ground;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`World`] says what there is, [`TreeAccel`] finds it fast, [`BruteForce`] finds it surely; both give the same hits,
//! bit by bit. Hits do not depend on the tree, the threads or the order of objects, and scaling the world by a power
//! of two scales them exactly.
//!
//! A ray cannot pass between two triangles that share an edge, and it crosses a closed mesh an even number of times,
//! whatever it is aimed at. (A triangle of exactly zero area is left out. Where one was to close a gap between
//! corners on one straight line, the gap it leaves is narrower than double precision can tell for most rays, but it
//! is there.) Between different geometries and instances there is no such promise.
//!
//! What moves is met where it is at the ray's own time. Limits: only whole instances move, and rigidly; one level of instances; 2²⁸ triangles or shapes in one group;
//! nodes are four wide.
//!
//! Uses `etendue-core` and `etendue-geometry`. With the feature `parallel` trees are built on the current rayon pool.
//! No other crate names obvhs, which clusters the boxes.

mod accel;
mod brute;
mod build;
mod error;
mod group;
mod instances;
mod kernel;
mod level;
mod shape_hits;
mod sink;
mod tree_accel;
mod world;

pub use accel::{Accel, HitFilter};
pub use brute::BruteForce;
pub use error::{BuildError, Place};
pub use tree_accel::{BuildOptions, BuildReport, Quality, TreeAccel};
pub use world::{Instance, World};
