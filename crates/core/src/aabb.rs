use glam::Vec3A;

use crate::vector;

/// An axis-aligned box. Empty when any `lo > hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lowest corner.
    pub lo: Vec3A,
    /// Highest corner.
    pub hi: Vec3A,
}

impl Aabb {
    /// The box that holds nothing; the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self { lo: Vec3A::INFINITY, hi: Vec3A::NEG_INFINITY };
    /// The box that holds everything, as an infinite plane reports it.
    pub const INFINITE: Self = Self { lo: Vec3A::NEG_INFINITY, hi: Vec3A::INFINITY };

    /// The box of a set of points.
    pub fn of_points(points: impl IntoIterator<Item = Vec3A>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::grown)
    }

    /// The smallest box around both.
    #[inline]
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { lo: vector::min(self.lo, other.lo), hi: vector::max(self.hi, other.hi) }
    }

    /// The smallest box around this and a point.
    #[inline]
    #[must_use]
    pub fn grown(self, p: Vec3A) -> Self {
        Self { lo: vector::min(self.lo, p), hi: vector::max(self.hi, p) }
    }

    /// Whether nothing lies inside.
    pub fn is_empty(&self) -> bool {
        !self.lo.cmple(self.hi).all()
    }

    /// Whether all six bounds are finite numbers.
    pub fn is_finite(&self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// The centre. Halves first, so that large boxes do not overflow.
    pub fn center(&self) -> Vec3A {
        self.lo * 0.5 + self.hi * 0.5
    }

    /// Edge lengths; zero for an empty box.
    pub fn extent(&self) -> Vec3A {
        if self.is_empty() { Vec3A::ZERO } else { self.hi - self.lo }
    }

    /// Radius of the sphere around the box's centre that holds it; zero when empty.
    pub fn radius(&self) -> f32 {
        0.5 * vector::length(self.extent())
    }

    /// Whether the point lies inside or on the border.
    pub fn contains(&self, p: Vec3A) -> bool {
        p.cmpge(self.lo).all() && p.cmple(self.hi).all()
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3A; 8] {
        std::array::from_fn(|i| {
            Vec3A::new(
                if i & 1 == 0 { self.lo.x } else { self.hi.x },
                if i & 2 == 0 { self.lo.y } else { self.hi.y },
                if i & 4 == 0 { self.lo.z } else { self.hi.z },
            )
        })
    }
}
