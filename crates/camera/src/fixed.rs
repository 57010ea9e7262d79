//! The film's number: a fixed-point integer with quantum 2⁻⁶⁴. Integer addition is associative, so a sum of samples
//! has the same bits whatever the order, the threads or the shards.

/// Samples of this magnitude and above are refused: 2⁴⁰.
pub const LIMIT: f32 = 1_099_511_627_776.0;

/// 2⁻⁶⁴.
const QUANTUM: f64 = 1.0 / 18_446_744_073_709_551_616.0;

/// The nearest multiple of 2⁻⁶⁴, halves away from zero; exact from 2⁻⁴¹ up. `None` where the value is not finite or
/// reaches [`LIMIT`].
#[inline]
pub(crate) fn to_fixed(x: f32) -> Option<i128> {
    let bits = x.to_bits();
    let exponent = (bits >> 23) & 0xff;
    // 127 + 40: the exponent field of 2^40.
    if exponent >= 167 {
        return None;
    }
    let mantissa = i128::from((bits & 0x7f_ffff) | if exponent == 0 { 0 } else { 0x80_0000 });
    // x = mantissa · 2^(exponent − 150), so x · 2^64 = mantissa · 2^(exponent − 86).
    let magnitude = if exponent >= 86 {
        mantissa << (exponent - 86)
    } else {
        let down = 86 - exponent.max(1);
        if down > 25 { 0 } else { (mantissa + (1 << (down - 1))) >> down }
    };
    Some(if bits >> 31 == 0 { magnitude } else { -magnitude })
}

/// Back to a float: the sum divided by the number of samples, rounded once to f64.
#[inline]
pub(crate) fn mean(sum: i128, count: u64) -> f64 {
    if count == 0 { 0.0 } else { sum as f64 * QUANTUM / count as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversion_is_exact_where_it_says_so() {
        for x in [1.0f32, 0.1, 1e-6, -3.7e5, 2f32.powi(-41), 2f32.powi(39) * 1.999, 0.0, -0.0] {
            assert_eq!(mean(to_fixed(x).unwrap(), 1) as f32, x, "{x}");
        }
        assert_eq!(to_fixed(2f32.powi(-64)), Some(1));
        assert_eq!(to_fixed(2f32.powi(-65)), Some(1), "halves go away from zero");
        assert_eq!(to_fixed(2f32.powi(-66)), Some(0));
        assert_eq!(to_fixed(f32::MIN_POSITIVE), Some(0));
        assert_eq!(to_fixed(1e-44), Some(0));
        for bad in [LIMIT, -LIMIT, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, f32::MAX] {
            assert_eq!(to_fixed(bad), None, "{bad}");
        }
        assert!(to_fixed(LIMIT * 0.999).is_some());
    }
}
