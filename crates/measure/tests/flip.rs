//! FLIP against numbers of its authors' implementation (flip-evaluator 1.7), and its properties.

use etendue_measure::CompareError;
use etendue_measure::flip::{FlipMap, FlipOptions, flip, flip_ldr};
use proptest::prelude::*;

type Pixels = Vec<[f32; 3]>;

/// The authors' program computes in single precision. Measured: pixels differ by 2e-5 at most, means by 2e-7 (of
/// single pixels by 2e-5); the worst pixel of other pictures with fireflies by 4e-5.
const TOLERANCE: f64 = 1e-4;

/// A picture and its reference.
struct Pair {
    picture: Pixels,
    reference: Pixels,
    size: [u32; 2],
}

impl Pair {
    fn new(size: [u32; 2], pixel: impl Fn([u32; 2], [u32; 2]) -> [[f64; 3]; 2]) -> Self {
        let (mut picture, mut reference) = (Pixels::new(), Pixels::new());
        for y in 0..size[1] {
            for x in 0..size[0] {
                let [a, r] = pixel([x, y], size).map(|p| p.map(|c| c as f32));
                picture.push(a);
                reference.push(r);
            }
        }
        Self { picture, reference, size }
    }

    /// Ramps under a checkerboard, and the same with noise in every channel.
    fn displayed(size: [u32; 2]) -> Self {
        Self::new(size, |[x, y], [w, h]| {
            let blue = if (x / 5 + y / 3) % 2 == 0 { 0.75 } else { 0.25 };
            let r = [(f64::from(x) + 0.5) / f64::from(w), (f64::from(y) + 0.5) / f64::from(h), blue];
            let mut a = r;
            for (c, a) in (0..).zip(&mut a) {
                *a = (*a + 0.2 * (noise(3 * (y * w + x) + c) - 0.5)).clamp(0.0, 1.0);
            }
            [a, r]
        })
    }

    /// A dim ramp with a lamp, and the same with noise and fireflies.
    fn radiance(size: [u32; 2]) -> Self {
        Self::new(size, |[x, y], [w, h]| {
            let (dx, dy) = (x.abs_diff(w / 3), y.abs_diff(h / 2));
            let lamp = if dx * dx + dy * dy < 12 { 60.0 } else { 0.0 };
            let r = [1.0, 0.6, 0.3].map(|c| 0.02 + 0.5 * (f64::from(x) + 0.5) / f64::from(w) * c + lamp);
            let i = y * w + x;
            let gain = 0.5 + noise(i) + if noise(i + 100_000) > 0.99 { 20.0 } else { 0.0 };
            [r.map(|c| c * gain), r]
        })
    }

    fn flip(&self, options: FlipOptions) -> FlipMap {
        flip(&self.picture, &self.reference, self.size, options).unwrap()
    }

    fn flip_ldr(&self, options: FlipOptions) -> FlipMap {
        flip_ldr(&self.picture, &self.reference, self.size, options).unwrap()
    }
}

/// A hash in [0, 1) (PCG-RXS-M-XS).
fn noise(i: u32) -> f64 {
    let x = i.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let x = ((x >> ((x >> 28) + 4)) ^ x).wrapping_mul(277_803_737);
    f64::from((x >> 22) ^ x) / 4_294_967_296.0
}

fn at(pixels_per_degree: f64) -> FlipOptions {
    FlipOptions { pixels_per_degree }
}

fn usual() -> FlipOptions {
    FlipOptions::default()
}

#[track_caller]
fn assert_map(map: &FlipMap, mean: f64, pixels: &[(usize, f64)]) {
    assert!((map.mean() - mean).abs() < TOLERANCE, "mean {}, not {mean}", map.mean());
    for (i, want) in pixels {
        let got = f64::from(map.values[*i]);
        assert!((got - want).abs() < TOLERANCE, "pixel {i}: {got}, not {want}");
    }
}

#[test]
fn displayed_pictures_are_as_the_authors_have_them() {
    let pair = Pair::displayed([37, 23]);
    let pixels =
        [(0, 0.052908), (36, 0.303710), (283, 0.068040), (425, 0.048548), (814, 0.132715), (850, 0.079354)];
    assert_map(&pair.flip_ldr(usual()), 0.107952, &pixels);
    let pixels =
        [(0, 0.282650), (36, 0.341749), (186, 0.507554), (425, 0.207755), (814, 0.228685), (850, 0.115757)];
    assert_map(&pair.flip_ldr(at(20.0)), 0.265866, &pixels);
    assert_map(&Pair::displayed([1, 1]).flip_ldr(usual()), 0.212066, &[]);
    let row = [(0, 0.100683), (10, 0.160000), (15, 0.271105), (16, 0.295039), (30, 0.194138)];
    assert_map(&Pair::displayed([31, 1]).flip_ldr(usual()), 0.187025, &row);
    let column = [(0, 0.186422), (5, 0.300777), (10, 0.164612), (15, 0.270911), (30, 0.168244)];
    assert_map(&Pair::displayed([1, 31]).flip_ldr(usual()), 0.191939, &column);
}

#[test]
fn radiance_is_as_the_authors_have_it() {
    let pair = Pair::radiance([41, 29]);
    let map = pair.flip(usual());
    let pixels =
        [(0, 0.257142), (40, 0.268574), (396, 0.254980), (594, 0.188518), (1174, 0.789863), (1188, 0.145277)];
    assert_map(&map, 0.195974, &pixels);
    let exposures = map.exposures.unwrap();
    assert!((exposures.start - -4.827_279_6).abs() < 1e-5, "{exposures:?}");
    assert!((exposures.stop - 3.449_652_2).abs() < 1e-5, "{exposures:?}");
    assert_eq!(exposures.count, 9);
    let pixels =
        [(0, 0.210876), (40, 0.181494), (396, 0.275400), (594, 0.178116), (1174, 0.605814), (1188, 0.150430)];
    assert_map(&pair.flip(at(120.0)), 0.173352, &pixels);
    let row = [(0, 0.343514), (10, 0.121120), (15, 0.332803), (30, 0.371205)];
    assert_map(&Pair::radiance([31, 1]).flip(usual()), 0.221707, &row);
    assert_map(&Pair::radiance([1, 1]).flip(usual()), 0.214721, &[]);
}

#[test]
fn the_viewing_distance_counts() {
    let pair = Pair::displayed([37, 23]);
    let mean = |ppd| pair.flip_ldr(at(ppd)).mean();
    assert!((mean(67.0206) - mean(66.0)).abs() > 10.0 * TOLERANCE, "a wrong distance would not be noticed");
    assert!(mean(20.0) > mean(67.0) && mean(67.0) > mean(200.0), "noise fades with the distance");
}

#[test]
fn equal_pictures_do_not_differ() {
    for pair in [Pair::displayed([37, 23]), Pair::radiance([41, 29]), Pair::radiance([1, 5])] {
        for pixels in [&pair.picture, &pair.reference] {
            assert_eq!(flip(pixels, pixels, pair.size, usual()).unwrap().max(), 0.0);
            assert_eq!(flip_ldr(pixels, pixels, pair.size, usual()).unwrap().max(), 0.0);
        }
    }
}

#[test]
fn the_order_counts_only_for_the_exposures() {
    let a = Pair::radiance([41, 29]);
    let b = Pair { picture: a.reference.clone(), reference: a.picture.clone(), size: a.size };
    assert_eq!(a.flip_ldr(usual()), b.flip_ldr(usual()));
    let (forth, back) = (a.flip(usual()), b.flip(usual()));
    assert!(forth.exposures != back.exposures && (forth.mean() - back.mean()).abs() > TOLERANCE);
}

#[test]
fn what_is_no_number_is_counted_and_stays_where_it_is() {
    let pair = Pair::radiance([41, 29]);
    let (mut alike, mut broken) = (pair.picture.clone(), pair.picture.clone());
    let mut reference = pair.reference.clone();
    (alike[300], broken[300]) = (reference[300], [0.1, f32::NAN, 0.2]);
    (alike[301], broken[301]) = (reference[301], [f32::NEG_INFINITY; 3]);
    let broken = |reference: &Pixels| flip(&broken, reference, pair.size, usual()).unwrap();
    let got = broken(&reference);
    let want = flip(&alike, &reference, pair.size, usual()).unwrap();
    assert_eq!((got.not_finite, want.not_finite), (2, 0));
    for (i, (g, w)) in got.values.iter().zip(&want.values).enumerate() {
        assert_eq!(*g, if i == 300 || i == 301 { 1.0 } else { *w }, "pixel {i}");
    }
    (reference[301], reference[900]) = ([f32::NAN; 3], [f32::INFINITY; 3]);
    let got = broken(&reference);
    assert_eq!((got.not_finite, got.values[900]), (3, 1.0));
    assert!(got.values[901] < 0.9, "the infinity dazzles no neighbour");
    assert_eq!(got.exposures.map(|e| e.count), Some(9), "nor the exposures");
}

#[test]
fn references_without_light() {
    let black = vec![[0.0; 3]; 60];
    let lit = vec![[0.5; 3]; 60];
    assert_eq!(flip(&black, &black, [10, 6], usual()).unwrap().max(), 0.0);
    let map = flip(&lit, &black, [10, 6], usual()).unwrap();
    assert!(map.values.iter().all(|v| *v > 0.9 && *v <= 1.0), "{map:?}");
    let map = flip(&black, &lit, [10, 6], usual()).unwrap();
    assert!(map.values.iter().all(|v| *v > 0.9 && *v <= 1.0), "{map:?}");
    let negative = vec![[-0.5, -1e30, 0.0]; 60];
    assert_eq!(flip(&negative, &black, [10, 6], usual()).unwrap().max(), 0.0);
}

#[test]
fn what_cannot_be_compared() {
    let (a, b) = ([[0.0; 3]; 6], [[0.0; 3]; 4]);
    for compared in [flip, flip_ldr] {
        assert_eq!(compared(&a, &b, [3, 2], usual()), Err(CompareError::Size(6, 4)));
        let shape = CompareError::Shape { pixels: 6, width: 2, height: 2 };
        assert_eq!(compared(&a, &a, [2, 2], usual()), Err(shape));
        assert!(compared(&a, &a, [u32::MAX, u32::MAX], usual()).is_err());
        for ppd in [0.0, -67.0, f64::NAN, f64::INFINITY, 1e9] {
            assert_eq!(compared(&a, &a, [3, 2], at(ppd)), Err(CompareError::PixelsPerDegree));
        }
        for size in [[0, 0], [7, 0], [0, u32::MAX]] {
            let map = compared(&[], &[], size, usual()).unwrap();
            assert_eq!((map.size, map.mean(), map.max()), (size, 0.0, 0.0));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn whatever_the_numbers_are_the_map_is_from_0_to_1(
        (size, bits) in ([1u32..7, 1u32..7])
            .prop_flat_map(|s| (Just(s), prop::collection::vec(any::<[u32; 6]>(), (s[0] * s[1]) as usize))),
        ppd in 1.0..1000.0f64,
    ) {
        let half = |from: usize| -> Pixels {
            bits.iter().map(|b| [0, 1, 2].map(|c| f32::from_bits(b[from + c]))).collect()
        };
        let (picture, reference) = (half(0), half(3));
        for compared in [flip, flip_ldr] {
            let map = compared(&picture, &reference, size, at(ppd)).unwrap();
            prop_assert_eq!(map.values.len(), picture.len());
            prop_assert!(map.values.iter().all(|v| (0.0..=1.0).contains(v)), "{:?}", map);
        }
    }
}
