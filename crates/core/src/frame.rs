use glam::Vec3A;

/// An orthonormal, right-handed frame. Local `z` is the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x axis, unit.
    pub x: Vec3A,
    /// Local y axis, unit.
    pub y: Vec3A,
    /// Local z axis, unit: the normal.
    pub z: Vec3A,
}

impl Frame {
    /// The frame around a unit normal, continuous except across `z = 0` of the *normal's* z component
    /// (Duff et al. 2017, "Building an orthonormal basis, revisited").
    #[inline]
    pub fn from_normal(n: Vec3A) -> Self {
        let sign = 1.0f32.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            x: Vec3A::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            y: Vec3A::new(b, sign + n.y * n.y * a, -n.y),
            z: n,
        }
    }

    /// The frame around a unit normal whose x axis follows `tangent` as far as orthogonality allows; falls back to
    /// [`Frame::from_normal`] where the tangent is zero or parallel to the normal.
    pub fn from_normal_tangent(n: Vec3A, tangent: Vec3A) -> Self {
        let Some(tangent) = crate::vector::try_normalize(tangent) else { return Self::from_normal(n) };
        let t = tangent - n * n.dot(tangent);
        // What is left of a parallel tangent is rounding.
        if t.dot(t) <= 1e-8 {
            return Self::from_normal(n);
        }
        match crate::vector::try_normalize(t) {
            Some(x) => Self { x, y: n.cross(x), z: n },
            None => Self::from_normal(n),
        }
    }

    /// World to local.
    #[inline]
    pub fn to_local(&self, v: Vec3A) -> Vec3A {
        Vec3A::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Local to world.
    #[inline]
    pub fn to_world(&self, v: Vec3A) -> Vec3A {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}
