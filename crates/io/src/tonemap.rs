use etendue_core::{Spectrum, math};

/// From linear radiance to the 0…255 of a display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneMap {
    /// Radiance is multiplied by 2 to the power of this.
    pub exposure: f32,
    /// Rolls bright values off instead of clipping them (Reinhard et al. 2002 on luminance, white at 4).
    pub filmic: bool,
}

impl Default for ToneMap {
    /// As it is: exposure 0, clipped.
    fn default() -> Self {
        Self { exposure: 0.0, filmic: false }
    }
}

impl ToneMap {
    /// sRGB bytes; anything that is not a number becomes black.
    pub fn bytes(&self, l: Spectrum) -> [u8; 3] {
        let mut l = l * math::exp2(self.exposure);
        if self.filmic {
            let y = l.luminance();
            if y > 0.0 && y.is_finite() {
                l *= (1.0 + y / 16.0) / (1.0 + y);
            }
        }
        l.to_array().map(|c| {
            let c = if c > 0.0 { c } else { 0.0 };
            let c = if c < 1.0 { c } else { 1.0 };
            // IEC 61966-2-1.
            let s = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * math::pow(c, 1.0 / 2.4) - 0.055 };
            (s * 255.0 + 0.5) as u8
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        let t = ToneMap::default();
        assert_eq!(t.bytes(Spectrum::BLACK), [0; 3]);
        assert_eq!(t.bytes(Spectrum::gray(9.0)), [255; 3]);
        assert_eq!(t.bytes(Spectrum::gray(f32::NAN)), [0; 3]);
        // ((128/255 + 0.055) / 1.055)^2.4.
        assert_eq!(t.bytes(Spectrum::gray(0.215_860_5)), [128; 3]);
        let up = ToneMap { exposure: 1.0, ..t };
        assert_eq!(up.bytes(Spectrum::gray(0.107_930_25)), [128; 3]);
    }
}
