//! How far a picture is from a reference, in numbers.

/// Fraction of pixels that the trimmed error leaves out.
const TRIM: f64 = 1e-3;
/// Keeps the relative error of black references finite.
pub(crate) const EPSILON: f64 = 0.01;

/// The distance of a picture from a reference. Pixels where either has a number that is not finite are counted and
/// left out of everything else.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Pixels compared.
    pub pixels: u64,
    /// Pixels of the picture with a NaN or an infinity.
    pub not_finite: u64,
    /// Pixels of the reference with a NaN or an infinity.
    pub reference_not_finite: u64,
    /// Root of the mean over pixels and channels of (a − r)².
    pub rmse: f64,
    /// Mean over pixels and channels of (a − r)² / (r² + 0.01) (Rousselle, Knaus & Zwicker 2011).
    pub relative_mse: f64,
    /// The same without the ⌈n/1000⌉ pixels where it is largest.
    pub relative_mse_trimmed: f64,
    /// Mean of each channel of the picture.
    pub mean: [f64; 3],
    /// Mean of each channel of the reference.
    pub reference_mean: [f64; 3],
}

impl Comparison {
    /// The picture's mean over the reference's, by channel; `None` where the reference is black.
    pub fn ratio(&self) -> [Option<f64>; 3] {
        let mut out = [None; 3];
        for ((o, a), r) in out.iter_mut().zip(self.mean).zip(self.reference_mean) {
            *o = (r != 0.0).then_some(a / r);
        }
        out
    }
}

/// Why two pictures are not compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// Not the same number of pixels.
    #[error("the pictures have {0} and {1} pixels; render both in one size")]
    Size(usize, usize),
    /// Not the number of pixels that the size has.
    #[error("the pictures have {pixels} pixels, which is not {width} times {height}")]
    Shape {
        /// Pixels of either picture.
        pixels: usize,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A viewing distance that is none.
    #[error("pixels to a degree must be from 1 to 1000; the default is 67")]
    PixelsPerDegree,
    /// Not one picture and one cost for each run.
    #[error("{pictures} pictures and the costs of {costs} runs; give one of both for each run")]
    Runs {
        /// Pictures.
        pictures: usize,
        /// Costs.
        costs: usize,
    },
    /// Room for one number a pixel.
    #[error("out of memory while comparing")]
    Memory,
}

/// Compares linear pictures, pixel by pixel in the same order.
///
/// # Errors
/// Different numbers of pixels; no room for one number a pixel.
pub fn compare(picture: &[[f32; 3]], reference: &[[f32; 3]]) -> Result<Comparison, CompareError> {
    if picture.len() != reference.len() {
        return Err(CompareError::Size(picture.len(), reference.len()));
    }
    let mut out = Comparison::default();
    let mut errors: Vec<f64> = Vec::new();
    errors.try_reserve_exact(picture.len()).map_err(|_| CompareError::Memory)?;
    let mut squares = 0.0;
    for (a, r) in picture.iter().zip(reference) {
        let (bad_a, bad_r) = (!finite(a), !finite(r));
        out.not_finite = out.not_finite.saturating_add(u64::from(bad_a));
        out.reference_not_finite = out.reference_not_finite.saturating_add(u64::from(bad_r));
        if bad_a || bad_r {
            continue;
        }
        let mut error = 0.0;
        for (c, (a, r)) in a.iter().zip(r).enumerate() {
            let (a, r) = (f64::from(*a), f64::from(*r));
            let square = (a - r) * (a - r);
            squares += square;
            error += square / (r * r + EPSILON) / 3.0;
            let sums = out.mean.get_mut(c).zip(out.reference_mean.get_mut(c));
            if let Some((mean, reference_mean)) = sums {
                *mean += a;
                *reference_mean += r;
            }
        }
        errors.push(error);
    }
    let n = errors.len();
    out.pixels = n as u64;
    if n == 0 {
        return Ok(out);
    }
    let count = n as f64;
    out.mean = out.mean.map(|s| s / count);
    out.reference_mean = out.reference_mean.map(|s| s / count);
    out.rmse = (squares / (3.0 * count)).sqrt();
    out.relative_mse = errors.iter().sum::<f64>() / count;
    out.relative_mse_trimmed = trimmed_mean(&mut errors);
    Ok(out)
}

/// The mean without the ⌈n/1000⌉ largest; 0 where nothing is left.
pub(crate) fn trimmed_mean(errors: &mut [f64]) -> f64 {
    let kept = errors.len().saturating_sub((errors.len() as f64 * TRIM).ceil() as usize);
    if kept == 0 {
        return 0.0;
    }
    let (small, _, _) = errors.select_nth_unstable_by(kept, f64::total_cmp);
    small.iter().sum::<f64>() / kept as f64
}

pub(crate) fn finite(c: &[f32; 3]) -> bool {
    c.iter().all(|v| v.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_numbers() {
        let r = vec![[1.0, 0.0, 2.0]; 4];
        let mut a = r.clone();
        assert_eq!(compare(&a, &r).unwrap().rmse, 0.0);
        a[2] = [1.5, 0.1, 2.0];
        let c = compare(&a, &r).unwrap();
        // Squares 0.25, 0.01 and 0, of twelve numbers.
        assert!((c.rmse - (0.26f64 / 12.0).sqrt()).abs() < 1e-8);
        assert!((c.relative_mse - (0.25 / 1.01 + 0.01 / 0.01) / 12.0).abs() < 1e-7);
        assert_eq!(c.relative_mse_trimmed, 0.0, "the one wrong pixel is the worst");
        assert_eq!((c.mean[2], c.reference_mean), (2.0, [1.0, 0.0, 2.0]));
        assert_eq!(c.ratio()[1], None);
        assert_eq!(c.ratio()[0], Some(1.125));
    }

    #[test]
    fn one_pixel_of_each_thousand_begun_is_trimmed() {
        let r = vec![[1.0; 3]; 1001];
        let mut a = r.clone();
        (a[3], a[700], a[9]) = ([5.0; 3], [7.0; 3], [2.0; 3]);
        let c = compare(&a, &r).unwrap();
        assert!((c.relative_mse_trimmed - 1.0 / 1.01 / 999.0).abs() < 1e-9, "{c:?}");
    }

    #[test]
    fn what_is_no_number_is_counted() {
        let r = [[1.0; 3], [f32::INFINITY, 0.0, 0.0], [1.0; 3], [f32::NAN; 3]];
        let a = [[f32::NAN, 1.0, 1.0], [0.0; 3], [2.0; 3], [f32::NAN; 3]];
        let c = compare(&a, &r).unwrap();
        assert_eq!((c.pixels, c.not_finite, c.reference_not_finite), (1, 2, 2));
        assert_eq!((c.rmse, c.relative_mse_trimmed), (1.0, 0.0));
        assert_eq!(compare(&a[..0], &r[..0]).unwrap(), Comparison::default());
        assert_eq!(compare(&a, &r[..2]), Err(CompareError::Size(4, 2)));
    }
}
