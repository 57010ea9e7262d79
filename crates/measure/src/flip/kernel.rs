//! The eye's filters, as products of filters along rows and along columns.

use std::f64::consts::PI;

use etendue_core::math::wide::exp;

/// A filter along one axis: an odd number of weights, the middle one for the pixel itself.
#[derive(Clone, Debug)]
pub(super) struct Kernel(Vec<f32>);

impl Kernel {
    /// From the weights at `0, ±1, …, ±radius`. Weights too small for an f32 sum to notice are left out.
    fn new(radius: usize, weight: impl Fn(f64) -> f64) -> Self {
        let side = |x: usize| weight(x as f64).abs().max(weight(-(x as f64)).abs());
        let largest = (0..=radius).map(side).fold(0.0, f64::max);
        let reach = (1..=radius).rev().find(|x| side(*x) > 1e-9 * largest).unwrap_or(0);
        let taps = 2 * reach + 1;
        Self((0..taps).map(|i| weight(i as f64 - reach as f64) as f32).collect())
    }

    /// How far it looks to either side.
    pub(super) fn radius(&self) -> usize {
        self.0.len() / 2
    }

    /// The weights, of the pixels from `-radius` to `radius`.
    pub(super) fn weights(&self) -> &[f32] {
        &self.0
    }
}

/// All filters for one viewing distance.
#[derive(Clone, Debug)]
pub(super) struct Kernels {
    /// Contrast sensitivity to luminance.
    pub(super) luminance: Kernel,
    /// Contrast sensitivity from red to green.
    pub(super) red_green: Kernel,
    /// The two Gaussians of the sensitivity from blue to yellow, each with its share.
    pub(super) blue_yellow: [Kernel; 2],
    pub(super) blue_yellow_shares: [f32; 2],
    /// The Gaussian across, and its first and second derivative along, an edge or a point.
    pub(super) feature: [Kernel; 3],
}

impl Kernels {
    /// For displays of this many pixels to a degree of the field of view.
    pub(super) fn new(pixels_per_degree: f64) -> Self {
        // Every contrast filter has the radius of the widest Gaussian: three standard deviations.
        let radius = (3.0 * deviation(BLUE_YELLOW[0].falloff) * pixels_per_degree).ceil() as usize;
        let gaussian = |falloff: f64| {
            let weight = move |x: f64| {
                let degrees = x / pixels_per_degree;
                exp(-PI * PI * degrees * degrees / falloff)
            };
            let sum = total(radius, weight);
            (Kernel::new(radius, move |x| weight(x) / sum), sum)
        };
        let (first, first_sum) = gaussian(BLUE_YELLOW[0].falloff);
        let (second, second_sum) = gaussian(BLUE_YELLOW[1].falloff);
        // The Gaussians are normalised one by one; what they had in two dimensions is their share.
        let [a, b] = [(BLUE_YELLOW[0], first_sum), (BLUE_YELLOW[1], second_sum)]
            .map(|(g, sum)| g.amplitude * (PI / g.falloff).sqrt() * sum * sum);
        Self {
            luminance: gaussian(LUMINANCE_FALLOFF).0,
            red_green: gaussian(RED_GREEN_FALLOFF).0,
            blue_yellow: [first, second],
            blue_yellow_shares: [a / (a + b), b / (a + b)].map(|s| s as f32),
            feature: feature(0.5 * FEATURE_WIDTH * pixels_per_degree),
        }
    }

    /// How far the farthest-looking filter looks.
    pub(super) fn radius(&self) -> usize {
        let contrast = [&self.luminance, &self.red_green].into_iter().chain(&self.blue_yellow);
        contrast.chain(&self.feature).map(Kernel::radius).max().unwrap_or(0)
    }
}

/// One term of a contrast sensitivity, a √(π/b) exp(−π²x²/b) with x in degrees.
#[derive(Clone, Copy)]
struct Term {
    amplitude: f64,
    /// Degrees².
    falloff: f64,
}

// The contrast sensitivities of Andersson et al. 2020. The second terms of the first two have no amplitude.
const LUMINANCE_FALLOFF: f64 = 0.0047;
const RED_GREEN_FALLOFF: f64 = 0.0053;
const BLUE_YELLOW: [Term; 2] =
    [Term { amplitude: 34.1, falloff: 0.04 }, Term { amplitude: 13.5, falloff: 0.025 }];

/// Width in degrees of the features that the eye finds by itself, two standard deviations (Andersson et al. 2020).
const FEATURE_WIDTH: f64 = 0.082;

/// Standard deviation in degrees.
fn deviation(falloff: f64) -> f64 {
    (falloff / (2.0 * PI * PI)).sqrt()
}

fn total(radius: usize, weight: impl Fn(f64) -> f64) -> f64 {
    weight(0.0) + 2.0 * (1..=radius).map(|x| weight(x as f64)).sum::<f64>()
}

/// The Gaussian with sum 1; its derivatives with sum 1 over the positive weights and −1 over the negative ones, so
/// that features of black and white reach ±1 and constants vanish.
fn feature(deviation: f64) -> [Kernel; 3] {
    let radius = (3.0 * deviation).ceil() as usize;
    let square = move |x: f64| x * x / (deviation * deviation);
    let gaussian = move |x: f64| exp(-0.5 * square(x));
    let first = move |x: f64| -x * gaussian(x);
    let second = move |x: f64| (square(x) - 1.0) * gaussian(x);
    let sum = total(radius, gaussian);
    let half = 0.5 * total(radius, |x| first(x).abs());
    let positive = total(radius, |x| second(x).max(0.0));
    let negative = total(radius, |x| (-second(x)).max(0.0));
    [
        Kernel::new(radius, |x| gaussian(x) / sum),
        Kernel::new(radius, |x| first(x) / half),
        Kernel::new(radius, |x| second(x) / if second(x) > 0.0 { positive } else { negative }),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(k: &Kernel) -> f32 {
        k.weights().iter().sum()
    }

    #[test]
    fn constants_pass_the_contrast_filters_and_not_the_features() {
        for ppd in [1.0, 2.5, 20.0, 67.02, 300.0, 1000.0] {
            let k = Kernels::new(ppd);
            for kernel in [&k.luminance, &k.red_green, &k.blue_yellow[0], &k.blue_yellow[1], &k.feature[0]] {
                assert!((sum(kernel) - 1.0).abs() < 1e-5, "{ppd}: {kernel:?}");
            }
            assert!((k.blue_yellow_shares.iter().sum::<f32>() - 1.0).abs() < 1e-6);
            assert!(k.feature[1..].iter().all(|d| sum(d).abs() < 1e-5), "{ppd}: {:?}", k.feature);
            let positive = |k: &Kernel| k.weights().iter().map(|w| w.max(0.0)).sum::<f32>();
            assert!(k.feature[1..].iter().all(|d| (positive(d) - 1.0).abs() < 1e-5), "{ppd}");
        }
    }

    #[test]
    fn radii_at_the_usual_distance() {
        let k = Kernels::new(67.02);
        assert_eq!((k.radius(), k.feature[1].radius()), (10, 9));
        assert!(k.luminance.radius() < 10, "nothing is left of it there");
    }
}
