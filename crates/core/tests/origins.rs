//! Points that rays leave from, segments between them, and the small types of the crate.

use etendue_core::glam::DVec3;
use etendue_core::{
    Aabb, CancelFlag, Fingerprint, Origin, Progress, Ray, Segment, Spectrum, Vec3A, rounding, vector,
};

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
        let mut s = || (2.0 * self.unit() - 1.0) as f32;
        Vec3A::new(s(), s(), s())
    }
    fn direction(&mut self) -> Vec3A {
        let v = self.vector();
        vector::try_normalize(v).unwrap_or(Vec3A::X)
    }
    fn origin(&mut self, size: f32) -> Origin {
        let p = self.vector() * size;
        let p_err = p.abs() * rounding::gamma(7) * self.unit() as f32;
        Origin { p, p_err, ng: self.direction() }
    }
}

fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(v.x.into(), v.y.into(), v.z.into())
}

/// How far `p` lies from the plane through `at`, to the side of its normal.
fn height(p: Vec3A, at: &Origin) -> f64 {
    (wide(p) - wide(at.p)).dot(wide(at.ng))
}

/// How far the error box reaches along the normal.
fn reach(at: &Origin) -> f64 {
    wide(at.ng).abs().dot(wide(at.p_err))
}

#[test]
fn rays_start_outside_of_the_error_box_and_hardly_further() {
    let mut rng = Rng(1);
    for i in 0..300_000 {
        let size = 10f32.powi(i % 17 - 8);
        let (at, d) = (rng.origin(size), rng.direction());
        let ray = at.ray(d, 0.25);
        let side = if d.dot(at.ng) < 0.0 { -1.0 } else { 1.0 };
        let h = side * height(ray.o, &at);
        // The normal is unit within 2^-23 only, as are the sums that make the offset.
        assert!(h >= reach(&at) * (1.0 - 5e-7), "{h:e} inside of {:e}", reach(&at));
        let slack = 4.0 * f64::from(f32::EPSILON) * wide(at.p).abs().max_element();
        assert!(h <= reach(&at) + slack, "{h:e} beyond {:e}", reach(&at));
        assert_eq!((ray.d, ray.time, ray.t_min, ray.mask), (d, 0.25, 0.0, u32::MAX));
    }
}

#[test]
fn scaling_by_powers_of_two_changes_no_bit() {
    let mut rng = Rng(2);
    for i in 0..20_000 {
        let (a, b) = (rng.origin(1.0), rng.origin(3.0));
        let d = vector::normalize(b.p - a.p);
        let s = 2f32.powi(i % 41 - 20);
        let scaled = |o: Origin| Origin { p: o.p * s, p_err: o.p_err * s, ng: o.ng };
        assert_eq!(scaled(a).toward(d), a.toward(d) * s);
        let ray = |from, to| Segment { from, d, to: Some(to), time: 0.0 }.ray();
        match (ray(a, b), ray(scaled(a), scaled(b))) {
            (Some(x), Some(y)) => assert_eq!((x.o * s, x.d, x.t_max * s), (y.o, y.d, y.t_max)),
            (x, y) => assert_eq!(x.is_none(), y.is_none()),
        }
    }
}

#[test]
fn free_points_are_not_moved() {
    let p = Vec3A::new(1.0, -2.0, 3.0);
    let at = Origin::free(p);
    assert_eq!(at.toward(Vec3A::X), p);
    let known_exactly = Origin { p, p_err: Vec3A::ZERO, ng: Vec3A::Y };
    assert_eq!(known_exactly.toward(-Vec3A::Y), p);
}

#[test]
fn segments_end_before_the_far_surface() {
    let mut rng = Rng(3);
    for i in 0..300_000 {
        let size = 10f32.powi(i % 13 - 6);
        let (from, to) = (rng.origin(size), rng.origin(size * 3.0));
        let Some(d) = vector::try_normalize(to.p - from.p) else { continue };
        let segment = Segment { from, d, to: Some(to), time: 0.5 };
        let Some(ray) = segment.ray() else { continue };
        // The end as a hit test sees it, in exact arithmetic, is clear of the far error box on the near side.
        let end = wide(ray.o) + wide(ray.d) * f64::from(ray.t_max);
        let side = if d.dot(to.ng) < 0.0 { 1.0 } else { -1.0 };
        let h = side * (end - wide(to.p)).dot(wide(to.ng));
        assert!(h >= reach(&to) * (1.0 - 1e-6), "{h:e} inside of {:e}", reach(&to));
        assert_eq!(ray.time, 0.5);
    }
}

#[test]
fn segments_to_infinity_and_to_nowhere() {
    let at = Origin { p: Vec3A::ONE, p_err: Vec3A::splat(1e-6), ng: Vec3A::Y };
    let sky = Segment { from: at, d: Vec3A::Y, to: None, time: 0.0 }.ray().unwrap();
    assert_eq!((sky.d, sky.t_max), (Vec3A::Y, f32::INFINITY));
    assert!(Segment { from: at, d: Vec3A::Y, to: Some(at), time: 0.0 }.ray().is_none());
    let free = Origin::free(Vec3A::ONE);
    assert!(Segment { from: free, d: Vec3A::Y, to: Some(free), time: 0.0 }.ray().is_none());
    // Two sheets closer than their error boxes: nothing between them to ask about.
    let near = Origin { p: at.p + Vec3A::Y * 1e-6, ng: -Vec3A::Y, ..at };
    assert!(Segment { from: at, d: Vec3A::Y, to: Some(near), time: 0.0 }.ray().is_none());
}

#[test]
fn rays_know_what_counts() {
    assert_eq!(size_of::<Ray>(), 48);
    let ray = Ray { t_min: 1.0, t_max: 2.0, ..Ray::new(Vec3A::ZERO, Vec3A::X) };
    assert!(ray.accepts(1.5) && !ray.accepts(1.0) && !ray.accepts(2.0) && !ray.accepts(f32::NAN));
    assert!(ray.is_valid());
    for bad in [
        Ray { o: Vec3A::NAN, ..ray },
        Ray { d: Vec3A::ZERO, ..ray },
        Ray { d: Vec3A::INFINITY, ..ray },
        Ray { t_min: f32::NAN, ..ray },
        Ray { t_max: f32::NAN, ..ray },
        Ray { t_min: 3.0, ..ray },
    ] {
        assert!(!bad.is_valid(), "{bad:?}");
    }
}

#[test]
fn boxes_grow_and_tell_what_they_hold() {
    let b = Aabb::of_points([Vec3A::ZERO, Vec3A::new(1.0, 2.0, -3.0)]);
    assert_eq!((b.lo, b.hi), (Vec3A::new(0.0, 0.0, -3.0), Vec3A::new(1.0, 2.0, 0.0)));
    assert_eq!((b.center(), b.extent()), (Vec3A::new(0.5, 1.0, -1.5), Vec3A::new(1.0, 2.0, 3.0)));
    assert!(b.contains(b.lo) && b.contains(b.center()) && !b.contains(Vec3A::splat(1.5)));
    assert!(b.corners().iter().all(|&c| b.contains(c)));
    assert_eq!(Aabb::of_points(b.corners()), b);
    assert_eq!(b.union(Aabb::EMPTY), b);
    assert_eq!(Aabb::EMPTY.union(b), b);
    assert!(Aabb::EMPTY.is_empty() && !b.is_empty() && !Aabb::INFINITE.is_empty());
    assert!(b.is_finite() && !Aabb::INFINITE.is_finite() && !Aabb::EMPTY.is_finite());
    assert_eq!((Aabb::EMPTY.extent(), Aabb::EMPTY.radius()), (Vec3A::ZERO, 0.0));
    let far = Aabb { lo: Vec3A::splat(3e38), hi: Vec3A::splat(3.2e38) };
    assert!(far.center().is_finite());
    assert!(Aabb { lo: Vec3A::NAN, hi: Vec3A::ONE }.is_empty());
    assert!((b.radius() - 0.5 * 14f32.sqrt()).abs() < 1e-6);
}

#[test]
fn the_padding_of_a_spectrum_is_never_looked_at() {
    assert_eq!(size_of::<Spectrum>(), 16);
    let s = Spectrum::rgb(2.0, 4.0, 8.0) / 2.0;
    // Zero times infinity makes the fourth lane NaN; no reduction may see it.
    let spoiled = s * f32::INFINITY;
    assert_eq!(spoiled, Spectrum::gray(f32::INFINITY));
    assert_eq!((spoiled.max_channel(), spoiled.mean()), (f32::INFINITY, f32::INFINITY));
    assert!(spoiled.luminance() == f32::INFINITY && !spoiled.is_finite() && !spoiled.is_black());
    assert_eq!(s, Spectrum::rgb(1.0, 2.0, 4.0));
    assert_eq!((s.r(), s.g(), s.b()), (s[0], s[1], s[2]));
    assert_eq!((s.max_channel(), s.mean()), (4.0, 7.0 / 3.0));
    assert!((Spectrum::ONE.luminance() - 1.0).abs() < 1e-6);
    assert!(Spectrum::BLACK.is_black() && Spectrum::rgb(-0.0, 0.0, 0.0).is_black() && !s.is_black());
    assert!(!Spectrum::rgb(f32::NAN, 0.0, 0.0).is_black());
    assert_eq!(s.lerp(Spectrum::BLACK, 0.5), s * 0.5);
    assert_eq!(s.map(|v| v + 1.0), Spectrum::rgb(2.0, 3.0, 5.0));
    assert_eq!(Spectrum::from([1.0, 2.0, 4.0]), s);
    assert_ne!(Spectrum::rgb(f32::NAN, 0.0, 0.0), Spectrum::rgb(f32::NAN, 0.0, 0.0));
    let mut sum = s - s;
    sum += -s;
    sum *= Spectrum::gray(2.0);
    assert_eq!(sum, -2.0 * s);
    assert_eq!(format!("{s:?}"), "Spectrum(1, 2, 4)");
}

#[test]
fn fingerprints_depend_on_every_byte_and_its_place() {
    let digest = |f: &dyn Fn(&mut Fingerprint)| {
        let mut d = Fingerprint::default();
        f(&mut d);
        d.value()
    };
    let all = [
        digest(&|_| ()),
        digest(&|f| f.tag("ab")),
        digest(&|f| f.tag("ba")),
        digest(&|f| {
            f.tag("a");
            f.tag("b");
        }),
        digest(&|f| f.u64(1)),
        digest(&|f| f.u64(256)),
        digest(&|f| f.f32(0.0)),
        digest(&|f| f.f32(-0.0)),
        digest(&|f| f.floats(&[1.0, 2.0])),
        digest(&|f| f.floats(&[2.0, 1.0])),
        digest(&|f| f.opaque()),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(!all[..i].contains(a), "{i}");
        // Both halves carry information.
        assert!(!all[..i].iter().any(|b| b >> 64 == a >> 64 || b << 64 == a << 64), "{i}");
    }
    let mut f = Fingerprint::default();
    assert!(!f.is_opaque());
    f.opaque();
    assert!(f.is_opaque());
}

#[test]
fn a_flag_cancels_what_it_was_handed_to() {
    let flag = CancelFlag::default();
    assert!(!flag.cancelled() && !().cancelled());
    flag.update(1, 2);
    flag.cancel();
    flag.cancel();
    assert!(flag.cancelled());
}

#[test]
fn rounding_bounds_are_those_of_higham() {
    let n = f64::from(rounding::gamma(3));
    let exact = 3.0 * 2f64.powi(-24) / (1.0 - 3.0 * 2f64.powi(-24));
    assert!((n / exact - 1.0).abs() < 1e-7);
    assert_eq!(rounding::next_up(1.0), 1.0 + f32::EPSILON);
    assert_eq!(rounding::next_down(1.0), 1.0 - f32::EPSILON / 2.0);
    assert_eq!(rounding::next_up(f32::INFINITY), f32::INFINITY);
}
