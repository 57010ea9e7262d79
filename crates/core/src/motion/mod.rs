mod bounds;
mod double;

use glam::{DMat3, DVec3, Mat3A, Vec3A};

use self::double::{cross, dot, length, narrowed, widened};
use crate::math::wide;
use crate::rounding::gamma;
use crate::{Fingerprint, Transform};

/// Why a motion is not accepted.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// An axis, angle, pivot or travel that is NaN or infinite.
    #[error("the motion has a number that is not finite")]
    NotFinite,
    /// A turn about an axis of no direction.
    #[error("the motion turns by {angle} radians about an axis of length zero; give the axis a direction")]
    NoAxis {
        /// Angle asked for, radians.
        angle: f32,
    },
    /// Two placements between which no rigid motion leads.
    #[error(
        "no rigid motion leads from one placement to the other (|AᵀA − 1| = {off:.1e}, mirrored: {mirrored}): scale and \
         shear have to be the same at both ends"
    )]
    NotRigid {
        /// Largest entry of |AᵀA − 1|, where A is the linear part that leads from one to the other.
        off: f64,
        /// Whether one is a mirror image of the other.
        mirrored: bool,
    },
}

/// A rigid displacement over the shutter interval: at time `t` in \[0, 1\] the point `p` has gone to
/// `pivot + travel · t + R(axis, angle · t) (p − pivot)`.
///
/// The angular velocity is constant, over any number of turns, and so is that of the pivot, along a straight line
/// (Shoemake 1985 for the rotation). Whoever moves is where it was placed at time 0. Times outside of the interval are
/// taken for its nearer end, NaN for 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Unit; any where `angle` is 0.
    axis: DVec3,
    /// Radians over the interval.
    angle: f64,
    pivot: DVec3,
    travel: DVec3,
}

impl Motion {
    /// A turn by `angle` radians about an axis through `pivot` (counter-clockwise seen against the axis), while the pivot
    /// goes straight by `travel`, world space.
    ///
    /// # Errors
    /// [`MotionError::NotFinite`]; [`MotionError::NoAxis`] where there is an angle and no axis.
    pub fn new(axis: Vec3A, angle: f32, pivot: Vec3A, travel: Vec3A) -> Result<Self, MotionError> {
        if !(axis.is_finite() && angle.is_finite() && pivot.is_finite() && travel.is_finite()) {
            return Err(MotionError::NotFinite);
        }
        let (a, length) = (widened(axis), length(widened(axis)));
        if length == 0.0 && angle != 0.0 {
            return Err(MotionError::NoAxis { angle });
        }
        let axis = if length == 0.0 { DVec3::Z } else { a / length };
        Ok(Self { axis, angle: angle.into(), pivot: widened(pivot), travel: widened(travel) })
    }

    /// Straight by `travel`.
    ///
    /// # Errors
    /// [`MotionError::NotFinite`].
    pub fn travel(travel: Vec3A) -> Result<Self, MotionError> {
        Self::new(Vec3A::Z, 0.0, Vec3A::ZERO, travel)
    }

    /// A turn by `angle` radians about an axis through `pivot`.
    ///
    /// # Errors
    /// As [`Motion::new`].
    pub fn turn(axis: Vec3A, angle: f32, pivot: Vec3A) -> Result<Self, MotionError> {
        Self::new(axis, angle, pivot, Vec3A::ZERO)
    }

    /// From one placement to another of the same object: the origin of the object goes straight, and the object turns
    /// about it the shorter way round (glTF 2.0, section 3.11: linear and spherical linear interpolation).
    ///
    /// # Errors
    /// [`MotionError::NotRigid`] where what leads from `start` to `end` stretches, shears or mirrors by more than 10⁻⁴ and
    /// what rounding of the placements explains; [`MotionError::NotFinite`].
    pub fn between(start: &Transform, end: &Transform) -> Result<Self, MotionError> {
        let ([x, y, z, t0], [ex, ey, ez, t1]) = (start.columns(), end.columns());
        let (first, last) = (linear_of(start), linear_of(end));
        let (pivot, travel) = (widened(t0), widened(t1) - widened(t0));
        if [x, y, z] == [ex, ey, ez] {
            return Ok(Self { axis: DVec3::Z, angle: 0.0, pivot, travel });
        }
        let rows = inverse_rows(&first);
        // Sum of the outer products of the end's columns with the rows of the start's inverse.
        let a = [last.x_axis, last.y_axis, last.z_axis];
        let column = |i: usize| a[0] * rows[0][i] + a[1] * rows[1][i] + a[2] * rows[2][i];
        let a = [column(0), column(1), column(2)];
        let mut off = 0.0f64;
        for (i, u) in a.iter().enumerate() {
            for (j, v) in a.iter().enumerate() {
                let e = (dot(*u, *v) - if i == j { 1.0 } else { 0.0 }).abs();
                off = if e <= off { off } else { e };
            }
        }
        if !(off.is_finite() && travel.is_finite()) {
            return Err(MotionError::NotFinite);
        }
        let gain = (0..3).map(|j| length(first.col(j)) * length(rows[j])).sum::<f64>();
        let mirrored = dot(a[0], cross(a[1], a[2])) < 0.0;
        if mirrored || off > 1e-4 + gain * f64::from(gamma(4)) {
            return Err(MotionError::NotRigid { off, mirrored });
        }
        let (axis, angle) = axis_angle(&a);
        Ok(Self { axis, angle, pivot, travel })
    }

    /// Whether nothing moves.
    pub fn is_still(&self) -> bool {
        self.angle == 0.0 && self.travel == DVec3::ZERO
    }

    /// Radians turned over the interval; negative clockwise.
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// Unit axis of the turn; any where there is none.
    pub fn axis(&self) -> Vec3A {
        narrowed(self.axis)
    }

    /// The displacement at time `t`, with its exact inverse (the transposed rotation). The identity at 0, to the bit.
    #[must_use]
    pub fn at(&self, t: f32) -> Transform {
        self.placement(&Transform::IDENTITY, t)
    }

    /// Where something placed by `start` stands at time `t`: the displacement after `start`, computed in double precision
    /// from the columns of `start` and rounded once. The inverse is that of these columns, rounded once as well.
    #[must_use]
    pub fn placement(&self, start: &Transform, t: f32) -> Transform {
        let turn = self.turned(self.clamped(t));
        let linear = linear_of(start);
        let translation = self.carried(&turn, widened(start.columns()[3]));
        // The rows of a product's inverse with a rotation on the left are those of the inverse, turned.
        let [r0, r1, r2] = inverse_rows(&linear).map(|r| turn.vector(r));
        let column = |i: usize| narrowed(DVec3::new(r0[i], r1[i], r2[i]));
        let back = -DVec3::new(dot(r0, translation), dot(r1, translation), dot(r2, translation));
        Transform::from_parts(
            Mat3A::from_cols(
                narrowed(turn.vector(linear.x_axis)),
                narrowed(turn.vector(linear.y_axis)),
                narrowed(turn.vector(linear.z_axis)),
            ),
            narrowed(translation),
            Mat3A::from_cols(column(0), column(1), column(2)),
            narrowed(back),
            start.mirrors(),
        )
    }

    /// Into a digest.
    pub fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("motion");
        for v in [self.axis, self.pivot, self.travel] {
            v.to_array().into_iter().for_each(|x| f.u64(x.to_bits()));
        }
        f.u64(self.angle.to_bits());
    }

    fn clamped(&self, t: f32) -> f64 {
        if t >= 1.0 {
            1.0
        } else if t > 0.0 {
            f64::from(t)
        } else {
            0.0
        }
    }

    fn turned(&self, t: f64) -> Turn {
        let (sin_half, cos_half) = wide::sin_cos(0.5 * self.angle * t);
        Turn {
            axis: self.axis,
            sin: 2.0 * sin_half * cos_half,
            versine: 2.0 * sin_half * sin_half,
            travel: self.travel * t,
        }
    }

    fn carried(&self, turn: &Turn, p: DVec3) -> DVec3 {
        p + turn.change(p - self.pivot) + turn.travel
    }
}

/// How far things have got at one moment.
#[derive(Clone, Copy)]
struct Turn {
    axis: DVec3,
    sin: f64,
    /// 1 − cos.
    versine: f64,
    travel: DVec3,
}

impl Turn {
    /// What the rotation adds to a vector (Rodrigues); exactly zero without one.
    fn change(&self, v: DVec3) -> DVec3 {
        let side = cross(self.axis, v);
        side * self.sin + cross(self.axis, side) * self.versine
    }

    fn vector(&self, v: DVec3) -> DVec3 {
        v + self.change(v)
    }
}

/// Axis and angle in [0, π] of a rotation given by its columns, by way of the quaternion (Shepperd 1978).
fn axis_angle(a: &[DVec3; 3]) -> (DVec3, f64) {
    let trace = a[0].x + a[1].y + a[2].z;
    let sides = DVec3::new(a[1].z - a[2].y, a[2].x - a[0].z, a[0].y - a[1].x);
    let (w, v) = if trace > 0.0 {
        (1.0 + trace, sides)
    } else {
        let i = (0..3).fold(0, |i, k| if a[k][k] > a[i][i] { k } else { i });
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let mut v = DVec3::ZERO;
        v[i] = 1.0 + a[i][i] - a[j][j] - a[k][k];
        v[j] = a[i][j] + a[j][i];
        v[k] = a[i][k] + a[k][i];
        (sides[i], v)
    };
    let (w, v) = if w < 0.0 { (-w, -v) } else { (w, v) };
    let l = length(v);
    if l == 0.0 { (DVec3::Z, 0.0) } else { (v / l, 2.0 * wide::atan2(l, w)) }
}

/// The rows of the inverse: cofactors over the determinant.
fn inverse_rows(m: &DMat3) -> [DVec3; 3] {
    let (bc, ca, ab) = (cross(m.y_axis, m.z_axis), cross(m.z_axis, m.x_axis), cross(m.x_axis, m.y_axis));
    let det = dot(m.x_axis, bc);
    [bc / det, ca / det, ab / det]
}

fn linear_of(m: &Transform) -> DMat3 {
    let [x, y, z, _] = m.columns();
    DMat3::from_cols(widened(x), widened(y), widened(z))
}
