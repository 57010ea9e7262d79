use etendue::measure::{Axis, Curve, Measured, Metric, Point, Reference, ToError};

/// What was measured on one scene.
pub(super) struct SceneResult {
    pub(super) name: String,
    pub(super) size: [u32; 2],
    pub(super) runs: u32,
    pub(super) threads: usize,
    pub(super) reference: Option<(String, Reference)>,
    pub(super) curves: Vec<Curve>,
    /// Biased options of each contender.
    pub(super) bias: Vec<Vec<String>>,
    /// The picture of each contender's first run.
    pub(super) pictures: Vec<Vec<[f32; 3]>>,
    pub(super) warnings: Vec<String>,
}

/// One contender in numbers.
pub(super) struct Row<'a> {
    pub(super) name: &'a str,
    pub(super) last: &'a Point,
    /// Exponent of relMSE over samples.
    pub(super) slope: Option<Measured>,
    pub(super) efficiency: Option<Measured>,
    /// Against the first contender, at the last number of samples that both have.
    pub(super) ratio: Option<Measured>,
    pub(super) trimmed_ratio: Option<Measured>,
    pub(super) to_target: Option<ToError>,
    /// Against the first contender.
    pub(super) speed: Option<Measured>,
}

impl SceneResult {
    /// The cost that contenders are compared by: CPU time where the system tells it.
    pub(super) fn axis(&self) -> Axis {
        let has_cpu = |p: &Point| p.costs.iter().all(|c| c.cpu_seconds.is_some());
        let all = self.curves.iter().flat_map(|c| &c.points).all(has_cpu);
        if all { Axis::CpuSeconds } else { Axis::Seconds }
    }

    /// The relMSE that every contender gets to, for the time to it.
    pub(super) fn target(&self) -> Option<f64> {
        let last = |c: &Curve| Some(c.points.last()?.corrected(Metric::Relative)?.value);
        let all: Option<Vec<f64>> = self.curves.iter().map(last).collect();
        all?.into_iter().reduce(f64::max)
    }

    pub(super) fn rows(&self) -> Vec<Row<'_>> {
        let (axis, target) = (self.axis(), self.target());
        let Some(first) = self.curves.first() else { return Vec::new() };
        self.curves
            .iter()
            .filter_map(|c| {
                let (last, common) = (c.points.last()?, c.last_common(first));
                let over = |metric| common.and_then(|(a, b)| a.efficiency_over(b, metric, axis));
                Some(Row {
                    name: &c.name,
                    last,
                    slope: c.slope(Metric::Relative, Axis::Samples),
                    efficiency: last.efficiency(Metric::Relative, axis),
                    ratio: over(Metric::Relative),
                    trimmed_ratio: over(Metric::Trimmed),
                    to_target: target.and_then(|t| c.to_error(Metric::Relative, t, axis)),
                    speed: target.and_then(|t| c.speed_over(first, Metric::Relative, t, axis)),
                })
            })
            .collect()
    }
}

/// Squared bias as a part of relMSE.
pub(super) fn bias_share(p: &Point) -> Option<Measured> {
    let error = p.error(Metric::Relative)?.value;
    let bias = p.bias_squared(Metric::Relative)?;
    Some(Measured { value: bias.value / error, interval: bias.interval.map(|i| i.map(|x| x / error)) })
}

/// `1.234e-3 ±2.1%`: the larger side of the interval.
pub(super) fn with_percent(m: Option<Measured>) -> String {
    let Some(m) = m else { return "-".into() };
    match m.relative_half_width() {
        Some(h) => format!("{:.3e} ±{:.1}%", m.value, 100.0 * h),
        None => format!("{:.3e}", m.value),
    }
}

/// `1.03 [0.98, 1.08]`.
pub(super) fn with_bounds(m: Option<Measured>) -> String {
    let Some(m) = m else { return "-".into() };
    match m.interval {
        Some([low, high]) => format!("{} [{}, {}]", short(m.value), short(low), short(high)),
        None => short(m.value),
    }
}

/// Three digits that count, without an exponent where that is short.
pub(super) fn short(x: f64) -> String {
    match x.abs() {
        a if a == 0.0 || !(1e-3..1e5).contains(&a) => format!("{x:.2e}"),
        a if a < 0.1 => format!("{x:.4}"),
        a if a < 1.0 => format!("{x:.3}"),
        a if a < 10.0 => format!("{x:.2}"),
        a if a < 100.0 => format!("{x:.1}"),
        _ => format!("{x:.0}"),
    }
}
