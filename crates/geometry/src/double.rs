//! Double precision in the one place where single precision is widened and narrowed.

use etendue_core::Vec3A;
use etendue_core::glam::DVec3;

/// Exact.
#[inline]
pub(crate) fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

/// Rounded once per component.
#[inline]
pub(crate) fn narrow(v: DVec3) -> Vec3A {
    Vec3A::new(v.x as f32, v.y as f32, v.z as f32)
}

/// A position rounded to single precision with the bound on its error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rounded {
    pub(crate) p: Vec3A,
    pub(crate) p_err: Vec3A,
}

/// Rounds a position that was computed in double precision from coordinates no larger than `reach`.
///
/// The bound is the half ulp of the one rounding plus 2⁻⁴⁶ `reach`, which covers a few dozen roundings in double
/// precision. It is never zero, and it scales with the scene.
#[inline]
pub(crate) fn rounded(p: DVec3, reach: f64) -> Rounded {
    const HALF_ULP: f64 = 1.0 / (1u64 << 24) as f64;
    const DOUBLE: f64 = 1.0 / (1u64 << 46) as f64;
    // The last factor covers the roundings of the bound itself.
    let bound = |x: f64| ((x.abs() * HALF_ULP + reach * DOUBLE) * (1.0 + 1e-6)) as f32;
    Rounded { p: narrow(p), p_err: Vec3A::new(bound(p.x), bound(p.y), bound(p.z)) }
}

/// The largest absolute coordinate.
#[inline]
pub(crate) fn largest(v: DVec3) -> f64 {
    let m = if v.x.abs() > v.y.abs() { v.x.abs() } else { v.y.abs() };
    if m > v.z.abs() { m } else { v.z.abs() }
}

/// `v / |v|`, rounded; `None` where `v` is zero or not finite. Squares of what single precision holds stay in range.
#[inline]
pub(crate) fn direction(v: DVec3) -> Option<Vec3A> {
    let l = v.dot(v).sqrt();
    (l > 0.0 && l.is_finite()).then(|| narrow(v / l))
}

/// How much more than for a square what two edges span loses in double precision: the product of their lengths over
/// the area between them. At least 1; slivers have much.
#[inline]
pub(crate) fn loss(e1: DVec3, e2: DVec3) -> f64 {
    let n = e1.cross(e2);
    let aspect = (e1.dot(e1) * e2.dot(e2) / n.dot(n)).sqrt() / 16.0;
    if aspect > 1.0 && aspect.is_finite() { aspect } else { 1.0 }
}
