//! Rays against generated meshes of 10³ to 10⁶ triangles on one thread: `cargo bench --bench traversal`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use etendue::bvh::{Accel, BuildOptions, TreeAccel, World};
use etendue::core::vector;
use etendue::geometry::presets;
use etendue::prelude::*;
use etendue::sampling::warp;

/// Rays of one kind.
const RAYS: usize = 16_384;

/// A picture's rays: neighbours go alike.
fn primary() -> Vec<Ray> {
    let eye = Vec3A::new(0.4, 1.5, 2.6);
    let side = RAYS.isqrt();
    (0..side * side)
        .map(|i| {
            let at = |k: usize| k as f32 / side as f32 - 0.5;
            let target = Vec3A::new(2.2 * at(i % side), 2.2 * at(i / side), 0.0);
            Ray::new(eye, vector::normalize(target - eye))
        })
        .collect()
}

/// What leaves the hits of the primary rays by the cosine: neighbours go anywhere.
fn diffuse(world: &World, accel: &dyn Accel) -> Vec<Ray> {
    let sampler = Independent::new(1, 1);
    primary()
        .iter()
        .enumerate()
        .filter_map(|(i, ray)| {
            let surface = world.surface(ray, &accel.intersect(ray)?);
            let side = if surface.ng.dot(ray.d) < 0.0 { surface.ng } else { -surface.ng };
            let d = warp::cosine(sampler.start(i as u64, 0).get_2d(Dim::FILM));
            Some(surface.origin().ray(Frame::from_normal(side).to_world(d), 0.0))
        })
        .collect()
}

fn traversal(c: &mut Criterion) {
    let mut group = c.benchmark_group("traversal");
    let terrains = [22, 71, 224, 707].map(|n| ("terrain", presets::terrain(n, 1)));
    let spheres = [3, 6].map(|n| ("spiky sphere", presets::spiky_sphere(n, 0.6, 1)));
    for (name, mesh) in terrains.into_iter().chain(spheres) {
        let triangles = mesh.triangle_count();
        let mut world = World::default();
        world.add(mesh);
        let Ok(accel) = TreeAccel::build(&world, &BuildOptions::default(), &|| false) else {
            eprintln!("{name} of {triangles} triangles could not be built");
            continue;
        };
        for (kind, rays) in [("primary", primary()), ("diffuse", diffuse(&world, &accel))] {
            group.throughput(Throughput::Elements(rays.len() as u64));
            group.bench_function(format!("{name} {triangles}/{kind} closest"), |b| {
                b.iter(|| {
                    for ray in &rays {
                        black_box(accel.intersect(ray));
                    }
                });
            });
            group.bench_function(format!("{name} {triangles}/{kind} any"), |b| {
                b.iter(|| {
                    for ray in &rays {
                        black_box(accel.occluded(ray));
                    }
                });
            });
        }
    }
    group.finish();
}

/// From triangles to a hierarchy.
fn building(c: &mut Criterion) {
    let mut group = c.benchmark_group("building");
    for n in [71, 224] {
        let mesh = presets::terrain(n, 1);
        group.throughput(Throughput::Elements(mesh.triangle_count() as u64));
        let mut world = World::default();
        world.add(mesh);
        group.bench_function(format!("terrain {}", 2 * n * n), |b| {
            b.iter(|| black_box(TreeAccel::build(&world, &BuildOptions::default(), &|| false)));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    targets = traversal, building
}
criterion_main!(benches);
