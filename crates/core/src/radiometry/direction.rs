use glam::DVec3;

use super::Angle;
use super::solid_angle::length;
use crate::math::wide;

/// The plane angle that an arc of `arc` metres subtends on a circle of `radius` metres: s/r.
pub fn arc_angle(arc: f64, radius: f64) -> Angle {
    Angle(arc / radius)
}

/// A direction by its angle from the pole (+z) and around it.
///
/// ```
/// use etendue_core::radiometry::Hemispherical;
/// use std::f64::consts::{FRAC_PI_2, PI};
/// // The irradiance under a sky of radiance 1, by the midpoint rule in (θ, φ): ∫∫ cos θ sin θ dθ dφ = π.
/// let n = 1000;
/// let e: f64 = (0..n)
///     .map(|i| Hemispherical { theta: (f64::from(i) + 0.5) / f64::from(n) * FRAC_PI_2, phi: 0.0 })
///     .map(|d| d.direction().z * d.jacobian() * FRAC_PI_2 / f64::from(n) * 2.0 * PI)
///     .sum();
/// assert!((e - PI).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hemispherical {
    /// Angle from +z in radians: [0, π/2] in the upper hemisphere, up to π in all.
    pub theta: f64,
    /// Angle from +x toward +y in radians; [0, 2π) when it comes from a direction.
    pub phi: f64,
}

impl Hemispherical {
    /// The unit direction (sin θ cos φ, sin θ sin φ, cos θ).
    pub fn direction(self) -> DVec3 {
        let (st, ct) = wide::sin_cos(self.theta);
        let (sp, cp) = wide::sin_cos(self.phi);
        DVec3::new(st * cp, st * sp, ct)
    }

    /// The angles of a direction of any length; both 0 at the pole. Small angles keep their digits.
    pub fn from_direction(w: DVec3) -> Self {
        let across = length(DVec3::new(w.x, w.y, 0.0));
        let phi = wide::atan2(w.y, w.x);
        let phi = if phi < 0.0 { phi + std::f64::consts::TAU } else { phi };
        // A negative angle of less than half an ulp rounds to the full turn.
        let phi = if phi < std::f64::consts::TAU { phi } else { 0.0 };
        Self { theta: wide::atan2(across, w.z), phi: if across > 0.0 { phi } else { 0.0 } }
    }

    /// dω / (dθ dφ) = sin θ: what turns a density per solid angle into one per angles.
    pub fn jacobian(self) -> f64 {
        wide::sin_cos(self.theta).0
    }
}
