//! Frames and transforms: orthonormality, inverses, error bounds, exact scaling.

use etendue_core::glam::{DMat3, DVec3};
use etendue_core::{Aabb, Frame, Ray, Transform, TransformError, Vec3A, vector};

/// A plain generator (splitmix64).
struct Rng(u64);

impl Rng {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
    fn symmetric(&mut self) -> f32 {
        (2.0 * self.unit() - 1.0) as f32
    }
    fn vector(&mut self) -> Vec3A {
        Vec3A::new(self.symmetric(), self.symmetric(), self.symmetric())
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
    fn transform(&mut self, e: f64) -> Option<Transform> {
        let scale = Vec3A::new(self.magnitude(e), self.magnitude(e), -self.magnitude(e));
        let scale = Transform::scale(scale).ok()?;
        let turn = Transform::rotation(self.direction(), 6.0 * self.unit() as f32);
        let shift = Transform::translation(self.vector() * self.magnitude(4.0));
        shift.after(&turn.after(&scale).ok()?).ok()
    }
}

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(v.x.into(), v.y.into(), v.z.into())
}

#[test]
fn frames_are_orthonormal_everywhere() {
    let mut rng = Rng(1);
    let mut worst: f64 = 0.0;
    for i in 0..1_000_000 {
        // Half of them next to the pole that naive constructions divide by zero at.
        let n = if i % 2 == 0 {
            rng.direction()
        } else {
            vector::normalize(Vec3A::new(
                rng.symmetric() * rng.magnitude(8.0).min(1.0),
                rng.symmetric() * 1e-4,
                -1.0,
            ))
        };
        let f = Frame::from_normal(n);
        let (x, y, z) = (wide(f.x), wide(f.y), wide(f.z));
        for e in [x.dot(y), y.dot(z), z.dot(x), x.dot(x) - 1.0, y.dot(y) - 1.0, x.cross(y).dot(z) - 1.0] {
            worst = worst.max(e.abs());
        }
    }
    assert!(worst < 5e-7, "{worst:e}");
    for n in [Vec3A::Z, -Vec3A::Z, Vec3A::X, Vec3A::new(1.0, 0.0, -0.0)] {
        let f = Frame::from_normal(n);
        assert!(f.x.is_finite() && f.y.is_finite());
        assert_eq!(f.to_local(n), Vec3A::Z);
        assert_eq!(f.to_world(Vec3A::Z), n);
    }
}

#[test]
fn frames_follow_the_tangent_at_every_scale() {
    let mut rng = Rng(2);
    for _ in 0..10_000 {
        let (n, t) = (rng.direction(), rng.vector());
        let f = Frame::from_normal_tangent(n, t);
        assert!((f.x.dot(n)).abs() < 1e-3 && f.x.dot(t) >= 0.0 && (f.x.cross(f.y).dot(n) - 1.0).abs() < 1e-3);
        let v = rng.vector();
        assert!((f.to_world(f.to_local(v)) - v).length() < 2e-3 * v.length());
        for k in [-100, -40, 40, 100] {
            assert_eq!(Frame::from_normal_tangent(n, t * 2f32.powi(k)), f, "2^{k}");
        }
    }
    for t in [Vec3A::ZERO, Vec3A::Y * 3.0, Vec3A::splat(f32::NAN), Vec3A::splat(f32::INFINITY)] {
        assert_eq!(Frame::from_normal_tangent(Vec3A::Y, t), Frame::from_normal(Vec3A::Y), "{t}");
    }
}

#[test]
fn inverses_undo() {
    let mut rng = Rng(3);
    let mut tried = 0;
    for _ in 0..20_000 {
        let Some(m) = rng.transform(3.0) else { continue };
        tried += 1;
        let (c, i) = (m.columns(), m.inverse().columns());
        let lin = |c: [Vec3A; 4]| DMat3::from_cols(wide(c[0]), wide(c[1]), wide(c[2]));
        let product = lin(c) * lin(i);
        // Both are rounded to f32, so each entry may be off by the sum of magnitudes times 2^-23.
        let sizes = DMat3::from_cols(
            lin(c).abs() * wide(i[0]).abs(),
            lin(c).abs() * wide(i[1]).abs(),
            lin(c).abs() * wide(i[2]).abs(),
        );
        for k in 0..3 {
            for r in 0..3 {
                let e = (product.col(k)[r] - if k == r { 1.0 } else { 0.0 }).abs();
                assert!(e <= 1.3e-7 * sizes.col(k)[r], "{e:e} against {:e}", sizes.col(k)[r]);
            }
        }
        assert!(m.mirrors() && m.inverse().mirrors());
        assert_eq!(m.inverse().inverse(), m);
    }
    assert!(tried > 15_000, "{tried}");
}

#[test]
fn the_error_bound_of_a_point_holds() {
    let mut rng = Rng(4);
    let (mut n, mut beyond_a_tenth) = (0, 0);
    while n < 200_000 {
        let Some(m) = rng.transform(2.0) else { continue };
        for _ in 0..20 {
            n += 1;
            let p = rng.vector() * rng.magnitude(4.0);
            let err = Vec3A::new(1e-6, 2e-7, 0.0) * p.abs() * rng.unit() as f32;
            let (q, q_err) = m.point_with_error(p, err);
            // The true point anywhere in its box, mapped exactly by the stored columns.
            let truth = wide(p) + wide(err) * wide(rng.vector());
            let [x, y, z, t] = m.columns().map(wide);
            let image = x * truth.x + y * truth.y + z * truth.z + t;
            let off = (image - wide(q)).abs();
            assert!(off.cmple(wide(q_err)).all(), "{off} beyond {q_err}");
            beyond_a_tenth += u32::from(off.cmpgt(wide(q_err) * 0.1).any());
        }
    }
    // A bound ten times smaller (the mutant) would be broken often.
    assert!(beyond_a_tenth > n / 20, "{beyond_a_tenth} of {n}");
}

#[test]
fn object_rays_keep_the_meaning_of_t() {
    let mut rng = Rng(5);
    for _ in 0..20_000 {
        let Some(m) = rng.transform(1.0) else { continue };
        let ray = Ray::new(rng.vector(), rng.direction());
        let (object, o_err) = m.ray_to_object(&ray);
        let t = rng.unit() as f32 * 10.0;
        let back = m.point(object.at(t));
        // Errors of the object-space point come back through the map.
        let [x, y, z, _] = m.columns().map(|c| c.abs());
        let spread = o_err + object.at(t).abs() * 1e-6 + object.d.abs() * (t * 1e-6);
        let bound = x * spread.x + y * spread.y + z * spread.z + back.abs() * 1e-6 + ray.at(t).abs() * 1e-6;
        assert!((back - ray.at(t)).abs().cmple(bound).all());
        assert_eq!((object.t_min, object.t_max, object.mask), (ray.t_min, ray.t_max, ray.mask));
    }
}

#[test]
fn normals_stay_normal_and_boxes_hold_their_content() {
    let mut rng = Rng(6);
    for _ in 0..20_000 {
        let Some(m) = rng.transform(1.0) else { continue };
        let n = rng.direction();
        let tangent = vector::normalize(n.cross(rng.direction()));
        let (image, along) = (m.normal(n), vector::normalize(m.vector(tangent)));
        assert!(image.dot(along).abs() < 2e-4, "{}", image.dot(along));
        // The front stays the front: a step along n lands on the side the image points to, mirror or not.
        assert!(image.dot(m.vector(n)) > 0.0);
        let b = Aabb::of_points([rng.vector(), rng.vector()]);
        let mapped = m.aabb(&b);
        for _ in 0..4 {
            let w = rng.vector() * 0.5 + Vec3A::splat(0.5);
            assert!(mapped.contains(m.point(b.lo + (b.hi - b.lo) * w)));
        }
    }
    let m = Transform::translation(Vec3A::X);
    assert!(m.aabb(&Aabb::EMPTY).is_empty());
    assert_eq!(m.aabb(&Aabb::INFINITE), Aabb::INFINITE);
}

#[test]
fn unfit_matrices_are_refused_with_their_reason() {
    let bad = |x, y, z, t| Transform::from_columns(x, y, z, t);
    assert!(matches!(Transform::scale(Vec3A::new(1.0, 0.0, 1.0)), Err(TransformError::NearSingular { .. })));
    assert!(
        matches!(Transform::scale(Vec3A::splat(1e-30)), Ok(t) if t.point(Vec3A::ONE) == Vec3A::splat(1e-30))
    );
    assert!(matches!(
        bad(Vec3A::X, Vec3A::X + Vec3A::Y * 1e-14, Vec3A::Z, Vec3A::ZERO),
        Err(TransformError::NearSingular { .. })
    ));
    assert_eq!(bad(Vec3A::NAN, Vec3A::Y, Vec3A::Z, Vec3A::ZERO), Err(TransformError::NotFinite));
    assert_eq!(bad(Vec3A::X, Vec3A::Y, Vec3A::Z, Vec3A::INFINITY), Err(TransformError::NotFinite));
    // An inverse that leaves the range of f32.
    assert_eq!(Transform::scale(Vec3A::splat(1e-42)), Err(TransformError::NotFinite));
    let huge = DMat3::from_diagonal(DVec3::splat(1e300));
    assert!(Transform::from_f64(huge, DVec3::ZERO).is_err());
    assert!(TransformError::NotFinite.to_string().contains("finite"));
    assert!(TransformError::NearSingular { det: 0.0, norm: 1.0 }.to_string().contains("zero scale"));
}

#[test]
fn composition_is_application_in_turn() {
    let mut rng = Rng(7);
    for _ in 0..1000 {
        let (Some(a), Some(b)) = (rng.transform(0.5), rng.transform(0.5)) else { continue };
        let Ok(both) = a.after(&b) else { continue };
        let p = rng.vector();
        let scale =
            a.point(b.point(p)).length() + a.columns()[3].length() + b.columns()[3].length() * 4.0 + 10.0;
        assert!((both.point(p) - a.point(b.point(p))).length() < 4e-6 * scale);
        assert!(!both.mirrors(), "two mirrors make none");
    }
    let turn = Transform::rotation(Vec3A::Y, std::f32::consts::FRAC_PI_2);
    assert!((turn.point(Vec3A::Z) - Vec3A::X).length() < 1e-6, "counter-clockwise seen against the axis");
    let rows =
        Transform::from_rows([[1.0, 0.0, 0.0, 5.0], [0.0, 2.0, 0.0, 6.0], [0.0, 0.0, 3.0, 7.0]]).unwrap();
    assert_eq!(rows.point(Vec3A::ONE), Vec3A::new(6.0, 8.0, 10.0));
}
