use etendue_core::{Fingerprint, Vec4, math};

/// How 8-bit numbers mean light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// The sRGB curve (IEC 61966-2-1); alpha is linear all the same.
    Srgb,
    /// 255 is 1.
    Linear,
}

impl Encoding {
    fn decode(self, byte: u8) -> f32 {
        let v = f32::from(byte) / 255.0;
        match self {
            Self::Linear => v,
            Self::Srgb if v <= 0.040_45 => v / 12.92,
            Self::Srgb => math::pow((v + 0.055) / 1.055, 2.4),
        }
    }

    fn table(self) -> Box<[f32; 256]> {
        Box::new(std::array::from_fn(|i| self.decode(i as u8)))
    }
}

/// The numbers of an image, row by row, in the width they came in.
pub(crate) enum Texels {
    /// 8-bit, decoded by table at every read: a quarter of the memory of floats.
    Bytes { data: Box<[u8]>, decode: Box<[f32; 256]>, alpha: Box<[f32; 256]>, encoding: Encoding },
    /// Linear floats.
    Floats(Box<[f32]>),
}

impl Texels {
    pub(crate) fn bytes(data: Vec<u8>, encoding: Encoding) -> Self {
        let data = data.into_boxed_slice();
        Self::Bytes { data, decode: encoding.table(), alpha: Encoding::Linear.table(), encoding }
    }

    /// One decoded number; 0 beyond the end, which the invariants of the image rule out.
    #[inline]
    pub(crate) fn number(&self, i: usize, is_alpha: bool) -> f32 {
        match self {
            Self::Bytes { data, decode, alpha, .. } => {
                let byte = usize::from(data.get(i).copied().unwrap_or(0));
                if is_alpha { alpha[byte] } else { decode[byte] }
            }
            Self::Floats(data) => data.get(i).copied().unwrap_or(0.0),
        }
    }

    /// Red, green, blue and alpha of the texels that start at each place: what kind of image it is, is asked once.
    #[inline]
    pub(crate) fn texels<const N: usize>(&self, places: [usize; N], channels: usize) -> [Vec4; N] {
        match self {
            Self::Bytes { data, decode, alpha, .. } => places.map(|i| {
                let byte = |k: usize| usize::from(data.get(i + k).copied().unwrap_or(0));
                spread(channels, |k| decode[byte(k)], |k| alpha[byte(k)])
            }),
            Self::Floats(data) => {
                let float = |i: usize| data.get(i).copied().unwrap_or(0.0);
                places.map(|i| spread(channels, |k| float(i + k), |k| float(i + k)))
            }
        }
    }

    pub(crate) fn fingerprint(&self, f: &mut Fingerprint) {
        match self {
            Self::Bytes { data, encoding, .. } => {
                f.tag(if *encoding == Encoding::Srgb { "srgb" } else { "linear" });
                f.bytes(data);
            }
            Self::Floats(data) => {
                f.tag("float");
                f.floats(data);
            }
        }
    }

    pub(crate) fn size(&self) -> usize {
        match self {
            Self::Bytes { data, .. } => data.len() + 2 * size_of::<[f32; 256]>(),
            Self::Floats(data) => data.len() * size_of::<f32>(),
        }
    }
}

/// What the channels of a texel mean.
#[inline(always)]
fn spread(channels: usize, color: impl Fn(usize) -> f32, alpha: impl Fn(usize) -> f32) -> Vec4 {
    match channels {
        1 => Vec4::new(color(0), color(0), color(0), 1.0),
        2 => Vec4::new(color(0), color(0), color(0), alpha(1)),
        3 => Vec4::new(color(0), color(1), color(2), 1.0),
        _ => Vec4::new(color(0), color(1), color(2), alpha(3)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_decodes_by_the_standard() {
        for i in 0..=255u8 {
            let v = f64::from(i) / 255.0;
            let exact = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
            assert!((f64::from(Encoding::Srgb.decode(i)) - exact).abs() < 2e-7, "{i}");
        }
        assert_eq!((Encoding::Srgb.decode(0), Encoding::Srgb.decode(255)), (0.0, 1.0));
        assert_eq!(Encoding::Linear.decode(51), 0.2);
    }
}
