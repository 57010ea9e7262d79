//! What the tests of this crate share.
#![allow(dead_code)]

use std::sync::Arc;

use etendue_camera::CameraSample;
use etendue_core::{Ray, Spectrum, Vec3A};
use etendue_geometry::{Geometry, Parallelogram, TriangleMesh};
use etendue_integrator::{Context, Integrator, PathTracer};
use etendue_material::Diffuse;
use etendue_sampling::{Independent, Sampler};
use etendue_scene::{MaterialId, Scene, SceneBuilder};

pub(crate) fn gray(b: &mut SceneBuilder) -> MaterialId {
    b.material(Diffuse::new(Spectrum::gray(0.5)))
}

/// A square of side 2 around the origin in the plane z = `z`, facing +z.
pub(crate) fn square(z: f32) -> Parallelogram {
    Parallelogram::new(Vec3A::new(-1.0, -1.0, z), Vec3A::X * 2.0, Vec3A::Y * 2.0).expect("a square")
}

pub(crate) fn shared(mesh: TriangleMesh) -> Geometry {
    Geometry::Mesh(Arc::new(mesh))
}

/// `n` independent samples of the mean radiance along one ray.
pub(crate) fn radiance(scene: &Scene, path: &PathTracer, ray: Ray, seed: u64, n: u64) -> Vec<f64> {
    let cx = Context::new(scene);
    let s = CameraSample { ray, weight: 1.0, spread: 0.0 };
    let sampler = Independent::new(seed, 1);
    (0..n).map(|i| f64::from(path.li_plain(&cx, &s, sampler.start(i, 0)).l.mean())).collect()
}
