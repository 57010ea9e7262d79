//! The shapes that are not meshes.

mod cylinder;
mod disc;
mod parallelogram;
mod plane;
mod sphere;

pub use cylinder::Cylinder;
pub use disc::Disc;
pub use parallelogram::Parallelogram;
pub use plane::Plane;
pub use sphere::Sphere;
