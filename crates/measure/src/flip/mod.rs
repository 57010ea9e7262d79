//! ꟻLIP: how different two pictures look when one is flipped to the other in place.
//!
//! Colours are filtered as the eye does at a viewing distance, compared in a uniform space, and the difference is
//! amplified where edges or points (fireflies) come or go. What numbers like RMSE drown in a few bright pixels is
//! seen here as a viewer would. Sources: P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström &
//! M. D. Fairchild 2020, "ꟻLIP: A Difference Evaluator for Alternating Images"; P. Andersson, J. Nilsson,
//! P. Shirley & T. Akenine-Möller 2021, "Visualizing Errors in Rendered High Dynamic Range Images".

mod colour;
mod exposure;
mod kernel;
mod map;
mod pass;
mod window;

pub use map::{FlipExposures, FlipMap};

use std::f64::consts::LN_2;

use etendue_core::math::wide;

use crate::CompareError;
use pass::Pass;

/// How the pictures are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlipOptions {
    /// Pixels to a degree of the field of view, 1 to 1000: (π/180) · distance · pixels / width of the display. The
    /// default is 0.7 m from a display 0.7 m and 3840 pixels wide.
    pub pixels_per_degree: f64,
}

impl Default for FlipOptions {
    fn default() -> Self {
        Self { pixels_per_degree: 3840.0_f64.to_radians() }
    }
}

/// How different a picture of linear radiance looks from a reference, `size` (width, height) each, row by row from
/// the top: HDR-FLIP, the largest difference at any of the exposures that the reference asks for, on a film like
/// ACES. Negative radiance is taken as none.
///
/// The order matters: the exposures are those that show the reference. A pixel where either picture has a NaN or an
/// infinity gets the largest difference, 1; its neighbours are compared as if the two were alike there.
///
/// Time grows with the exposures, one for each stop between the brightest and the median luminance of the reference.
/// Luminances below f32's ε count as that: if more than half of a reference is black, exposures go on for 24 stops, and
/// any light in the dark is an error.
///
/// ```
/// use etendue_measure::flip::{FlipOptions, flip};
/// let reference = vec![[0.5, 0.4, 0.3]; 32 * 16];
/// let mut picture = reference.clone();
/// picture[200] = [9.0, 8.0, 7.0];
/// let map = flip(&picture, &reference, [32, 16], FlipOptions::default()).unwrap();
/// assert!(map.max() == map.values[200] && map.mean() < 0.25);
/// assert_eq!(map.exposures.unwrap().count, 2);
/// ```
///
/// # Errors
/// Not as many pixels as the other picture or the size have; an impossible number of pixels to a degree; no room for
/// a number a pixel.
pub fn flip(
    picture: &[[f32; 3]],
    reference: &[[f32; 3]],
    size: [u32; 2],
    options: FlipOptions,
) -> Result<FlipMap, CompareError> {
    let mut pass = Pass::new(picture, reference, size, options)?;
    let exposures = exposure::exposures(reference)?;
    for i in 0..exposures.count {
        if i > 0 && exposures.start == exposures.stop {
            break;
        }
        let along = f64::from(i) / f64::from(exposures.count - 1);
        let stops = exposures.start + (exposures.stop - exposures.start) * along;
        let scale = wide::exp(stops * LN_2);
        pass.look(|radiance| exposure::tone_map(scale * f64::from(radiance)))?;
    }
    Ok(FlipMap { exposures: Some(exposures), ..pass.into_map(size) })
}

/// How different two pictures look that are shown as they are: LDR-FLIP, of linear Rec.709 (not sRGB-encoded), clamped
/// to [0, 1]. The order of the pictures does not matter. Pixels that are not finite are as in [`flip`].
///
/// # Errors
/// As [`flip`].
pub fn flip_ldr(
    picture: &[[f32; 3]],
    reference: &[[f32; 3]],
    size: [u32; 2],
    options: FlipOptions,
) -> Result<FlipMap, CompareError> {
    let mut pass = Pass::new(picture, reference, size, options)?;
    pass.look(|light| light.clamp(0.0, 1.0))?;
    Ok(pass.into_map(size))
}
