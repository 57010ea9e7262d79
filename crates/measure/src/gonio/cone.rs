use std::f32::consts::FRAC_PI_2;
use std::f64::consts::PI;

use etendue_core::math::{self, wide};
use etendue_core::{Fingerprint, Frame, Needs, Ray, Spectrum, Vec2, Vec3A, vector};
use etendue_geometry::Surface;
use etendue_light::{DirectionalLight, Light, LightBounds, LightSample, LitPoint};
use etendue_sampling::warp;
use etendue_scene::SceneBuilder;

use super::GonioError;

/// Below it the rounding of directions would be seen in the cone's solid angle.
const SMALLEST: f32 = 1e-3;
/// What a direction's rounding may reach beyond the horizon.
const SLACK: f64 = 1e-6;

/// All directions around one that are above the sample: of a source, or of a detector. In the spot's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    /// Unit.
    pub(super) axis: Vec3A,
    /// Radians; 0 is one direction.
    half_angle: f32,
}

impl Cone {
    pub(super) fn new(which: &'static str, direction: Vec3A, half_angle: f32) -> Result<Self, GonioError> {
        let Some(axis) = vector::try_normalize(direction) else {
            return Err(GonioError::Direction { which, direction });
        };
        if half_angle != 0.0 && !(SMALLEST..=FRAC_PI_2).contains(&half_angle) {
            return Err(GonioError::HalfAngle { which, half_angle });
        }
        let (sin, _) = wide::sin_cos(f64::from(half_angle));
        if !(axis.z > 0.0 && f64::from(axis.z) >= sin - SLACK) {
            return Err(GonioError::Horizon { which, direction, half_angle });
        }
        Ok(Self { axis, half_angle })
    }

    /// ∫ cos θ dω over the cone, sr: its circle on the unit sphere, projected onto the plane. Irradiance on the
    /// macroscopic surface under radiance 1. For one direction cos θ, the irradiance under 1 across the ray.
    pub(super) fn projected(&self) -> f64 {
        let (sin, _) = wide::sin_cos(f64::from(self.half_angle));
        let across = if self.half_angle > 0.0 { PI * sin * sin } else { 1.0 };
        across * f64::from(self.axis.z)
    }

    /// A direction with density in proportion to cos θ. Seen from above, the cone's directions fill an ellipse: the
    /// projection of its circle on the unit sphere. A uniform point of it is the foot of the direction (Malley's way,
    /// for any cone above the horizon).
    pub(super) fn draw(&self, u: Vec2) -> Vec3A {
        if self.half_angle == 0.0 {
            return self.axis;
        }
        let wide3 = |v: Vec3A| [f64::from(v.x), f64::from(v.y), f64::from(v.z)];
        let [ax, ay, az] = wide3(self.axis);
        let across = (ax * ax + ay * ay).sqrt();
        let (hx, hy) = if across > 0.0 { (ax / across, ay / across) } else { (1.0, 0.0) };
        let (sin, cos) = wide::sin_cos(f64::from(self.half_angle));
        let q = warp::disc(u);
        let (along, aside) = (cos * across + sin * az * f64::from(q.x), sin * f64::from(q.y));
        let up = (1.0 - along * along - aside * aside).max(0.0).sqrt();
        Vec3A::new((hx * along - hy * aside) as f32, (hy * along + hx * aside) as f32, up as f32)
    }

    /// Lights a scene from the cone: radiance 1, or irradiance 1 across a collimated beam.
    pub(super) fn light(&self, b: &mut SceneBuilder, spot: &Frame) {
        let axis = vector::normalize(spot.to_world(self.axis));
        if self.half_angle == 0.0 {
            b.light(DirectionalLight::new(-axis, Spectrum::ONE));
        } else {
            b.light(Source::new(axis, self.half_angle));
        }
    }
}

/// Radiance 1 from all directions of a cone, infinitely far away.
struct Source {
    frame: Frame,
    one_minus_cos: f32,
}

impl Source {
    fn new(axis: Vec3A, half_angle: f32) -> Self {
        let sin = math::sin(0.5 * half_angle);
        Self { frame: Frame::from_normal(axis), one_minus_cos: 2.0 * sin * sin }
    }

    /// By the chord, whose square is 2 (1 − cos): that of a small angle has digits left.
    fn holds(&self, w: Vec3A) -> bool {
        let chord = w - self.frame.z;
        chord.dot(chord) <= 2.0 * self.one_minus_cos
    }
}

impl Light for Source {
    fn sample(&self, _at: &LitPoint, _part: u32, u: Vec2) -> Option<LightSample> {
        let wi = vector::normalize(self.frame.to_world(warp::cone(u, self.one_minus_cos)));
        let pdf = warp::cone_pdf(self.one_minus_cos);
        Some(LightSample { wi, li: Spectrum::ONE, pdf, end: None, is_delta: false })
    }

    fn pdf(&self, _at: &LitPoint, _part: u32, wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        if self.holds(wi) { warp::cone_pdf(self.one_minus_cos) } else { 0.0 }
    }

    fn power(&self, _part: u32, scene_radius: f32) -> Spectrum {
        let solid = 2.0 * PI * f64::from(self.one_minus_cos);
        Spectrum::gray((solid * PI * f64::from(scene_radius) * f64::from(scene_radius)) as f32)
    }

    fn bounds(&self, _part: u32) -> Option<LightBounds> {
        None
    }

    fn escaped(&self, ray: &Ray) -> Spectrum {
        if self.holds(ray.d) { Spectrum::ONE } else { Spectrum::BLACK }
    }

    fn is_infinite(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::LIGHTS | Needs::ENVIRONMENT | Needs::AREA_LIGHTS
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("goniometer's source");
        f.floats(&self.frame.z.to_array());
        f.floats(&[self.one_minus_cos]);
    }
}

#[cfg(test)]
mod tests {
    use etendue_light::Sides;
    use etendue_sampling::{Dim, Independent, Sampler};
    use etendue_testkit::{Budget, check_light, stats};

    use super::*;

    #[test]
    fn the_source_keeps_the_contract() {
        let n = vector::normalize(Vec3A::new(0.4, -0.2, 0.9));
        for half_angle in [0.001, 0.05, 0.7, FRAC_PI_2] {
            let light = Source::new(vector::normalize(Vec3A::new(0.1, 0.2, 0.97)), half_angle);
            let points = [Sides::Free, Sides::Both].map(|sides| LitPoint {
                p: Vec3A::new(1.0, 2.0, 3.0),
                p_err: Vec3A::ZERO,
                ng: n,
                ns: n,
                sides,
                time: 0.0,
            });
            check_light(&light, 0, &points, &|_| None, &Budget::default().shared(4))
                .unwrap_or_else(|f| panic!("{f:?}"));
        }
    }

    /// Of the directions in a cone, those in one of half the angle have the part that the projected solid angles say, and
    /// those above its axis 1/2 + tan θ (b − sin b cos b) / (π sin² b). Draws uniform by solid angle fit neither.
    #[test]
    fn detectors_draw_by_the_projected_solid_angle() {
        let n = 400_000;
        let fits = |hits, part| !stats::binomial_test(hits, u64::from(n), part).rejects(1e-4);
        for (theta, b) in [(0.0f32, FRAC_PI_2), (0.0, 0.6), (0.7, 0.5), (1.3, 0.25), (1.4, 0.01)] {
            let (s, c) = math::sin_cos(theta);
            let (sp, cp) = math::sin_cos(2.0);
            let axis = Vec3A::new(s * cp, s * sp, c);
            let cone = Cone::new("exitant", axis, b).unwrap();
            let inner = Cone::new("exitant", axis, 0.5 * b).unwrap();
            let [all, half] = [b, 0.5 * b].map(|b| Source::new(cone.axis, b));
            let sampler = Independent::new(3, n);
            let (mut within, mut above) = (0, 0);
            for i in 0..n {
                let d = cone.draw(sampler.start(0, u64::from(i)).get_2d(Dim::LENS));
                assert!((d.dot(d) - 1.0).abs() < 1e-6 && d.z > 0.0);
                let chord = d - cone.axis;
                assert!(chord.dot(chord) <= 2.0 * all.one_minus_cos * (1.0 + 1e-4), "{d} is outside");
                within += u64::from(half.holds(d));
                above += u64::from(d.dot(Vec3A::new(-c * cp, -c * sp, s)) > 0.0);
            }
            let part = inner.projected() / cone.projected();
            assert!(fits(within, part), "{theta} {b}: {within} of {n}, not {part}");
            let (b64, (sin, cos)) = (f64::from(b), wide::sin_cos(f64::from(b)));
            let part = 0.5 + f64::from(s / c) * (b64 - sin * cos) / (PI * sin * sin);
            assert!(fits(above, part), "{theta} {b}: {above} of {n}, not {part}");
            // The mutant, where the cosine varies enough over the cone.
            let uniform = f64::from(half.one_minus_cos / all.one_minus_cos);
            assert!(
                b < 0.1 || !(fits(within, uniform) && fits(above, 0.5)),
                "{theta} {b} fits uniform draws"
            );
        }
    }
}
