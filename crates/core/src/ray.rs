use glam::Vec3A;

/// A half-line with the part of it that counts.
///
/// World-space rays have a unit `d`, so that `t` is a length in scene units (metres). Inside an instance the same
/// ray is expressed in object space with `d` *not* renormalised, so that `t` means the same on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Origin.
    pub o: Vec3A,
    /// Direction; unit length in world space.
    pub d: Vec3A,
    /// Hits with `t <= t_min` do not count.
    pub t_min: f32,
    /// Hits with `t >= t_max` do not count. May be infinite.
    pub t_max: f32,
    /// Moment in the shutter interval, in `[0, 1)`.
    pub time: f32,
    /// Only objects sharing a bit with this are seen.
    pub mask: u32,
}

impl Ray {
    /// A ray that sees everything in front of it.
    pub fn new(o: Vec3A, d: Vec3A) -> Self {
        Self { o, d, t_min: 0.0, t_max: f32::INFINITY, time: 0.0, mask: u32::MAX }
    }

    /// The point `o + t d`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3A {
        self.o + self.d * t
    }

    /// Whether `t` lies inside the open interval that counts. False for NaN.
    #[inline]
    pub fn accepts(&self, t: f32) -> bool {
        t > self.t_min && t < self.t_max
    }

    /// Whether origin, direction and interval are numbers a query can work with.
    pub fn is_valid(&self) -> bool {
        self.o.is_finite()
            && self.d.is_finite()
            && self.d != Vec3A::ZERO
            && !self.t_min.is_nan()
            && !self.t_max.is_nan()
            && self.t_min <= self.t_max
    }
}
