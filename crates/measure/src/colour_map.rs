//! Colours for numbers: false-colour pictures of errors.

/// `magma` at 0, 1/32, …, 1, sRGB. By S. van der Walt and N. Smith for matplotlib (2015), who gave it to the public
/// domain (CC0). Between these the original is met to 2 of 255.
#[rustfmt::skip]
const MAGMA: [[u8; 3]; 33] = [
    [0, 0, 4], [3, 3, 17], [10, 8, 34], [19, 13, 51], [29, 17, 70], [40, 17, 90],
    [54, 16, 106], [67, 15, 118], [80, 18, 124], [93, 23, 127], [105, 28, 129], [118, 33, 129],
    [130, 38, 129], [143, 42, 129], [156, 46, 127], [169, 50, 125], [182, 55, 121], [195, 59, 117],
    [207, 65, 112], [219, 72, 106], [230, 81, 99], [238, 92, 94], [245, 105, 92], [249, 120, 93],
    [251, 135, 97], [253, 150, 104], [254, 165, 113], [254, 180, 123], [254, 195, 135], [254, 209, 148],
    [253, 224, 162], [252, 238, 176], [252, 253, 191],
];

/// [`signed`] below and above 0, at 0, 1/5, …, 1, sRGB: of equal lightness L* on both sides (6, 22, 38, 54, 70, 86).
const BLUE: [[u8; 3]; 6] =
    [[19, 19, 21], [19, 51, 106], [21, 86, 180], [60, 129, 223], [119, 174, 244], [193, 218, 247]];
const RED: [[u8; 3]; 6] =
    [[19, 19, 21], [96, 30, 24], [167, 44, 29], [221, 84, 55], [245, 144, 115], [250, 206, 186]];

/// The colour (sRGB) of an error from 0, black, over purple and orange to 1, a light yellow: `magma` of Smith & van
/// der Walt 2015, in which equal steps look equal and lightness alone tells the order. What lies outside, or is no
/// number, gets the colour of the nearer end; NaN that of 1, since no number is no small error.
pub fn magma(x: f32) -> [u8; 3] {
    interpolate(&MAGMA, if x.is_nan() { 1.0 } else { x })
}

/// The colour (sRGB) of a signed error from −1 to 1: blue below the reference, red above it, lighter the farther, and
/// nearly black at 0. Equal amounts are equally light. Blue and red stay apart for viewers without one kind of cone
/// for long or middle waves. What lies outside gets the colour of the nearer end; NaN is white.
pub fn signed(x: f32) -> [u8; 3] {
    if x.is_nan() {
        return [255; 3];
    }
    interpolate(if x < 0.0 { &BLUE } else { &RED }, x.abs())
}

/// Linear between the colours of a table that are spread over [0, 1].
fn interpolate(table: &[[u8; 3]], x: f32) -> [u8; 3] {
    let last = table.len() - 1;
    let position = x.clamp(0.0, 1.0) * last as f32;
    let below = (position as usize).min(last);
    let (a, b) = (table[below], table[(below + 1).min(last)]);
    let t = position - below as f32;
    let mut out = a;
    for (o, b) in out.iter_mut().zip(b) {
        let from = f32::from(*o);
        *o = (from + (f32::from(b) - from) * t).round() as u8;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of sRGB, roughly: a square instead of the curve.
    fn linear(c: [u8; 3]) -> [f32; 3] {
        c.map(|c| (f32::from(c) / 255.0) * (f32::from(c) / 255.0))
    }

    fn luminance(c: [u8; 3]) -> f32 {
        let [r, g, b] = linear(c);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    #[test]
    fn magma_is_the_published_one() {
        // Entries of matplotlib's table of 256.
        let published = [
            (0, [0, 0, 4]),
            (20, [14, 11, 43]),
            (77, [101, 26, 128]),
            (128, [183, 55, 121]),
            (200, [253, 152, 105]),
            (255, [252, 253, 191]),
        ];
        for (i, want) in published {
            let got = magma(i as f32 / 255.0);
            assert!(got.iter().zip(want).all(|(g, w)| g.abs_diff(w) <= 2), "{i}: {got:?}, not {want:?}");
        }
    }

    #[test]
    fn lightness_tells_the_order() {
        let steps =
            |map: &dyn Fn(f32) -> [u8; 3]| (0..=50).map(|i| luminance(map(i as f32 / 50.0))).collect();
        let [m, above, below]: [Vec<f32>; 3] = [steps(&magma), steps(&signed), steps(&|x| signed(-x))];
        for lightness in [&m, &above, &below] {
            assert!(lightness.is_sorted_by(|a, b| a < b), "{lightness:?}");
        }
        for (a, b) in above.iter().zip(&below) {
            assert!((a - b).abs() < 0.1 * (a + b), "{a}, {b}");
        }
    }

    #[test]
    fn signs_stay_apart_without_one_kind_of_cone() {
        // What protanopes and deuteranopes see (Viénot, Brettel & Mollon 1999): red and green become one.
        for [[r, g], [blue, _]] in [[[0.1124, 0.8876], [0.004, 0.0]], [[0.2927, 0.7073], [-0.0223, 0.0]]] {
            let seen = |x: f32| {
                let c = linear(signed(x));
                [r * c[0] + g * c[1], blue * c[0] - blue * c[1] + c[2]].map(f32::sqrt)
            };
            for i in 2..=10 {
                let x = i as f32 / 10.0;
                let [[yellow, blue], [other_yellow, other_blue]] = [seen(x), seen(-x)];
                let apart = (blue - yellow) - (other_blue - other_yellow);
                assert!(apart < -0.15, "{x}: {apart}");
            }
        }
    }

    #[test]
    fn ends_and_what_is_no_number() {
        assert_eq!((magma(-1.0), magma(7.0)), (MAGMA[0], MAGMA[32]));
        assert_eq!((magma(f32::NAN), magma(f32::NEG_INFINITY)), (MAGMA[32], MAGMA[0]));
        assert_eq!((signed(-9.0), signed(f32::INFINITY), signed(-0.0)), (BLUE[5], RED[5], signed(0.0)));
        assert_eq!(signed(f32::NAN), [255; 3]);
        assert_eq!(signed(-0.4), BLUE[2]);
    }
}
