/// Why a measure of a point set cannot be had.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QualityError {
    /// No points.
    #[error("the point set is empty: pass at least one point")]
    Empty,
    /// A coordinate is NaN or not in [0, 1).
    #[error(
        "coordinate {axis} of point {point} is {value}: coordinates must be in [0, 1); wrap or scale them"
    )]
    OutsideUnitCube {
        /// Which point.
        point: usize,
        /// Which of its coordinates.
        axis: usize,
        /// Its value.
        value: f64,
    },
    /// No grid, or one that is too fine.
    #[error(
        "a grid of {cells} cells along each of {dimensions} axes: take 1 or more, and at most 2²⁴ corners"
    )]
    Grid {
        /// Cells an axis.
        cells: usize,
        /// Axes.
        dimensions: usize,
    },
    /// Not as many points as the net should have.
    #[error("{got} points are no net of 2^{m}: pass exactly that many")]
    PointCount {
        /// Digits asked for.
        m: u32,
        /// Points passed.
        got: usize,
    },
    /// More digits than the coordinates have.
    #[error("a net of 2^{m} points needs {m} binary digits: coordinates and matrices have 32")]
    Digits {
        /// Digits asked for.
        m: u32,
    },
}

/// Refuses empty sets, and points outside [0, 1)^D.
pub(super) fn check<const D: usize>(points: &[[f64; D]]) -> Result<(), QualityError> {
    if points.is_empty() {
        return Err(QualityError::Empty);
    }
    for (point, p) in points.iter().enumerate() {
        for (axis, &value) in p.iter().enumerate() {
            if !(0.0..1.0).contains(&value) {
                return Err(QualityError::OutsideUnitCube { point, axis, value });
            }
        }
    }
    Ok(())
}
