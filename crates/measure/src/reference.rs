use etendue_camera::Film;
use etendue_core::UVec2;

use crate::compare::{EPSILON, finite, trimmed_mean};

/// What a reference is off by itself, in the terms of [`Comparison`](crate::Comparison): the expectation of the
/// square of its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Part of a picture's relMSE.
    pub relative: f64,
    /// Part of a picture's trimmed relMSE.
    pub trimmed: f64,
    /// Part of a picture's mean square error (the square of RMSE).
    pub absolute: f64,
}

/// A picture that others are measured against, linear radiance row by row, and what is known of its own error.
///
/// Its noise adds to every error measured against it; [`Point::corrected`](crate::Point::corrected) takes it out again.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The pixels.
    pub rgb: Vec<[f32; 3]>,
    /// Its own error; zeros for one without.
    pub residual: Residual,
}

impl Reference {
    /// A reference without any error, such as a known integral.
    pub fn exact(size: [u32; 2], rgb: Vec<[f32; 3]>) -> Self {
        Self { size, rgb, residual: Residual::default() }
    }

    /// The mean of a film, its error from the scatter of the film's replicates; `None` below two replicates with
    /// samples, which tell nothing of the error.
    pub fn from_film(film: &Film) -> Option<Self> {
        let size = film.size();
        let rgb = film.to_rgb();
        let mut relative = Vec::with_capacity(rgb.len());
        let mut absolute = 0.0;
        let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
        for (pixel, r) in pixels.zip(&rgb).filter(|(_, r)| finite(r)) {
            let variance = film.standard_error(pixel)?.map(|e| e * e);
            absolute += variance.iter().sum::<f64>() / 3.0;
            let weigh = |(v, r): (&f64, &f32)| v / (f64::from(*r).powi(2) + EPSILON);
            relative.push(variance.iter().zip(r).map(weigh).sum::<f64>() / 3.0);
        }
        let n = relative.len().max(1) as f64;
        let residual = Residual {
            relative: relative.iter().sum::<f64>() / n,
            absolute: absolute / n,
            trimmed: trimmed_mean(&mut relative),
        };
        Some(Self { size: size.to_array(), rgb, residual })
    }
}
