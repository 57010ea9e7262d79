//! Exact signs (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust geometric predicates").

use etendue_core::Vec3A;
use etendue_core::glam::DVec3;

/// Rounding error of `a + b = s` (Knuth): `s + error` is exact.
#[inline]
fn two_sum_error(a: f64, b: f64, s: f64) -> f64 {
    let bb = s - a;
    (a - (s - bb)) + (b - bb)
}

/// Rounding error of the product `a b = p` (Veltkamp and Dekker): `p + error` is exact.
#[inline]
pub(crate) fn two_product_error(a: f64, b: f64, p: f64) -> f64 {
    const SPLIT: f64 = 134_217_729.0; // 2^27 + 1
    let high = |x: f64| {
        let c = SPLIT * x;
        c - (c - x)
    };
    let (ah, bh) = (high(a), high(b));
    let (al, bl) = (a - ah, b - bh);
    al * bl - (((p - ah * bh) - al * bh) - ah * bl)
}

/// `|v|² − r²` to nearly the last digit, however close to each other the two squares are (Ogita, Rump & Oishi 2005,
/// "Accurate sum and dot product", Dot2).
pub(crate) fn squared_distance_beyond(v: DVec3, r: f64) -> f64 {
    let (mut sum, mut rest) = (0.0f64, 0.0);
    for (a, b) in [(v.x, v.x), (-r, r), (v.y, v.y), (v.z, v.z)] {
        let p = a * b;
        let s = sum + p;
        rest += two_sum_error(sum, p, s) + two_product_error(a, b, p);
        sum = s;
    }
    sum + rest
}

/// Whether the six terms cancel exactly.
fn sums_to_zero(terms: [f64; 6]) -> bool {
    // Grow the expansion one term at a time; it stays exact, and is zero only if every component is.
    let mut expansion = [0.0f64; 6];
    for (n, &term) in terms.iter().enumerate() {
        let mut q = term;
        for e in expansion.iter_mut().take(n) {
            let s = q + *e;
            *e = two_sum_error(q, *e, s);
            q = s;
        }
        if let Some(last) = expansion.get_mut(n) {
            *last = q;
        }
    }
    expansion.iter().all(|&e| e == 0.0)
}

/// Whether three points of the plane lie exactly on one line.
fn collinear_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> bool {
    // Products of two single-precision numbers are exact in double precision.
    let terms = [b[0] * c[1], -b[0] * a[1], -a[0] * c[1], -b[1] * c[0], b[1] * a[0], a[1] * c[0]];
    let (mut sum, mut size) = (0.0, 0.0);
    for t in terms {
        sum += t;
        size += f64::abs(t);
    }
    if f64::abs(sum) > size * 1e-14 {
        return false;
    }
    sums_to_zero(terms)
}

/// Whether the triangle has exactly zero area: equal or collinear corners. No rounding is involved.
pub(crate) fn is_flat(v: [Vec3A; 3]) -> bool {
    let pair = |i: usize, j: usize| {
        let at = |p: Vec3A| [f64::from(p[i]), f64::from(p[j])];
        collinear_2d(at(v[0]), at(v[1]), at(v[2]))
    };
    pair(0, 1) && pair(1, 2) && pair(2, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_is_exact() {
        let p = |x: f32, y: f32, z: f32| Vec3A::new(x, y, z);
        assert!(is_flat([p(0.1, 0.2, 0.3); 3]));
        assert!(is_flat([p(1.0, 1.0, 1.0), p(2.0, 2.0, 2.0), p(3.0, 3.0, 3.0)]));
        // One ulp off the line is a triangle.
        assert!(!is_flat([p(1.0, 1.0, 1.0), p(2.0, 2.0, 2.0), p(3.0, 3.0, 3.0f32.next_up())]));
        assert!(!is_flat([p(0.0, 0.0, 0.0), p(1e15, 0.0, 0.0), p(0.0, 1e-40, 0.0)]));
        // Far apart in exponent: the differences do not fit a double, the six products do.
        assert!(!is_flat([p(1e18, 1e18, 0.0), p(1e-30, 0.0, 0.0), p(0.0, 0.0, 0.0)]));
        assert!(is_flat([p(1e18, 1e18, 0.0), p(1e-30, 1e-30, 0.0), p(0.0, 0.0, 0.0)]));
    }

    #[test]
    fn product_error_is_exact() {
        let (a, b) = (1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
        // (1 + e)(1 - e) = 1 - e^2: rounds to 1 with the error -e^2.
        assert_eq!(two_product_error(a, b, a * b), -f64::EPSILON * f64::EPSILON);
        assert_eq!(two_product_error(3.0, 5.0, 15.0), 0.0);
    }
}
