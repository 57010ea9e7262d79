/// Which random number of a path is meant. Named, never counted: skipping light sampling or roulette shifts nothing.
///
/// The first block of eight is one joint point set: film 2, light 2, lens 2, BSDF 2 of the first vertex (a dimension
/// skipped because the scene lacks a lens leaves the others where they are). Every later vertex owns one stride of
/// [`Dim::STRIDE`] dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Dim(u32);

/// The named numbers of one path vertex. Two-dimensional slots take their own number and the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Slot {
    /// 2-D: point on a light. The pick of the light takes the first coordinate and remaps it.
    Light = 0,
    /// 2-D: scattered direction.
    Bsdf = 2,
    /// 1-D: Russian roulette.
    Roulette = 4,
    /// 1-D: opacity along the ray that leaves.
    Cutout = 5,
    /// 1-D: which lobe of the BSDF.
    Lobe = 6,
    /// First spare number.
    Spare0 = 7,
    /// Second spare number.
    Spare1 = 8,
}

impl Dim {
    /// 2-D: position inside the pixel.
    pub const FILM: Self = Self(0);
    /// 2-D: position on the lens.
    pub const LENS: Self = Self(4);
    /// 1-D: moment in the shutter interval; shares the lens's block (its own fresh dimension beside it).
    pub const TIME: Self = Self(8);
    /// Numbers per path vertex after the camera block.
    pub const STRIDE: u32 = 9;
    /// Where the strides begin; below are the camera's numbers and those of the first vertex that joined them.
    pub const FIRST: u32 = 16;

    /// The number `slot` of the vertex at `depth` (0 is the first hit). Past a depth of 4 · 10⁸ the numbers repeat.
    #[inline]
    pub const fn bounce(depth: u32, slot: Slot) -> Self {
        // The first vertex's light and BSDF pairs live in the joint block of eight.
        if depth == 0 {
            match slot {
                Slot::Light => return Self(2),
                Slot::Bsdf => return Self(6),
                _ => {}
            }
        }
        Self(depth.wrapping_mul(Self::STRIDE).wrapping_add(Self::FIRST + slot as u32))
    }

    /// The dimension after this one: the second of a pair.
    #[inline]
    pub const fn next(self) -> Self {
        Self(self.0.wrapping_add(1))
    }

    /// The plain index.
    #[inline]
    pub const fn index(self) -> u32 {
        self.0
    }
}
