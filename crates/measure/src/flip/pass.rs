use etendue_core::math::pow;

use super::colour::{colour_error, from_ycxcz, hunt_lab, to_ycxcz};
use super::kernel::Kernels;
use super::window::{Seen, Window};
use super::{FlipMap, FlipOptions};
use crate::CompareError;

/// Two pictures, and each pixel's largest difference over the exposures so far.
pub(super) struct Pass<'a> {
    picture: &'a [[f32; 3]],
    reference: &'a [[f32; 3]],
    size: [usize; 2],
    kernels: Kernels,
    values: Vec<f32>,
}

impl<'a> Pass<'a> {
    pub(super) fn new(
        picture: &'a [[f32; 3]],
        reference: &'a [[f32; 3]],
        size: [u32; 2],
        options: FlipOptions,
    ) -> Result<Self, CompareError> {
        if picture.len() != reference.len() {
            return Err(CompareError::Size(picture.len(), reference.len()));
        }
        if u64::from(size[0]) * u64::from(size[1]) != picture.len() as u64 {
            return Err(CompareError::Shape { pixels: picture.len(), width: size[0], height: size[1] });
        }
        if !(options.pixels_per_degree >= 1.0 && options.pixels_per_degree <= 1000.0) {
            return Err(CompareError::PixelsPerDegree);
        }
        let mut values = Vec::new();
        values.try_reserve_exact(picture.len()).map_err(|_| CompareError::Memory)?;
        values.resize(picture.len(), 0.0);
        let kernels = Kernels::new(options.pixels_per_degree);
        Ok(Self { picture, reference, size: size.map(|s| s as usize), kernels, values })
    }

    /// Looks at both pictures through `film`, from linear radiance to linear display light in [0, 1].
    pub(super) fn look(&mut self, film: impl Fn(f32) -> f32) -> Result<(), CompareError> {
        let width = self.size[0];
        if self.values.is_empty() {
            return Ok(());
        }
        let [mut picture, mut reference] =
            [Window::new(&self.kernels, self.size)?, Window::new(&self.kernels, self.size)?];
        let shown = |pixel: [f32; 3]| to_ycxcz(pixel.map(&film));
        let mut rows = self.picture.chunks_exact(width).zip(self.reference.chunks_exact(width));
        for (y, values) in self.values.chunks_exact_mut(width).enumerate() {
            let missing = picture.needs(y) - picture.pushed();
            for (a, r) in rows.by_ref().take(missing) {
                picture.push(a.iter().zip(r).map(|(a, r)| shown(repaired(*a, *r))));
                reference.push(a.iter().zip(r).map(|(a, r)| shown(repaired(*r, *a))));
            }
            picture.filter(y);
            reference.filter(y);
            for (x, value) in values.iter_mut().enumerate() {
                *value = value.max(difference(picture.seen(x), reference.seen(x)));
            }
        }
        Ok(())
    }

    /// What was seen, with the pixels that are not finite.
    pub(super) fn into_map(self, size: [u32; 2]) -> FlipMap {
        let Self { picture, reference, mut values, .. } = self;
        let mut not_finite = 0;
        for (value, (a, r)) in values.iter_mut().zip(picture.iter().zip(reference)) {
            if !(finite(a) && finite(r)) {
                not_finite += 1;
                *value = 1.0;
            }
        }
        FlipMap { size, values, not_finite, exposures: None }
    }
}

/// The pixel, or what makes the pictures alike there if it is no colour: the other's, or black.
fn repaired(pixel: [f32; 3], other: [f32; 3]) -> [f32; 3] {
    if finite(&pixel) {
        pixel
    } else if finite(&other) {
        other
    } else {
        [0.0; 3]
    }
}

fn finite(c: &[f32; 3]) -> bool {
    c.iter().all(|v| v.is_finite())
}

/// The difference of two pixels: that of their colours, the more the more their features differ (Andersson et al.
/// 2020, final difference).
fn difference(a: Seen, b: Seen) -> f32 {
    let colour = colour_error(hunt_lab(from_ycxcz(a.ycxcz)), hunt_lab(from_ycxcz(b.ycxcz)));
    let feature = (a.edge - b.edge).abs().max((a.point - b.point).abs());
    let feature = (feature * std::f32::consts::FRAC_1_SQRT_2).sqrt().min(1.0);
    pow(colour, 1.0 - feature)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_amplify_a_difference_of_colour_and_make_none() {
        let plain = Seen { ycxcz: [0.5, 0.0, 0.0], edge: 0.0, point: 0.0 };
        let lighter = Seen { ycxcz: [0.6, 0.0, 0.0], ..plain };
        let colour = difference(plain, lighter);
        assert!(colour > 0.05 && colour < 0.3, "{colour}");
        let edge = difference(plain, Seen { edge: 0.3, ..lighter });
        let point = difference(plain, Seen { point: 0.6, ..lighter });
        assert!(edge > 1.5 * colour && point > edge && point < 1.0, "{colour}, {edge}, {point}");
        assert_eq!(difference(plain, Seen { edge: 0.3, point: 0.6, ..plain }), 0.0);
        assert_eq!(difference(lighter, plain), colour);
        // c^(1 − f), with f = √(0.3 / √2).
        let want = f64::from(colour).powf(1.0 - (0.3f64 / 2.0f64.sqrt()).sqrt());
        assert!((f64::from(edge) - want).abs() < 1e-6);
    }

    #[test]
    fn only_what_is_no_colour_is_repaired() {
        let (good, other, bad) = ([1.0, -2.0, 3.0], [4.0; 3], [0.0, f32::NAN, 0.0]);
        assert_eq!((repaired(good, other), repaired(good, bad)), (good, good));
        assert_eq!((repaired(bad, other), repaired(bad, bad)), (other, [0.0; 3]));
    }
}
