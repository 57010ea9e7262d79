//! Instances give what the transformed geometry would.

mod common;

use std::sync::Arc;

use common::{Rng, aimed, mapped, tree, wide};
use etendue_bvh::{Accel, Instance, World};
use etendue_core::{Ray, Transform, Vec3A};
use etendue_geometry::{Sphere, presets};

fn one_instance(mesh: etendue_geometry::TriangleMesh, to_world: Transform) -> World {
    let mut world = World::default();
    world.geometries.push(mesh.into());
    world.instances.push(Instance::new(Arc::new([0]), to_world));
    world
}

/// Scale 10⁻⁴ … 10⁴, up to 30 times more along one axis than another, sheared, turned, mirrored now and then.
fn placement(rng: &mut Rng) -> Option<Transform> {
    let spread = rng.magnitude(-4.0, 4.0);
    let mut axis = || rng.magnitude(-0.75, 0.75) * if rng.below(2) == 0 { spread } else { -spread };
    let scale = Transform::scale(Vec3A::new(axis(), axis(), axis())).ok()?;
    let shear = Transform::from_columns(
        Vec3A::X,
        Vec3A::new(rng.range(-1.0, 1.0), 1.0, 0.0),
        Vec3A::new(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0), 1.0),
        Vec3A::ZERO,
    )
    .ok()?;
    let turn = Transform::rotation(rng.direction(), rng.range(0.0, 6.0));
    let back = Transform::rotation(rng.direction(), rng.range(0.0, 6.0));
    let shift = Transform::translation(rng.direction() * spread * 3.0);
    shift.after(&turn).ok()?.after(&scale).ok()?.after(&shear).ok()?.after(&back).ok()
}

/// How much an error in one direction can grow on the way there and back.
fn condition(t: &Transform) -> f32 {
    let largest = |c: [Vec3A; 4]| c[..3].iter().map(|v| v.dot(*v).sqrt()).fold(0.0, f32::max);
    largest(t.columns()) * largest(t.inverse().columns())
}

fn instanced_is_flattened(transforms: usize, rays: usize) {
    let mut rng = Rng(51);
    let (mut total, mut ties) = (0usize, 0usize);
    for _ in 0..transforms {
        let Some(to_world) = placement(&mut rng) else { continue };
        let mesh = presets::icosphere(2, 1.0);
        let flat = mapped(&mesh, |p| to_world.point(p));
        let instanced = tree(&one_instance(mesh, to_world));
        let flattened = {
            let mut world = World::default();
            world.add(flat);
            tree(&world)
        };
        for _ in 0..rays {
            let o = to_world.point(rng.direction() * 3.0);
            let target = to_world.point(rng.direction() * rng.range(0.0, 1.1));
            let Some(ray) = aimed(o, wide(target)) else { continue };
            total += 1;
            let (a, b) = (instanced.intersect(&ray), flattened.intersect(&ray));
            match (a, b) {
                (Some(a), Some(b)) if a.prim == b.prim => {
                    assert_eq!((a.inst, b.inst), (0, u32::MAX));
                    // Rounding moves the thinnest direction most; a ray at a glance makes more of it.
                    let far = (a.t - b.t).abs() / b.t / condition(&to_world);
                    assert!(far <= 1e-4, "{a:?} {b:?} {to_world:?}");
                    ties += usize::from(far > 1e-6);
                }
                (None, None) => {}
                _ => ties += 1,
            }
        }
    }
    println!("{ties} of {total} rays fall on the other side of an edge or glance off");
    assert!(total > transforms * rays / 2);
    assert!(ties as f64 <= 2e-4 * total as f64 + 2.0, "{ties} of {total}");
}

#[test]
fn instanced_equals_flattened() {
    instanced_is_flattened(100, 1000);
}

#[test]
#[ignore = "a million rays"]
fn instanced_equals_flattened_at_length() {
    instanced_is_flattened(1000, 1000);
}

#[test]
fn surfaces_are_placed_with_their_front_outside() {
    let mut rng = Rng(52);
    for _ in 0..200 {
        let Some(to_world) = placement(&mut rng) else { continue };
        let center = to_world.point(Vec3A::ZERO);
        for body in 0..2 {
            let mut world = one_instance(presets::icosphere(2, 1.0), to_world);
            if body == 1 {
                world.geometries = vec![Sphere::new(Vec3A::ZERO, 1.0).unwrap().into()];
            }
            let accel = tree(&world);
            for _ in 0..20 {
                let o = to_world.point(rng.direction() * 3.0);
                let Some(ray) = aimed(o, wide(to_world.point(rng.direction() * 0.5))) else { continue };
                let Some(hit) = accel.intersect(&ray) else { panic!("{ray:?} misses the middle") };
                let s = world.surface(&ray, &hit);
                assert_eq!((s.inst, s.geom), (0, 0));
                assert!(s.ng.dot(ray.d) < 0.0, "{s:?} is seen from inside: {to_world:?}");
                assert!(s.ng.dot(s.shading.z) > 0.0, "{s:?}");
                // The point lies on the ray, to within the rounding of both.
                let off = (s.p - ray.at(hit.t)).abs().max_element();
                let reach = (ray.o.abs() + center.abs() + (s.p - ray.o).abs()).max_element();
                assert!(off <= 1e-5 * reach / s.ng.dot(ray.d).abs().min(1.0), "{off} of {reach}: {s:?}");
            }
        }
    }
}

#[test]
fn masks_count_at_both_levels() {
    let mut world = one_instance(presets::icosphere(1, 1.0), Transform::IDENTITY);
    world.masks = vec![0b0110];
    world.instances[0].mask = 0b0011;
    let accel = tree(&world);
    let ray = |mask| Ray { mask, ..Ray::new(Vec3A::Z * 3.0, -Vec3A::Z) };
    for (mask, seen) in [(0b0010, true), (0b0001, false), (0b0100, false), (0b0101, true), (0b1000, false)] {
        assert_eq!(accel.occluded(&ray(mask)), seen, "{mask:b}");
    }
}

#[test]
fn equal_groups_share_a_hierarchy() {
    let mesh = presets::icosphere(4, 1.0);
    let bytes = |count: usize, shared: bool| {
        let mut world = World::default();
        world.geometries.push(mesh.clone().into());
        let group: Arc<[u32]> = Arc::new([0]);
        for i in 0..count {
            let geoms = if shared { group.clone() } else { Arc::new([0]) };
            let to_world = Transform::translation(Vec3A::X * (3.0 * i as f32));
            world.instances.push(Instance::new(geoms, to_world));
        }
        tree(&world).report().bytes
    };
    let one = bytes(1, true);
    assert!(bytes(50, true) < one + 50 * 400);
    assert_eq!(bytes(50, true), bytes(50, false), "equal lists are one group");
}

#[test]
fn many_instances_are_found_from_far_away() {
    // Far from the origin of the world, where rounding between the spaces is worst.
    let mut rng = Rng(53);
    let mut world = World::default();
    world.geometries.push(presets::cuboid(Vec3A::splat(-0.5), Vec3A::splat(0.5)).into());
    let group: Arc<[u32]> = Arc::new([0]);
    let at = Vec3A::new(3e5, -2e5, 4e5);
    for _ in 0..300 {
        let turn = Transform::rotation(rng.direction(), rng.range(0.0, 6.0));
        let to_world = Transform::translation(at + rng.point(20.0)).after(&turn).unwrap();
        world.instances.push(Instance::new(group.clone(), to_world));
    }
    let (accel, oracle) = (tree(&world), etendue_bvh::BruteForce::build(&world).unwrap());
    let mut hits = 0;
    for _ in 0..20_000 {
        let ray = Ray::new(at + rng.point(25.0), rng.direction());
        let hit = accel.intersect(&ray);
        assert_eq!(hit, oracle.intersect(&ray));
        hits += usize::from(hit.is_some());
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn edges_of_flat_instances_are_not_lost() {
    // Level squares under a shear that leaves them as they are. Their boxes end where they end, and the way to object
    // space mixes the large height of a far origin into the small coordinates: without slack for that, a ray at an
    // edge meets the square and not its box.
    let mut rng = Rng(54);
    let mut world = World::default();
    let shear = Transform::from_columns(Vec3A::X, Vec3A::new(7.3, 1.0, -4.1), Vec3A::Z, Vec3A::ZERO).unwrap();
    world.geometries.push(presets::quad(Vec3A::new(-0.5, 0.0, -0.5), Vec3A::Z, Vec3A::X).into());
    let group: Arc<[u32]> = Arc::new([0]);
    for i in 0..25 {
        let shift = Transform::translation(Vec3A::new((i % 5) as f32 * 1.5, 0.0, (i / 5) as f32 * 1.5));
        let to_world = shift.after(&shear).unwrap();
        world.instances.push(Instance::new(group.clone(), to_world));
    }
    let (accel, oracle) = (tree(&world), etendue_bvh::BruteForce::build(&world).unwrap());
    let mut hits = 0;
    for _ in 0..40_000 {
        let [.., at] = world.instances[rng.below(25)].to_world.columns();
        // Up to two millimetres beside the edge, less than the origin is rounded by.
        let side = 0.5 + rng.range(-0.002, 0.002);
        let (along, side) = (rng.range(-0.5, 0.5), if rng.below(2) == 0 { -side } else { side });
        let edge =
            at + if rng.below(2) == 0 { Vec3A::new(along, 0.0, side) } else { Vec3A::new(side, 0.0, along) };
        let o = edge + Vec3A::new(rng.range(-1.0, 1.0), 1e4, rng.range(-1.0, 1.0));
        let Some(ray) = aimed(o, wide(edge)) else { continue };
        let hit = accel.intersect(&ray);
        assert_eq!(hit, oracle.intersect(&ray), "{ray:?}");
        hits += usize::from(hit.is_some());
    }
    assert!(hits > 10_000, "{hits}");
}
