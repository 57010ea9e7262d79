use etendue_core::{Fingerprint, Transform, Vec3A};

use crate::{TexPoint, UvTransform};

/// Where a procedural texture is defined: on the surface or in the space around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TexSpace {
    /// On the surface: the point (u, v, 0).
    Uv {
        /// Which set of texture coordinates: 0, or 1 for anything else.
        set: u8,
        /// Map of the coordinates; its scale is how often the pattern repeats.
        transform: UvTransform,
    },
    /// In the world, as if the object were carved from it: the position in metres, mapped from world to pattern. It does
    /// not move along with an object; an object that shall keep its pattern needs a transform of its own.
    World(Transform),
}

impl TexSpace {
    /// On the surface, `scale` cells to the unit of the first texture coordinates.
    pub fn uv(scale: f32) -> Self {
        let transform = UvTransform {
            u_row: UvTransform::IDENTITY.u_row * scale,
            v_row: UvTransform::IDENTITY.v_row * scale,
            ..UvTransform::IDENTITY
        };
        Self::Uv { set: 0, transform }
    }

    /// The point of the pattern that a point of a surface has.
    #[inline]
    pub(crate) fn point(&self, at: &TexPoint<'_>) -> Vec3A {
        match self {
            Self::Uv { set, transform } => {
                let uv = transform.apply(if *set == 0 { at.uv[0] } else { at.uv[1] });
                Vec3A::new(uv.x, uv.y, 0.0)
            }
            Self::World(transform) => transform.point(at.p),
        }
    }

    pub(crate) fn fingerprint(&self, f: &mut Fingerprint) {
        match self {
            Self::Uv { set, transform } => {
                f.tag("uv");
                f.u64(u64::from(*set));
                transform.fingerprint(f);
            }
            Self::World(transform) => {
                f.tag("world");
                transform.fingerprint(f);
            }
        }
    }
}

/// The average of what a pattern has over the unit square, or over 16³ cells of the space, by 4,096 midpoints.
pub(crate) fn average(space: &TexSpace, value: impl Fn(Vec3A) -> f32) -> f32 {
    let mut sum = 0.0f64;
    for i in 0..4096u16 {
        let p = match space {
            TexSpace::Uv { transform, .. } => {
                let at = |k: u16| (f32::from(k) + 0.5) / 64.0;
                let uv = transform.apply(etendue_core::Vec2::new(at(i % 64), at(i / 64)));
                Vec3A::new(uv.x, uv.y, 0.0)
            }
            TexSpace::World(_) => {
                let at = |k: u16| f32::from(k % 16) + 0.5 + f32::from(k % 7) / 8.0;
                Vec3A::new(at(i), at(i / 16), at(i / 256))
            }
        };
        sum += f64::from(value(p));
    }
    (sum / 4096.0) as f32
}
