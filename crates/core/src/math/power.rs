use super::exponential::{exp2_wide, log2_wide};

/// x^y, with the special values of IEEE 754: 1 for `y = 0` or `x = 1` whatever the other is, NaN for negative `x`
/// and non-integral `y`, signed zeros and infinities by the parity of `y`.
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    if y == 0.0 || x == 1.0 {
        return 1.0;
    }
    if x > 0.0 && x < f32::INFINITY {
        // y may be infinite (the sign of the logarithm then decides) or NaN (which passes through).
        return exp2_wide(f64::from(y) * log2_wide(x));
    }
    pow_special(x, y)
}

#[cold]
fn pow_special(x: f32, y: f32) -> f32 {
    if x.is_nan() || y.is_nan() {
        return f32::NAN;
    }
    let integral = y.is_infinite() || y.trunc() == y;
    // From 2²⁴ on every f32 is even.
    let odd = integral && y.abs() < 16_777_216.0 && (y as i32) & 1 != 0;
    let a = x.abs();
    let magnitude = if a == 0.0 || a == f32::INFINITY {
        if (a == 0.0) == (y > 0.0) { 0.0 } else { f32::INFINITY }
    } else if !integral {
        return f32::NAN;
    } else if a == 1.0 {
        1.0
    } else {
        exp2_wide(f64::from(y) * log2_wide(a))
    };
    if odd && x.is_sign_negative() { -magnitude } else { magnitude }
}

/// The real cube root, of negative numbers too.
#[inline]
pub fn cbrt(x: f32) -> f32 {
    let a = f64::from(x.abs());
    if !(a > 0.0 && a < f64::INFINITY) {
        return x;
    }
    // A third of the exponent (and, linearly, of the mantissa), to 5 bits; Halley's step triples the digits.
    let mut t = f64::from_bits(a.to_bits() / 3 + 0x2a9f_8400_0000_0000);
    for _ in 0..2 {
        let t3 = t * t * t;
        t = t * (t3 + 2.0 * a) / (2.0 * t3 + a);
    }
    (t as f32).copysign(x)
}
