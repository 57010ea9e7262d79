use super::QualityError;
use super::net::check_digits;

/// The strength of a digital net in base 2, by the ranks of its generator matrices: the smallest t for which the first
/// 2^m points are a (t, m, s)-net. `matrices[d][k]` is what bit `k` of a point's index contributes to its coordinate
/// `d` by exclusive or, in units of 2⁻³²: direction numbers, as [`Sobol::direction_numbers`](crate::Sobol) has them.
///
/// t = m - ρ, where ρ is the largest number for which any ρ rows that are the first k₁, …, kₛ of the matrices, k₁ + … +
/// kₛ = ρ, are linearly independent over GF(2) (Niederreiter 1987; Schmid 1999). Owen's scrambling and
/// digital shifts leave it as it is. Tries all ways to split up to ρ + 1 rows among the matrices, with one step of
/// Gaussian elimination each.
///
/// # Errors
///
/// [`QualityError::Digits`] if m is above 32.
///
/// ```
/// use etendue_sampling::{Sobol, quality::net_t_by_rank};
/// let four: Vec<_> = (0..4).filter_map(Sobol::direction_numbers).collect();
/// assert_eq!(net_t_by_rank(&four[..2], 16), Ok(0));
/// assert_eq!(net_t_by_rank(&four, 8), Ok(3));
/// ```
pub fn net_t_by_rank(matrices: &[[u32; 32]], m: u32) -> Result<u32, QualityError> {
    check_digits(m)?;
    let rows: Vec<[u32; 32]> = matrices.iter().map(|columns| rows(columns, m)).collect();
    Ok(m + 1 - fewest_dependent(&rows, Basis::default(), 0, m + 1))
}

/// Row r of a matrix, the digit 2^-(r + 1) of the coordinate, as the set of those of the first `m` index bits that it
/// depends on.
fn rows(columns: &[u32; 32], m: u32) -> [u32; 32] {
    std::array::from_fn(|r| (0..m).fold(0, |row, k| row | (columns[k as usize] >> (31 - r) & 1) << k))
}

/// The size of the smallest dependent system of first rows of `matrices` that includes the `chosen` ones of earlier
/// matrices, which are independent and span `basis`; or `known` if none is smaller.
fn fewest_dependent(matrices: &[[u32; 32]], mut basis: Basis, chosen: u32, mut known: u32) -> u32 {
    let Some((rows, rest)) = matrices.split_first() else { return known };
    known = fewest_dependent(rest, basis, chosen, known);
    for (row, size) in rows.iter().zip(chosen + 1..) {
        if size >= known {
            break;
        }
        if !basis.add(*row) {
            return size;
        }
        known = fewest_dependent(rest, basis, size, known);
    }
    known
}

/// Independent vectors over GF(2), each filed under its highest bit.
#[derive(Clone, Copy, Default)]
struct Basis([u32; 32]);

impl Basis {
    /// Takes a vector in; false if it depends on those that are there.
    fn add(&mut self, mut vector: u32) -> bool {
        while let Some(bit) = vector.checked_ilog2() {
            let filed = &mut self.0[bit as usize];
            if *filed == 0 {
                *filed = vector;
                return true;
            }
            vector ^= *filed;
        }
        false
    }
}
