use std::fmt;
use std::sync::Arc;

use etendue_core::{Aabb, Fingerprint, Ray};

use crate::{Cylinder, Disc, Hit, Parallelogram, Plane, Shape, ShapeHit, Sphere, Surface, TriangleMesh};

/// One geometry of a scene: the closed set that hierarchies store by value, and the door for any other shape.
#[derive(Clone)]
pub enum Geometry {
    /// Triangles.
    Mesh(Arc<TriangleMesh>),
    /// A sphere.
    Sphere(Sphere),
    /// An unbounded plane.
    Plane(Plane),
    /// A flat parallelogram.
    Parallelogram(Parallelogram),
    /// A flat round disc.
    Disc(Disc),
    /// An open tube.
    Cylinder(Cylinder),
    /// A shape from outside.
    Open(Arc<dyn Shape>),
}

impl Geometry {
    /// A mesh.
    pub fn mesh(mesh: TriangleMesh) -> Self {
        Self::Mesh(Arc::new(mesh))
    }

    /// A shape from outside.
    pub fn open(shape: impl Shape + 'static) -> Self {
        Self::Open(Arc::new(shape))
    }

    /// The shape, unless it is a mesh.
    pub fn shape(&self) -> Option<&dyn Shape> {
        match self {
            Self::Mesh(_) => None,
            Self::Sphere(s) => Some(s),
            Self::Plane(s) => Some(s),
            Self::Parallelogram(s) => Some(s),
            Self::Disc(s) => Some(s),
            Self::Cylinder(s) => Some(s),
            Self::Open(s) => Some(&**s),
        }
    }

    /// A box around it, object space; [`Aabb::INFINITE`] where it is unbounded.
    pub fn bounds(&self) -> Aabb {
        match self {
            Self::Mesh(m) => m.bounds(),
            _ => self.shape().map_or(Aabb::EMPTY, Shape::bounds),
        }
    }

    /// How many primitives it has: triangles, or one shape.
    pub fn prims(&self) -> usize {
        match self {
            Self::Mesh(m) => m.triangle_count(),
            _ => 1,
        }
    }

    /// Everything about the point that the ray hit, object space. The ray must be in object space too.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let at = ShapeHit { t: hit.t, uv: hit.uv };
        let mut surface = match self {
            Self::Mesh(m) => m.surface(hit.prim, hit.uv),
            Self::Sphere(s) => s.surface(ray, &at),
            Self::Plane(s) => s.surface(ray, &at),
            Self::Parallelogram(s) => s.surface(ray, &at),
            Self::Disc(s) => s.surface(ray, &at),
            Self::Cylinder(s) => s.surface(ray, &at),
            Self::Open(s) => s.surface(ray, &at),
        };
        surface.time = ray.time;
        surface.inst = hit.inst;
        surface.geom = hit.geom;
        surface.prim = hit.prim;
        surface
    }

    /// What decides the geometry, for comparing scenes.
    pub fn fingerprint(&self, f: &mut Fingerprint) {
        match self {
            Self::Mesh(m) => m.fingerprint(f),
            _ => {
                if let Some(s) = self.shape() {
                    s.fingerprint(f);
                }
            }
        }
    }

    /// Bytes held on the heap; an open shape's own are not known.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Mesh(m) => m.bytes(),
            _ => 0,
        }
    }
}

impl fmt::Debug for Geometry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mesh(m) => write!(f, "Mesh({} triangles)", m.triangle_count()),
            Self::Sphere(s) => s.fmt(f),
            Self::Plane(s) => s.fmt(f),
            Self::Parallelogram(s) => s.fmt(f),
            Self::Disc(s) => s.fmt(f),
            Self::Cylinder(s) => s.fmt(f),
            Self::Open(s) => write!(f, "Open({:?})", s.bounds()),
        }
    }
}

impl From<TriangleMesh> for Geometry {
    fn from(mesh: TriangleMesh) -> Self {
        Self::mesh(mesh)
    }
}

impl From<Sphere> for Geometry {
    fn from(shape: Sphere) -> Self {
        Self::Sphere(shape)
    }
}

impl From<Plane> for Geometry {
    fn from(shape: Plane) -> Self {
        Self::Plane(shape)
    }
}

impl From<Parallelogram> for Geometry {
    fn from(shape: Parallelogram) -> Self {
        Self::Parallelogram(shape)
    }
}

impl From<Disc> for Geometry {
    fn from(shape: Disc) -> Self {
        Self::Disc(shape)
    }
}

impl From<Cylinder> for Geometry {
    fn from(shape: Cylinder) -> Self {
        Self::Cylinder(shape)
    }
}
