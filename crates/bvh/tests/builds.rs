//! Builds end, in time and with a bounded depth, whatever they are given.
#![allow(clippy::disallowed_methods)] // Builds are timed.

mod common;

use std::time::Instant;

use common::{Rng, soup, tree};
use etendue_bvh::{Accel, BruteForce, TreeAccel, World};
use etendue_core::{Ray, Vec3, Vec3A};
use etendue_geometry::TriangleMesh;

struct Timed {
    accel: TreeAccel,
    seconds: f64,
}

fn built(name: &str, mesh: TriangleMesh) -> Timed {
    let mut world = World::default();
    world.add(mesh);
    let start = Instant::now();
    let accel = tree(&world);
    let seconds = start.elapsed().as_secs_f64();
    let report = accel.report();
    println!("{name}: {seconds:.2} s, {report:?}");
    assert!(report.depth <= 64, "{name}: depth {}", report.depth);
    Timed { accel, seconds }
}

fn from_triangles(triangles: impl Iterator<Item = [Vec3; 3]>) -> TriangleMesh {
    let positions: Vec<Vec3> = triangles.flatten().collect();
    let indices = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriangleMesh::new(positions, indices).unwrap()
}

fn small_triangle(at: Vec3, size: f32) -> [Vec3; 3] {
    [at, at + Vec3::Z * size, at + Vec3::Y * size]
}

/// Everything that made some builder slow or deep.
fn pathologies(n: usize) -> Vec<(&'static str, TriangleMesh)> {
    let mut rng = Rng(41);
    let side = (n as f64 / 2.0).sqrt() as usize;
    let line = |step: f32, size: f32| {
        from_triangles((0..n).map(move |i| small_triangle(Vec3::X * (i as f32 * step), size)))
    };
    vec![
        ("equal triangles", from_triangles((0..n).map(|_| small_triangle(Vec3::ONE, 1.0)))),
        ("a line of specks", line(1.0, 1e-3)),
        ("a line of dust", line(1.0, 1e-30)),
        (
            "nested triangles",
            from_triangles((0..n).map(|i| {
                let s = 1.0 + i as f32;
                [Vec3::new(-s, -s, 0.0), Vec3::new(s, -s, 0.0), Vec3::new(0.0, s, 0.0)]
            })),
        ),
        (
            "a flat grid",
            from_triangles((0..2 * side * side).map(|i| {
                let at = Vec3::new((i / 2 % side) as f32, 0.0, (i / 2 / side) as f32);
                if i % 2 == 0 {
                    [at, at + Vec3::Z, at + Vec3::X]
                } else {
                    [at + Vec3::X, at + Vec3::Z, at + Vec3::X + Vec3::Z]
                }
            })),
        ),
        (
            "a swarm far from a giant",
            from_triangles((0..n).map(|i| match i {
                0 => small_triangle(Vec3::splat(1e15), 1e15),
                _ => small_triangle(Vec3::from(rng.point(1e-3)), 1e-5),
            })),
        ),
        (
            "halving distances",
            from_triangles((0..n).map(|i| {
                let s = common::power(-(i as i32 % 120));
                small_triangle(Vec3::new(s, s * 0.5, s * 0.25), s * 0.1)
            })),
        ),
        ("soup times 1e15", common::mapped(&soup(&mut rng, n, 1.0, 0.01), |p| p * 1e15)),
        ("soup times 1e30", common::mapped(&soup(&mut rng, n, 1.0, 0.01), |p| p * 1e30)),
        ("soup times 1e-30", common::mapped(&soup(&mut rng, n, 1.0, 0.01), |p| p * 1e-30)),
        (
            "long needles",
            from_triangles((0..n).map(|_| {
                let a = rng.point(1.0);
                [Vec3::from(a), Vec3::from(a + 1e-4), Vec3::from(-a)]
            })),
        ),
    ]
}

#[test]
fn pathological_builds_end() {
    for (name, mesh) in pathologies(20_000) {
        let Timed { accel, seconds } = built(name, mesh);
        assert!(seconds < 5.0, "{name} took {seconds} s");
        if name == "soup times 1e30" {
            assert_eq!(accel.report().dropped_non_finite, 20_000);
            assert!(!accel.occluded(&Ray::new(Vec3A::ZERO, Vec3A::X)));
        } else {
            assert!(accel.report().primitives > 0, "{name}");
        }
    }
}

#[test]
#[ignore = "a million triangles, eleven times"]
fn pathological_builds_end_at_length() {
    for (name, mesh) in pathologies(1_000_000) {
        let Timed { seconds, .. } = built(name, mesh);
        assert!(seconds < 5.0, "{name} took {seconds} s");
    }
}

#[test]
fn hits_survive_extreme_scales() {
    let mut rng = Rng(42);
    for scale in [1e-30f32, 1e-12, 1.0, 1e12, 1e17] {
        let mut world = World::default();
        world.add(common::mapped(&soup(&mut rng, 400, 1.0, 0.3), |p| p * scale));
        let (accel, oracle) = (tree(&world), BruteForce::build(&world).unwrap());
        let mut hits = 0;
        for _ in 0..2000 {
            let ray = Ray::new(rng.point(1.5) * scale, rng.direction());
            let hit = accel.intersect(&ray);
            assert_eq!(hit, oracle.intersect(&ray), "at {scale}");
            hits += usize::from(hit.is_some());
        }
        assert!(hits > 400, "{hits} hits at {scale}");
    }
}

/// Vertices of random bits and random indices, valid or not in meaning.
fn garbage(rng: &mut Rng) -> World {
    let mut world = World::default();
    for _ in 0..20 {
        let triangles = rng.below(256);
        let vertices = 3 * triangles.max(1);
        let positions = (0..vertices)
            .map(|_| Vec3::from_array([0; 3].map(|_| f32::from_bits(rng.bits() as u32))))
            .collect();
        let indices = (0..triangles as u32)
            .map(|i| match rng.below(32) {
                0 => [0; 3].map(|_| rng.below(vertices) as u32),
                _ => [3 * i, 3 * i + 1, 3 * i + 2],
            })
            .collect();
        world.add(TriangleMesh::new(positions, indices).unwrap());
    }
    world
}

fn garbage_is_harmless(worlds: usize) {
    let mut rng = Rng(43);
    for _ in 0..worlds {
        let world = garbage(&mut rng);
        let (accel, oracle) = (tree(&world), BruteForce::build(&world).unwrap());
        assert!(accel.report().depth <= 64);
        for _ in 0..10 {
            let bits = |rng: &mut Rng| Vec3A::from_array([0; 3].map(|_| f32::from_bits(rng.bits() as u32)));
            let wild =
                Ray { t_max: f32::from_bits(rng.bits() as u32), ..Ray::new(bits(&mut rng), bits(&mut rng)) };
            // Whatever comes out, it comes out; sane rays agree with the oracle.
            let _ = (accel.intersect(&wild), oracle.intersect(&wild));
            let ray = Ray::new(rng.direction() * rng.magnitude(-10.0, 10.0), rng.direction());
            assert_eq!(accel.intersect(&ray), oracle.intersect(&ray), "{ray:?}");
        }
    }
}

#[test]
fn garbage_geometry_is_harmless() {
    garbage_is_harmless(40);
}

#[test]
#[ignore = "a thousand worlds"]
fn garbage_geometry_is_harmless_at_length() {
    garbage_is_harmless(1000);
}
