use etendue_core::{Fingerprint, Needs, Ray, Transform, TransformError, UVec2, Vec2, Vec3A, math, vector};
use etendue_sampling::warp;

use crate::{Camera, CameraSample};

/// Why a camera cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A picture without pixels.
    #[error("a picture of {0} x {1} pixels has none; both sides must be at least 1")]
    NoPixels(u32, u32),
    /// A field of view that no flat film has.
    #[error("a vertical field of view of {0} degrees is not between 0 and 180")]
    FieldOfView(f32),
    /// Position, target and up vector leave the orientation open.
    #[error("the camera's position and target coincide, or its up vector points along the view")]
    Orientation,
    /// A lens that is no lens.
    #[error(
        "a lens of radius {radius} focused at {focus} needs a radius >= 0 and a focus distance > 0, both finite"
    )]
    Lens {
        /// Radius asked for, metres.
        radius: f32,
        /// Focus distance asked for, metres.
        focus: f32,
    },
    /// An aperture that is no polygon.
    #[error(
        "an aperture of {blades} blades turned by {rotation} is no polygon: it needs 3 blades or more, or none for a disc, and a finite angle"
    )]
    Blades {
        /// Blades asked for.
        blades: u32,
        /// Angle asked for, radians.
        rotation: f32,
    },
    /// A picture of no size in the world.
    #[error("an extent of {half_width} x {half_height} metres from the middle is not positive and finite")]
    Extent {
        /// Half of the width asked for, metres.
        half_width: f32,
        /// Half of the height asked for, metres.
        half_height: f32,
    },
    /// The placement is no placement.
    #[error("the camera's placement: {0}")]
    Placement(#[from] TransformError),
}

/// A pinhole or thin-lens camera with a flat film (Cook, Porter & Carpenter 1984 for the lens).
///
/// Camera space: right-handed, `x` right, `y` up, looking along `−z`.
#[derive(Clone, Debug, PartialEq)]
pub struct Perspective {
    to_world: Transform,
    size: UVec2,
    /// Half the height of the film at distance 1.
    half_height: f32,
    lens_radius: f32,
    focus_distance: f32,
    /// Corners of the aperture; 0 for a disc.
    blades: u32,
    /// Of the first corner from +x, turns.
    rotation: f32,
}

impl Perspective {
    /// A pinhole camera placed by `to_world` (any scale in it is ignored), with a vertical field of view in degrees.
    ///
    /// # Errors
    /// No pixels, a field of view outside (0, 180), or axes that lie in one plane.
    pub fn new(to_world: Transform, vertical_fov_deg: f32, size: UVec2) -> Result<Self, CameraError> {
        if size.x == 0 || size.y == 0 {
            return Err(CameraError::NoPixels(size.x, size.y));
        }
        if !(vertical_fov_deg > 0.0 && vertical_fov_deg < 180.0) {
            return Err(CameraError::FieldOfView(vertical_fov_deg));
        }
        let half_height = math::tan(vertical_fov_deg.to_radians() * 0.5);
        // Without scale: a lens and a focus distance are lengths of the world.
        let [x, y, z, eye] = to_world.columns();
        let to_world =
            Transform::from_columns(vector::normalize(x), vector::normalize(y), vector::normalize(z), eye)?;
        Ok(Self {
            to_world,
            size,
            half_height,
            lens_radius: 0.0,
            focus_distance: 1.0,
            blades: 0,
            rotation: 0.0,
        })
    }

    /// A pinhole camera at `from` that looks at `target`.
    ///
    /// # Errors
    /// As [`Perspective::new`], and where `up` or the view leave the orientation open.
    pub fn look_at(
        from: Vec3A,
        target: Vec3A,
        up: Vec3A,
        vertical_fov_deg: f32,
        size: UVec2,
    ) -> Result<Self, CameraError> {
        let back = vector::try_normalize(from - target).ok_or(CameraError::Orientation)?;
        let right =
            vector::try_normalize(vector::normalize(up).cross(back)).ok_or(CameraError::Orientation)?;
        let to_world = Transform::from_columns(right, back.cross(right), back, from)?;
        Self::new(to_world, vertical_fov_deg, size)
    }

    /// The same camera with a round lens: points at `focus_distance` metres along the view are sharp.
    ///
    /// # Errors
    /// A negative or infinite radius, or a focus distance that is not positive and finite.
    pub fn with_lens(mut self, radius: f32, focus_distance: f32) -> Result<Self, CameraError> {
        if !(radius >= 0.0 && radius.is_finite() && focus_distance > 0.0 && focus_distance.is_finite()) {
            return Err(CameraError::Lens { radius, focus: focus_distance });
        }
        self.lens_radius = radius;
        self.focus_distance = focus_distance;
        Ok(self)
    }

    /// The same camera with an aperture of straight blades: a regular polygon whose corners lie on the lens's rim, the
    /// first `rotation` radians from `x` toward `y`. No blades give back the disc. Points out of focus show its shape.
    ///
    /// # Errors
    /// One or two blades, or an angle that is not finite.
    pub fn with_blades(mut self, blades: u32, rotation: f32) -> Result<Self, CameraError> {
        if matches!(blades, 1 | 2) || !rotation.is_finite() {
            return Err(CameraError::Blades { blades, rotation });
        }
        self.blades = blades;
        self.rotation = if blades == 0 { 0.0 } else { rotation / std::f32::consts::TAU };
        Ok(self)
    }

    /// A uniform point of the polygon inscribed in the unit disc: a triangle from the middle to one of its sides, and a
    /// point of it by what is left of the first number.
    #[inline(never)]
    fn polygon(&self, u: Vec2) -> Vec2 {
        let scaled = f64::from(u.x) * f64::from(self.blades);
        let side = scaled.floor();
        let weights = warp::triangle(Vec2::new((scaled - side) as f32, u.y));
        let corner = |i: f64| {
            let (sin, cos) = math::sin_cos_turns((i / f64::from(self.blades)) as f32 + self.rotation);
            Vec2::new(cos, sin)
        };
        corner(side) * weights.x + corner(side + 1.0) * weights.y
    }

    /// The same camera with another picture size; the vertical field of view stays.
    ///
    /// # Errors
    /// No pixels.
    pub fn with_resolution(mut self, size: UVec2) -> Result<Self, CameraError> {
        if size.x == 0 || size.y == 0 {
            return Err(CameraError::NoPixels(size.x, size.y));
        }
        self.size = size;
        Ok(self)
    }
}

impl Camera for Perspective {
    fn resolution(&self) -> UVec2 {
        self.size
    }

    fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Option<CameraSample> {
        let pixel = 2.0 * self.half_height / self.size.y as f32;
        let x = (film.x - 0.5 * self.size.x as f32) * pixel;
        let y = (0.5 * self.size.y as f32 - film.y) * pixel;
        let through_pinhole = Vec3A::new(x, y, -1.0);
        let (o, d) = if self.lens_radius > 0.0 {
            let l = if self.blades == 0 { warp::disc(lens) } else { self.polygon(lens) } * self.lens_radius;
            let o = Vec3A::new(l.x, l.y, 0.0);
            (self.to_world.point(o), through_pinhole * self.focus_distance - o)
        } else {
            (self.to_world.point(Vec3A::ZERO), through_pinhole)
        };
        let d = vector::try_normalize(self.to_world.vector(d))?;
        let ray = Ray { time, ..Ray::new(o, d) };
        Some(CameraSample { ray, weight: 1.0, spread: pixel })
    }

    fn needs(&self) -> Needs {
        if self.lens_radius > 0.0 { Needs::LENS } else { Needs::empty() }
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("perspective");
        self.to_world.fingerprint(f);
        f.u64(u64::from(self.size.x) << 32 | u64::from(self.size.y));
        f.floats(&[self.half_height, self.lens_radius, self.focus_distance]);
        if self.blades > 0 {
            f.u64(u64::from(self.blades));
            f.f32(self.rotation);
        }
    }
}
