//! Millions of rays per second on one thread, on a bumpy closed mesh: `cargo run --release --example rays_per_second`.
//!
//! Prints our tree beside obvhs's own binary traversal of its default tree (with its Möller–Trumbore test, which is
//! not watertight).
#![allow(clippy::disallowed_methods)] // A stopwatch is what this is.

use std::time::Instant;

use etendue_bvh::{Accel, BuildOptions, TreeAccel, World};
use etendue_core::{Ray, Vec3A, vector};
use etendue_geometry::{TriangleMesh, presets};
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::triangle::Triangle;

struct Rng(u64);

impl Rng {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    fn direction(&mut self) -> Vec3A {
        loop {
            let v = Vec3A::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0;
            if v.dot(v) <= 1.0 && v.dot(v) > 0.01 {
                return vector::normalize(v);
            }
        }
    }
}

fn primary(count: usize) -> Vec<Ray> {
    let side = (count as f32).sqrt() as usize;
    let eye = Vec3A::new(0.0, 1.0, 3.0);
    (0..side * side)
        .map(|i| {
            let (x, y) = ((i % side) as f32 / side as f32 - 0.5, (i / side) as f32 / side as f32 - 0.5);
            Ray::new(eye, vector::normalize(Vec3A::new(x, y - 0.3, -1.0)))
        })
        .collect()
}

fn diffuse(accel: &TreeAccel, world: &World, first: &[Ray], rng: &mut Rng) -> Vec<Ray> {
    first
        .iter()
        .filter_map(|ray| {
            let surface = world.surface(ray, &accel.intersect(ray)?);
            let d = vector::normalize(surface.ng + rng.direction() * 0.999);
            Some(surface.origin().ray(d, 0.0))
        })
        .collect()
}

fn random(count: usize, rng: &mut Rng) -> Vec<Ray> {
    (0..count)
        .map(|_| {
            let o = Vec3A::new(rng.unit(), rng.unit(), rng.unit()) * 2.0 - 1.0;
            Ray::new(o, rng.direction())
        })
        .collect()
}

fn rate(rays: &[Ray], mut trace: impl FnMut(&Ray) -> bool) -> f64 {
    // The best of some rounds: the machine may be busy with other things.
    (0..5)
        .map(|_| {
            let start = Instant::now();
            let hits = rays.iter().filter(|r| trace(r)).count();
            let seconds = start.elapsed().as_secs_f64();
            std::hint::black_box(hits);
            rays.len() as f64 / seconds * 1e-6
        })
        .fold(0.0, f64::max)
}

fn measure(name: &str, mesh: TriangleMesh) {
    let triangles: Vec<Triangle> = (0..mesh.triangle_count() as u32)
        .map(|i| {
            let [v0, v1, v2] = mesh.triangle(i);
            Triangle { v0, v1, v2 }
        })
        .collect();
    let mut world = World::default();
    world.add(mesh);
    let start = Instant::now();
    let Ok(accel) = TreeAccel::build(&world, &BuildOptions::default(), &|| false) else { return };
    let ours = start.elapsed().as_secs_f64() * 1e3;
    let start = Instant::now();
    let theirs =
        build_bvh2_from_tris(&triangles, obvhs::BvhBuildParams::medium_build(), &mut Default::default());
    let report = accel.report();
    println!(
        "{name}: {} triangles, build {ours:.0} ms (obvhs {:.0} ms), depth {}, {:.0} bytes a triangle",
        triangles.len(),
        start.elapsed().as_secs_f64() * 1e3,
        report.depth,
        report.bytes as f64 / triangles.len() as f64
    );

    let mut rng = Rng(1);
    let primary = primary(1 << 18);
    let diffuse = diffuse(&accel, &world, &primary, &mut rng);
    let random = random(1 << 18, &mut rng);
    for (set, rays) in [("primary", &primary), ("diffuse", &diffuse), ("random", &random)] {
        let closest = rate(rays, |r| accel.intersect(r).is_some());
        let any = rate(rays, |r| accel.occluded(r));
        let other = rate(rays, |r| {
            let ray = obvhs::ray::Ray::new(r.o, r.d, r.t_min, r.t_max);
            let mut hit = obvhs::ray::RayHit::none();
            theirs.ray_traverse(ray, &mut hit, |ray, id| {
                triangles[theirs.primitive_indices[id] as usize].intersect(ray)
            });
            hit.t < f32::INFINITY
        });
        println!("  {set:8} closest {closest:6.2} M/s  any {any:6.2} M/s  obvhs closest {other:6.2} M/s");
    }
}

fn main() {
    measure("terrain block", presets::block(185, 1));
    measure("spiky sphere", presets::spiky_sphere(6, 0.5, 1));
    if std::env::args().any(|a| a == "--large") {
        measure("large terrain", presets::block(700, 2));
    }
}
