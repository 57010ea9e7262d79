//! Where values lie along an axis.

use super::ticks::LABELS;

/// How far, in decades, an interval may stretch a logarithmic axis beyond the points.
const REACH: f64 = 1.0;
/// Room around the points, as a part of the axis.
const PAD: f64 = 0.02;
/// Beyond this, sums and differences overflow.
const LARGEST: f64 = 1e300;
/// Below this, there are no steps to divide an axis into.
const SMALLEST: f64 = 1e-280;
/// What counts as equal to a round number, in decades.
pub(super) const SLACK: f64 = 1e-9;

/// An axis with its ends: values to 0…1 along it.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    pub(super) log: bool,
    /// The ends, as their decimal logarithm if the axis is logarithmic.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Distance of the labels of a linear axis.
    pub(super) step: f64,
}

/// The values to make room for, along one axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    low: f64,
    high: f64,
}

impl Extent {
    pub(super) fn new() -> Self {
        Self { low: f64::INFINITY, high: f64::NEG_INFINITY }
    }

    pub(super) fn add(&mut self, v: f64) {
        (self.low, self.high) = (self.low.min(v), self.high.max(v));
    }

    fn is_empty(self) -> bool {
        !(self.low <= self.high)
    }
}

/// A value on its axis: its logarithm, or itself; `None` if it has no place there.
pub(super) fn place(log: bool, v: f64) -> Option<f64> {
    match log {
        _ if !v.is_finite() => None,
        true => (v > 0.0).then(|| v.log10()),
        false if v.abs() < SMALLEST => Some(0.0),
        false => Some(v.clamp(-LARGEST, LARGEST)),
    }
}

impl Scale {
    /// Ends at round numbers around points and, within reason, intervals. Both are [`place`]d already.
    pub(super) fn fit(log: bool, points: Extent, intervals: Extent) -> Self {
        let mut all = points;
        if points.is_empty() {
            all = Extent { low: 0.0, high: 1.0 };
        } else if !intervals.is_empty() {
            // One interval next to zero would otherwise push everything else into a corner.
            let reach = if log { REACH } else { f64::INFINITY };
            all.add(intervals.low.max(points.low - reach));
            all.add(intervals.high.min(points.high + reach));
        }
        if log { Self::fit_log(all) } else { Self::fit_linear(all) }
    }

    fn fit_log(e: Extent) -> Self {
        let pad = PAD * (e.high - e.low);
        let (mut low, mut high) = (round_down(e.low - pad), round_up(e.high + pad));
        if high - low > f64::from(LABELS) {
            (low, high) = (low.floor(), high.ceil());
        }
        if high - low < SLACK {
            (low, high) = (round_down(low - 2.0 * SLACK), round_up(high + 2.0 * SLACK));
        }
        Self { log: true, low, high, step: 1.0 }
    }

    fn fit_linear(e: Extent) -> Self {
        let (mut low, mut high) = (e.low, e.high);
        let size = low.abs().max(high.abs());
        if size < SMALLEST {
            (low, high) = (0.0, 1.0);
        } else if high - low <= 1e-9 * size {
            (low, high) = (low - 0.5 * size, high + 0.5 * size);
        }
        let rough = (high - low) / 5.0;
        let decade = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0].map(|m| m * decade).into_iter().find(|s| *s >= rough).unwrap_or(10.0 * decade);
        Self { log: false, low: (low / step).floor() * step, high: (high / step).ceil() * step, step }
    }

    /// 0…1 along the axis for what [`place`] gave; beyond the ends it is the end.
    pub(super) fn unit(&self, placed: f64) -> f64 {
        ((placed - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }

    /// Whether a placed value is between the ends.
    pub(super) fn holds(&self, placed: f64) -> bool {
        (self.low..=self.high).contains(&placed)
    }
}

/// The largest of 1, 2, 5 times a power of ten that is not above, all as logarithms.
fn round_down(l: f64) -> f64 {
    let decade = (l + SLACK).floor();
    let step = [5f64, 2.0].map(f64::log10).into_iter().find(|s| decade + s <= l + SLACK).unwrap_or(0.0);
    decade + step
}

fn round_up(l: f64) -> f64 {
    let decade = (l - SLACK).floor();
    let step = [2f64, 5.0].map(f64::log10).into_iter().find(|s| decade + s >= l - SLACK).unwrap_or(1.0);
    decade + step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_next_to_zero_takes_one_decade() {
        let (mut points, mut intervals) = (Extent::new(), Extent::new());
        [-2.0, 0.0].into_iter().for_each(|v| points.add(v));
        [-30.0, 0.5].into_iter().for_each(|v| intervals.add(v));
        let s = Scale::fit(true, points, intervals);
        assert!((-3.31..=-3.0).contains(&s.low) && (0.5..=0.7).contains(&s.high), "{s:?}");
        assert_eq!(s.unit(-30.0), 0.0);
    }

    #[test]
    fn what_has_no_place() {
        for v in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(place(true, v), None);
        }
        assert_eq!(place(false, f64::NEG_INFINITY), None);
        assert_eq!(place(false, -2.0), Some(-2.0));
        assert_eq!(place(true, 100.0), Some(2.0));
    }
}
