//! From a texture coordinate to the texels it touches, one axis at a time.

/// What lies beyond the border of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// Its border texels.
    Clamp,
    /// Its mirror image.
    Mirror,
}

/// How texels become a continuous image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The texel whose cell holds the point.
    Nearest,
    /// Linear between the four nearest texel centres.
    #[default]
    Bilinear,
}

/// Two texels of a row or column and where between them the point lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    pub(crate) lo: u32,
    pub(crate) hi: u32,
    /// Weight of `hi`, in `[0, 1)`.
    pub(crate) t: f32,
}

/// `⌊x⌋` without a library call; saturates, and NaN is 0.
#[inline]
pub(crate) fn floor(x: f32) -> i32 {
    let i = x as i32;
    if (i as f32) > x { i.saturating_sub(1) } else { i }
}

impl Wrap {
    /// The coordinate brought near the image, so that `coordinate · size` keeps its fraction however far out it was.
    #[inline]
    fn reduce(self, x: f32) -> f32 {
        // Beyond 2²³ there is no fraction left; what is not a number is put at 0.
        let has_fraction = x.abs() < 8_388_608.0;
        if !has_fraction {
            return if x > 0.0 && matches!(self, Self::Clamp) { 2.0 } else { 0.0 };
        }
        match self {
            Self::Repeat => x - floor(x) as f32,
            Self::Clamp => x.clamp(-1.0, 2.0),
            Self::Mirror => x - 2.0 * floor(0.5 * x) as f32,
        }
    }

    /// The texel at index `i`, which is at most a few images away.
    #[inline]
    fn texel(self, i: i32, size: u32) -> u32 {
        let n = size as i32;
        match self {
            Self::Repeat => i.rem_euclid(n) as u32,
            Self::Clamp => i.clamp(0, n - 1) as u32,
            Self::Mirror => {
                let j = i.rem_euclid(2 * n);
                (if j < n { j } else { 2 * n - 1 - j }) as u32
            }
        }
    }

    /// The texel whose cell holds `x`; `size` is at least 1 and at most 2¹⁶.
    #[inline]
    pub(crate) fn nearest(self, x: f32, size: u32) -> u32 {
        self.texel(floor(self.reduce(x) * size as f32), size)
    }

    /// The texels whose centres enclose `x`.
    #[inline]
    pub(crate) fn pair(self, x: f32, size: u32) -> Pair {
        let s = self.reduce(x) * size as f32 - 0.5;
        let i = floor(s);
        Pair { lo: self.texel(i, size), hi: self.texel(i + 1, size), t: s - i as f32 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_is_floor() {
        for (x, y) in [(0.0, 0), (0.5, 0), (-0.5, -1), (-1.0, -1), (2.999, 2), (-2.001, -3), (f32::NAN, 0)] {
            assert_eq!(floor(x), y, "{x}");
        }
    }

    #[test]
    fn wraps_by_the_book() {
        let nearest = |w: Wrap| [-1.3, -0.25, 0.0, 0.3, 0.99, 1.0, 1.3, 2.1].map(|x| w.nearest(x, 4));
        assert_eq!(nearest(Wrap::Repeat), [2, 3, 0, 1, 3, 0, 1, 0]);
        assert_eq!(nearest(Wrap::Clamp), [0, 0, 0, 1, 3, 3, 3, 3]);
        assert_eq!(nearest(Wrap::Mirror), [2, 0, 0, 1, 3, 3, 2, 0]);
    }

    #[test]
    fn pairs_meet_across_the_border() {
        let at = |w: Wrap, x: f32| (w.pair(x, 4).lo, w.pair(x, 4).hi, w.pair(x, 4).t);
        assert_eq!(at(Wrap::Repeat, 0.0), (3, 0, 0.5));
        assert_eq!(at(Wrap::Clamp, 0.0), (0, 0, 0.5));
        assert_eq!(at(Wrap::Mirror, 0.0), (0, 0, 0.5));
        assert_eq!(at(Wrap::Mirror, 1.0), (3, 3, 0.5));
        assert_eq!(at(Wrap::Repeat, 0.25), (0, 1, 0.5));
        assert_eq!(at(Wrap::Repeat, 7.25), (0, 1, 0.5));
    }

    #[test]
    fn anything_is_a_coordinate() {
        for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -1e30, 1e-45, 8_388_607.5] {
            for w in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
                for size in [1, 7, 65_536] {
                    let p = w.pair(x, size);
                    assert!(w.nearest(x, size) < size && p.lo < size && p.hi < size, "{x} {w:?}");
                    assert!((0.0..1.0).contains(&p.t), "{x} {w:?}: {p:?}");
                }
            }
        }
        assert_eq!(Wrap::Clamp.nearest(f32::INFINITY, 4), 3);
    }
}
