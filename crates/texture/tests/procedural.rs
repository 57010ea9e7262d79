//! Checkers and noise: cells, ranges, statistics, and the same bits everywhere.

use std::cell::Cell;
use std::sync::Arc;

use etendue_core::{Fingerprint, Spectrum, Transform, Vec2, Vec3A};
use etendue_texture::{
    Checker, Encoding, ImageTexture, Noise, NoiseKind, ScalarTex, Tex, TexPoint, TexSpace, Texture,
    UvTransform,
};
use proptest::prelude::*;

const BLACK: Spectrum = Spectrum::BLACK;
const WHITE: Spectrum = Spectrum::ONE;

fn world(scale: f32) -> TexSpace {
    TexSpace::World(Transform::scale(Vec3A::splat(scale)).expect("invertible"))
}

fn look(tex: &dyn Texture, uv: Vec2, p: Vec3A) -> Spectrum {
    let fetches = Cell::new(0);
    tex.eval(&TexPoint { uv: [uv, uv + Vec2::splat(1.0)], p, fetches: &fetches })
}

/// Splitmix64.
fn numbers(seed: u64) -> impl FnMut() -> f32 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / 16_777_216.0
    }
}

#[test]
fn squares_take_turns() {
    let board = Checker::new(TexSpace::uv(4.0), WHITE, BLACK);
    for i in -9..9 {
        for j in -9..9 {
            let uv = Vec2::new((i as f32 + 0.3) / 4.0, (j as f32 + 0.9) / 4.0);
            let expected = if (i + j) % 2 == 0 { WHITE } else { BLACK };
            assert_eq!(look(&board, uv, Vec3A::ZERO), expected, "{i} {j}");
        }
    }
    assert_eq!(board.mean(), Spectrum::gray(0.5));
    assert_eq!(Checker::new(TexSpace::uv(1.0), WHITE, BLACK).mean(), WHITE, "one cell fills the unit square");
    let second =
        Checker { space: TexSpace::Uv { set: 1, transform: UvTransform::IDENTITY }, ..board.clone() };
    assert_eq!(look(&second, Vec2::splat(0.5), Vec3A::ZERO), WHITE);
    assert_eq!(look(&second, Vec2::new(0.5, 1.5), Vec3A::ZERO), BLACK);
    for bad in [f32::NAN, f32::INFINITY, -1e30] {
        let c = look(&board, Vec2::new(bad, 0.1), Vec3A::ZERO);
        assert!(c == WHITE || c == BLACK);
    }
}

#[test]
fn cubes_take_turns() {
    let dice = Checker::new(world(2.0), Spectrum::gray(0.75), Spectrum::gray(0.25));
    for i in 0..1000 {
        let (x, y, z) = (i % 10 - 5, i / 10 % 10 - 5, i / 100 - 5);
        let p = (Vec3A::new(x as f32, y as f32, z as f32) + Vec3A::new(0.1, 0.5, 0.99)) / 2.0;
        let expected = if (x + y + z) % 2 == 0 { 0.75 } else { 0.25 };
        assert_eq!(look(&dice, Vec2::ZERO, p), Spectrum::gray(expected));
    }
    assert_eq!(
        (dice.mean(), dice.max(), dice.min()),
        (Spectrum::gray(0.5), Spectrum::gray(0.75), Spectrum::gray(0.25))
    );
}

/// Textures within textures: what is seen is looked up and counted, what is not, is not.
#[test]
fn cells_hold_textures() {
    let image = ImageTexture::from_u8(2, 1, 1, vec![51, 204], Encoding::Linear).expect("sizes agree");
    let tex: Tex = Checker::new(TexSpace::uv(2.0), Tex::image(Arc::new(image)), Tex::gray(0.5)).into();
    for (u, count, value) in [(0.25, 2, 0.2), (0.75, 1, 0.5)] {
        let fetches = Cell::new(0);
        let v = tex.eval(&TexPoint { uv: [Vec2::new(u, 0.25); 2], p: Vec3A::ZERO, fetches: &fetches });
        assert_eq!((v, fetches.get()), (Spectrum::gray(value), count));
    }
    assert_eq!((tex.max(), tex.min()), (Spectrum::gray(0.8), Spectrum::gray(0.2)));
    assert_eq!(tex.scaled(Spectrum::gray(0.5)).max(), Spectrum::gray(0.4));
}

/// The digest of a thousand values. Changing it changes pictures.
#[test]
fn noise_has_the_same_bits_everywhere() {
    let mut next = numbers(1);
    let mut f = Fingerprint::default();
    for i in 0..1000 {
        let noise = Noise::fractal(world(1.0), 1 + i % 6, BLACK, WHITE).with_seed(i / 100);
        let p = Vec3A::new(next(), next(), next()) * 200.0 - Vec3A::splat(100.0);
        f.f32(noise.value(p));
        f.f32(Noise { kind: NoiseKind::Turbulence, ..noise }.value(p));
    }
    assert_eq!(f.value(), PINNED);
}

/// Mean 0; hardly any correlation at two cells and beyond, most of it at a tenth of a cell.
#[test]
fn noise_has_mean_zero_and_a_cell_of_correlation() {
    for (octaves, seed) in [(1, 0), (1, 7), (5, 0), (5, 7)] {
        let noise = Noise::fractal(world(1.0), octaves, BLACK, WHITE).with_seed(seed);
        let lags = [0.0f32, 0.1, 0.5, 1.0, 2.0, 3.5];
        let (mut mean, mut products, mut most) = (0.0f64, [0.0f64; 6], 0.0f32);
        let mut next = numbers(u64::from(seed) + 5);
        let n = 200_000;
        for _ in 0..n {
            let p = Vec3A::new(next(), next(), next()) * 1000.0;
            let v = noise.value(p);
            mean += f64::from(v) / f64::from(n);
            most = if v.abs() > most { v.abs() } else { most };
            for (sum, lag) in products.iter_mut().zip(lags) {
                *sum += f64::from(v * noise.value(p + Vec3A::X * lag)) / f64::from(n);
            }
        }
        let [variance, ..] = products;
        let correlation = products.map(|c| c / variance);
        println!(
            "{octaves} octaves: mean {mean:.4}, deviation {:.3}, most {most:.3}, correlation {correlation:.3?}",
            variance.sqrt()
        );
        // 200,000 independent values: 5 standard errors are 0.011 of the deviation.
        assert!(mean.abs() < 0.012 * variance.sqrt(), "{mean}");
        assert!(most <= 1.0 && variance > 0.02);
        assert!(
            correlation[1] > 0.7 && correlation[2] < 0.6 && correlation[3].abs() < 0.2,
            "{correlation:?}"
        );
        assert!(correlation[4].abs() < 0.012 && correlation[5].abs() < 0.012, "{correlation:?}");
    }
}

#[test]
fn octaves_and_gains_are_bounded() {
    let p = Vec3A::new(0.3, 1.7, -2.2);
    let noise = Noise::fractal(world(1.0), 4, BLACK, WHITE);
    assert_eq!(Noise { octaves: 0, ..noise }.value(p), Noise { octaves: 1, ..noise }.value(p));
    assert_eq!(Noise { octaves: u32::MAX, ..noise }.value(p), Noise { octaves: 16, ..noise }.value(p));
    for gain in [0.0, -1.0, f32::NAN] {
        assert_eq!(Noise { gain, ..noise }.value(p), Noise { octaves: 1, ..noise }.value(p));
    }
    for gain in [1.0, 2.0, 1e30, f32::INFINITY] {
        for lacunarity in [2.0, 1e30, f32::NAN, 0.0] {
            let v = Noise { gain, lacunarity, octaves: 16, ..noise }.value(p);
            assert!((-1.0..=1.0).contains(&v), "{v}");
        }
    }
    assert_ne!(noise.value(p), noise.with_seed(1).value(p));
}

/// What every material and every light copies.
#[test]
fn parameters_stay_small() {
    assert_eq!((size_of::<Tex>(), size_of::<ScalarTex>()), SIZES);
}

#[test]
fn fingerprints_tell_patterns_apart() {
    let noise = Noise::fractal(TexSpace::uv(3.0), 4, BLACK, WHITE);
    let all: Vec<Tex> = vec![
        noise.into(),
        noise.with_seed(1).into(),
        Noise { octaves: 5, ..noise }.into(),
        Noise { kind: NoiseKind::Turbulence, ..noise }.into(),
        Noise { space: world(3.0), ..noise }.into(),
        Noise { gain: 0.6, ..noise }.into(),
        Noise { low: Spectrum::gray(0.1), ..noise }.into(),
        Checker::new(TexSpace::uv(3.0), BLACK, WHITE).into(),
        Checker::new(TexSpace::uv(3.0), WHITE, BLACK).into(),
    ];
    let mut seen = std::collections::BTreeSet::new();
    for tex in &all {
        let mut f = Fingerprint::default();
        tex.fingerprint(&mut f);
        assert!(!f.is_opaque() && seen.insert(f.value()), "{tex:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        rng_seed: prop::test_runner::RngSeed::Fixed(4),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Whatever the point, the value lies between the two colours, and what a parameter says of its range holds.
    #[test]
    fn values_stay_between_the_colours(
        turbulence in any::<bool>(),
        (octaves, seed) in (0u32..20, any::<u32>()),
        (low, high) in (-2.0f32..2.0, -2.0f32..2.0),
        uv in prop_oneof![(-50.0f32..50.0, -50.0f32..50.0), (any::<f32>(), any::<f32>())],
        z in prop_oneof![-50.0f32..50.0, any::<f32>()],
        in_world in any::<bool>(),
    ) {
        let kind = if turbulence { NoiseKind::Turbulence } else { NoiseKind::Fractal };
        let space = if in_world { world(1.5) } else { TexSpace::uv(1.5) };
        let noise = Noise { kind, ..Noise::fractal(space, octaves, Spectrum::rgb(low, high, low), Spectrum::rgb(high, low, low)) };
        let noise = noise.with_seed(seed);
        let v = look(&noise, Vec2::new(uv.0, uv.1), Vec3A::new(uv.0, uv.1, z));
        for c in 0..3 {
            prop_assert!(noise.min()[c] <= v[c] && v[c] <= noise.max()[c], "{noise:?}: {v:?}");
        }
        prop_assert_eq!(v.b(), low);
        let number = ScalarTex::from(noise).scaled(2.0);
        prop_assert_eq!((number.min(), number.max()), (2.0 * low.min(high), 2.0 * low.max(high)));
        let fetches = Cell::new(0);
        let at = TexPoint { uv: [Vec2::new(uv.0, uv.1); 2], p: Vec3A::new(uv.0, uv.1, z), fetches: &fetches };
        prop_assert_eq!(number.eval(&at), 2.0 * v.r());
        prop_assert_eq!(fetches.get(), 1);
        let value = noise.value(at.p);
        let least = if turbulence { 0.0 } else { -1.0 };
        prop_assert!(least <= value && value <= 1.0);
    }
}

/// (Tex, ScalarTex), bytes.
const SIZES: (usize, usize) = (64, 80);
/// See `noise_has_the_same_bits_everywhere`.
const PINNED: u128 = 156_798_872_982_924_771_854_496_660_571_958_299_195;
