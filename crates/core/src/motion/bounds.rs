use glam::DVec3;

use super::double::{dot, length, max, min, narrowed, widened};
use super::{Motion, Turn, linear_of};
use crate::rounding::{gamma, next_down, next_up};
use crate::{Aabb, Transform, Vec3A};

/// Most radians between two nodes of a bound.
const STEP: f64 = std::f64::consts::PI / 16.0;
/// Past this many radians a bound is that of the body of revolution.
const WHOLE: f64 = 4.0 * std::f64::consts::TAU;
/// What a few dozen roundings in double precision lose of the largest length.
const DOUBLE: f64 = 1.0 / (1u64 << 47) as f64;

impl Motion {
    /// A box around all that a box passes through, rounded outward.
    ///
    /// It exceeds the smallest box by half a hundredth of the distance of its corners from the axis at most (much less
    /// for small angles); past four turns it is that of the body of revolution.
    #[must_use]
    pub fn bounds_of(&self, b: &Aabb) -> Aabb {
        self.bounds_after(&Transform::IDENTITY, b)
    }

    /// The same of a box in the space that `start` places: as tight as for its eight corners, and around every point that
    /// [`Motion::placement`] gives at any time, roundings included.
    #[must_use]
    pub fn bounds_after(&self, start: &Transform, b: &Aabb) -> Aabb {
        if b.is_empty() {
            return *b;
        }
        if !b.is_finite() {
            return Aabb::INFINITE;
        }
        let linear = linear_of(start);
        let origin = widened(start.columns()[3]);
        let nodes = self.nodes();
        let path = |p: DVec3| self.path_of(&nodes, p);
        let (lo, hi) = path(origin);
        let reach = max(lo.abs(), hi.abs());
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for c in b.corners() {
            let c = widened(c);
            let parts = [linear.x_axis * c.x, linear.y_axis * c.y, linear.z_axis * c.z];
            let (lo, hi) = path(parts[0] + parts[1] + parts[2] + origin);
            // What rounding the placement and applying it can add, at any time.
            let size = length(parts[0]) + length(parts[1]) + length(parts[2]);
            let rounding = (DVec3::splat(size) + reach) * f64::from(gamma(4));
            low = min(low, lo - rounding);
            high = max(high, hi + rounding);
        }
        let (lo, hi) = (narrowed(low), narrowed(high));
        Aabb {
            lo: Vec3A::new(next_down(lo.x), next_down(lo.y), next_down(lo.z)),
            hi: Vec3A::new(next_up(hi.x), next_up(hi.y), next_up(hi.z)),
        }
    }

    /// Moments between which a path is nearly straight; empty where the whole body of revolution is taken.
    fn nodes(&self) -> Vec<Turn> {
        let n = if self.angle == 0.0 {
            1
        } else if self.angle.abs() > WHOLE {
            return Vec::new();
        } else {
            ((self.angle.abs() / STEP).ceil() as u32).clamp(8, 128)
        };
        (0..=n).map(|k| self.turned(f64::from(k) / f64::from(n))).collect()
    }

    /// The box of a point's path.
    fn path_of(&self, nodes: &[Turn], p: DVec3) -> (DVec3, DVec3) {
        let q = p - self.pivot;
        let along = self.axis * dot(self.axis, q);
        let radius = length(q - along);
        // How far a unit circle around the axis reaches along each coordinate.
        let a = self.axis * self.axis;
        let circle = DVec3::new((a.y + a.z).sqrt(), (a.z + a.x).sqrt(), (a.x + a.y).sqrt());
        // What double precision loses.
        let noise = DVec3::splat((length(q) + length(p) + length(self.travel)) * DOUBLE);
        if nodes.is_empty() {
            let (middle, reach) = (self.pivot + along, circle * radius + noise);
            return (
                min(middle - reach, middle - reach + self.travel),
                max(middle + reach, middle + reach + self.travel),
            );
        }
        // Linear interpolation between nodes is off by h²/8 of the second derivative, which is the radius times the square
        // of the angular velocity.
        let step = self.angle / (nodes.len() - 1) as f64;
        let sagitta = circle * (radius * step * step * 0.125);
        let (lo, hi) = nodes.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), turn| {
            let at = self.carried(turn, p);
            (min(lo, at), max(hi, at))
        });
        (lo - sagitta - noise, hi + sagitta + noise)
    }
}
