//! Hierarchies find what the exhaustive search finds.

mod common;

use std::sync::Arc;

use common::{Rng, aimed, power, soup, tree, wide};
use etendue_bvh::{
    Accel, BruteForce, BuildError, BuildOptions, HitFilter, Instance, Quality, TreeAccel, World,
};
use etendue_core::{Aabb, Fingerprint, Ray, Transform, Vec2, Vec3A};
use etendue_geometry::{
    Cylinder, Disc, Geometry, Hit, Parallelogram, Plane, Shape, ShapeHit, Sphere, Surface, TriangleMesh,
    presets,
};

/// A shape that enters by the door.
struct Foreign(Sphere);

impl Shape for Foreign {
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        self.0.intersect(ray)
    }
    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        self.0.surface(ray, hit)
    }
    fn fingerprint(&self, f: &mut Fingerprint) {
        self.0.fingerprint(f);
    }
}

/// Everything at once: meshes, all shapes, masks, instances of several groups, mirrored and sheared.
fn zoo(seed: u64) -> World {
    let mut rng = Rng(seed);
    let mut world = World::default();
    world.add(soup(&mut rng, 300, 4.0, 0.8));
    world.add(presets::icosphere(2, 1.5));
    for _ in 0..20 {
        world.add(Sphere::new(rng.point(4.0), rng.range(0.05, 0.8)).unwrap());
        let (o, u, v) = (rng.point(4.0), rng.point(1.0), rng.point(1.0));
        world.add(Parallelogram::new(o, u, v).unwrap());
        world.add(Disc::new(rng.point(4.0), rng.point(1.0), rng.range(0.05, 0.8)).unwrap());
        world.add(Cylinder::new(rng.point(4.0), rng.point(4.0), rng.range(0.05, 0.3)).unwrap());
        world.add(Geometry::open(Foreign(Sphere::new(rng.point(4.0), rng.range(0.05, 0.8)).unwrap())));
    }
    world.add(Cylinder::endless(rng.point(4.0), rng.point(1.0), 0.2).unwrap());
    world.add(Plane::new(Vec3A::new(0.0, -5.0, 0.0), Vec3A::new(0.1, 1.0, 0.0)).unwrap());
    world.masks = world.geometries.iter().map(|_| rng.bits() as u32 | 1).collect();
    // Two groups, each placed several times.
    let a = world.geometries.len() as u32;
    world.geometries.push(presets::cuboid(Vec3A::splat(-0.5), Vec3A::splat(0.5)).into());
    world.geometries.push(Sphere::new(Vec3A::X, 0.4).unwrap().into());
    world.geometries.push(soup(&mut rng, 50, 1.0, 0.5).into());
    world.geometries.push(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap().into());
    let groups: [Arc<[u32]>; 3] = [Arc::new([a, a + 1]), Arc::new([a + 2]), Arc::new([a + 3])];
    for i in 0..24 {
        let m = [rng.point(1.0), rng.point(1.0), rng.point(1.0)];
        let Ok(to_world) = Transform::from_columns(m[0], m[1], m[2], rng.point(4.0)) else { continue };
        let group = if i == 0 { 2 } else { rng.below(2) };
        let instance = Instance::new(groups[group].clone(), to_world);
        world.instances.push(Instance { mask: rng.bits() as u32 | 2, ..instance });
    }
    world
}

fn rays(rng: &mut Rng, count: usize, half: f32) -> Vec<Ray> {
    (0..count)
        .map(|i| {
            let mut ray = Ray::new(rng.point(half), rng.direction());
            if i % 3 == 0 {
                ray.t_max = rng.range(0.0, 6.0);
            }
            if i % 4 == 0 {
                ray.t_min = rng.range(-1.0, 1.0);
            }
            if i % 5 == 0 {
                // Along an axis, and in a plane of coordinates.
                ray.d = [Vec3A::X, -Vec3A::Y, Vec3A::Z, Vec3A::new(0.6, -0.0, -0.8)][rng.below(4)];
            }
            if i % 2 == 0 {
                ray.mask = rng.bits() as u32;
            }
            ray.t_max = if ray.t_max < ray.t_min { ray.t_min } else { ray.t_max };
            ray
        })
        .collect()
}

/// Keeps hits by a hash of what they are.
struct Coin;

impl HitFilter for Coin {
    fn keep(&self, ray_index: u32, _ray: &Ray, hit: &Hit) -> bool {
        let h =
            ray_index ^ hit.t.to_bits() ^ hit.prim.wrapping_mul(77) ^ hit.geom.wrapping_mul(1001) ^ hit.inst;
        h.wrapping_mul(0x9e37_79b1) >> 31 == 0
    }
}

#[test]
fn the_tree_finds_what_brute_force_finds() {
    for seed in 0..6 {
        let world = zoo(seed);
        let oracle = BruteForce::build(&world).unwrap();
        let accel = tree(&world);
        let mut rng = Rng(1000 + seed);
        let mut found = 0;
        for (i, ray) in rays(&mut rng, 3000, 6.0).iter().enumerate() {
            let expected = oracle.intersect(ray);
            assert_eq!(accel.intersect(ray), expected, "seed {seed}, ray {i}: {ray:?}");
            assert_eq!(accel.occluded(ray), expected.is_some(), "seed {seed}, ray {i}: {ray:?}");
            let filtered = oracle.intersect_filtered(ray, i as u32, &Coin);
            assert_eq!(accel.intersect_filtered(ray, i as u32, &Coin), filtered, "seed {seed}, ray {i}");
            assert_eq!(accel.occluded_filtered(ray, i as u32, &Coin), filtered.is_some());
            found += usize::from(expected.is_some());
        }
        assert!(found > 1500, "only {found} rays hit anything: the test says little");
        assert!(accel.bounds().lo.cmple(oracle.bounds().lo).all());
    }
}

#[test]
fn qualities_agree() {
    let mut rng = Rng(5);
    let mut world = World::default();
    world.add(soup(&mut rng, 5000, 4.0, 0.3));
    let accels: Vec<TreeAccel> = [Quality::Fast, Quality::Balanced, Quality::High]
        .map(|quality| {
            TreeAccel::build(&world, &BuildOptions { quality, ..BuildOptions::default() }, &|| false).unwrap()
        })
        .into();
    for ray in rays(&mut rng, 20_000, 5.0) {
        let hit = accels[0].intersect(&ray);
        assert!(accels.iter().all(|a| a.intersect(&ray) == hit), "{ray:?}");
    }
}

#[test]
fn the_order_of_objects_does_not_matter() {
    let mut rng = Rng(9);
    let meshes: Vec<TriangleMesh> = (0..8).map(|_| soup(&mut rng, 100, 2.0, 0.5)).collect();
    let mut forward = World::default();
    let mut backward = World::default();
    for m in &meshes {
        forward.add(m.clone());
    }
    for m in meshes.iter().rev() {
        backward.add(m.clone());
    }
    let (a, b) = (tree(&forward), tree(&backward));
    for ray in rays(&mut rng, 20_000, 3.0) {
        let ray = Ray { mask: u32::MAX, ..ray };
        let other = b.intersect(&ray).map(|h| Hit { geom: 7 - h.geom, ..h });
        assert_eq!(a.intersect(&ray), other);
    }
}

#[test]
fn equal_distances_go_to_the_lowest_ids() {
    let quad = presets::quad(Vec3A::new(-1.0, -1.0, 0.0), Vec3A::X * 2.0, Vec3A::Y * 2.0);
    let mut world = World::default();
    for _ in 0..20 {
        world.add(quad.clone());
    }
    let accel = tree(&world);
    let oracle = BruteForce::build(&world).unwrap();
    let mut rng = Rng(3);
    for _ in 0..2000 {
        let o = Vec3A::new(rng.range(-0.9, 0.9), rng.range(-0.9, 0.9), 3.0);
        let ray = aimed(o, wide(Vec3A::new(rng.range(-0.9, 0.9), rng.range(-0.9, 0.9), 0.0))).unwrap();
        let hit = accel.intersect(&ray).expect("the quads fill the view");
        assert_eq!(hit.geom, 0);
        assert_eq!(Some(hit), oracle.intersect(&ray));
    }
}

fn round(d: &Disc, s: f32) -> Geometry {
    Disc::new(d.center() * s, d.normal(), d.radius() * s).unwrap().into()
}

fn tube(c: &Cylinder, s: f32) -> Geometry {
    let (from, r) = (c.from() * s, c.radius() * s);
    match c.to() {
        Some(to) => Cylinder::new(from, to * s, r).unwrap().into(),
        None => Cylinder::endless(from, c.axis(), r).unwrap().into(),
    }
}

#[test]
fn scaling_by_a_power_of_two_changes_nothing() {
    let base = zoo(77);
    let accel = tree(&base);
    let mut rng = Rng(4);
    let rays = rays(&mut rng, 4000, 6.0);
    for k in [-40, -20, -7, 1, 13, 20, 40] {
        let s = power(k);
        let mut world = base.clone();
        for g in &mut world.geometries {
            *g = match &*g {
                Geometry::Mesh(m) => common::mapped(m, |p| p * s).into(),
                Geometry::Sphere(b) => Sphere::new(b.center() * s, b.radius() * s).unwrap().into(),
                // From the normal it was made of: making a unit vector unit again may move it.
                Geometry::Plane(p) => {
                    let n = if p.point().y < -1.0 { Vec3A::new(0.1, 1.0, 0.0) } else { Vec3A::Y };
                    Plane::new(p.point() * s, n).unwrap().into()
                }
                Geometry::Parallelogram(p) => {
                    Parallelogram::new(p.origin() * s, p.edge_u() * s, p.edge_v() * s).unwrap().into()
                }
                Geometry::Disc(d) => round(d, s),
                Geometry::Cylinder(c) => tube(c, s),
                // Bounds of a foreign sphere are a sphere again.
                Geometry::Open(o) => {
                    let b = o.bounds();
                    Sphere::new(b.center() * s, 0.5 * b.extent().x * s).unwrap().into()
                }
            };
        }
        for i in &mut world.instances {
            let [x, y, z, t] = i.to_world.columns();
            i.to_world = Transform::from_columns(x, y, z, t * s).unwrap();
        }
        // Compare like with like: the same replacement at the original scale.
        let mut reference = base.clone();
        for g in &mut reference.geometries {
            match &*g {
                Geometry::Open(o) => {
                    let b = o.bounds();
                    *g = Sphere::new(b.center(), 0.5 * b.extent().x).unwrap().into();
                }
                Geometry::Disc(d) => *g = round(d, 1.0),
                Geometry::Cylinder(c) => *g = tube(c, 1.0),
                _ => {}
            }
        }
        let (reference, scaled) = (tree(&reference), tree(&world));
        for ray in &rays {
            let big = Ray { o: ray.o * s, t_min: ray.t_min * s, t_max: ray.t_max * s, ..*ray };
            let expected = reference.intersect(ray).map(|h| Hit { t: h.t * s, ..h });
            let found = scaled.intersect(&big).map(|h| match world.geometries[h.geom as usize] {
                // Parameters of a plane are metres.
                Geometry::Plane(_) => Hit { uv: h.uv * power(-k), ..h },
                Geometry::Cylinder(c) if c.to().is_none() => {
                    Hit { uv: h.uv * Vec2::new(1.0, power(-k)), ..h }
                }
                _ => h,
            });
            assert_eq!(found, expected, "2^{k}: {ray:?}");
        }
    }
    assert!(accel.report().primitives > 0);
}

#[test]
fn invalid_rays_hit_nothing() {
    let world = zoo(1);
    let (accel, oracle) = (tree(&world), BruteForce::build(&world).unwrap());
    let good = Ray::new(Vec3A::ZERO, Vec3A::Z);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let mut rays = vec![
        Ray { d: Vec3A::ZERO, ..good },
        Ray { t_min: f32::NAN, ..good },
        Ray { t_max: f32::NAN, ..good },
        Ray { t_min: 2.0, t_max: 1.0, ..good },
    ];
    for b in bad {
        for axis in 0..3 {
            let (mut o, mut d) = (good.o, good.d);
            o[axis] = b;
            d[axis] = b;
            rays.push(Ray { o, ..good });
            rays.push(Ray { d, ..good });
        }
    }
    for ray in rays {
        assert_eq!(accel.intersect(&ray), None, "{ray:?}");
        assert_eq!(oracle.intersect(&ray), None, "{ray:?}");
        assert!(!accel.occluded(&ray) && !accel.occluded_filtered(&ray, 0, &Coin));
    }
}

#[test]
fn wrong_references_and_cancelling_are_errors() {
    let mut world = World::default();
    world.direct.push(3);
    assert!(matches!(BruteForce::build(&world), Err(BuildError::UnknownGeometry { geom: 3, .. })));
    let message = BruteForce::build(&world).unwrap_err().to_string();
    assert!(message.contains("geometry 3"), "{message}");
    let mut world = World::default();
    world.add(presets::icosphere(3, 1.0));
    let never = TreeAccel::build(&world, &BuildOptions::default(), &|| true);
    assert!(matches!(never, Err(BuildError::Cancelled)));
}

#[test]
fn an_empty_world_is_valid() {
    let accel = tree(&World::default());
    assert_eq!(accel.intersect(&Ray::new(Vec3A::ZERO, Vec3A::X)), None);
    assert!(accel.bounds().is_empty());
    let mut world = World::default();
    world.add(TriangleMesh::empty());
    world.instances.push(Instance::new(Arc::new([0]), Transform::IDENTITY));
    assert_eq!(tree(&world).intersect(&Ray::new(Vec3A::ZERO, Vec3A::X)), None);
}
