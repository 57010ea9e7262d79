//! What all lights with a surface share. Geometry is computed in double precision from single-precision positions:
//! differences, squares and quotients then neither cancel nor leave the range, and scaling a scene by a power of two
//! scales them exactly.

use etendue_core::glam::DVec3;
use etendue_core::{Needs, Origin, Spectrum, Vec3A};
use etendue_geometry::Surface;
use etendue_texture::{Tex, TexPoint, Texture};

use crate::{LitPoint, Sides};

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

/// The largest absolute coordinate.
pub(crate) fn largest(v: Vec3A) -> f64 {
    let m = if v.x.abs() > v.y.abs() { v.x.abs() } else { v.y.abs() };
    f64::from(if m > v.z.abs() { m } else { v.z.abs() })
}

/// Half an ulp of 1 in single precision.
pub(crate) const HALF_ULP: f32 = 1.0 / (1u32 << 24) as f32;
/// What a few dozen roundings in double precision lose of the largest coordinate.
pub(crate) const DOUBLE: f64 = 1.0 / (1u64 << 46) as f64;

/// The end of a shadow ray on a surface, from a point computed in double precision out of coordinates no larger than
/// `reach`.
#[inline]
pub(crate) fn end_on(p: DVec3, reach: f64, ng: Vec3A) -> Origin {
    let p = narrow(p);
    let p_err = p.abs() * (HALF_ULP * (1.0 + 1e-6)) + Vec3A::splat((reach * DOUBLE) as f32);
    Origin { p, p_err, ng }
}

/// Another point as seen from one.
#[derive(Clone, Copy)]
pub(crate) struct Toward {
    /// Unit direction.
    pub(crate) w: Vec3A,
    /// Squared distance.
    pub(crate) d2: f64,
}

/// `None` where the points coincide or are not finite.
#[inline]
pub(crate) fn toward(from: Vec3A, to: Vec3A) -> Option<Toward> {
    let d = wide(to) - wide(from);
    let d2 = d.dot(d);
    (d2 > 0.0 && d2 < f64::INFINITY).then(|| Toward { w: narrow(d / d2.sqrt()), d2 })
}

/// The density per solid angle of a point drawn with `pdf_area` that faces the viewer at `cos` and squared distance
/// `d2`; `None` edge-on or out of range.
#[inline]
pub(crate) fn per_solid_angle(pdf_area: f64, d2: f64, cos: f64) -> Option<f32> {
    let pdf = (pdf_area * d2 / cos.abs()) as f32;
    (pdf > 0.0 && pdf.is_finite()).then_some(pdf)
}

/// Whether light from `w` falls on the side of the surface that the point does not use.
#[inline]
pub(crate) fn is_behind(at: &LitPoint, w: Vec3A) -> bool {
    at.sides == Sides::Same && at.ng.dot(w) <= 0.0 && at.ng != Vec3A::ZERO
}

/// Radiance is what the texture says, but never negative.
#[inline]
pub(crate) fn radiance(tex: &Tex, at: &TexPoint<'_>) -> Spectrum {
    positive(tex.eval(at))
}

/// Each channel that is a positive number; 0 for the others.
#[inline]
pub(crate) fn positive(s: Spectrum) -> Spectrum {
    s.map(|c| if c > 0.0 { c } else { 0.0 })
}

/// An average that is not zero where the texture may shine after all: an estimate that missed a small bright spot
/// makes a light rare, and must not make it never chosen.
pub(crate) fn floored(mean: Spectrum, tex: &Tex) -> Spectrum {
    let (mean, most) = (positive(mean), positive(tex.max()));
    let pick = |mean: f32, most: f32| {
        let floor = most * (1.0 / 1024.0);
        if mean > floor { mean } else { floor }
    };
    Spectrum::rgb(pick(mean.r(), most.r()), pick(mean.g(), most.g()), pick(mean.b(), most.b()))
}

/// Radiance that a point of an emitter sends along `wo`.
#[inline]
pub(crate) fn emitted(tex: &Tex, two_sided: bool, at: &Surface, wo: Vec3A) -> Spectrum {
    if two_sided || at.ng.dot(wo) > 0.0 { radiance(tex, &TexPoint::of(at)) } else { Spectrum::BLACK }
}

/// What a light with a surface asks of the renderer.
pub(crate) fn needs(tex: &Tex) -> Needs {
    let mut needs = Needs::LIGHTS | Needs::AREA_LIGHTS;
    needs.set(Needs::TEXTURES, !tex.is_constant());
    needs
}

/// Power of a Lambertian emitter, W: π times radiance times area, each channel rounded once. Two sides emit twice.
pub(crate) fn lambertian_power(radiance: Spectrum, area: f64, two_sided: bool) -> Spectrum {
    held_power(radiance, std::f64::consts::PI * area * if two_sided { 2.0 } else { 1.0 })
}

/// Power at infinity, W: what enters a sphere of the scene's radius, if `integral` is the radiance over all directions.
pub(crate) fn infinite_power(integral: Spectrum, scene_radius: f32) -> Spectrum {
    held_power(integral, std::f64::consts::PI * f64::from(scene_radius) * f64::from(scene_radius))
}

/// Each channel times a factor, rounded once.
pub(crate) fn held_power(radiance: Spectrum, factor: f64) -> Spectrum {
    // What shines keeps a power that single precision can hold, however small or large the scene.
    let held = |p: f64| {
        if p > 0.0 { p.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32 } else { 0.0 }
    };
    radiance.map(|c| held(f64::from(c) * factor))
}
