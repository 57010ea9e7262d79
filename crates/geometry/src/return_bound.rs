use etendue_core::rounding::gamma;
use etendue_core::{Motion, Transform, Vec3A, vector};

/// A bound on [`return_error`](crate::return_error) at every moment of a motion: `slope` times the largest coordinate of
/// the point plus `offset`, the same for all axes.
///
/// A rotation keeps the lengths of the columns of a placement and of the rows of its inverse, so their products, which no
/// rotation changes, bound what a sum of magnitudes can be (Cauchy–Schwarz); the offset is the same for the farthest that
/// the origin of the object gets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReturnBound {
    /// Per unit of the largest coordinate.
    pub slope: f32,
    /// Whatever the point.
    pub offset: f32,
}

impl ReturnBound {
    /// Of something placed by `start` that moves.
    pub fn new(start: &Transform, motion: &Motion) -> Self {
        // Taken from the motion, whose inverse is computed anew.
        let at = motion.placement(start, 0.0);
        let [x, y, z, _] = at.columns();
        let [ix, iy, iz, _] = at.inverse().columns();
        let row = |i: usize| vector::length(Vec3A::new(ix[i], iy[i], iz[i]));
        let gain = vector::length(x) * row(0) + vector::length(y) * row(1) + vector::length(z) * row(2);
        let origin = etendue_core::Aabb { lo: Vec3A::ZERO, hi: Vec3A::ZERO };
        let path = motion.bounds_after(start, &origin);
        let farthest = vector::length(vector::max(path.lo.abs(), path.hi.abs()));
        // γ(8): the six of `return_error` and the roundings of this bound itself.
        let per_length = gain * gamma(8);
        const ROOT_3: f32 = 1.733;
        Self { slope: per_length * ROOT_3 + gamma(3), offset: per_length * farthest }
    }

    /// The bound for a point.
    #[inline]
    pub fn at(&self, p: Vec3A) -> f32 {
        self.slope * vector::max_element(p.abs()) + self.offset
    }

    /// Whether both are finite numbers.
    pub fn is_finite(&self) -> bool {
        self.slope.is_finite() && self.offset.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::return_error;

    #[test]
    fn it_holds_at_every_moment_and_is_not_far_off() {
        let axis = |k: u32| {
            let s = |n: u32| {
                ((k.wrapping_mul(2_654_435_761).rotate_left(n) >> 8) as f32) / (1 << 23) as f32 - 1.0
            };
            Vec3A::new(s(0), s(7), s(13))
        };
        let (mut worst, mut start_alone) = (f32::INFINITY, 0);
        for k in 1..400 {
            let start = Transform::from_columns(
                axis(k) * 3.0,
                axis(k + 1000),
                axis(k + 2000) * 0.1,
                axis(k + 3000) * 10.0,
            );
            let Ok(start) = start else { continue };
            let motion = Motion::new(axis(k + 4000), 5.0, axis(k + 5000) * 20.0, axis(k + 6000) * 50.0);
            let motion = motion.expect("finite");
            let bound = ReturnBound::new(&start, &motion);
            let p = axis(k + 7000) * 30.0;
            let mut largest = 0.0f32;
            for i in 0..=50 {
                let e = return_error(&motion.placement(&start, i as f32 / 50.0), p);
                largest = largest.max(vector::max_element(e));
            }
            assert!(largest <= bound.at(p), "{largest:e} beyond {:e}", bound.at(p));
            worst = worst.min(largest / bound.at(p));
            start_alone += u32::from(largest > vector::max_element(return_error(&start, p)) * 1.2);
        }
        assert!(worst > 0.1, "{worst}");
        // Mutant: the error at the start alone is not enough.
        assert!(start_alone > 100, "{start_alone}");
    }
}
