use glam::{DMat3, DVec3, Mat3A, Vec3A};

use crate::rounding::gamma;
use crate::{Aabb, Ray, vector};

/// Why a matrix is not accepted as a placement.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TransformError {
    /// An entry is NaN or infinite.
    #[error("the transform has an entry that is not a finite number")]
    NotFinite,
    /// The linear part flattens space, so that no inverse exists within single precision.
    #[error(
        "the transform is singular or nearly so (|det| = {det:e} against {norm:e}^3): it flattens the object; \
         check for a zero scale"
    )]
    NearSingular {
        /// Determinant of the linear part.
        det: f64,
        /// Largest column length.
        norm: f64,
    },
}

/// An affine map with its inverse: object space to world space where it places an object.
///
/// The inverse is computed in double precision. Negative and non-uniform scale are right: normals go by the
/// cofactors with the determinant's sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    linear: Mat3A,
    translation: Vec3A,
    inverse_linear: Mat3A,
    inverse_translation: Vec3A,
    mirrors: bool,
}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        linear: Mat3A::IDENTITY,
        translation: Vec3A::ZERO,
        inverse_linear: Mat3A::IDENTITY,
        inverse_translation: Vec3A::ZERO,
        mirrors: false,
    };

    /// From the columns of the linear part and the translation.
    ///
    /// # Errors
    /// [`TransformError`] where an entry is not finite or `|det| < 1e-12 · (largest column)³`.
    pub fn from_columns(x: Vec3A, y: Vec3A, z: Vec3A, translation: Vec3A) -> Result<Self, TransformError> {
        let d = |v: Vec3A| DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z));
        Self::from_f64(DMat3::from_cols(d(x), d(y), d(z)), d(translation))
    }

    /// From a row-major 3 × 4 matrix, as file formats print it.
    ///
    /// # Errors
    /// As [`Transform::from_columns`].
    pub fn from_rows(r: [[f32; 4]; 3]) -> Result<Self, TransformError> {
        let c = |i: usize| Vec3A::new(r[0][i], r[1][i], r[2][i]);
        Self::from_columns(c(0), c(1), c(2), c(3))
    }

    /// From double precision, the form in which chains of placements are multiplied.
    ///
    /// # Errors
    /// As [`Transform::from_columns`].
    pub fn from_f64(m: DMat3, t: DVec3) -> Result<Self, TransformError> {
        let (a, b, c) = (m.x_axis, m.y_axis, m.z_axis);
        if !(a.is_finite() && b.is_finite() && c.is_finite() && t.is_finite()) {
            return Err(TransformError::NotFinite);
        }
        let dot = |a: DVec3, b: DVec3| a.x * b.x + a.y * b.y + a.z * b.z;
        let cross = |a: DVec3, b: DVec3| {
            DVec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
        };
        let norm = dot(a, a).max(dot(b, b)).max(dot(c, c)).sqrt();
        let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
        let det = dot(a, bc);
        if det.abs() < 1e-12 * norm * norm * norm || det == 0.0 {
            return Err(TransformError::NearSingular { det, norm });
        }
        // Rows of the inverse are the cofactors over the determinant.
        let (r0, r1, r2) = (bc / det, ca / det, ab / det);
        let inv_t = DVec3::new(-dot(r0, t), -dot(r1, t), -dot(r2, t));
        let f = |v: DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
        let out = Self {
            linear: Mat3A::from_cols(f(a), f(b), f(c)),
            translation: f(t),
            inverse_linear: Mat3A::from_cols(
                f(DVec3::new(r0.x, r1.x, r2.x)),
                f(DVec3::new(r0.y, r1.y, r2.y)),
                f(DVec3::new(r0.z, r1.z, r2.z)),
            ),
            inverse_translation: f(inv_t),
            mirrors: det < 0.0,
        };
        if out.is_finite() { Ok(out) } else { Err(TransformError::NotFinite) }
    }

    /// From maps that are known to undo each other.
    pub(crate) fn from_parts(
        linear: Mat3A,
        translation: Vec3A,
        inverse_linear: Mat3A,
        inverse_translation: Vec3A,
        mirrors: bool,
    ) -> Self {
        Self { linear, translation, inverse_linear, inverse_translation, mirrors }
    }

    /// Whether all entries, those of the inverse too, are finite numbers.
    pub fn is_finite(&self) -> bool {
        self.linear.is_finite()
            && self.translation.is_finite()
            && self.inverse_linear.is_finite()
            && self.inverse_translation.is_finite()
    }

    /// A translation.
    pub fn translation(t: Vec3A) -> Self {
        Self { translation: t, inverse_translation: -t, ..Self::IDENTITY }
    }

    /// A scale per axis.
    ///
    /// # Errors
    /// As [`Transform::from_columns`].
    pub fn scale(s: Vec3A) -> Result<Self, TransformError> {
        Self::from_columns(Vec3A::X * s.x, Vec3A::Y * s.y, Vec3A::Z * s.z, Vec3A::ZERO)
    }

    /// A rotation by `angle` radians, counter-clockwise seen against the `axis` (Rodrigues). An axis without a
    /// direction rotates nothing.
    pub fn rotation(axis: Vec3A, angle: f32) -> Self {
        let Some(n) = vector::try_normalize(axis) else { return Self::IDENTITY };
        let (s, c) = crate::math::sin_cos(angle);
        let col = |e: Vec3A| e * c + n.cross(e) * s + n * (n.dot(e) * (1.0 - c));
        Self::from_columns(col(Vec3A::X), col(Vec3A::Y), col(Vec3A::Z), Vec3A::ZERO).unwrap_or(Self::IDENTITY)
    }

    /// `self` after `first`: maps `p` to `self(first(p))`.
    ///
    /// # Errors
    /// As [`Transform::from_columns`], where the product degenerates.
    pub fn after(&self, first: &Self) -> Result<Self, TransformError> {
        let d = |v: Vec3A| DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z));
        let (a, b, c) = (d(self.linear.x_axis), d(self.linear.y_axis), d(self.linear.z_axis));
        let map = |v: DVec3| a * v.x + b * v.y + c * v.z;
        let m = DMat3::from_cols(
            map(d(first.linear.x_axis)),
            map(d(first.linear.y_axis)),
            map(d(first.linear.z_axis)),
        );
        Self::from_f64(m, map(d(first.translation)) + d(self.translation))
    }

    /// The inverse map.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self {
            linear: self.inverse_linear,
            translation: self.inverse_translation,
            inverse_linear: self.linear,
            inverse_translation: self.translation,
            mirrors: self.mirrors,
        }
    }

    /// Whether the map turns right hands into left hands.
    pub fn mirrors(&self) -> bool {
        self.mirrors
    }

    /// A position.
    #[inline]
    pub fn point(&self, p: Vec3A) -> Vec3A {
        self.linear * p + self.translation
    }

    /// A displacement.
    #[inline]
    pub fn vector(&self, v: Vec3A) -> Vec3A {
        self.linear * v
    }

    /// A position known to within `err`, and the bound after the map (γ(3) per row, Pharr et al. 2023, section 6.8.5).
    #[inline]
    pub fn point_with_error(&self, p: Vec3A, err: Vec3A) -> (Vec3A, Vec3A) {
        let a =
            Mat3A::from_cols(self.linear.x_axis.abs(), self.linear.y_axis.abs(), self.linear.z_axis.abs());
        let carried = a * err;
        let rounding = (a * p.abs() + self.translation.abs()) * gamma(3);
        (self.point(p), carried * (1.0 + gamma(3)) + rounding)
    }

    /// World area over object area where the object's unit normal is `n`: the length of the cofactor matrix times `n`.
    pub fn area_scale(&self, n: Vec3A) -> f64 {
        let d = |v: Vec3A| DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z));
        let (x, y, z, n) = (d(self.linear.x_axis), d(self.linear.y_axis), d(self.linear.z_axis), d(n));
        let v = y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z;
        v.dot(v).sqrt()
    }

    /// A unit normal to a unit normal, by the transposed inverse. A front face stays a front face under a mirror:
    /// the winding flips with the space, and the normal follows the winding.
    #[inline]
    pub fn normal(&self, n: Vec3A) -> Vec3A {
        let m = &self.inverse_linear;
        let v = Vec3A::new(m.x_axis.dot(n), m.y_axis.dot(n), m.z_axis.dot(n));
        vector::normalize(v)
    }

    /// The ray in object space, if `self` maps object to world. The direction is not renormalised, so `t` keeps its
    /// meaning. `o_err` is the bound on the rounding error of the new origin.
    #[inline]
    pub fn ray_to_object(&self, ray: &Ray) -> (Ray, Vec3A) {
        let inv = self.inverse_parts();
        let a = Mat3A::from_cols(inv.0.x_axis.abs(), inv.0.y_axis.abs(), inv.0.z_axis.abs());
        let o_err = (a * ray.o.abs() + inv.1.abs()) * gamma(3);
        (Ray { o: inv.0 * ray.o + inv.1, d: inv.0 * ray.d, ..*ray }, o_err)
    }

    fn inverse_parts(&self) -> (Mat3A, Vec3A) {
        (self.inverse_linear, self.inverse_translation)
    }

    /// A box around the image of a box, rounded outward.
    pub fn aabb(&self, b: &Aabb) -> Aabb {
        if b.is_empty() {
            return *b;
        }
        if !b.is_finite() {
            return Aabb::INFINITE;
        }
        b.corners().into_iter().fold(Aabb::EMPTY, |acc, c| {
            let (p, e) = self.point_with_error(c, Vec3A::ZERO);
            acc.grown(p - e).grown(p + e)
        })
    }

    /// The columns of the linear part and the translation.
    pub fn columns(&self) -> [Vec3A; 4] {
        [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis, self.translation]
    }

    /// Into a digest.
    pub fn fingerprint(&self, f: &mut crate::Fingerprint) {
        for c in self.columns() {
            f.floats(&c.to_array());
        }
    }
}
