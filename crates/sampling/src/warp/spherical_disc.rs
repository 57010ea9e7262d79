use std::f64::consts::TAU;

use etendue_core::glam::DVec3;
use etendue_core::{Frame, Vec2, Vec3A};

use super::spherical_triangle::{cross, dot, unit, wide3};

/// How much narrower than wide a disc may look. Seen edge-on, the direction's own rounding would decide where in the
/// ellipse it lies. Measured by `narrow_ellipses_are_right` of `tests/discs.rs` with other thresholds, the irradiance is
/// off by 2e-7 here, by 4e-6 at 1e-5 and by 5e-4 at 1e-7.
const NARROWEST: f64 = 1e-4;

/// A disc seen from a point, ready to be sampled nearly uniformly in solid angle, in double precision.
///
/// The directions that meet a disc are an elliptic cone. Projected along its axis onto the plane across, they fill a
/// plane ellipse whose half axes are the sines of the cone's two half angles; it is divided into sectors as it is
/// by area, and within each sector 1 − cos of the angle to the axis is uniform up to the rim. The density is then
/// (1 + c) / (2π sin α sin β) with c the cosine of the angle to the rim in that sector: it varies by less than a factor of
/// two over any disc, it is exact, and nothing has to be inverted numerically (Guillén et al. 2017, "Area-preserving
/// parameterizations for spherical ellipses", divide by the solid angle itself and so need elliptic integrals).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalDisc {
    /// Unit axes of the cone: across the plane of symmetry, within it, and along the middle.
    x: DVec3,
    y: DVec3,
    axis: DVec3,
    /// Sines and cosines of the half angles along `x` and `y`.
    sin: [f64; 2],
    cos: [f64; 2],
    /// From the viewpoint to the disc's plane, unit, and how far that is.
    up: DVec3,
    height: f64,
    center: DVec3,
    radius: f64,
}

/// A point of a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscSample {
    /// Unit direction toward it.
    pub w: Vec3A,
    /// From the disc's centre to it, within the disc's plane and rim.
    pub from_center: DVec3,
    /// Density per solid angle (sr⁻¹).
    pub pdf: f32,
}

impl SphericalDisc {
    /// The disc with the given centre (as displacement from the viewpoint), normal of any length and radius. `None` where
    /// it is seen edge-on (then sample by area), or where it degenerates.
    #[inline]
    pub fn new(center: DVec3, normal: Vec3A, radius: f32) -> Option<Self> {
        let (c, n, r) = (center, unit(wide3(normal))?, f64::from(radius));
        let signed = dot(c, n);
        let (up, h) = if signed < 0.0 { (-n, -signed) } else { (n, signed) };
        let (t, rho) = lateral(c, n);
        // The plane of symmetry: lateral positions and distances of the rim's nearest and farthest point.
        let (y0, y1) = (rho - r, rho + r);
        let (l0, l1) = ((y0 * y0 + h * h).sqrt(), (y1 * y1 + h * h).sqrt());
        // With 2β between the two: l0 l1 cos 2β, l0 l1 sin 2β = 2 h r. Of sine and cosine of β, the one that does not
        // cancel comes first.
        let (product, straight) = (l0 * l1, h * h + y0 * y1);
        let (sin_b, cos_b, ay, ah) = if straight > 0.0 {
            let cos = (0.5 * (product + straight) / product).sqrt();
            (h * r / (product * cos), cos, (y0 / l0 + y1 / l1) / (2.0 * cos), (h / l0 + h / l1) / (2.0 * cos))
        } else {
            let sin = (0.5 * (product - straight) / product).sqrt();
            (sin, h * r / (product * sin), (h / l0 - h / l1) / (2.0 * sin), (y1 / l1 - y0 / l0) / (2.0 * sin))
        };
        // Across: the bisector meets the disc at a distance t, with half a chord of s beside it; by Stewart's theorem
        // s² + t² = l0 l1, and s = 2r √(l0 l1) / (l0 + l1).
        let sin_a = 2.0 * r / (l0 + l1);
        let cos_a = 2.0 * product.sqrt() * cos_b / (l0 + l1);
        let (sin, cos) = ([sin_a, sin_b], [cos_a, cos_b]);
        if !(h > 0.0 && sin_b > NARROWEST * sin_a && sin_a * sin_b > 0.0 && (sin_a * sin_b).is_finite()) {
            return None;
        }
        let (axis, y) = (t * ay + up * ah, t * ah - up * ay);
        Some(Self { x: cross(y, axis), y, axis, sin, cos, up, height: h, center: c, radius: r })
    }

    /// Unit direction of the cone's middle.
    #[inline]
    pub fn axis(&self) -> DVec3 {
        self.axis
    }

    /// Sines of the half angles of the cone, the larger first: across the plane through viewpoint, centre and normal, and
    /// within it. A plane across [`SphericalDisc::axis`] receives π L times their product from radiance L.
    #[inline]
    pub fn sines(&self) -> [f64; 2] {
        self.sin
    }

    /// Density of [`SphericalDisc::sample`] for a unit direction inside of the cone (sr⁻¹).
    #[inline]
    pub fn pdf(&self, w: Vec3A) -> f32 {
        let w = wide3(w);
        let [a, b] = self.sin;
        let (x, y) = (dot(w, self.x) / a, dot(w, self.y) / b);
        self.density(x * x, y * y) as f32
    }

    /// By the squares of the position in the ellipse, in units of its half axes; only their ratio matters.
    #[inline]
    fn density(&self, x2: f64, y2: f64) -> f64 {
        (1.0 + self.rim(x2, y2)) / (TAU * self.sin[0] * self.sin[1])
    }

    /// Cosine of the rim's angle to the axis in that sector.
    #[inline]
    fn rim(&self, x2: f64, y2: f64) -> f64 {
        let ([ca, cb], all) = (self.cos, x2 + y2);
        if all > 0.0 { ((x2 * ca * ca + y2 * cb * cb) / all).sqrt() } else { cb }
    }

    /// A point nearly uniform in solid angle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Option<DiscSample> {
        let p = super::disc(u);
        let (px, py) = (f64::from(p.x), f64::from(p.y));
        let (x, y) = (self.sin[0] * px, self.sin[1] * py);
        // 1 − cos of the angle: r² of what it is at the rim, which is s² / (1 + c).
        let one_and_c = 1.0 + self.rim(px * px, py * py);
        let less = (x * x + y * y) / one_and_c;
        let stretch = ((2.0 - less) / one_and_c).sqrt();
        let w = self.x * (x * stretch) + self.y * (y * stretch) + self.axis * (1.0 - less);
        // Where it meets the plane, measured from the foot of the perpendicular; back into the rim, where rounding left it.
        let along = self.height / dot(w, self.up);
        let v = w * along - self.center;
        let v = v - self.up * dot(v, self.up);
        let l = dot(v, v).sqrt();
        let from_center = if l > self.radius { v * (self.radius / l) } else { v };
        let w = Vec3A::new(w.x as f32, w.y as f32, w.z as f32);
        // Of the direction as it was rounded, so that both ways of asking agree to the bit.
        let pdf = self.pdf(w);
        (from_center.is_finite() && pdf > 0.0 && pdf.is_finite()).then_some(DiscSample {
            w,
            from_center,
            pdf,
        })
    }
}

/// Unit direction within the plane of normal `n` toward `c`, and how far that is; where it is no more than rounding, any
/// direction within the plane and 0.
#[inline]
fn lateral(c: DVec3, n: DVec3) -> (DVec3, f64) {
    const ROUNDING: f64 = 1e-14;
    let v = c - n * dot(c, n);
    let v = v - n * dot(v, n);
    let l = dot(v, v).sqrt();
    if l * l > ROUNDING * ROUNDING * dot(c, c) {
        return (v / l, l);
    }
    let t = wide3(Frame::from_normal(Vec3A::new(n.x as f32, n.y as f32, n.z as f32)).x);
    let t = t - n * dot(t, n);
    (t / dot(t, t).sqrt(), 0.0)
}
