use super::QualityError;
use super::error::check;

/// The L2 star discrepancy: the root mean square of #(points in [0, q))/N - volume over uniform q (Warnock
/// 1972). The root, not its square. O(D N²); independent uniform points have the mean square
/// (2⁻ᴰ - 3⁻ᴰ)/N. Not symmetric: the origin is special.
///
/// # Errors
///
/// [`QualityError`] if there are no points, or not all of them are in [0, 1)^D.
///
/// ```
/// use etendue_sampling::quality::l2_star;
/// // The centres of 4 intervals: 1 / (√12 · 4).
/// let d = l2_star(&[[0.125], [0.375], [0.625], [0.875]]).unwrap();
/// assert!((d - 1.0 / 192f64.sqrt()).abs() < 1e-15);
/// ```
pub fn l2_star<const D: usize>(points: &[[f64; D]]) -> Result<f64, QualityError> {
    root(points, 1.0 / 3.0, |x| 0.5 * (1.0 - x * x), |x, y| 1.0 - x.max(y))
}

/// The centred L2 discrepancy: boxes from the nearest corner of the cube, in it and in all its faces (Hickernell 1998,
/// "A generalized discrepancy and quadrature error bound"). The root, not its square (which is what scipy's `method='CD'` returns). The same for points that are
/// mirrored in an axis. O(D N²).
///
/// # Errors
///
/// [`QualityError`] if there are no points, or not all of them are in [0, 1)^D.
pub fn centred_l2<const D: usize>(points: &[[f64; D]]) -> Result<f64, QualityError> {
    let one = |x: f64| {
        let a = (x - 0.5).abs();
        1.0 + 0.5 * a - 0.5 * a * a
    };
    let two = |x: f64, y: f64| 1.0 + 0.5 * ((x - 0.5).abs() + (y - 0.5).abs() - (x - y).abs());
    root(points, 13.0 / 12.0, one, two)
}

/// The wrap-around L2 discrepancy: boxes anywhere in the unit torus, and in all its faces (Hickernell 1998,
/// "Lattice rules: how well do they measure up?"). The root, not its square (scipy's `method='WD'`). The same for points that
/// are shifted or mirrored. O(D N²).
///
/// # Errors
///
/// [`QualityError`] if there are no points, or not all of them are in [0, 1)^D.
pub fn wrap_around_l2<const D: usize>(points: &[[f64; D]]) -> Result<f64, QualityError> {
    let two = |x: f64, y: f64| {
        let a = (x - y).abs();
        1.5 - a * (1.0 - a)
    };
    // On the torus no place is special: the mean of the kernel over one of the points is 4/3 wherever the other is.
    root(points, 4.0 / 3.0, |_| 4.0 / 3.0, two)
}

/// The mixture discrepancy: between the centred and the wrap-around one, without the weaknesses of either in high
/// dimensions (Zhou, Fang & Ning 2013). The root, not its square (scipy's `method='MD'`). The same for
/// points that are mirrored in an axis. O(D N²).
///
/// # Errors
///
/// [`QualityError`] if there are no points, or not all of them are in [0, 1)^D.
pub fn mixture<const D: usize>(points: &[[f64; D]]) -> Result<f64, QualityError> {
    let one = |x: f64| {
        let a = (x - 0.5).abs();
        5.0 / 3.0 - 0.25 * a - 0.25 * a * a
    };
    let two = |x: f64, y: f64| {
        let a = (x - y).abs();
        1.875 - 0.25 * ((x - 0.5).abs() + (y - 0.5).abs()) - 0.75 * a + 0.5 * a * a
    };
    root(points, 19.0 / 12.0, one, two)
}

/// The discrepancy of a product kernel: the root of ∏ mean - 2/N Σᵢ ∏ one(xᵢ) + 1/N² Σᵢⱼ ∏ two(xᵢ, xⱼ), where `two` is
/// the kernel in one dimension, symmetric, `one` its mean over uniform values of one argument, and `mean` that over both.
fn root<const D: usize>(
    points: &[[f64; D]],
    mean: f64,
    one: impl Fn(f64) -> f64,
    two: impl Fn(f64, f64) -> f64,
) -> Result<f64, QualityError> {
    check(points)?;
    let n = points.len() as f64;
    // Three numbers near 1 that nearly cancel: sums without compensation would lose the smaller discrepancies.
    let mut singles = Sum::default();
    let mut pairs = Sum::default();
    for (i, p) in points.iter().enumerate() {
        singles.add(p.iter().map(|&x| one(x)).product());
        let kernel = |q: &[f64; D]| p.iter().zip(q).map(|(&x, &y)| two(x, y)).product::<f64>();
        pairs.add(kernel(p));
        for q in &points[..i] {
            pairs.add(2.0 * kernel(q));
        }
    }
    let mut square = Sum::default();
    square.add([mean; D].iter().product());
    square.add(-2.0 / n * singles.total());
    square.add(pairs.total() / (n * n));
    // Of points that are too even for double precision rounding may leave less than nothing.
    Ok(square.total().max(0.0).sqrt())
}

/// A sum that carries the rounding errors of its additions (Neumaier 1974).
#[derive(Clone, Copy, Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn add(&mut self, x: f64) {
        let sum = self.sum + x;
        self.lost += if self.sum.abs() >= x.abs() { (self.sum - sum) + x } else { (x - sum) + self.sum };
        self.sum = sum;
    }

    fn total(self) -> f64 {
        self.sum + self.lost
    }
}
