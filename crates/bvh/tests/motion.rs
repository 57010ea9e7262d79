//! Moving instances: the tree finds what testing everything finds, at every moment, and it is where it should be.

mod common;

use std::sync::Arc;

use common::{Rng, aimed, soup, tree, wide};
use etendue_bvh::{Accel, BruteForce, HitFilter, Instance, World};
use etendue_core::{Motion, Ray, Transform, Vec3A, vector};
use etendue_geometry::{Hit, Plane, Sphere, presets};

fn motion(rng: &mut Rng, around: Vec3A, reach: f32) -> Motion {
    let angle = match rng.below(4) {
        0 => 0.0,
        1 => rng.range(-0.5, 0.5),
        2 => rng.range(-6.0, 6.0),
        _ => rng.range(-60.0, 60.0),
    };
    let travel = if rng.below(3) == 0 { Vec3A::ZERO } else { rng.point(reach) };
    Motion::new(rng.direction(), angle, around + rng.point(0.5 * reach), travel).unwrap()
}

/// Meshes and spheres, sheared and mirrored, standing in the world, placed, and moving.
fn crowd(rng: &mut Rng, center: Vec3A, count: usize) -> World {
    let mut world = World::default();
    world.add(soup(rng, 20, 3.0, 0.5));
    world.geometries.push(soup(rng, 60, 1.0, 0.5).into());
    world.geometries.push(Sphere::new(Vec3A::X, 0.4).unwrap().into());
    world.geometries.push(presets::icosphere(1, 0.7).into());
    let groups: [Arc<[u32]>; 3] = [Arc::new([1, 2]), Arc::new([3]), Arc::new([2])];
    while world.instances.len() < count {
        let m = [rng.point(1.0), rng.point(1.0), rng.point(1.0)];
        let at = center + rng.point(6.0);
        let Ok(to_world) = Transform::from_columns(m[0], m[1], m[2], at) else { continue };
        let mut instance = Instance::new(groups[rng.below(3)].clone(), to_world);
        if rng.below(3) > 0 {
            instance = instance.with_motion(motion(rng, at, 5.0));
        }
        instance.mask = rng.bits() as u32 | 2;
        world.instances.push(instance);
    }
    world
}

/// Keeps about half of the hits, by where they are and when.
struct Half<'a>(&'a World);

impl HitFilter for Half<'_> {
    fn keep(&self, _ray_index: u32, ray: &Ray, hit: &Hit) -> bool {
        let p = self.0.alpha_attributes(ray, hit).p;
        (p.x + p.y + p.z + ray.time).rem_euclid(0.2) < 0.1
    }
}

#[test]
fn the_tree_finds_what_testing_everything_finds() {
    let mut rng = Rng(61);
    let (mut hits, mut moving, mut frozen_differs) = (0, 0, 0);
    for round in 0..12 {
        let center = if round % 3 == 2 { Vec3A::new(3e4, -2e4, 4e4) } else { Vec3A::ZERO };
        let world = crowd(&mut rng, center, 10 + 8 * round);
        let (accel, oracle) = (tree(&world), BruteForce::build(&world).unwrap());
        let (a, b) = (accel.bounds(), oracle.bounds());
        assert!((a.lo - b.lo).abs().max_element() <= 1e-2 && (a.hi - b.hi).abs().max_element() <= 1e-2);
        for i in 0..1_500 {
            let time = if i % 50 == 0 { 0.0 } else { rng.unit() };
            let mut ray = Ray::new(center + rng.point(9.0), rng.direction());
            if i % 4 > 0 {
                // At something, where it is then.
                let instance = &world.instances[rng.below(world.instances.len())];
                let placed = instance.motion.as_ref().map(|m| m.placement(&instance.to_world, time));
                let target = placed.unwrap_or(instance.to_world).point(rng.point(0.7));
                let Some(aimed) = aimed(ray.o, wide(target)) else { continue };
                ray = aimed;
            }
            ray.time = time;
            ray.mask = if i % 5 == 0 { 4 } else { u32::MAX };
            if i % 3 == 0 {
                ray.t_max = rng.range(0.0, 12.0);
            }
            let hit = accel.intersect(&ray);
            assert_eq!(hit, oracle.intersect(&ray), "{ray:?}");
            assert_eq!(accel.occluded(&ray), hit.is_some());
            let filter = Half(&world);
            let kept = accel.intersect_filtered(&ray, 0, &filter);
            assert_eq!(kept, oracle.intersect_filtered(&ray, 0, &filter), "{ray:?}");
            assert_eq!(accel.occluded_filtered(&ray, 0, &filter), kept.is_some());
            let Some(hit) = hit else { continue };
            hits += 1;
            if world.instances.get(hit.inst as usize).is_some_and(|i| i.motion.is_some()) {
                moving += 1;
                let s = world.surface(&ray, &hit);
                assert_eq!(s.time, ray.time);
                assert!(accel.bounds().contains(s.p));
                let off = vector::length(s.p - ray.at(hit.t));
                let reach = vector::length(ray.o) + hit.t;
                assert!(off <= 3e-5 * reach / s.ng.dot(ray.d).abs().max(1e-3), "{off}: {s:?}");
                // Mutant: all of it at time 0.
                frozen_differs += usize::from(accel.intersect(&Ray { time: 0.0, ..ray }) != Some(hit));
            }
        }
    }
    assert!(
        hits > 6_000 && moving > 3_000 && frozen_differs > moving / 2,
        "{hits} {moving} {frozen_differs}"
    );
}

/// At each moment the moving world is the still one with everything at its place of that moment.
#[test]
fn a_moment_is_a_still_world() {
    let mut rng = Rng(62);
    let (mut same, mut other) = (0, 0);
    for _ in 0..8 {
        let world = crowd(&mut rng, Vec3A::ZERO, 40);
        let accel = tree(&world);
        for t in [0.0, 0.3, 0.999] {
            let mut still = world.clone();
            for i in &mut still.instances {
                let Some(motion) = i.motion.take() else { continue };
                let [x, y, z, o] = motion.placement(&i.to_world, t).columns();
                i.to_world = Transform::from_columns(x, y, z, o).unwrap();
            }
            let frozen = tree(&still);
            for _ in 0..2_000 {
                let ray = Ray { time: t, ..Ray::new(rng.point(9.0), rng.direction()) };
                match (accel.intersect(&ray), frozen.intersect(&ray)) {
                    (Some(a), Some(b)) if (a.inst, a.geom, a.prim) == (b.inst, b.geom, b.prim) => {
                        let (p, q) = (world.surface(&ray, &a), still.surface(&ray, &b));
                        let cos = p.ng.dot(ray.d).abs().max(1e-3);
                        // Flat ones move their points most.
                        let bound = vector::length(p.p_err + q.p_err);
                        assert!(vector::length(p.p - q.p) <= bound / cos, "{p:?} {q:?}");
                        assert!(vector::length(p.ng - q.ng) <= 1e-3, "{p:?} {q:?}");
                        same += 1;
                    }
                    (None, None) => {}
                    _ => other += 1,
                }
            }
        }
    }
    println!("{other} of {same} rays fall on the other side of an edge");
    assert!(same > 3_000 && other <= 4, "{same} {other}");
}

/// As in `instances.rs`: level squares under a shear, whose boxes end where they end, seen from far away. Here they
/// move.
#[test]
fn edges_of_moving_flat_instances_are_not_lost() {
    let mut rng = Rng(63);
    let mut world = World::default();
    let shear =
        Transform::from_columns(Vec3A::X, Vec3A::new(73.0, 1.0, -41.0), Vec3A::Z, Vec3A::ZERO).unwrap();
    world.geometries.push(presets::quad(Vec3A::new(-0.5, 0.0, -0.5), Vec3A::Z, Vec3A::X).into());
    let group: Arc<[u32]> = Arc::new([0]);
    for i in 0..25 {
        let at = Vec3A::new((i % 5) as f32 * 1.5, 0.0, (i / 5) as f32 * 1.5);
        let to_world = Transform::translation(at).after(&shear).unwrap();
        // In their own plane, so that the boxes stay flat.
        let motion =
            Motion::new(Vec3A::Y, rng.range(-0.4, 0.4), at, Vec3A::X * rng.range(-0.2, 0.2)).unwrap();
        world.instances.push(Instance::new(group.clone(), to_world).with_motion(motion));
    }
    let (accel, oracle) = (tree(&world), BruteForce::build(&world).unwrap());
    let mut hits = 0;
    for _ in 0..40_000 {
        let instance = &world.instances[rng.below(25)];
        let time = [0.0, 1.0, rng.unit()][rng.below(3)];
        let placed = instance.motion.as_ref().unwrap().placement(&instance.to_world, time);
        let side = 0.5 + rng.range(-0.02, 0.02);
        let (along, side) = (rng.range(-0.5, 0.5), if rng.below(2) == 0 { -side } else { side });
        let local = if rng.below(2) == 0 { [along, side] } else { [side, along] };
        let edge = placed.point(Vec3A::new(local[0], 0.0, local[1]));
        let o = edge + Vec3A::new(rng.range(-1.0, 1.0), 1e4, rng.range(-1.0, 1.0));
        let Some(ray) = aimed(o, wide(edge)) else { continue };
        let ray = Ray { time, ..ray };
        let hit = accel.intersect(&ray);
        assert_eq!(hit, oracle.intersect(&ray), "{ray:?}");
        hits += usize::from(hit.is_some());
    }
    assert!(hits > 5_000, "{hits}");
}

/// Rays that leave a moving convex body outward do not meet it again, and inward they do.
#[test]
fn rays_leave_what_moves_without_an_epsilon() {
    let mut rng = Rng(64);
    let (mut left, mut entered) = (0, 0);
    for round in 0..60 {
        let mut world = World::default();
        world.geometries.push(if round % 2 == 0 {
            presets::icosphere(2, 1.0).into()
        } else {
            Sphere::new(Vec3A::ZERO, 1.0).unwrap().into()
        });
        let at = rng.point(100.0);
        let scale = Vec3A::new(rng.range(0.5, 2.0), rng.range(0.5, 2.0), -rng.range(0.5, 2.0));
        let turn = Transform::rotation(rng.direction(), rng.range(0.0, 6.0));
        let turned = turn.after(&Transform::scale(scale).unwrap()).unwrap();
        let to_world = Transform::translation(at).after(&turned).unwrap();
        let motion = motion(&mut rng, at, 30.0);
        world.instances.push(Instance::new(Arc::new([0]), to_world).with_motion(motion));
        let accel = tree(&world);
        for _ in 0..300 {
            let time = rng.unit();
            let placed = motion.placement(&to_world, time);
            let (o, target) = (placed.point(rng.direction() * 3.0), placed.point(rng.direction() * 0.9));
            let Some(ray) = aimed(o, wide(target)) else { continue };
            let ray = Ray { time, ..ray };
            let Some(hit) = accel.intersect(&ray) else { continue };
            let s = world.surface(&ray, &hit);
            let d = rng.direction();
            if d.dot(s.ng).abs() < 1e-2 {
                continue;
            }
            let away = s.origin().ray(d, time);
            if d.dot(s.ng) > 0.0 {
                assert!(!accel.occluded(&away), "{away:?} meets what it left: {s:?}");
                left += 1;
            } else {
                assert!(accel.occluded(&away), "{away:?} falls through: {s:?}");
                entered += 1;
            }
        }
    }
    assert!(left > 5_000 && entered > 5_000, "{left} {entered}");
}

#[test]
fn what_moves_nowhere_is_still_and_what_has_no_bounds_may_move() {
    let group: Arc<[u32]> = Arc::new([0]);
    let still =
        Instance::new(group.clone(), Transform::IDENTITY).with_motion(Motion::travel(Vec3A::ZERO).unwrap());
    assert!(still.motion.is_none());
    let mut world = World::default();
    world.geometries.push(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap().into());
    let motion = Motion::travel(Vec3A::Y * 2.0).unwrap();
    world.instances.push(Instance::new(group, Transform::IDENTITY).with_motion(motion));
    let (accel, oracle) = (tree(&world), BruteForce::build(&world).unwrap());
    for time in [0.0, 0.25, 0.5] {
        let ray = Ray { time, ..Ray::new(Vec3A::Y * 10.0, Vec3A::NEG_Y) };
        let hit = accel.intersect(&ray);
        assert_eq!(hit, oracle.intersect(&ray));
        assert_eq!(hit.unwrap().t, 10.0 - 2.0 * time);
    }
}

/// No time is an error.
#[test]
fn odd_times_are_the_nearer_end() {
    let mut rng = Rng(65);
    let world = crowd(&mut rng, Vec3A::ZERO, 30);
    let accel = tree(&world);
    for _ in 0..500 {
        let ray = Ray::new(rng.point(9.0), rng.direction());
        let at = |time| accel.intersect(&Ray { time, ..ray });
        assert_eq!(at(f32::NAN), at(0.0));
        assert_eq!(at(-1.0), at(0.0));
        assert_eq!(at(7.0), at(1.0));
    }
}
