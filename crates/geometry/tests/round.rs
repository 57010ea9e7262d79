//! Discs and cylinders against twice the precision, far from the origin, at a glance and scaled.

mod common;

use common::{Rng, Twice, cross, dot, minus, point};
use etendue_core::{Aabb, Fingerprint, Frame, Ray, Vec2, Vec3A, vector};
use etendue_geometry::{Cylinder, Disc, Geometry, Parallelogram, Shape, ShapeError, ShapeHit, Surface};
use etendue_testkit::{Budget, check_shape};

fn ulps(a: f32, b: f64) -> f64 {
    (f64::from(a) - b).abs() / f64::from(a.abs().next_up() - a.abs())
}

/// Distance from the line `from` + s `axis`.
fn distance_to_line(p: Vec3A, from: Vec3A, axis: [Twice; 3]) -> f64 {
    let c = cross(minus(point(p), point(from)), axis);
    dot(c, c).sqrt().ratio(dot(axis, axis).sqrt())
}

/// Tubes seen from up to 10 000 radii away, most rays near the silhouette, some nearly along the axis.
#[test]
fn cylinders_are_right_from_far_away() {
    let mut rng = Rng(21);
    for distance in [1.5f32, 1e2, 1e3, 1e4] {
        const RAYS: u32 = 50_000;
        let (mut wrong, mut hits, mut worst_t, mut worst_p) = (0, 0, 0.0f64, 0.0f64);
        for _ in 0..RAYS {
            let (from, axis) = (rng.direction() * rng.unit(), rng.direction());
            let tube = Cylinder::endless(from, axis, 1.0).unwrap();
            let frame = Frame::from_normal(axis);
            let turn = rng.range(0.0, std::f32::consts::TAU);
            let around = |a: f32| frame.x * etendue_core::math::cos(a) + frame.y * etendue_core::math::sin(a);
            let o = from + around(turn) * distance + axis * (rng.range(-1.0, 1.0) * distance);
            let target =
                from + around(rng.range(0.0, 7.0)) * rng.range(0.0, 1.1) + axis * rng.range(-1.0, 1.0);
            let ray = Ray::new(o, vector::normalize(target - o));
            // |f + t d|² across the axis is r²: all terms times axis².
            let (f, d, a) = (minus(point(o), point(from)), point(ray.d), point(axis));
            let (fa, da) = (cross(f, a), cross(d, a));
            let (aa, b, r2) = (dot(da, da), dot(fa, da), dot(a, a));
            let discriminant = b * b - aa * (dot(fa, fa) - r2);
            let hit = tube.intersect(&ray);
            let scale = f64::from(distance * distance) * aa.hi;
            let tangent = discriminant.hi.abs() < 1e-12 * scale;
            let minus_b = Twice::new(0.0) - b;
            if discriminant.hi < 0.0 || tangent {
                wrong += u32::from(hit.is_some() && !tangent);
                continue;
            }
            let root = discriminant.sqrt();
            let (near, far) = ((minus_b - root).ratio(aa), (minus_b + root).ratio(aa));
            if far <= 0.0 {
                wrong += u32::from(hit.is_some());
                continue;
            }
            let Some(hit) = hit else {
                wrong += 1;
                continue;
            };
            hits += 1;
            worst_t = worst_t.max(ulps(hit.t, if near > 0.0 { near } else { far }));
            let s = tube.surface(&ray, &hit);
            let off = (distance_to_line(s.p, from, a) - 1.0).abs();
            worst_p = worst_p.max(off / f64::from(s.p_err.dot(s.ng.abs())));
        }
        println!(
            "distance {distance}: {wrong} wrong of {RAYS}, {hits} hits, t {worst_t:.3} ulp, off {worst_p:.3} bounds"
        );
        assert!(wrong == 0 && hits > RAYS / 2);
        assert!(worst_t <= 1.0, "t off by {worst_t} ulp from {distance}");
        assert!(worst_p <= 1.0, "the radius is off by {worst_p} error bounds from {distance}");
    }
}

/// The box of `p ± p_err` holds the plane and lies within the rim.
#[test]
fn discs_keep_their_points() {
    let mut rng = Rng(22);
    let mut hits = 0;
    for _ in 0..100_000 {
        let scale = rng.magnitude(-6.0, 6.0);
        let (c, r) = (rng.direction() * scale, scale * rng.magnitude(-4.0, 1.0));
        let disc = Disc::new(c, rng.direction(), r).unwrap();
        let o = c + rng.direction() * (scale * rng.range(0.1, 100.0));
        let target = c + Frame::from_normal(disc.normal()).to_world(rng.direction()) * r;
        let Some(d) = vector::try_normalize(target - o) else { continue };
        let ray = Ray::new(o, d);
        let Some(hit) = disc.intersect(&ray) else { continue };
        hits += 1;
        let s = disc.surface(&ray, &hit);
        let off = dot(minus(point(s.p), point(c)), point(disc.normal())).hi.abs();
        assert!(off <= f64::from(s.p_err.dot(s.ng.abs())) * 1.000001, "{ray:?} {disc:?}: {off}");
        let v = minus(point(s.p), point(c));
        assert!(dot(v, v).sqrt().hi <= f64::from(r) + f64::from(vector::length(s.p_err)) * 1.000001);
        let sample = disc.sample(Vec2::new(rng.unit(), rng.unit())).unwrap();
        let off = dot(minus(point(sample.p), point(c)), point(disc.normal())).hi.abs();
        assert!(off <= f64::from(sample.p_err.dot(s.ng.abs())) * 1.000001, "{sample:?} {disc:?}: {off}");
    }
    assert!(hits > 20_000, "{hits}");
}

/// What leaves a convex outside, or a plane, never comes back: coordinates and radii over many decades (as pbrt's
/// reintersection test has them).
#[test]
fn rays_that_leave_do_not_come_back() {
    let mut rng = Rng(23);
    let (mut asked, mut met) = (0u32, 0u32);
    for _ in 0..2_000 {
        let mut far = || rng.magnitude(-8.0, 8.0) * if rng.unit() < 0.5 { -1.0 } else { 1.0 };
        let p = Vec3A::new(far(), far(), far());
        let (r, length) = (rng.magnitude(-4.0, 4.0), rng.magnitude(-4.0, 4.0));
        let axis = rng.direction();
        let to = p + axis * length;
        let disc = Disc::new(p, axis, r).unwrap();
        let tube = Cylinder::new(p, to, r);
        let mut shapes: Vec<&dyn Shape> = vec![&disc];
        if let Ok(tube) = &tube {
            shapes.push(tube);
        }
        for shape in shapes {
            for _ in 0..50 {
                let Some(s) = shape.sample(Vec2::new(rng.unit(), rng.unit())) else { continue };
                let origin = etendue_core::Origin { p: s.p, p_err: s.p_err, ng: s.ng };
                for _ in 0..8 {
                    let d = rng.direction();
                    let d = if d.dot(s.ng) < 0.0 { -d } else { d };
                    asked += 1;
                    met += u32::from(shape.intersect(&origin.ray(d, 0.0)).is_some());
                }
            }
        }
    }
    println!("{met} of {asked} rays came back");
    assert!(asked > 1_000_000 && met == 0, "{met} of {asked}");
}

/// Every float of hit and surface is that of the unscaled shape times the power of its unit.
#[test]
fn scaling_by_powers_of_two_is_exact() {
    let mut rng = Rng(24);
    for _ in 0..2_000 {
        let (c, n, to, o) = (rng.direction(), rng.direction(), rng.direction() * 2.0, rng.direction() * 3.0);
        let (r, u) = (rng.range(0.1, 1.0), Vec2::new(rng.unit(), rng.unit()));
        let d = vector::normalize(c + (to - c) * rng.unit() + rng.direction() * r - o);
        for kind in 0..3 {
            let at = |s: f32| -> Vec<f32> {
                let shape: Box<dyn Shape> = match kind {
                    0 => Box::new(Disc::new(c * s, n, r * s).unwrap()),
                    1 => Box::new(Cylinder::new(c * s, to * s, r * s).unwrap()),
                    _ => Box::new(Cylinder::endless(c * s, n, r * s).unwrap()),
                };
                let mut out = vec![shape.area() / s / s];
                if let Some(x) = shape.sample(u) {
                    out.extend((x.p / s).to_array().into_iter().chain((x.p_err / s).to_array()));
                    out.push(x.pdf_area * s * s);
                }
                let ray = Ray::new(o * s, d);
                if let Some(h) = shape.intersect(&ray) {
                    let x = shape.surface(&ray, &h);
                    out.extend([h.t / s, h.uv.x, if kind == 2 { h.uv.y / s } else { h.uv.y }]);
                    out.extend(
                        [x.p / s, x.p_err / s, x.ng, x.dpdu / s].into_iter().flat_map(|v| v.to_array()),
                    );
                }
                let b = shape.bounds();
                out.extend([b.lo / s, b.hi / s].into_iter().flat_map(|v| v.to_array()));
                out
            };
            let plain = at(1.0);
            for k in [-20, -1, 7, 20] {
                assert_eq!(at(2f32.powi(k)), plain, "kind {kind}, 2^{k}");
            }
        }
    }
}

/// Closed forms, and rays along axes and rims.
#[test]
fn simple_cases() {
    let pi = std::f32::consts::PI;
    let disc = Disc::new(Vec3A::Y, Vec3A::Y * 7.0, 2.0).unwrap();
    assert!((disc.area() / (4.0 * pi) - 1.0).abs() < 1e-6 && disc.normal() == Vec3A::Y);
    let down = |x: f32| disc.intersect(&Ray::new(Vec3A::new(x, 5.0, 0.0), Vec3A::NEG_Y));
    assert!(down(1.999).is_some() && down(2.0).is_some() && down(2.0001).is_none());
    assert_eq!(down(0.0).map(|h| (h.t, h.uv)), Some((4.0, Vec2::splat(0.5))));
    assert!(disc.intersect(&Ray::new(Vec3A::new(-5.0, 1.0, 0.0), Vec3A::X)).is_none(), "edge-on");
    let b = disc.bounds();
    assert!((b.lo - Vec3A::new(-2.0, 1.0, -2.0)).abs().max_element() < 1e-6 && b.lo.y < 1.0 && b.hi.y > 1.0);

    let tube = Cylinder::new(Vec3A::ZERO, Vec3A::Z * 3.0, 0.5).unwrap();
    assert!((tube.area() / (3.0 * pi) - 1.0).abs() < 1e-6);
    assert_eq!((tube.length(), tube.axis(), tube.radius(), tube.from()), (3.0, Vec3A::Z, 0.5, Vec3A::ZERO));
    let inward = |z: f32| tube.intersect(&Ray::new(Vec3A::new(2.0, 0.0, z), Vec3A::NEG_X));
    assert_eq!(inward(1.5).map(|h| (h.t, h.uv)), Some((1.5, Vec2::new(0.0, 0.5))));
    assert!(
        inward(0.0).is_some() && inward(3.0).is_some() && inward(-1e-6).is_none() && inward(3.0001).is_none()
    );
    // Through the open end onto the inside.
    let ray = Ray::new(Vec3A::new(0.0, 0.0, -1.0), vector::normalize(Vec3A::new(0.5, 0.0, 2.0)));
    let hit = tube.intersect(&ray).unwrap();
    let s = tube.surface(&ray, &hit);
    assert!((s.p - Vec3A::new(0.5, 0.0, 1.0)).abs().max_element() < 1e-6 && s.ng.dot(ray.d) > 0.0);
    assert!(tube.intersect(&Ray::new(Vec3A::new(0.1, 0.0, -1.0), Vec3A::Z)).is_none(), "along the axis");
    // The azimuth grows to the right of who stands outside with the axis up, as on the sphere.
    let front = tube.surface(
        &Ray::new(Vec3A::new(0.0, -2.0, 1.0), Vec3A::Y),
        &tube.intersect(&Ray::new(Vec3A::new(0.0, -2.0, 1.0), Vec3A::Y)).unwrap(),
    );
    assert!(front.dpdu.x > 3.0 && front.dpdv == Vec3A::Z * 3.0 && front.uv[0].x == 0.75);
    let endless = Cylinder::endless(Vec3A::ZERO, Vec3A::Z, 0.5).unwrap();
    assert!(
        endless.area() == 0.0 && endless.bounds() == Aabb::INFINITE && endless.sample(Vec2::ZERO).is_none()
    );
    assert!(endless.intersect(&Ray::new(Vec3A::new(2.0, 0.0, 1e6), Vec3A::NEG_X)).is_some());
}

#[test]
fn what_is_no_shape_is_refused() {
    let nan = Vec3A::splat(f32::NAN);
    assert!(matches!(Disc::new(nan, Vec3A::Y, 1.0), Err(ShapeError::NotFinite { .. })));
    assert!(matches!(Disc::new(Vec3A::ZERO, nan, 1.0), Err(ShapeError::NotFinite { .. })));
    assert!(matches!(Disc::new(Vec3A::ZERO, Vec3A::Y, f32::INFINITY), Err(ShapeError::NotFinite { .. })));
    assert_eq!(Disc::new(Vec3A::ZERO, Vec3A::ZERO, 1.0), Err(ShapeError::ZeroNormal { shape: "disc" }));
    let e = Disc::new(Vec3A::ZERO, Vec3A::Y, -1.0).expect_err("no radius");
    assert!(e.to_string().starts_with("disc: the radius"), "{e}");
    assert_eq!(Cylinder::new(Vec3A::ONE, Vec3A::ONE, 1.0), Err(ShapeError::NoAxis));
    assert_eq!(Cylinder::endless(Vec3A::ONE, Vec3A::ZERO, 1.0), Err(ShapeError::NoAxis));
    assert!(matches!(Cylinder::new(Vec3A::ONE, nan, 1.0), Err(ShapeError::NotFinite { .. })));
    assert!(matches!(Cylinder::new(Vec3A::ONE, Vec3A::X, 0.0), Err(ShapeError::Radius { .. })));
}

/// The sizes that hierarchies and scenes hold by value stay those of a parallelogram.
#[test]
fn the_closed_set_has_not_grown() {
    assert!(size_of::<Disc>() <= size_of::<Parallelogram>());
    assert!(size_of::<Cylinder>() <= size_of::<Parallelogram>());
    assert_eq!(size_of::<Geometry>(), size_of::<Parallelogram>() + 16);
}

#[test]
fn digests_tell_shapes_apart() {
    let shapes: [Geometry; 5] = [
        Disc::new(Vec3A::ZERO, Vec3A::Y, 1.0).unwrap().into(),
        Disc::new(Vec3A::ZERO, Vec3A::Y, 2.0).unwrap().into(),
        Cylinder::new(Vec3A::ZERO, Vec3A::Y, 1.0).unwrap().into(),
        Cylinder::endless(Vec3A::ZERO, Vec3A::Y, 1.0).unwrap().into(),
        Cylinder::new(Vec3A::ZERO, Vec3A::Z, 1.0).unwrap().into(),
    ];
    let digests: std::collections::BTreeSet<u128> = shapes
        .iter()
        .map(|s| {
            let mut f = Fingerprint::default();
            s.fingerprint(&mut f);
            assert!(!f.is_opaque());
            f.value()
        })
        .collect();
    assert_eq!(digests.len(), shapes.len());
}

/// A part with one thing wrong.
struct Wrong<T> {
    shape: T,
    surface: fn(&mut Surface),
    hit: fn(&Ray, ShapeHit) -> Option<ShapeHit>,
    area: f32,
}

impl<T: Shape> Shape for Wrong<T> {
    fn bounds(&self) -> Aabb {
        self.shape.bounds()
    }
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        self.shape.intersect(ray).and_then(|h| (self.hit)(ray, h))
    }
    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let mut s = self.shape.surface(ray, hit);
        (self.surface)(&mut s);
        s
    }
    fn area(&self) -> f32 {
        self.shape.area() * self.area
    }
    fn sample(&self, u: Vec2) -> Option<etendue_geometry::ShapeSample> {
        self.shape.sample(u)
    }
}

/// The suite sees what could be wrong with these two.
#[test]
fn mutants_are_rejected() {
    let disc = Disc::new(Vec3A::new(3.0, 1.0, -2.0), Vec3A::new(0.3, 1.0, 0.2), 0.8).unwrap();
    let tube = Cylinder::new(Vec3A::new(3.0, 1.0, -2.0), Vec3A::new(4.0, 2.0, -1.0), 0.8).unwrap();
    fn none(_: &mut Surface) {}
    fn same(_: &Ray, h: ShapeHit) -> Option<ShapeHit> {
        Some(h)
    }
    let verdict = |shape: &dyn Shape| check_shape(shape, &Budget::default()).map_err(|f| f.test);
    assert!(verdict(&disc).is_ok() && verdict(&tube).is_ok());
    assert_eq!(verdict(&Wrong { shape: disc, surface: none, hit: same, area: 0.93 }), Err("area"));
    assert_eq!(verdict(&Wrong { shape: tube, surface: none, hit: same, area: 1.07 }), Err("area"));
    let no_bound = |s: &mut Surface| s.p_err = Vec3A::ZERO;
    assert_eq!(verdict(&Wrong { shape: tube, surface: no_bound, hit: same, area: 1.0 }), Err("self-hit"));
    assert_eq!(verdict(&Wrong { shape: disc, surface: no_bound, hit: same, area: 1.0 }), Err("self-hit"));
    let swapped = |s: &mut Surface| std::mem::swap(&mut s.dpdu, &mut s.dpdv);
    assert_eq!(verdict(&Wrong { shape: tube, surface: swapped, hit: same, area: 1.0 }), Err("derivatives"));
    // A tube that is closed by its ends' discs would have another outline; one that forgets half of itself has less.
    let half = |_: &Ray, h: ShapeHit| (h.uv.y < 0.5).then_some(h);
    assert!(verdict(&Wrong { shape: tube, surface: none, hit: half, area: 1.0 }).is_err());
}
