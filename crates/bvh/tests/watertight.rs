//! No ray slips between neighbouring triangles, and each crossing is counted once.

mod common;

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use common::{Rng, aimed, mapped, tree, wide};
use etendue_bvh::{Accel, HitFilter, Instance, TreeAccel, World};
use etendue_core::glam::DVec3;
use etendue_core::{Ray, Transform, Vec3A};
use etendue_geometry::{Hit, TriangleMesh, presets};

/// A closed mesh and points that are certainly inside: within `radius` of `inside`.
struct Closed {
    name: &'static str,
    mesh: TriangleMesh,
    inside: Vec3A,
    radius: f32,
}

fn closed_meshes(fine: u32) -> Vec<Closed> {
    let of = |name, mesh, inside, radius| Closed { name, mesh, inside, radius };
    vec![
        of("icosphere", presets::icosphere(fine, 1.0), Vec3A::ZERO, 0.5),
        of("spiky sphere", presets::spiky_sphere(fine, 4.0, 7), Vec3A::ZERO, 0.5),
        of("slivers", presets::uv_sphere(400, 40 * fine, 1.0), Vec3A::ZERO, 0.5),
        of("block", presets::block(16 << fine, 3), Vec3A::new(0.1, -0.7, 0.2), 0.2),
        of("torus", presets::torus(1.0, 0.4, 60 * fine, 20 * fine), Vec3A::X, 0.2),
        of("box", presets::cuboid(Vec3A::splat(-1.0), Vec3A::ONE), Vec3A::ZERO, 0.9),
    ]
}

fn single(mesh: TriangleMesh) -> TreeAccel {
    let mut world = World::default();
    world.add(mesh);
    tree(&world)
}

/// A point of an edge, or a corner, in double precision: what a malicious ray aims at.
fn weak_point(rng: &mut Rng, mesh: &TriangleMesh) -> DVec3 {
    let v = mesh.triangle(rng.below(mesh.triangle_count()) as u32).map(wide);
    let i = rng.below(3);
    match rng.below(4) {
        0 => v[i],
        1 => (v[i] + v[(i + 1) % 3]) * 0.5,
        _ => {
            let s = rng.unit_f64();
            v[i] * (1.0 - s) + v[(i + 1) % 3] * s
        }
    }
}

/// The smallest edge in ulp of the largest coordinate.
fn smallest_edge_in_ulp(mesh: &TriangleMesh) -> f64 {
    let mut smallest = f64::INFINITY;
    let mut largest = 0.0f32;
    for i in 0..mesh.triangle_count() as u32 {
        let v = mesh.triangle(i);
        for k in 0..3 {
            let e = wide(v[k]) - wide(v[(k + 1) % 3]);
            smallest = smallest.min(e.dot(e).sqrt());
            largest = largest.max(v[k].abs().max_element());
        }
    }
    smallest / f64::from(largest.next_up() - largest)
}

fn nothing_gets_out(rays_per_setting: usize, fine: u32) {
    let mut rng = Rng(11);
    let mut total = 0;
    for closed in closed_meshes(fine) {
        for scale in [1e-6f32, 1e-3, 1.0, 1e3, 1e6] {
            for offset in [0.0f32, 1.0, 1e3, 1e6] {
                let shift = Vec3A::new(1.0, -0.7, 0.4) * (offset * scale);
                let mesh = mapped(&closed.mesh, |p| p * scale + shift);
                if offset > 0.0 && smallest_edge_in_ulp(&mesh) < 64.0 {
                    continue;
                }
                let accel = single(mesh.clone());
                for _ in 0..rays_per_setting {
                    let o = (closed.inside + rng.direction() * closed.radius * rng.unit()) * scale + shift;
                    let target = weak_point(&mut rng, &mesh);
                    let Some(ray) = aimed(o, target) else { continue };
                    assert!(
                        accel.occluded(&ray) && accel.intersect(&ray).is_some(),
                        "{} at scale {scale}, offset {offset}: {ray:?} aimed at {target} gets out",
                        closed.name
                    );
                    total += 1;
                }
            }
        }
    }
    println!("{total} rays at edges and corners, none got out");
}

#[test]
fn nothing_gets_out_of_a_closed_mesh() {
    nothing_gets_out(1500, 2);
}

#[test]
#[ignore = "ten million rays"]
fn nothing_gets_out_of_a_closed_mesh_at_length() {
    nothing_gets_out(130_000, 4);
}

/// Lets everything through and counts it.
#[derive(Default)]
struct Counter(AtomicU32);

impl HitFilter for Counter {
    fn keep(&self, _ray_index: u32, _ray: &Ray, _hit: &Hit) -> bool {
        self.0.fetch_add(1, Ordering::Relaxed);
        false
    }
}

fn crossings(accel: &TreeAccel, ray: &Ray) -> u32 {
    let counter = Counter::default();
    assert!(!accel.occluded_filtered(ray, 0, &counter));
    counter.0.into_inner()
}

fn crossings_are_even(rays_per_mesh: usize) {
    let mut rng = Rng(12);
    let (mut total, mut crossed) = (0, 0u64);
    for closed in closed_meshes(3) {
        let mesh = closed.mesh;
        let accel = single(mesh.clone());
        for i in 0..rays_per_mesh {
            // Outside of everything: the spikes reach out to 5.
            let from = rng.direction() * 12.0;
            let target = match i % 4 {
                0 => wide(rng.point(1.0)),
                _ => weak_point(&mut rng, &mesh),
            };
            let Some(mut ray) = aimed(from, target) else { continue };
            if i % 5 == 0 {
                // Exactly along an axis through the target: arithmetic without rounding, ties at every turn.
                let axis = rng.below(3);
                let mut d = [0.0; 3];
                d[axis] = if rng.below(2) == 0 { 1.0 } else { -1.0 };
                let d = Vec3A::from_array(d);
                let target = Vec3A::new(target.x as f32, target.y as f32, target.z as f32);
                ray = Ray::new(target * (Vec3A::ONE - d.abs()) - d * 12.0, d);
            }
            let outside = crossings(&accel, &ray);
            assert_eq!(outside % 2, 0, "{}: {outside} crossings of {ray:?}", closed.name);
            crossed += u64::from(outside);
            let inside = closed.inside + rng.direction() * closed.radius * rng.unit();
            if let Some(ray) = aimed(inside, target) {
                let out = crossings(&accel, &ray);
                assert_eq!(out % 2, 1, "{}: {out} crossings from inside of {ray:?}", closed.name);
            }
            total += 1;
        }
    }
    println!("{total} pairs of rays, {crossed} crossings");
    assert!(crossed > total);
}

#[test]
fn crossings_of_a_closed_mesh_are_even() {
    crossings_are_even(17_000);
}

#[test]
#[ignore = "a million pairs of rays"]
fn crossings_of_a_closed_mesh_are_even_at_length() {
    crossings_are_even(170_000);
}

#[test]
fn nothing_gets_out_of_an_instance() {
    let mut rng = Rng(13);
    for closed in closed_meshes(2) {
        for _ in 0..60 {
            let m: [Vec3A; 3] = std::array::from_fn(|_| rng.direction() * rng.magnitude(-2.0, 2.0));
            let shift = rng.direction() * rng.magnitude(-2.0, 4.0);
            let Ok(to_world) = Transform::from_columns(m[0], m[1], m[2], shift) else { continue };
            let mut world = World::default();
            world.geometries.push(closed.mesh.clone().into());
            world.instances.push(Instance::new(Arc::new([0]), to_world));
            let accel = tree(&world);
            for _ in 0..300 {
                let o = to_world.point(closed.inside + rng.direction() * closed.radius * rng.unit() * 0.5);
                // Rounding in world space must not put the origin outside.
                let back = to_world.inverse().point(o) - closed.inside;
                if back.dot(back) > closed.radius * closed.radius {
                    continue;
                }
                let p = weak_point(&mut rng, &closed.mesh);
                let target = to_world.point(Vec3A::new(p.x as f32, p.y as f32, p.z as f32));
                let Some(ray) = aimed(o, wide(target)) else { continue };
                assert!(accel.occluded(&ray), "{}: {ray:?} gets out through {to_world:?}", closed.name);
            }
        }
    }
}

/// The test of Möller & Trumbore (1997), as it is usually written.
fn moller_trumbore(ray: &Ray, [a, b, c]: [Vec3A; 3]) -> bool {
    let (e1, e2) = (b - a, c - a);
    let p = ray.d.cross(e2);
    let inverse = 1.0 / e1.dot(p);
    let s = ray.o - a;
    let u = s.dot(p) * inverse;
    let q = s.cross(e1);
    let v = ray.d.dot(q) * inverse;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && e2.dot(q) * inverse > 0.0
}

#[test]
fn another_triangle_test_would_leak() {
    // What the rays above are worth: the common test loses some of them.
    let mut rng = Rng(14);
    let mesh = presets::icosphere(2, 1.0);
    let (mut lost, mut total) = (0, 0);
    for _ in 0..10_000 {
        let o = rng.direction() * 0.5 * rng.unit();
        let Some(ray) = aimed(o, weak_point(&mut rng, &mesh)) else { continue };
        let hit = (0..mesh.triangle_count() as u32).any(|i| moller_trumbore(&ray, mesh.triangle(i)));
        lost += usize::from(!hit);
        total += 1;
    }
    println!("Möller–Trumbore loses {lost} of {total}");
    assert!(lost * 100 > total, "{lost} of {total}: the rays are not hard");
}
