/// How the distance of two pictures is told as one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Metric {
    /// relMSE: mean of (x − r)² / (r² + 0.01) over pixels and channels (Rousselle, Knaus & Zwicker 2011).
    Relative,
    /// relMSE without the worst 0.1 % of pixels.
    Trimmed,
    /// Mean square error, (W·m⁻²·sr⁻¹)².
    Absolute,
}

/// What a run has cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Camera samples.
    Samples,
    /// Rays traced.
    Rays,
    /// Seconds by the wall.
    Seconds,
    /// Seconds of all threads together.
    CpuSeconds,
}

/// What one run has cost up to a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Costs {
    /// Camera samples.
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// Samples that were no usable numbers and count as black.
    pub rejected: u64,
    /// Seconds by the wall, of drawing alone.
    pub seconds: f64,
    /// Seconds of all threads together; `None` without such a clock.
    pub cpu_seconds: Option<f64>,
}

impl Costs {
    pub(crate) fn on(&self, axis: Axis) -> Option<f64> {
        match axis {
            Axis::Samples => Some(self.samples as f64),
            Axis::Rays => Some(self.rays as f64),
            Axis::Seconds => Some(self.seconds),
            Axis::CpuSeconds => self.cpu_seconds,
        }
        .filter(|c| *c > 0.0)
    }
}
