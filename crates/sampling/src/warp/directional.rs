use std::f32::consts::{FRAC_1_PI, TAU};

use etendue_core::{Vec2, Vec3A, math};

use super::planar::disc_and_radius;

/// Density of [`sphere`]: 1/4π sr⁻¹.
pub const SPHERE_PDF: f32 = 0.25 * FRAC_1_PI;
/// Density of [`hemisphere`]: 1/2π sr⁻¹.
pub const HEMISPHERE_PDF: f32 = 0.5 * FRAC_1_PI;

/// A direction whose distance below the pole is `h = 1 − cos θ`, at `turn` of a full turn around it. The sine comes
/// from h(2 − h), which does not cancel.
#[inline]
fn below_pole(h: f32, turn: f32) -> Vec3A {
    let r = (h * (2.0 - h)).sqrt();
    let (s, c) = math::sin_cos_turns(turn);
    Vec3A::new(r * c, r * s, 1.0 - h)
}

/// A uniform direction.
#[inline]
pub fn sphere(u: Vec2) -> Vec3A {
    below_pole(2.0 * u.x, u.y)
}

/// A uniform direction of the hemisphere around +z; z ≥ 2⁻²⁴.
#[inline]
pub fn hemisphere(u: Vec2) -> Vec3A {
    below_pole(u.x, u.y)
}

/// A direction of the hemisphere around +z with density cos θ / π; z > 3 · 10⁻⁴.
#[inline]
pub fn cosine(u: Vec2) -> Vec3A {
    let (p, r) = disc_and_radius(u);
    Vec3A::new(p.x, p.y, ((1.0 - r) * (1.0 + r)).sqrt())
}

/// Density of [`cosine`] (sr⁻¹); 0 below the horizon.
#[inline]
pub fn cosine_pdf(cos_theta: f32) -> f32 {
    if cos_theta > 0.0 { cos_theta * FRAC_1_PI } else { 0.0 }
}

/// A direction of the hemisphere around +z with density proportional to cosⁿ θ, n ≥ 0 (smaller n count as 0).
#[inline]
pub fn power_cosine(u: Vec2, n: f32) -> Vec3A {
    let n = if n > 0.0 { n } else { 0.0 };
    // cos θ = (1 - u)^(1/(n+1)); the sine from 1 - cos² = -expm1(2 ln cos), which does not cancel for large n.
    let ln_cos = math::ln_1p(-u.x) / (n + 1.0);
    let r = (-math::exp_m1(2.0 * ln_cos)).sqrt();
    let (s, c) = math::sin_cos_turns(u.y);
    Vec3A::new(r * c, r * s, math::exp(ln_cos))
}

/// Density of [`power_cosine`] (sr⁻¹): (n + 1)/2π · cosⁿ θ; 0 below the horizon.
#[inline]
pub fn power_cosine_pdf(cos_theta: f32, n: f32) -> f32 {
    let n = if n > 0.0 { n } else { 0.0 };
    if cos_theta > 0.0 { (n + 1.0) / TAU * math::pow(cos_theta, n) } else { 0.0 }
}

/// A uniform direction of the cone around +z with `one_minus_cos_max` = 1 − cos θ_max in [0, 2]. The cone is given by
/// that difference (compute it as 2 sin²(θ/2)) because the cosine of a small one has no digits left.
#[inline]
pub fn cone(u: Vec2, one_minus_cos_max: f32) -> Vec3A {
    below_pole(u.x * one_minus_cos_max, u.y)
}

/// Density of [`cone`] inside it (sr⁻¹); infinite for a cone without extent, which is a delta direction.
#[inline]
pub fn cone_pdf(one_minus_cos_max: f32) -> f32 {
    1.0 / (TAU * one_minus_cos_max)
}
