//! Numbers as the report writes them.

/// A number in three significant digits: `0.0123`, `45.6`, `7.89×10⁻⁶`; whole numbers below a million in full.
pub fn number(v: f64) -> String {
    if v.is_nan() {
        return "not a number".into();
    }
    if v.is_infinite() {
        return signed(if v > 0.0 { "∞" } else { "-∞" });
    }
    if v == 0.0 {
        return "0".into();
    }
    if v.fract() == 0.0 && v.abs() < 1e6 {
        return signed(&format!("{v:.0}"));
    }
    let parts = Scientific::new(v, 2);
    match parts.exponent {
        e @ -3..=4 => signed(&format!("{v:.*}", usize::try_from(2 - e).unwrap_or(0))),
        _ => parts.written(),
    }
}

/// A number as a mantissa, rounded, and a power of ten.
pub(super) struct Scientific {
    pub(super) mantissa: String,
    pub(super) exponent: i32,
}

impl Scientific {
    /// With so many decimals. `v` is finite.
    pub(super) fn new(v: f64, decimals: usize) -> Self {
        // The formatter carries 9.999 over to 1.00e1, which logarithms get wrong now and then.
        let text = format!("{v:.decimals$e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        Self { mantissa: mantissa.to_owned(), exponent: exponent.parse().unwrap_or(0) }
    }

    pub(super) fn written(&self) -> String {
        format!("{}×{}", signed(&self.mantissa), power_of_ten(self.exponent))
    }
}

/// `10⁻³`.
pub(super) fn power_of_ten(exponent: i32) -> String {
    let digits = exponent.to_string();
    let raised = digits.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁰',
    });
    "10".chars().chain(raised).collect()
}

/// With a minus sign as wide as the digits instead of the hyphen.
pub(super) fn signed(text: &str) -> String {
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits() {
        for (v, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (64.0, "64"),
            (-999_999.0, "−999999"),
            (1.5, "1.50"),
            (45.64, "45.6"),
            (1234.5, "1234"),
            (0.012_34, "0.0123"),
            (0.001, "0.00100"),
            (0.000_999_6, "0.00100"),
            (0.000_999_4, "9.99×10⁻⁴"),
            (-7.891e-6, "−7.89×10⁻⁶"),
            (1e6, "1.00×10⁶"),
            (f64::MIN_POSITIVE, "2.23×10⁻³⁰⁸"),
            (f64::MAX, "1.80×10³⁰⁸"),
            (f64::NAN, "not a number"),
            (f64::NEG_INFINITY, "−∞"),
        ] {
            assert_eq!(number(v), text);
        }
    }

    #[test]
    fn powers() {
        assert_eq!(power_of_ten(-120), "10⁻¹²⁰");
        assert_eq!(power_of_ten(3_456_789), "10³⁴⁵⁶⁷⁸⁹");
    }
}
