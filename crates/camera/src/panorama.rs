use std::f64::consts::{FRAC_PI_4, PI, TAU};

use etendue_core::glam::{DVec2, DVec3};
use etendue_core::math::wide::{atan2, sin_cos};
use etendue_core::{Fingerprint, Ray, Transform, UVec2, Vec2, Vec3A, vector};

use crate::{Camera, CameraError, CameraSample};

/// How the sphere of directions is laid onto the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PanoramaMap {
    /// Longitude and latitude: the middle looks along `−z`, the upper edge is `+y`, the left and right ones meet
    /// behind. Pixels fill Δφ (cos θ₀ − cos θ₁).
    Equirectangular,
    /// The octahedron unfolded into a square so that all pixels fill the same solid angle (Clarberg 2008, "Fast
    /// equal-area mapping of the (hemi)sphere using SIMD"): the middle is `+y`, the corners are `−y`, the middle of the
    /// lower edge looks along `−z`, that of the right one along `+x`. Each edge is folded at its middle.
    EqualArea,
}

/// A camera that sees in all directions from one point.
///
/// Camera space: right-handed, `x` right, `y` up, front along `−z`. Film positions outside of the picture go on around
/// the sphere, so that wide filters see no border.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    to_world: Transform,
    size: UVec2,
    map: PanoramaMap,
}

impl Panorama {
    /// A panorama from where `to_world` places it (any scale in it is ignored).
    ///
    /// # Errors
    /// No pixels, or axes that lie in one plane.
    pub fn new(to_world: Transform, map: PanoramaMap, size: UVec2) -> Result<Self, CameraError> {
        if size.x == 0 || size.y == 0 {
            return Err(CameraError::NoPixels(size.x, size.y));
        }
        let [x, y, z, eye] = to_world.columns();
        let to_world =
            Transform::from_columns(vector::normalize(x), vector::normalize(y), vector::normalize(z), eye)?;
        Ok(Self { to_world, size, map })
    }

    /// A panorama from `eye`, upright, whose front is along `−z`.
    ///
    /// # Errors
    /// As [`Panorama::new`].
    pub fn at(eye: Vec3A, map: PanoramaMap, size: UVec2) -> Result<Self, CameraError> {
        Self::new(Transform::translation(eye), map, size)
    }

    /// Where on the film a direction of the world (of any length) is seen, within the picture; `None` where it is zero
    /// or not finite.
    pub fn film_position(&self, d: Vec3A) -> Option<Vec2> {
        let d = vector::try_normalize(d)?;
        // By the inverse, which is right for axes that are not square to each other too.
        let d = self.to_world.inverse().vector(d);
        let d = DVec3::new(f64::from(d.x), f64::from(d.y), f64::from(d.z));
        let d = d / d.dot(d).sqrt();
        let p = match self.map {
            PanoramaMap::Equirectangular => to_equirectangular(d),
            PanoramaMap::EqualArea => to_equal_area(d),
        };
        let at = |x: f64, n: u32| (x.clamp(0.0, 1.0) * f64::from(n)) as f32;
        Some(Vec2::new(at(p.x, self.size.x), at(p.y, self.size.y)))
    }

    /// Camera space, unit.
    fn direction(&self, film: Vec2) -> DVec3 {
        let p = DVec2::new(
            f64::from(film.x) / f64::from(self.size.x),
            f64::from(film.y) / f64::from(self.size.y),
        );
        match self.map {
            PanoramaMap::Equirectangular => from_equirectangular(p),
            PanoramaMap::EqualArea => from_equal_area(p),
        }
    }
}

fn from_equirectangular(p: DVec2) -> DVec3 {
    let ((s, c), (sin, cos)) = (sin_cos((p.x - 0.5) * TAU), sin_cos(p.y * PI));
    DVec3::new(sin * s, cos, -sin * c)
}

fn to_equirectangular(d: DVec3) -> DVec2 {
    let across = (d.x * d.x + d.z * d.z).sqrt();
    DVec2::new(0.5 + atan2(d.x, -d.z) / TAU, atan2(across, d.y) / PI)
}

/// Into the unit square: beyond an edge the octahedron goes on at the place on the same edge that lies as far from the
/// edge's middle on its other side.
fn folded(p: DVec2) -> DVec2 {
    let turn = |a: f64, b: f64| {
        let a = a.rem_euclid(2.0);
        if a > 1.0 { (2.0 - a, 1.0 - b) } else { (a, b) }
    };
    let (x, y) = turn(p.x, p.y);
    let (y, x) = turn(y, x);
    DVec2::new(x, y)
}

fn from_equal_area(p: DVec2) -> DVec3 {
    let q = folded(p) * 2.0 - DVec2::ONE;
    let (a, b) = (q.x.abs(), q.y.abs());
    // Distance from the diamond that is the horizon, positive above it.
    let beyond = 1.0 - (a + b);
    let r = 1.0 - beyond.abs();
    let phi = if r > 0.0 { ((b - a) / r + 1.0) * FRAC_PI_4 } else { 0.0 };
    let (sin, cos) = sin_cos(phi);
    // The distance from the axis, so that the height 1 − r² and it are those of a unit vector.
    let across = r * (2.0 - r * r).max(0.0).sqrt();
    DVec3::new((across * cos).copysign(q.x), (1.0 - r * r).copysign(beyond), -(across * sin).copysign(q.y))
}

fn to_equal_area(d: DVec3) -> DVec2 {
    let across2 = d.x * d.x + d.z * d.z;
    // 1 − |y| without cancellation, of a vector that is nearly unit.
    let r = (across2 / (1.0 + d.y.abs())).max(0.0).sqrt();
    let turn = atan2(d.z.abs(), d.x.abs()) / FRAC_PI_4 * 0.5;
    let (mut b, mut a) = (turn * r, r - turn * r);
    if d.y < 0.0 {
        (a, b) = (1.0 - b, 1.0 - a);
    }
    (DVec2::new(a.copysign(d.x), b.copysign(-d.z)) + DVec2::ONE) * 0.5
}

impl Camera for Panorama {
    fn resolution(&self) -> UVec2 {
        self.size
    }

    /// The spread is that of the widest pixels.
    fn ray(&self, film: Vec2, _lens: Vec2, time: f32) -> Option<CameraSample> {
        let d = self.direction(film);
        let d = Vec3A::new(d.x as f32, d.y as f32, d.z as f32);
        let d = vector::try_normalize(self.to_world.vector(d))?;
        let ray = Ray { time, ..Ray::new(self.to_world.point(Vec3A::ZERO), d) };
        let (w, h) = (f64::from(self.size.x), f64::from(self.size.y));
        let spread = match self.map {
            PanoramaMap::Equirectangular => (TAU / w).max(PI / h),
            PanoramaMap::EqualArea => (2.0 * TAU).sqrt() / w.min(h),
        };
        Some(CameraSample { ray, weight: 1.0, spread: spread as f32 })
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag(match self.map {
            PanoramaMap::Equirectangular => "equirectangular panorama",
            PanoramaMap::EqualArea => "equal-area panorama",
        });
        self.to_world.fingerprint(f);
        f.u64(u64::from(self.size.x) << 32 | u64::from(self.size.y));
    }
}

#[cfg(test)]
mod tests {
    use etendue_core::radiometry::polygon_solid_angle;

    use super::*;

    /// The solid angle of a part of the film, by the polygon of many points of its outline.
    fn solid_angle(from: impl Fn(DVec2) -> DVec3, lo: DVec2, hi: DVec2) -> f64 {
        const EDGE: u32 = 2000;
        let corners = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
        let mut outline = Vec::new();
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % 4];
            outline.extend((0..EDGE).map(|k| from(a + (b - a) * (f64::from(k) / f64::from(EDGE)))));
        }
        polygon_solid_angle(&outline).0
    }

    #[test]
    fn pixels_have_the_solid_angles_of_the_closed_forms() {
        const N: u32 = 16;
        let (mut worst, mut sums) = ([0.0f64; 2], [0.0; 2]);
        for i in 0..N * N {
            let lo = DVec2::new(f64::from(i % N), f64::from(i / N)) / f64::from(N);
            let hi = lo + DVec2::splat(1.0 / f64::from(N));
            let band = (lo.y * PI).cos() - (hi.y * PI).cos();
            let truths = [TAU / f64::from(N) * band, 2.0 * TAU / f64::from(N * N)];
            let found = [solid_angle(from_equirectangular, lo, hi), solid_angle(from_equal_area, lo, hi)];
            for k in 0..2 {
                worst[k] = worst[k].max((found[k] / truths[k] - 1.0).abs());
                sums[k] += found[k];
            }
        }
        println!("off by {worst:?}, sums {sums:?}");
        assert!(worst[0] < 1e-6 && worst[1] < 1e-6, "{worst:?}");
        assert!(sums.iter().all(|s| (s / (2.0 * TAU) - 1.0).abs() < 1e-6), "{sums:?}");
        // Mutant: the octahedron projected from its centre, whose pixels are not equal.
        let projected = |p: DVec2| {
            let q = p * 2.0 - DVec2::ONE;
            let y = 1.0 - q.x.abs() - q.y.abs();
            DVec3::new(q.x, y, -q.y).normalize()
        };
        let (a, b) = (DVec2::splat(0.5), DVec2::splat(0.5 + 1.0 / f64::from(N)));
        assert!((solid_angle(projected, a, b) / (2.0 * TAU / f64::from(N * N)) - 1.0).abs() > 0.1);
    }

    #[test]
    fn there_and_back_in_double_precision() {
        const N: u32 = 301;
        for i in 0..N * N {
            let p = DVec2::new(f64::from(i % N) + 0.5, f64::from(i / N) + 0.5) / f64::from(N);
            for (d, back) in [
                (from_equirectangular(p), to_equirectangular as fn(DVec3) -> DVec2),
                (from_equal_area(p), to_equal_area),
            ] {
                assert!((d.length() - 1.0).abs() < 1e-14, "{d}");
                let q = back(d);
                assert!((q - p).length() < 1e-12, "{p} came back as {q}");
            }
        }
    }
}
