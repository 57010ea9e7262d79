use etendue_core::{Fingerprint, Vec2, math};

/// An affine map of texture coordinates, applied before the look-up: `u' = u_row · uv + offset.x`, likewise `v'`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    /// Coefficients of `u'`.
    pub u_row: Vec2,
    /// Coefficients of `v'`.
    pub v_row: Vec2,
    /// Constant part.
    pub offset: Vec2,
}

impl UvTransform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self { u_row: Vec2::X, v_row: Vec2::Y, offset: Vec2::ZERO };

    /// Scale, then a turn by `rotation` radians, then the offset, in the order and with the sense of turning of glTF's
    /// `KHR_texture_transform` (the image turns clockwise as seen with `v` downward).
    pub fn new(offset: Vec2, rotation: f32, scale: Vec2) -> Self {
        let (s, c) = math::sin_cos(rotation);
        Self {
            u_row: Vec2::new(c * scale.x, s * scale.y),
            v_row: Vec2::new(-s * scale.x, c * scale.y),
            offset,
        }
    }

    /// The mapped coordinates.
    #[inline]
    pub fn apply(&self, uv: Vec2) -> Vec2 {
        Vec2::new(self.u_row.x * uv.x + self.u_row.y * uv.y, self.v_row.x * uv.x + self.v_row.y * uv.y)
            + self.offset
    }

    /// Into a digest.
    pub fn fingerprint(&self, f: &mut Fingerprint) {
        for v in [self.u_row, self.v_row, self.offset] {
            f.floats(&v.to_array());
        }
    }
}

impl Default for UvTransform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of the extension's text: offset (0, 1), a quarter turn, scale ½ select the lower left quadrant.
    #[test]
    fn quarter_turn_selects_the_lower_left_quadrant() {
        let t = UvTransform::new(Vec2::Y, std::f32::consts::FRAC_PI_2, Vec2::splat(0.5));
        for (from, to) in [
            (Vec2::ZERO, Vec2::new(0.0, 1.0)),
            (Vec2::X, Vec2::new(0.0, 0.5)),
            (Vec2::Y, Vec2::new(0.5, 1.0)),
            (Vec2::ONE, Vec2::new(0.5, 0.5)),
        ] {
            assert!((t.apply(from) - to).length() < 1e-6, "{from} to {}", t.apply(from));
        }
        assert_eq!(UvTransform::new(Vec2::ZERO, 0.0, Vec2::ONE), UvTransform::IDENTITY);
    }
}
