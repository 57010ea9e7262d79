//! Which values along an axis are marked and labelled.

use super::number::{Scientific, power_of_ten, signed};
use super::scale::{SLACK, Scale};

/// More labels than this become crowded.
pub(super) const LABELS: i32 = 8;

/// A line across the plot.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// 0…1 along the axis.
    pub(super) at: f64,
    /// `None` for the minor ones.
    pub(super) label: Option<String>,
}

impl Scale {
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

#[cfg(test)]
mod tests {
    use super::super::scale::{Extent, place};
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
}
