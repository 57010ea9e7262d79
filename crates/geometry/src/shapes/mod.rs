//! The shapes that are not meshes.

mod parallelogram;
mod plane;
mod sphere;

pub use parallelogram::Parallelogram;
pub use plane::Plane;
pub use sphere::Sphere;
