use std::sync::Arc;

use etendue_core::{Fingerprint, Spectrum, Vec3A};

use crate::lookup::floor;
use crate::space::average;
use crate::{Tex, TexPoint, TexSpace, Texture};

/// Two textures in turn, on the squares of a board or, in the world, in cubes.
///
/// Cells have side 1 in the pattern's space; the one at the origin is even. Where a surface lies in the plane between
/// two layers of cubes rounding decides, and it shows: shift the pattern by half a cell.
///
/// ```
/// use etendue_core::Spectrum;
/// use etendue_texture::{Checker, Tex, TexSpace};
///
/// let floor: Tex = Checker::new(TexSpace::uv(8.0), Spectrum::gray(0.8), Spectrum::gray(0.1)).into();
/// assert!(!floor.is_constant());
/// ```
#[derive(Clone, Debug)]
pub struct Checker {
    /// Where the cells are.
    pub space: TexSpace,
    /// What is seen where the sum of the cell's indices is even.
    pub even: Tex,
    /// What is seen elsewhere.
    pub odd: Tex,
}

impl Checker {
    /// Two textures or colours in turn.
    pub fn new(space: TexSpace, even: impl Into<Tex>, odd: impl Into<Tex>) -> Self {
        Self { space, even: even.into(), odd: odd.into() }
    }
}

/// Whether the cell of a point of the pattern is odd. Beyond 2²³, and where a coordinate is no number, cells are not told
/// apart.
#[inline]
fn is_odd(p: Vec3A) -> bool {
    let sum = floor(p.x).wrapping_add(floor(p.y)).wrapping_add(floor(p.z));
    sum & 1 != 0
}

impl Texture for Checker {
    /// Counts one look-up and those of the texture seen.
    fn eval(&self, at: &TexPoint<'_>) -> Spectrum {
        at.count();
        if is_odd(self.space.point(at)) { self.odd.eval(at) } else { self.even.eval(at) }
    }

    /// Of both means, by the cells' shares of the unit square (of the world, a half).
    fn mean(&self) -> Spectrum {
        let odd = match self.space {
            TexSpace::Uv { .. } => average(&self.space, |p| f32::from(u8::from(is_odd(p)))),
            TexSpace::World(_) => 0.5,
        };
        self.even.mean().lerp(self.odd.mean(), odd)
    }

    fn max(&self) -> Spectrum {
        larger(self.even.max(), self.odd.max())
    }

    fn min(&self) -> Spectrum {
        -larger(-self.even.min(), -self.odd.min())
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("checker");
        self.space.fingerprint(f);
        self.even.fingerprint(f);
        self.odd.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        size_of::<Self>() + self.even.bytes() + self.odd.bytes()
    }
}

/// The larger of each channel.
pub(crate) fn larger(a: Spectrum, b: Spectrum) -> Spectrum {
    let pick = |a: f32, b: f32| if a > b { a } else { b };
    Spectrum::rgb(pick(a.r(), b.r()), pick(a.g(), b.g()), pick(a.b(), b.b()))
}

impl From<Checker> for Tex {
    fn from(checker: Checker) -> Self {
        Self::Open(Arc::new(checker))
    }
}
