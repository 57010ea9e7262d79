//! Motions: rigid, at rest at the start, held by their boxes.

use etendue_core::glam::DVec3;
use etendue_core::{Aabb, Fingerprint, Motion, MotionError, Transform, Vec3A, vector};

/// A plain generator (splitmix64).
struct Rng(u64);

impl Rng {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
    fn vector(&mut self) -> Vec3A {
        let mut x = || (2.0 * self.unit() - 1.0) as f32;
        Vec3A::new(x(), x(), x())
    }
    fn direction(&mut self) -> Vec3A {
        loop {
            let v = self.vector();
            if v.dot(v) > 1e-3 && v.dot(v) < 1.0 {
                return vector::normalize(v);
            }
        }
    }
    /// 10^U(-e, e).
    fn magnitude(&mut self, e: f64) -> f32 {
        10f64.powf(e * (2.0 * self.unit() - 1.0)) as f32
    }
    /// Anything from a shiver to many turns, near and far.
    fn motion(&mut self) -> Motion {
        let angle = match (self.unit() * 4.0) as u32 {
            0 => 0.0,
            1 => self.magnitude(3.0),
            2 => -(self.unit() as f32) * 3.0,
            _ => 30.0 * (self.unit() as f32 - 0.5),
        };
        let (far, travel) = (self.magnitude(3.0), self.magnitude(2.0));
        Motion::new(self.vector(), angle, self.vector() * far, self.vector() * travel).unwrap()
    }
    fn placement(&mut self) -> Transform {
        let scale = Vec3A::new(self.magnitude(1.0), self.magnitude(1.0), -self.magnitude(1.0));
        let turn = Transform::rotation(self.direction(), 6.0 * self.unit() as f32);
        let shift = Transform::translation(self.vector() * self.magnitude(3.0));
        shift.after(&turn.after(&Transform::scale(scale).unwrap()).unwrap()).unwrap()
    }
}

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(v.x.into(), v.y.into(), v.z.into())
}

/// The definition, in double precision with the standard library's functions.
fn displaced(p: DVec3, axis: Vec3A, angle: f32, pivot: Vec3A, travel: Vec3A, t: f32) -> DVec3 {
    let (n, t) = (wide(axis).normalize(), f64::from(t));
    let q = p - wide(pivot);
    let (s, c) = (f64::from(angle) * t).sin_cos();
    wide(pivot) + wide(travel) * t + q * c + n.cross(q) * s + n * (n.dot(q) * (1.0 - c))
}

#[test]
fn points_go_where_the_definition_says() {
    let mut rng = Rng(1);
    let mut squared = 0;
    for _ in 0..20_000 {
        let (axis, angle) = (rng.vector() * rng.magnitude(8.0), 40.0 * (rng.unit() as f32 - 0.5));
        let (pivot, travel) = (rng.vector() * 5.0, rng.vector() * 3.0);
        let motion = Motion::new(axis, angle, pivot, travel).unwrap();
        let (p, t) = (rng.vector() * 4.0, rng.unit() as f32);
        let truth = displaced(wide(p), axis, angle, pivot, travel, t);
        let placed = motion.at(t);
        let (q, err) = placed.point_with_error(p, Vec3A::ZERO);
        // The entries were rounded too: as much again.
        assert!((wide(q) - truth).abs().cmple(wide(err) * 2.0).all(), "{q} for {truth}");
        // Mutant: accelerated.
        squared += usize::from((wide(motion.at(t * t).point(p)) - truth).length() > 1e-3);
    }
    assert!(squared > 19_000, "{squared}");
}

#[test]
fn motions_are_rigid_start_at_rest_and_have_an_inverse() {
    let mut rng = Rng(2);
    for _ in 0..20_000 {
        let motion = rng.motion();
        assert_eq!(motion.at(0.0), Transform::IDENTITY);
        assert_eq!(motion.at(-3.0), Transform::IDENTITY);
        assert_eq!(motion.at(f32::NAN), Transform::IDENTITY);
        assert_eq!(motion.at(1.0), motion.at(2.0));
        let m = motion.at(rng.unit() as f32);
        assert!(!m.mirrors());
        let [x, y, z, _] = m.columns().map(wide);
        for e in [x.dot(y), y.dot(z), z.dot(x), x.length() - 1.0, y.length() - 1.0, x.cross(y).dot(z) - 1.0] {
            assert!(e.abs() < 3e-7, "{e:e}");
        }
        // The linear parts undo each other by transposition, to the bit.
        let [ix, iy, iz, _] = m.inverse().columns();
        let [x, y, z, _] = m.columns();
        assert_eq!([x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z], {
            [ix.x, ix.y, ix.z, iy.x, iy.y, iy.z, iz.x, iz.y, iz.z]
        });
        let (p, e) = m.point_with_error(rng.vector(), Vec3A::ZERO);
        let (back, e) = m.inverse().point_with_error(p, e * 2.0);
        let (forth, e) = m.point_with_error(back, e * 2.0);
        assert!((forth - p).abs().cmple(e * 2.0).all(), "{forth} {p}");
    }
}

#[test]
fn placements_are_displacements_after_the_start() {
    let mut rng = Rng(3);
    for _ in 0..20_000 {
        let (motion, start, t) = (rng.motion(), rng.placement(), rng.unit() as f32);
        let placed = motion.placement(&start, t);
        assert_eq!(motion.placement(&start, 0.0).columns(), start.columns());
        assert_eq!(placed.mirrors(), start.mirrors());
        let p = rng.vector();
        let (q, err) = placed.point_with_error(p, Vec3A::ZERO);
        let (s, s_err) = start.point_with_error(p, Vec3A::ZERO);
        let (twice, twice_err) = motion.at(t).point_with_error(s, s_err);
        assert!((q - twice).abs().cmple(err * 2.0 + twice_err * 2.0).all(), "{q} {twice}");
        // There and back, with a bound from the magnitudes at play.
        let [x, y, z, o] = placed.inverse().columns().map(Vec3A::abs);
        let a = q.abs() + err * 2.0;
        let bound = (x * a.x + y * a.y + z * a.z + o) * 1e-6;
        assert!((placed.inverse().point(q) - p).abs().cmple(bound).all());
    }
}

#[test]
fn boxes_hold_every_moment() {
    let mut rng = Rng(4);
    let (mut checked, mut missed_by_ends) = (0, 0);
    for i in 0..4_000 {
        let (motion, start) = (rng.motion(), rng.placement());
        let b = Aabb::of_points([rng.vector(), rng.vector()]);
        let start = if i % 2 == 0 { Transform::IDENTITY } else { start };
        let held = motion.bounds_after(&start, &b);
        if i % 2 == 0 {
            assert_eq!(held, motion.bounds_of(&b));
        }
        let ends = motion.placement(&start, 0.0).aabb(&b).union(motion.placement(&start, 1.0).aabb(&b));
        for k in 0..40 {
            let t = if k == 0 { 1.0 } else { rng.unit() as f32 };
            let w = rng.vector() * 0.5 + Vec3A::splat(0.5);
            let corner = b.corners()[k % 8];
            let p = if k % 3 == 0 { b.lo + (b.hi - b.lo) * w } else { corner };
            let q = motion.placement(&start, t).point(p);
            assert!(held.contains(q), "{q} at {t} outside of {held:?}: {motion:?} {start:?}");
            checked += 1;
            // Mutant: the two ends alone.
            missed_by_ends += usize::from(!ends.contains(q));
        }
    }
    assert!(missed_by_ends > checked / 20, "{missed_by_ends} of {checked}");
}

/// Against the box of 20,000 moments, which is short of the smallest by nothing that shows.
#[test]
fn boxes_are_tight() {
    let mut rng = Rng(5);
    for _ in 0..300 {
        let (start, angle) = (rng.placement(), 24.0 * (rng.unit() as f32 - 0.5));
        let far = rng.magnitude(2.0);
        let pivot = start.columns()[3] + rng.vector() * far;
        let travel = rng.vector() * rng.magnitude(2.0);
        let motion = Motion::new(rng.direction(), angle, pivot, travel).unwrap();
        let b = Aabb::of_points([rng.vector(), rng.vector()]);
        let held = motion.bounds_after(&start, &b);
        let mut found = Aabb::EMPTY;
        let mut radius = 0.0f32;
        for k in 0..=20_000u32 {
            let m = motion.placement(&start, k as f32 / 20_000.0);
            found = b.corners().into_iter().fold(found, |f, c| f.grown(m.point(c)));
        }
        for c in b.corners() {
            radius = radius.max(vector::length(start.point(c) - pivot));
        }
        let largest = held.lo.abs().max_element().max(held.hi.abs().max_element());
        let slack = 0.005 * radius.min(radius * angle * angle) + 4e-6 * (largest + radius + far);
        let over = (found.lo - held.lo).max_element().max((held.hi - found.hi).max_element());
        assert!(over <= slack, "{over} of {radius}, slack {slack}: {motion:?}");
    }
}

#[test]
fn many_turns_are_a_body_of_revolution() {
    let b = Aabb { lo: Vec3A::new(2.9, -0.5, -0.1), hi: Vec3A::new(3.0, 0.5, 0.1) };
    let r = (9.01f32).sqrt();
    for angle in [26.0f32, 1e3, -1e6, 3e38] {
        let held = Motion::turn(Vec3A::Y, angle, Vec3A::ZERO).unwrap().bounds_of(&b);
        let truth = Aabb { lo: Vec3A::new(-r, -0.5, -r), hi: Vec3A::new(r, 0.5, r) };
        assert!((held.lo - truth.lo).abs().max_element() < 4e-6, "{held:?}");
        assert!((held.hi - truth.hi).abs().max_element() < 4e-6, "{held:?}");
        assert!(held.contains(truth.lo) && held.contains(truth.hi));
    }
    // Along the axis nothing is added, however far the pivot.
    let held = Motion::turn(Vec3A::Y, 1.0, Vec3A::X * 1e5).unwrap().bounds_of(&b);
    assert!((held.hi.y - 0.5).abs() < 1e-6 && held.hi.z > 1e4, "{held:?}");
    assert!(Motion::travel(Vec3A::X).unwrap().bounds_of(&Aabb::EMPTY).is_empty());
    assert_eq!(Motion::travel(Vec3A::X).unwrap().bounds_of(&Aabb::INFINITE), Aabb::INFINITE);
    assert!(
        !Motion::travel(Vec3A::X * 3e38).unwrap().bounds_of(&Aabb::of_points([Vec3A::X * 3e38])).is_finite()
    );
}

#[test]
fn between_leads_from_one_to_the_other_the_short_way() {
    let mut rng = Rng(6);
    for i in 0..20_000 {
        let start = rng.placement();
        let angle = match i % 4 {
            0 => std::f32::consts::PI * (2.0 * rng.unit() as f32 - 1.0),
            1 => std::f32::consts::PI,
            2 => rng.magnitude(6.0).min(3.0),
            _ => 0.0,
        };
        let origin = start.columns()[3];
        let given = Motion::new(rng.direction(), angle, origin, rng.vector() * 5.0).unwrap();
        let end = given.placement(&start, 1.0);
        let motion = Motion::between(&start, &end).unwrap();
        assert!(motion.angle() >= 0.0 && motion.angle() <= std::f64::consts::PI);
        for (a, b) in motion.placement(&start, 1.0).columns().into_iter().zip(end.columns()) {
            let off = vector::length(a - b);
            assert!(off <= 3e-6 * (vector::length(b) + vector::length(origin)), "{off}: {a} {b}");
        }
        if angle.abs() < 3.1 {
            // Halfway it is where the given motion is.
            let (a, b) = (motion.placement(&start, 0.5), given.placement(&start, 0.5));
            for (a, b) in a.columns().into_iter().zip(b.columns()) {
                assert!(vector::length(a - b) <= 2e-5 * (vector::length(b) + vector::length(origin)));
            }
        }
        assert!(Motion::between(&start, &start).unwrap().is_still());
    }
}

#[test]
fn what_is_no_motion_is_refused_with_its_reason() {
    let of = |t: Transform| Motion::between(&Transform::IDENTITY, &t);
    let stretched = of(Transform::scale(Vec3A::new(1.0, 1.01, 1.0)).unwrap());
    assert!(
        matches!(stretched, Err(MotionError::NotRigid { off, mirrored: false }) if (off - 0.0201).abs() < 1e-6)
    );
    assert!(stretched.unwrap_err().to_string().contains("2.0e-2"));
    let mirrored = of(Transform::scale(Vec3A::new(1.0, -1.0, 1.0)).unwrap());
    assert!(matches!(mirrored, Err(MotionError::NotRigid { mirrored: true, .. })));
    let sheared =
        Transform::from_columns(Vec3A::X, Vec3A::new(0.1, 1.0, 0.0), Vec3A::Z, Vec3A::ZERO).unwrap();
    assert!(matches!(of(sheared), Err(MotionError::NotRigid { .. })));
    // Just within what is taken for rounding.
    assert!(of(Transform::scale(Vec3A::splat(1.00004)).unwrap()).is_ok());
    for bad in [Vec3A::NAN, Vec3A::INFINITY] {
        assert_eq!(Motion::travel(bad), Err(MotionError::NotFinite));
        assert_eq!(Motion::turn(Vec3A::Y, 1.0, bad), Err(MotionError::NotFinite));
        assert_eq!(Motion::turn(bad, 1.0, Vec3A::ZERO), Err(MotionError::NotFinite));
    }
    assert_eq!(Motion::turn(Vec3A::Y, f32::NAN, Vec3A::ZERO), Err(MotionError::NotFinite));
    assert_eq!(Motion::turn(Vec3A::ZERO, 1.0, Vec3A::ZERO), Err(MotionError::NoAxis { angle: 1.0 }));
    assert!(Motion::turn(Vec3A::ZERO, 0.0, Vec3A::ZERO).unwrap().is_still());
    assert!(Motion::turn(Vec3A::splat(1e-30), 1.0, Vec3A::ZERO).is_ok());
}

#[test]
fn digests_tell_motions_apart() {
    let digest = |m: Motion| {
        let mut f = Fingerprint::default();
        m.fingerprint(&mut f);
        f.value()
    };
    let turn = |a, p| digest(Motion::turn(Vec3A::Y, a, p).unwrap());
    let all = [
        turn(1.0, Vec3A::ZERO),
        turn(-1.0, Vec3A::ZERO),
        turn(1.0, Vec3A::X),
        digest(Motion::turn(Vec3A::X, 1.0, Vec3A::ZERO).unwrap()),
        digest(Motion::travel(Vec3A::X).unwrap()),
        digest(Motion::travel(Vec3A::Y).unwrap()),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(all[..i].iter().all(|b| a != b));
    }
    assert_eq!(turn(1.0, Vec3A::ZERO), all[0]);
}
