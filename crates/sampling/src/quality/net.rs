use super::QualityError;

/// The strength of a net in base 2, by counting: the smallest t for which the 2^m points are a (t, m, D)-net, that is,
/// for which every elementary interval of volume 2^(t - m) holds exactly 2^t of them (Niederreiter 1987). Coordinates
/// are in units of 2⁻³². 0 is best; m is had by any 2^m points. Any points will do, scrambled ones too;
/// [`net_t_by_rank`](super::net_t_by_rank) is faster for those of generator matrices.
///
/// O(2^m) for each of the ways to split up to m digits among D axes, of which there are (m + D)! / (m! D!).
///
/// # Errors
///
/// [`QualityError::PointCount`] if there are not 2^m points, [`QualityError::Digits`] if m is above 32.
///
/// ```
/// use etendue_sampling::quality::net_t_by_counting;
/// // Quarters, as the first two digits after the point.
/// let q = [0, 1 << 30, 2 << 30, 3 << 30];
/// assert_eq!(net_t_by_counting(&[[q[0], q[0]], [q[1], q[2]], [q[2], q[1]], [q[3], q[3]]], 2), Ok(0));
/// assert_eq!(net_t_by_counting(&[[q[0], q[0]], [q[1], q[1]], [q[2], q[2]], [q[3], q[3]]], 2), Ok(1));
/// ```
pub fn net_t_by_counting<const D: usize>(points: &[[u32; D]], m: u32) -> Result<u32, QualityError> {
    check_digits(m)?;
    if points.len() as u64 != 1 << m {
        return Err(QualityError::PointCount { m, got: points.len() });
    }
    // A net is one of every larger t too: the first that fits is the smallest. The last, of the whole cube, fits.
    Ok((0..m).find(|&t| is_net(points, m - t, t)).unwrap_or(m))
}

/// Refuses more digits than coordinates have.
pub(super) fn check_digits(m: u32) -> Result<(), QualityError> {
    if m <= 32 { Ok(()) } else { Err(QualityError::Digits { m }) }
}

/// Whether every elementary interval of volume 2^-digits holds exactly 2^t points.
fn is_net<const D: usize>(points: &[[u32; D]], digits: u32, t: u32) -> bool {
    let mut counts = vec![0u32; 1 << digits];
    every_split(&mut [0; D], 0, digits, &mut |split| {
        counts.fill(0);
        points.iter().all(|p| {
            // Which interval: the leading digits of all axes, one after the other.
            let cell = p.iter().zip(split).fold(0, |cell, (&x, &k)| cell << k | u64::from(x) >> (32 - k));
            let count = &mut counts[cell as usize];
            *count += 1;
            // As many points as places: where no interval has too many, none has too few.
            *count <= 1 << t
        })
    })
}

/// Whether `is_good` holds for all ways to deal `digits` to the axes from `axis` on.
fn every_split<const D: usize>(
    split: &mut [u32; D],
    axis: usize,
    digits: u32,
    is_good: &mut impl FnMut(&[u32; D]) -> bool,
) -> bool {
    if axis + 1 < D {
        return (0..=digits).all(|k| {
            split[axis] = k;
            every_split(split, axis + 1, digits - k, is_good)
        });
    }
    match split.last_mut() {
        Some(last) => {
            *last = digits;
            is_good(split)
        }
        // Without axes there are no intervals.
        None => true,
    }
}
