use std::f64::consts::TAU;

use etendue_core::math::wide::{atan2, sin_cos};
use etendue_core::{Fingerprint, Vec3A};

/// Why numbers are no table of intensities.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntensityTableError {
    /// Angles that are too few, not ascending, not finite or out of range.
    #[error("{which} angle {index} ({angle} degrees): {what}")]
    Angle {
        /// "vertical" or "horizontal".
        which: &'static str,
        /// Number of the angle, from 0.
        index: usize,
        /// The angle.
        angle: f32,
        /// What is wrong.
        what: &'static str,
    },
    /// Not an intensity for each pair of angles.
    #[error("{values} intensities for {vertical} vertical times {horizontal} horizontal angles")]
    Count {
        /// Intensities.
        values: usize,
        /// Vertical angles.
        vertical: usize,
        /// Horizontal angles.
        horizontal: usize,
    },
    /// An intensity that is negative or not finite.
    #[error("intensity {index} is {value}: it must be a finite number, zero or more")]
    Value {
        /// Its number, from 0.
        index: usize,
        /// The intensity.
        value: f32,
    },
}

/// How the rest of the circle follows from the horizontal angles that are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symmetry {
    /// One angle: the same all around.
    Round,
    /// 0 to 90°: mirrored at both planes.
    Quarters,
    /// 0 to 180°: mirrored at the plane of 0 and 180°.
    Halves,
    /// 90 to 270°: mirrored at the plane of 90 and 270°.
    Sides,
    /// 0 to 360°.
    None,
}

/// Measured intensities by direction, in the angles of type C photometry (IES LM-63): the vertical angle counts from
/// straight down (0°) to straight up (180°), the horizontal one around the upward axis. Bilinear in the two angles;
/// nothing shines beyond the vertical angles given.
#[derive(Clone, Debug, PartialEq)]
pub struct IntensityTable {
    /// Degrees, strictly ascending.
    vertical: Vec<f32>,
    horizontal: Vec<f32>,
    /// One row of vertical angles for each horizontal angle.
    values: Vec<f32>,
    symmetry: Symmetry,
}

impl IntensityTable {
    /// A table of `values[h * vertical.len() + v]`, angles in degrees. The horizontal angles begin with 0, and the last
    /// one tells the symmetry: 0 (round), 90 (mirrored twice), 180 (mirrored) or 360 (none); or they go from 90 to 270
    /// (mirrored at the plane of those two).
    ///
    /// # Errors
    /// [`IntensityTableError`] where there are fewer than two vertical angles, angles do not ascend within their range
    /// (vertical 0 to 180), or an intensity is missing, negative or not finite.
    pub fn new(
        vertical: Vec<f32>,
        horizontal: Vec<f32>,
        values: Vec<f32>,
    ) -> Result<Self, IntensityTableError> {
        ascending("vertical", &vertical, 180.0)?;
        ascending("horizontal", &horizontal, 360.0)?;
        let wrong = |which, index, angle, what| Err(IntensityTableError::Angle { which, index, angle, what });
        if vertical.len() < 2 {
            let first = vertical.first().copied().unwrap_or(f32::NAN);
            return wrong("vertical", 0, first, "there must be two or more");
        }
        let (first, last) = match (horizontal.first(), horizontal.last()) {
            (Some(&first), Some(&last)) => (first, last),
            _ => return wrong("horizontal", 0, f32::NAN, "there must be one or more"),
        };
        let symmetry = match (first, last) {
            (0.0, 0.0) => Symmetry::Round,
            (0.0, 90.0) => Symmetry::Quarters,
            (0.0, 180.0) => Symmetry::Halves,
            (0.0, 360.0) => Symmetry::None,
            (90.0, 270.0) => Symmetry::Sides,
            (0.0, _) => {
                return wrong("horizontal", horizontal.len() - 1, last, "the last must be 0, 90, 180 or 360");
            }
            (90.0, _) => {
                return wrong("horizontal", horizontal.len() - 1, last, "from 90 on, the last must be 270");
            }
            _ => return wrong("horizontal", 0, first, "the first must be 0, or 90 with 270 as the last"),
        };
        if vertical.len().checked_mul(horizontal.len()) != Some(values.len()) {
            let (vertical, horizontal) = (vertical.len(), horizontal.len());
            return Err(IntensityTableError::Count { values: values.len(), vertical, horizontal });
        }
        match values.iter().position(|v| !(*v >= 0.0 && v.is_finite())) {
            Some(index) => Err(IntensityTableError::Value { index, value: values[index] }),
            None => Ok(Self { vertical, horizontal, values, symmetry }),
        }
    }

    /// Vertical angles, degrees.
    pub fn vertical(&self) -> &[f32] {
        &self.vertical
    }

    /// Horizontal angles, degrees.
    pub fn horizontal(&self) -> &[f32] {
        &self.horizontal
    }

    /// The intensities as they were given.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The largest intensity.
    pub fn max(&self) -> f32 {
        self.values.iter().fold(0.0, |m, &v| if v > m { v } else { m })
    }

    /// The intensity along a direction of the lamp's own space, of any length: `z` is up, horizontal angles go from `x`
    /// toward `y`.
    pub fn along(&self, d: Vec3A) -> f32 {
        // In double precision the squares of any length are in range.
        let (x, y, z) = (f64::from(d.x), f64::from(d.y), f64::from(d.z));
        let vertical = atan2((x * x + y * y).sqrt(), -z).to_degrees() as f32;
        let around = atan2(y, x).to_degrees() as f32;
        // Straight up is a rounding of 180°, which must not fall off the table.
        self.at(if vertical < 180.0 { vertical } else { 180.0 }, around)
    }

    /// The intensity at a vertical angle and a horizontal one between −360 and 360, degrees.
    pub fn at(&self, vertical: f32, horizontal: f32) -> f32 {
        let h = if horizontal < 0.0 { horizontal + 360.0 } else { horizontal };
        let mirrored = |h: f32, plane: f32| if h > plane { 2.0 * plane - h } else { h };
        let h = match self.symmetry {
            Symmetry::Round => 0.0,
            Symmetry::Quarters => mirrored(mirrored(h, 180.0), 90.0),
            Symmetry::Halves => mirrored(h, 180.0),
            Symmetry::Sides if h < 90.0 => 180.0 - h,
            Symmetry::Sides => mirrored(h, 270.0),
            Symmetry::None => h,
        };
        let (Some(v), Some(h)) = (between(&self.vertical, vertical), between(&self.horizontal, h)) else {
            return 0.0;
        };
        let row = |column: usize| {
            let at = |i: usize| self.values.get(column * self.vertical.len() + i).copied().unwrap_or(0.0);
            at(v.low) + (at(v.high) - at(v.low)) * v.part
        };
        let (a, b) = (row(h.low), row(h.high));
        a + (b - a) * h.part
    }

    /// The integral over all directions, sr times the unit of the intensities. In closed form, cell by cell: the
    /// interpolation is linear in the horizontal angle, and ∫ (a + bθ) sin θ dθ is elementary.
    pub fn integral(&self) -> f64 {
        let rows: Vec<f64> =
            self.values.chunks(self.vertical.len()).map(|row| self.row_integral(row)).collect();
        let Some(&first) = rows.first() else { return 0.0 };
        let copies = match self.symmetry {
            Symmetry::Round => return TAU * first,
            Symmetry::Quarters => 4.0,
            Symmetry::Halves | Symmetry::Sides => 2.0,
            Symmetry::None => 1.0,
        };
        let widths = self.horizontal.windows(2).map(|w| (f64::from(w[1]) - f64::from(w[0])).to_radians());
        let sum: f64 = rows.windows(2).zip(widths).map(|(r, width)| 0.5 * (r[0] + r[1]) * width).sum();
        copies * sum
    }

    /// ∫ I sin θ dθ at one horizontal angle.
    fn row_integral(&self, row: &[f32]) -> f64 {
        let pairs = self.vertical.windows(2).zip(row.windows(2));
        pairs
            .map(|(angles, i)| {
                let (a, b) = (f64::from(angles[0]).to_radians(), f64::from(angles[1]).to_radians());
                let (i, j) = (f64::from(i[0]), f64::from(i[1]));
                let ((sin_a, cos_a), (sin_b, cos_b)) = (sin_cos(a), sin_cos(b));
                i * cos_a - j * cos_b + (j - i) / (b - a) * (sin_b - sin_a)
            })
            .sum()
    }

    /// What decides the table.
    pub fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("intensities");
        for v in [&self.vertical, &self.horizontal, &self.values] {
            f.u64(v.len() as u64);
            f.floats(v);
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        (self.vertical.len() + self.horizontal.len() + self.values.len()) * size_of::<f32>()
    }
}

fn ascending(which: &'static str, angles: &[f32], most: f32) -> Result<(), IntensityTableError> {
    let mut last = f32::NEG_INFINITY;
    for (index, &angle) in angles.iter().enumerate() {
        let what = if !(0.0..=most).contains(&angle) {
            "it is out of range"
        } else if angle <= last {
            "it is not larger than the one before"
        } else {
            last = angle;
            continue;
        };
        return Err(IntensityTableError::Angle { which, index, angle, what });
    }
    Ok(())
}

/// Two neighbours in a list and how far between them.
struct Between {
    low: usize,
    high: usize,
    part: f32,
}

/// `None` beyond the ends.
fn between(angles: &[f32], x: f32) -> Option<Between> {
    let high = angles.partition_point(|&a| a <= x);
    let low = high.checked_sub(1)?;
    let a = *angles.get(low)?;
    match angles.get(high) {
        Some(&b) => Some(Between { low, high, part: (x - a) / (b - a) }),
        None => (x == a).then_some(Between { low, high: low, part: 0.0 }),
    }
}
