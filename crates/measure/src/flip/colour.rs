//! Colour spaces and the distance in them.

use etendue_core::math::{cbrt, pow};

/// Linear Rec.709 to XYZ relative to the white D65, from the primaries' chromaticities and the white's to
/// five digits (0.31271, 0.32902), as the authors take it.
const TO_XYZ: [[f32; 3]; 3] = [
    [0.433_895_4, 0.376_242_37, 0.189_862_24],
    [0.212_636_82, 0.715_183, 0.072_180_2],
    [0.017_752_42, 0.109_465_63, 0.872_781_95],
];
/// Its inverse.
const FROM_XYZ: [[f32; 3]; 3] = [
    [3.080_342, -1.537_399, -0.542_943],
    [-0.921_178_4, 1.875_93, 0.045_248_41],
    [0.052_881_29, -0.204_011_2, 1.151_129_9],
];

/// Large colour distances are rarely told apart: the exponent, the share of the largest distance from which on they
/// are compressed, and the part of the error's range left for those below (error redistribution,
/// Andersson et al. 2020).
const EXPONENT: f32 = 0.7;
const KNEE: f32 = 0.4;
const BELOW_KNEE: f32 = 0.95;
/// Largest distance: from the green primary to the blue one, both in [`hunt_lab`], to the power of [`EXPONENT`].
const LARGEST: f32 = 41.2761;

fn transform(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Linear Rec.709 to YCxCz: L*a*b* without its cube root, so that filtering there is filtering light. The first
/// component is the luminance (0 to 1) instead of 116 times it less 16, which the filters would only carry along.
pub(super) fn to_ycxcz(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = transform(&TO_XYZ, rgb);
    [y, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The inverse of [`to_ycxcz`], within the gamut: filtered colours may leave it.
pub(super) fn from_ycxcz([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    transform(&FROM_XYZ, [y + cx / 500.0, y, y - cz / 200.0]).map(|c| c.clamp(0.0, 1.0))
}

/// L*a*b* of linear Rec.709, its chroma scaled by the lightness: colours look more saturated the lighter they are
/// (Hunt 1952).
pub(super) fn hunt_lab(rgb: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let [x, y, z] = transform(&TO_XYZ, rgb)
        .map(|t| if t > DELTA * DELTA * DELTA { cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 });
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// HyAB: city block between lightness and chroma, Euclidean within chroma. Made for large distances (Abasi, Amani
/// Tehran & Fairchild 2020).
fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    let (da, db) = (a[1] - b[1], a[2] - b[2]);
    (a[0] - b[0]).abs() + (da * da + db * db).sqrt()
}

/// How different two colours in [`hunt_lab`] look, 0 to 1.
pub(super) fn colour_error(a: [f32; 3], b: [f32; 3]) -> f32 {
    let distance = pow(hyab(a, b), EXPONENT);
    let knee = KNEE * LARGEST;
    if distance < knee {
        distance * (BELOW_KNEE / knee)
    } else {
        (BELOW_KNEE + (distance - knee) / (LARGEST - knee) * (1.0 - BELOW_KNEE)).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_are_inverse_and_white_is_neutral() {
        for (i, row) in TO_XYZ.iter().enumerate() {
            assert!((row.iter().sum::<f32>() - 1.0).abs() < 1e-6, "row {i} moves white");
        }
        for rgb in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.7, 0.4]] {
            let back = from_ycxcz(to_ycxcz(rgb));
            assert!(back.iter().zip(rgb).all(|(a, b)| (a - b).abs() < 1e-5), "{back:?}, not {rgb:?}");
        }
        let [lightness, a, b] = hunt_lab([1.0; 3]);
        assert!((lightness - 100.0).abs() < 1e-4 && a.abs() < 1e-3 && b.abs() < 1e-3);
    }

    #[test]
    fn the_largest_distance_is_from_green_to_blue() {
        let corner = |i: u32| hunt_lab([0, 1, 2].map(|c| if i >> c & 1 == 1 { 1.0 } else { 0.0 }));
        let (green, blue) = (corner(2), corner(4));
        let largest = pow(hyab(green, blue), EXPONENT);
        assert!((largest - LARGEST).abs() < 1e-3, "{largest}");
        assert!((colour_error(green, blue) - 1.0).abs() < 1e-6);
        for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
            assert!(hyab(corner(i), corner(j)) <= hyab(green, blue));
            assert_eq!(colour_error(corner(i), corner(j)) == 0.0, i == j);
        }
    }
}
