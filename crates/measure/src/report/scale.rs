//! Where values lie along an axis, and which of them are labelled.

use super::number::{Scientific, power_of_ten, signed};

/// How far, in decades, an interval may stretch a logarithmic axis beyond the points.
const REACH: f64 = 1.0;
/// Room around the points, as a part of the axis.
const PAD: f64 = 0.02;
/// More labels than this become crowded.
const LABELS: i32 = 8;
/// Beyond this, sums and differences overflow.
const LARGEST: f64 = 1e300;
/// Below this, there are no steps to divide an axis into.
const SMALLEST: f64 = 1e-280;
/// What counts as equal to a round number, in decades.
const SLACK: f64 = 1e-9;

/// An axis with its ends: values to 0…1 along it.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    log: bool,
    /// The ends, as their decimal logarithm if the axis is logarithmic.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Distance of the labels of a linear axis.
    step: f64,
}

/// A line across the plot.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// 0…1 along the axis.
    pub(super) at: f64,
    /// `None` for the minor ones.
    pub(super) label: Option<String>,
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

    /// In increasing order.
    pub(super) fn ticks(&self) -> Vec<Tick> {
        if self.log { self.log_ticks() } else { self.linear_ticks() }
    }

    fn linear_ticks(&self) -> Vec<Tick> {
        let (first, last) = ((self.low / self.step).round() as i64, (self.high / self.step).round() as i64);
        let largest = self.low.abs().max(self.high.abs());
        let (top, unit) = (exponent_of(largest), exponent_of(self.step));
        (first..=last)
            .take(20)
            .map(|i| {
                let v = i as f64 * self.step;
                let label = if i == 0 {
                    "0".into()
                } else if top < 6 && unit >= -4 {
                    signed(&format!("{v:.*}", usize::try_from(-unit).unwrap_or(0)))
                } else {
                    Scientific::new(v, usize::try_from(exponent_of(v) - unit).unwrap_or(0)).written()
                };
                Tick { at: self.unit(v), label: Some(label) }
            })
            .collect()
    }

    fn log_ticks(&self) -> Vec<Tick> {
        // The ends are within ±400, whatever the numbers.
        let (first, last) = (self.low.floor() as i32, (self.high + SLACK).floor() as i32);
        let first_whole = (self.low - SLACK).ceil() as i32;
        let decades = last - first_whole + 1;
        let stride = [1, 2, 5, 10, 20, 50].into_iter().find(|s| s * LABELS >= decades).unwrap_or(100);
        // Where few decades are seen, their parts are labelled too.
        let parts: &[i32] = match decades {
            _ if self.high - self.low < 2.0 + SLACK => &[2, 5],
            ..=2 => &[3],
            _ => &[],
        };
        let plain = (if parts.is_empty() { first_whole } else { first }) >= -2 && last <= 4;
        let mut out = Vec::new();
        for exponent in first..=last {
            for mantissa in 1..=9 {
                let placed = f64::from(exponent) + f64::from(mantissa).log10();
                if placed < self.low - SLACK || placed > self.high + SLACK {
                    continue;
                }
                let labelled = match mantissa {
                    1 => exponent.rem_euclid(stride) == 0,
                    m => parts.contains(&m),
                };
                // Lines that would run into each other say nothing.
                let drawn = if mantissa == 1 { labelled || stride < 10 } else { stride == 1 };
                if drawn {
                    let label = labelled.then(|| log_label(mantissa, exponent, plain));
                    out.push(Tick { at: self.unit(placed), label });
                }
            }
        }
        out
    }
}

fn log_label(mantissa: i32, exponent: i32, plain: bool) -> String {
    match (mantissa, exponent) {
        (m, e) if plain => {
            let v = f64::from(m) * 10f64.powi(e);
            format!("{v:.*}", usize::try_from(-e).unwrap_or(0))
        }
        (m, 0) => m.to_string(),
        (1, 1) => "10".into(),
        (1, e) => power_of_ten(e),
        (m, e) => format!("{m}×{}", power_of_ten(e)),
    }
}

fn exponent_of(v: f64) -> i32 {
    // Enough digits that 0.1 and what is added up to it have one exponent.
    Scientific::new(v, 12).exponent
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

    fn fit(log: bool, values: &[f64]) -> Scale {
        let mut e = Extent::new();
        values.iter().filter_map(|v| place(log, *v)).for_each(|v| e.add(v));
        Scale::fit(log, e, Extent::new())
    }

    fn labels(s: &Scale) -> Vec<String> {
        s.ticks().into_iter().filter_map(|t| t.label).collect()
    }

    #[test]
    fn log_ends_are_round() {
        // 1 and 1000 with 2% of room: 0.5 and 2000.
        let s = fit(true, &[1.0, 1000.0]);
        assert!((s.low - 0.5f64.log10()).abs() < 1e-12 && (s.high - 2000f64.log10()).abs() < 1e-12);
        assert_eq!(labels(&s), ["1", "10", "100", "1000"]);
        assert!((s.unit(1.0) - 20f64.log10() / 4000f64.log10()).abs() < 1e-12);
        // Three whole decades and the ends' parts: 5…9, 3 × 9 and 1000, 2000.
        assert_eq!(s.ticks().len(), 5 + 27 + 2);
    }

    #[test]
    fn small_numbers_are_powers() {
        assert_eq!(labels(&fit(true, &[3e-6, 20.0])), ["10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "1", "10"]);
        assert_eq!(labels(&fit(true, &[0.02, 0.5])), ["0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1"]);
        assert_eq!(
            labels(&fit(true, &[1e-30, 1.0])),
            ["10⁻³⁰", "10⁻²⁵", "10⁻²⁰", "10⁻¹⁵", "10⁻¹⁰", "10⁻⁵", "1"]
        );
        assert_eq!(labels(&fit(true, &[3e-5, 4e-5])), ["2×10⁻⁵", "5×10⁻⁵"]);
    }

    #[test]
    fn linear_labels_have_the_decimals_of_the_step() {
        assert_eq!(labels(&fit(false, &[0.0, 1.0])), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&fit(false, &[-3.0, 40.0])), ["−10", "0", "10", "20", "30", "40"]);
        assert_eq!(labels(&fit(false, &[0.0, 4e9])), ["0", "1×10⁹", "2×10⁹", "3×10⁹", "4×10⁹"]);
    }

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
    fn any_range_has_few_ticks_in_order() {
        let ends = [
            0.0,
            5e-324,
            1e-310,
            1e-12,
            0.1,
            0.3,
            1.0,
            1.0 + 1e-15,
            1.0 + 1e-8,
            7.0,
            9.99e5,
            1e6,
            1e6 + 1e-3,
            1e16,
            1e200,
            1e300,
            f64::MAX,
        ];
        for log in [false, true] {
            for (a, b) in
                ends.iter().flat_map(|a| ends.map(|b| (*a, b))).flat_map(|(a, b)| [(a, b), (-a, b), (-a, -b)])
            {
                let s = fit(log, &[a, b]);
                assert!(s.low < s.high, "{a:e} {b:e} {s:?}");
                for v in [a, b].into_iter().filter_map(|v| place(log, v)) {
                    assert!(s.holds(v), "{v} in {s:?}");
                }
                let ticks = s.ticks();
                assert!(
                    ticks.len() <= 90 && labels(&s).len() >= 2 && labels(&s).len() <= 12,
                    "{a:e} {b:e} {ticks:?}"
                );
                assert!(ticks.iter().all(|t| (0.0..=1.0).contains(&t.at)));
                assert!(ticks.windows(2).all(|t| t[0].at < t[1].at), "{a:e} {b:e} {ticks:?}");
                let mut different = labels(&s);
                different.dedup();
                assert_eq!(different, labels(&s));
            }
        }
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
