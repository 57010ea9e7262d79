use etendue_core::{Fingerprint, Ray, Transform, UVec2, Vec2, Vec3A, vector};

use crate::{Camera, CameraError, CameraSample};

/// A camera of parallel rays, as glTF's: it sees a box of `2 half_width × 2 half_height` metres, from a plane on.
///
/// Camera space: right-handed, `x` right, `y` up, looking along `−z`; rays start at `z = 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Orthographic {
    to_world: Transform,
    size: UVec2,
    half_width: f32,
    half_height: f32,
}

impl Orthographic {
    /// A camera placed by `to_world` (any scale in it is ignored) whose picture is `2 half_height` metres high, and as
    /// wide as square pixels make it.
    ///
    /// # Errors
    /// No pixels, a height that is not positive and finite, or axes that lie in one plane.
    pub fn new(to_world: Transform, half_height: f32, size: UVec2) -> Result<Self, CameraError> {
        if size.x == 0 || size.y == 0 {
            return Err(CameraError::NoPixels(size.x, size.y));
        }
        Self::stretched(to_world, half_height * (size.x as f32 / size.y as f32), half_height, size)
    }

    /// The same with a width of its own, so that pixels need not be square (glTF's `xmag` and `ymag`).
    ///
    /// # Errors
    /// As [`Orthographic::new`].
    pub fn stretched(
        to_world: Transform,
        half_width: f32,
        half_height: f32,
        size: UVec2,
    ) -> Result<Self, CameraError> {
        if size.x == 0 || size.y == 0 {
            return Err(CameraError::NoPixels(size.x, size.y));
        }
        let sound = |v: f32| v > 0.0 && v.is_finite();
        if !(sound(half_width) && sound(half_height)) {
            return Err(CameraError::Extent { half_width, half_height });
        }
        // Without scale: the extent is a length of the world.
        let [x, y, z, eye] = to_world.columns();
        let to_world =
            Transform::from_columns(vector::normalize(x), vector::normalize(y), vector::normalize(z), eye)?;
        Ok(Self { to_world, size, half_width, half_height })
    }

    /// A camera at `from` that looks at `target`.
    ///
    /// # Errors
    /// As [`Orthographic::new`], and where `up` or the view leave the orientation open.
    pub fn look_at(
        from: Vec3A,
        target: Vec3A,
        up: Vec3A,
        half_height: f32,
        size: UVec2,
    ) -> Result<Self, CameraError> {
        let back = vector::try_normalize(from - target).ok_or(CameraError::Orientation)?;
        let right =
            vector::try_normalize(vector::normalize(up).cross(back)).ok_or(CameraError::Orientation)?;
        Self::new(Transform::from_columns(right, back.cross(right), back, from)?, half_height, size)
    }
}

impl Camera for Orthographic {
    fn resolution(&self) -> UVec2 {
        self.size
    }

    /// Its rays do not part: `spread` is 0.
    fn ray(&self, film: Vec2, _lens: Vec2, time: f32) -> Option<CameraSample> {
        let x = (2.0 * film.x / self.size.x as f32 - 1.0) * self.half_width;
        let y = (1.0 - 2.0 * film.y / self.size.y as f32) * self.half_height;
        let d = vector::try_normalize(self.to_world.vector(Vec3A::NEG_Z))?;
        let ray = Ray { time, ..Ray::new(self.to_world.point(Vec3A::new(x, y, 0.0)), d) };
        Some(CameraSample { ray, weight: 1.0, spread: 0.0 })
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("orthographic");
        self.to_world.fingerprint(f);
        f.u64(u64::from(self.size.x) << 32 | u64::from(self.size.y));
        f.floats(&[self.half_width, self.half_height]);
    }
}
