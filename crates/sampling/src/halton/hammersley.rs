use super::radical::{PRIMES, radical_inverse};

/// The Hammersley point set (Hammersley 1960): N points fixed beforehand, of which the first coordinate is i/N and the
/// others are the radical inverses of i in the first primes.
///
/// *When.* For studies, and for one integral whose number of points is known: the bound on its star discrepancy
/// has one factor of log N less than the Halton sequence's of as many dimensions. It is no [`Sampler`](crate::Sampler): no prefix of it is good, and it is the same
/// in every pixel; a picture wants [`Halton`](crate::Halton).
///
/// ```
/// use etendue_sampling::Hammersley;
/// let set = Hammersley::new(4);
/// let points: Vec<_> = (0..4).map(|i| (set.point(i, 0).unwrap(), set.point(i, 1).unwrap())).collect();
/// assert_eq!(points, [(0.0, 0.0), (0.25, 0.5), (0.5, 0.25), (0.75, 0.75)]);
/// assert_eq!(set.point(4, 0), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Hammersley {
    points: u32,
    centred: bool,
}

impl Hammersley {
    /// Coordinates a point has: one for the number of the point, 32 for the primes up to 131.
    pub const DIMENSIONS: u32 = PRIMES.len() as u32 + 1;

    /// The set of `points` points.
    pub const fn new(points: u32) -> Self {
        Self { points, centred: false }
    }

    /// The same with the first coordinate (i + ½)/N, which halves its discrepancy in one dimension.
    #[must_use]
    pub const fn centred(mut self) -> Self {
        self.centred = true;
        self
    }

    /// How many points the set has.
    pub const fn points(self) -> u32 {
        self.points
    }

    /// Coordinate `dimension` of point `index`, in `[0, 1)` and rounded once. `None` where the set has no such point or
    /// no such dimension ([`Hammersley::DIMENSIONS`]).
    pub fn point(self, index: u32, dimension: u32) -> Option<f64> {
        if index >= self.points {
            return None;
        }
        if dimension == 0 {
            let offset = if self.centred { 0.5 } else { 0.0 };
            return Some((f64::from(index) + offset) / f64::from(self.points));
        }
        let base = *PRIMES.get(dimension as usize - 1)?;
        Some(radical_inverse(base, index))
    }
}
