//! Which exposures show a reference, and the film they are shown on.

use std::f64::consts::LN_2;

use etendue_core::math::wide;

use super::FlipExposures;
use crate::CompareError;

/// What a display shows of the brightest pixel at the first exposure and of the median at the last.
const TARGET: f64 = 0.85;
/// Numerator and denominator of the film curve (Narkowicz 2015, for ACES), highest power first; 0.6 is the
/// exposure that it was fitted with.
const NUMERATOR: [f64; 3] = [0.36 * 2.51, 0.6 * 0.03, 0.0];
const DENOMINATOR: [f64; 3] = [0.36 * 2.43, 0.6 * 0.59, 0.14];

/// Linear radiance to linear display light, 0 to 1.
pub(super) fn tone_map(radiance: f64) -> f32 {
    // White is reached long before; infinities would divide one another. No display shows less than nothing.
    let x = radiance.clamp(0.0, 1e6);
    let [n, d] = [NUMERATOR, DENOMINATOR].map(|[a, b, c]| (a * x + b) * x + c);
    (n / d).min(1.0) as f32
}

/// The radiance that [`tone_map`] makes [`TARGET`]: the root of a quadratic.
fn target_radiance() -> f64 {
    let [a, b, c] = [0, 1, 2].map(|i| NUMERATOR[i] - TARGET * DENOMINATOR[i]);
    (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)
}

/// From the exposure that shows the brightest pixel to the one that shows the median (Andersson et al. 2021),
/// of the pixels that are finite. Luminances count from f32's ε on, so that pictures with little or no
/// light have exposures too.
pub(super) fn exposures(reference: &[[f32; 3]]) -> Result<FlipExposures, CompareError> {
    let mut luminances: Vec<f32> = Vec::new();
    luminances.try_reserve_exact(reference.len()).map_err(|_| CompareError::Memory)?;
    let finite = reference.iter().filter(|p| p.iter().all(|c| c.is_finite()));
    let wide = finite.map(|p| p.map(f64::from));
    luminances.extend(wide.map(|[r, g, b]| (0.2126 * r + 0.7152 * g + 0.0722 * b) as f32));
    let floor = f64::from(f32::EPSILON);
    let largest = luminances.iter().copied().fold(f32::EPSILON, f32::max);
    let middle = luminances.len() / 2;
    let median = if luminances.is_empty() {
        floor
    } else {
        // Of an even number the upper one.
        f64::from(*luminances.select_nth_unstable_by(middle, f32::total_cmp).1).max(floor)
    };
    let stops = |l: f64| wide::ln(target_radiance() / l) / LN_2;
    let (start, stop) = (stops(f64::from(largest)), stops(median));
    Ok(FlipExposures { start, stop, count: ((stop - start).ceil() as u32).max(2) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_film_is_white_at_the_end() {
        assert_eq!((tone_map(0.0), tone_map(-3.0), tone_map(f64::MAX)), (0.0, 0.0, 1.0));
        assert!((f64::from(tone_map(target_radiance())) - TARGET).abs() < 1e-7);
        assert!((target_radiance() - 2.118_872).abs() < 1e-6);
    }

    #[test]
    fn brightest_and_median_are_shown() {
        let e = exposures(&[[1.0; 3], [2.0; 3], [3.0; 3], [64.0; 3]]).unwrap();
        assert!((e.stop - e.start - (64.0f64 / 3.0).log2()).abs() < 1e-6 && e.count == 5, "{e:?}");
        assert_eq!(exposures(&[[1.0; 3], [f32::NAN; 3], [1.0; 3]]).unwrap().count, 2);
        for dark in [&[][..], &[[0.0; 3]; 4], &[[f32::INFINITY; 3]], &[[-1.0; 3]; 3], &[[1e-30; 3]]] {
            let e = exposures(dark).unwrap();
            assert!(e.start == e.stop && e.count == 2 && e.start.is_finite(), "{e:?}");
        }
        let widest = exposures(&[[0.0; 3], [0.0; 3], [f32::MAX; 3]]).unwrap();
        assert!(widest.count > 100 && widest.count < 200, "{widest:?}");
    }
}
