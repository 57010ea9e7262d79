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
    /// The picture of each contender's first run; none where the measurement was stopped.
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
        let last = |c: &Curve| {
            let own = c.points.iter().rev().filter(|p| !p.is_limited_by_reference(Metric::Relative));
            own.filter_map(|p| p.corrected(Metric::Relative)).map(|m| m.value).next()
        };
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
                // Nothing is judged by what is left of the reference's error.
                let own = |p: &Point, metric| !p.is_limited_by_reference(metric);
                let over = |metric| {
                    let (a, b) = common.filter(|(a, b)| own(a, metric) && own(b, metric))?;
                    a.efficiency_over(b, metric, axis)
                };
                let efficiency = || last.efficiency(Metric::Relative, axis);
                Some(Row {
                    name: &c.name,
                    last,
                    slope: c.slope(Metric::Relative, Axis::Samples),
                    efficiency: own(last, Metric::Relative).then(efficiency).flatten(),
                    ratio: over(Metric::Relative),
                    trimmed_ratio: over(Metric::Trimmed),
                    to_target: target.and_then(|t| c.to_error(Metric::Relative, t, axis)),
                    speed: target.and_then(|t| c.speed_over(first, Metric::Relative, t, axis)),
                })
            })
            .collect()
    }

    /// What to know before the numbers are believed.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut out = Vec::new();
        for (curve, bias) in self.curves.iter().zip(&self.bias) {
            let (name, last) = (&curve.name, curve.points.last());
            if last.is_some_and(|p| p.is_limited_by_reference(Metric::Relative)) {
                out.push(format!(
                    "'{name}': more than half of its error is the reference's own, and nothing is told by the rest; \
                     lengthen the reference"
                ));
            }
            if !bias.is_empty() {
                out.push(format!("'{name}' is biased: {}", bias.join("; ")));
            }
            let rejected: u64 = last.map_or(0, |p| p.costs.iter().map(|c| c.rejected).sum());
            if rejected > 0 {
                out.push(format!("'{name}': {rejected} samples are no usable numbers and count as black"));
            }
            let not_finite = last.map_or(0, |p| p.not_finite);
            if not_finite > 0 {
                out.push(format!(
                    "'{name}': {not_finite} pixels are no numbers in the reference or in one of the runs, and are left out"
                ));
            }
        }
        out
    }
}

/// Squared bias as a part of relMSE; `None` too where the reference's own error, which is an estimate, is most of it.
pub(super) fn bias_share(p: &Point) -> Option<Measured> {
    if p.is_limited_by_reference(Metric::Relative) {
        return None;
    }
    let error = p.error(Metric::Relative).map(|e| e.value).filter(|e| *e > 0.0)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use etendue::measure::{Costs, Residual};

    /// Two runs that are off by this much in every pixel, up and down.
    fn result(off: f32, residual: f64, rejected: u64) -> SceneResult {
        let pixels = |x: f32| vec![[x; 3]; 4];
        let residual = Residual { relative: residual, trimmed: residual, absolute: residual };
        let reference = Reference { residual, ..Reference::exact([4, 1], pixels(1.0)) };
        let costs = vec![Costs { samples: 4, rejected, seconds: 1.0, ..Costs::default() }; 2];
        let pictures = [pixels(1.0 + off), pixels(1.0 - off)];
        let point = Point::new(1, costs, &pictures, Some(&reference)).expect("a point");
        SceneResult {
            name: "scene".into(),
            size: [4, 1],
            runs: 2,
            threads: 1,
            reference: Some(("r".into(), reference)),
            curves: vec![Curve { name: "path".into(), points: vec![point] }],
            bias: vec![Vec::new()],
            pictures: vec![pixels(1.0)],
            warnings: Vec::new(),
        }
    }

    #[test]
    fn what_the_reference_limits_is_not_judged() {
        let good = result(0.1, 1e-4, 0);
        let row = &good.rows()[0];
        assert!(row.efficiency.is_some() && row.ratio.is_some() && good.target().is_some());
        assert!(bias_share(row.last).is_some() && good.notes().is_empty());
        let limited = result(0.1, 6e-3, 0);
        let row = &limited.rows()[0];
        assert_eq!(
            (row.efficiency, row.ratio, row.trimmed_ratio, limited.target()),
            (None, None, None, None)
        );
        assert_eq!(bias_share(row.last), None);
        assert!(limited.notes()[0].contains("lengthen the reference"), "{:?}", limited.notes());
    }

    #[test]
    fn nothing_is_no_part_of_nothing_and_losses_are_told() {
        let exact = result(0.0, 0.0, 3);
        assert_eq!(bias_share(exact.rows()[0].last), None);
        assert!(exact.notes()[0].contains("6 samples"), "{:?}", exact.notes());
    }
}
