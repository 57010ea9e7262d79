use crate::CompareError;

/// How different two pictures look, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// From 0 (alike) to 1 (as different as can be), row by row from the top, as the pictures are.
    pub values: Vec<f32>,
    /// Pixels where a picture has a NaN or an infinity. Their value is 1.
    pub not_finite: u64,
    /// The exposures whose largest value each pixel has; `None` for pictures that were compared as displayed.
    pub exposures: Option<FlipExposures>,
}

/// Exposures that a high-dynamic-range picture was looked at with, evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlipExposures {
    /// The darkest, in stops: radiance is multiplied by 2 to this power.
    pub start: f64,
    /// The brightest.
    pub stop: f64,
    /// How many, both ends included; at least 2.
    pub count: u32,
}

impl FlipMap {
    /// Mean over the pixels: the one number for a picture. 0 of nothing.
    pub fn mean(&self) -> f64 {
        if self.values.is_empty() {
            return 0.0;
        }
        self.values.iter().map(|v| f64::from(*v)).sum::<f64>() / self.values.len() as f64
    }

    /// The largest value. 0 of nothing.
    pub fn max(&self) -> f32 {
        self.values.iter().copied().fold(0.0, f32::max)
    }

    /// The least value that a share `fraction` (0 to 1) of the pixels does not exceed. 0 of nothing.
    ///
    /// # Errors
    /// No room for a copy of the values.
    pub fn quantile(&self, fraction: f64) -> Result<f32, CompareError> {
        if self.values.is_empty() {
            return Ok(0.0);
        }
        let mut values: Vec<f32> = Vec::new();
        values.try_reserve_exact(self.values.len()).map_err(|_| CompareError::Memory)?;
        values.extend_from_slice(&self.values);
        let rank = (fraction * values.len() as f64).ceil() as usize;
        let index = rank.saturating_sub(1).min(values.len() - 1);
        Ok(*values.select_nth_unstable_by(index, f32::total_cmp).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_numbers() {
        let values = vec![0.5, 0.25, 1.0, 0.0, 0.25];
        let map = FlipMap { size: [5, 1], values, not_finite: 0, exposures: None };
        assert_eq!((map.mean(), map.max()), (0.4, 1.0));
        let quantiles = [0.0, 0.2, 0.21, 0.5, 0.8, 0.81, 1.0, 7.0].map(|q| map.quantile(q).unwrap());
        assert_eq!(quantiles, [0.0, 0.0, 0.25, 0.25, 0.5, 1.0, 1.0, 1.0]);
        let nothing = FlipMap { size: [0, 3], values: Vec::new(), ..map };
        assert_eq!((nothing.mean(), nothing.max(), nothing.quantile(0.5)), (0.0, 0.0, Ok(0.0)));
    }
}
