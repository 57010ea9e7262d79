use etendue_core::rounding::gamma;
use etendue_core::{Ray, Vec3A};

/// A far distance grows by this much before it is compared with a near one, so that rounding never loses a box
/// (Ize 2013, "Robust BVH ray traversal": three roundings on either side). The fourth covers the rounding of the `t` of
/// a hit that limits the search, and what the triangle test allows itself.
pub(crate) const FAR_PAD: f32 = 2.0 * gamma(4);

/// A ray prepared for box tests.
///
/// A component of zero has an infinite inverse. A plane through the origin then gives 0 · ∞, not a number, which
/// every comparison below leaves out: the ray lies in that plane and the slab does not bound it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxRay {
    /// Origin as the near planes see it, per axis.
    pub(crate) near_origin: [f32; 3],
    /// Origin as the far planes see it.
    pub(crate) far_origin: [f32; 3],
    /// 1 / direction.
    pub(crate) inverse: [f32; 3],
    /// 1 where the direction points down the axis, so that the high plane is the near one.
    pub(crate) down: [usize; 3],
    /// Nothing nearer than this counts.
    pub(crate) t_min: f32,
}

impl BoxRay {
    #[inline]
    pub(crate) fn new(ray: &Ray) -> Self {
        Self::padded(ray, 0.0)
    }

    /// As if every box were larger by `pad` on all sides.
    #[inline]
    pub(crate) fn padded(ray: &Ray, pad: f32) -> Self {
        let inverse = (Vec3A::ONE / ray.d).to_array();
        let toward = ray.d.to_array().map(|d| if d.is_sign_negative() { -pad } else { pad });
        let o = ray.o.to_array();
        Self {
            near_origin: std::array::from_fn(|i| o[i] + toward[i]),
            far_origin: std::array::from_fn(|i| o[i] - toward[i]),
            inverse,
            down: ray.d.to_array().map(|d| usize::from(d.is_sign_negative())),
            t_min: ray.t_min,
        }
    }
}
