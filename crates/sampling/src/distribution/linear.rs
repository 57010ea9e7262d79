use super::{Distribution1d, DistributionError, Found, checked_total};

/// A piecewise linear density on [0, 1): straight lines between values at equally spaced places, the first at 0 and
/// the last at 1.
///
/// Drawn by the exact inverse of its distribution function: a segment by its mass, then the root of a quadratic
/// equation within, in the form that does not cancel. Monotone in `u`, so stratification passes through. Segments of
/// zero mass (and of less than 10⁻³⁶ of the total) are never drawn, nor are the places where a line touches zero.
///
/// ```
/// use etendue_sampling::LinearDistribution1d;
/// // The triangle 2x.
/// let d = LinearDistribution1d::new([0.0f32, 1.0])?;
/// let s = d.sample(0.25);
/// assert!((s.x - 0.5).abs() < 1e-15 && (s.pdf - 1.0).abs() < 1e-15);
/// assert_eq!(d.total(), 0.5);
/// # Ok::<(), etendue_sampling::DistributionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LinearDistribution1d {
    /// n + 1 values at the ends of n segments.
    values: Vec<f64>,
    /// Over the mean heights of the segments.
    segments: Distribution1d,
}

/// A draw from [`LinearDistribution1d`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearSample1d {
    /// Position in [0, 1), inside the segment.
    pub x: f64,
    /// Density at `x`; positive.
    pub pdf: f64,
    /// Which segment.
    pub index: usize,
}

impl LinearDistribution1d {
    /// From the values at 0, 1/n, 2/n, …, 1, which are finite and not negative.
    ///
    /// # Errors
    /// [`DistributionError`] where a value is unfit, there are fewer than two, or none is positive.
    pub fn new<V: Into<f64>>(values: impl IntoIterator<Item = V>) -> Result<Self, DistributionError> {
        let values: Vec<f64> = values.into_iter().map(Into::into).collect();
        checked_total(values.iter().copied())?;
        if values.len() < 2 {
            return Err(DistributionError::OneValue);
        }
        let segments = Distribution1d::new(values.windows(2).map(|ends| 0.5 * ends[0] + 0.5 * ends[1]))?;
        Ok(Self { values, segments })
    }

    /// Number of segments: one fewer than values.
    pub fn len(&self) -> usize {
        self.segments.len()
    }

    /// Never: there is at least one segment.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Integral of the lines over [0, 1], before they are normalised.
    pub fn total(&self) -> f64 {
        self.segments.total() / self.len() as f64
    }

    /// Probability of segment `index`; 0 outside.
    pub fn pmf(&self, index: usize) -> f64 {
        self.segments.width(index) / self.segments.total()
    }

    /// Density at `x`; 0 outside of [0, 1].
    pub fn pdf(&self, x: f64) -> f64 {
        if !(0.0..=1.0).contains(&x) {
            return 0.0;
        }
        let n = self.len();
        let index = segment(x, n);
        self.density(index, x * n as f64 - index as f64)
    }

    /// Density in segment `index` at the share `t` of its length.
    fn density(&self, index: usize, t: f64) -> f64 {
        match self.values.get(index..=index + 1) {
            // What is never drawn has no density, however small its lines.
            Some(&[a, b]) if self.segments.width(index) > 0.0 => {
                (a * (1.0 - t) + b * t) / self.segments.total() * self.len() as f64
            }
            _ => 0.0,
        }
    }

    /// A position by inversion, for `u` in [0, 1) (f32 or f64).
    pub fn sample(&self, u: impl Into<f64>) -> LinearSample1d {
        let Found { index, within, .. } = self.segments.invert(u.into());
        let (a, b) = (self.values[index], self.values[index + 1]);
        let mut x = inside(index, share(a, b, within), self.len());
        // Rounded onto the place where a line touches zero: back onto the line.
        for _ in 0..STEPS {
            if self.pdf(x) > 0.0 {
                break;
            }
            x = if a < b { x.next_up() } else { x.next_down() };
        }
        LinearSample1d { x, pdf: self.pdf(x), index }
    }
}

/// Roundings of x n are undone by so many neighbours at most.
const STEPS: usize = 4;

/// The `t` below which the line from `a` to `b` has the share `q` of its mass in [0, 1]:
/// (b − a) t² / 2 + a t = q (a + b) / 2, solved as 2c / (b + √(b² + 4ac)), every term of which is positive.
fn share(a: f64, b: f64, q: f64) -> f64 {
    // Neither end of a line may be drawn where it could be zero.
    const LEAST: f64 = 1.0 / (1u64 << 63) as f64;
    let q = q.clamp(LEAST, 1.0f64.next_down());
    // Against overflow of the squares; one end is positive.
    let scale = a.max(b);
    let (a, b) = (a / scale, b / scale);
    (a + b) * q / (a + ((1.0 - q) * a * a + q * b * b).sqrt())
}

/// Which of `n` segments holds `x`.
fn segment(x: f64, n: usize) -> usize {
    // Casts of floats saturate.
    ((x * n as f64) as usize).min(n - 1)
}

/// (index + t) / n, in its segment and below 1 even after rounding.
fn inside(index: usize, t: f64, n: usize) -> f64 {
    let mut x = (index as f64 + t) / n as f64;
    for _ in 0..STEPS {
        if x >= 1.0 || segment(x, n) > index {
            x = x.next_down();
        } else if segment(x, n) < index {
            x = x.next_up();
        }
    }
    x
}
