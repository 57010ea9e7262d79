//! Images as textures: layout, filtering, bounds, errors.

use std::cell::Cell;
use std::sync::Arc;

use etendue_core::{Fingerprint, Spectrum, Vec2, Vec3A, Vec4};
use etendue_texture::{
    Channel, Encoding, Filter, ImageTexture, ImageUse, ScalarTex, Tex, TexPoint, Texture, TextureError,
    UvTransform, Wrap,
};
use proptest::prelude::*;

fn ramp() -> ImageTexture {
    // 3 × 2 RGBA: red grows to the right, green downward, alpha with both.
    let data = (0..6u8).flat_map(|i| [i % 3 * 100, i / 3 * 200, 7, 40 * i]).collect();
    ImageTexture::from_u8(3, 2, 4, data, Encoding::Linear).expect("sizes agree")
}

#[test]
fn rows_run_down_and_centres_are_exact() {
    let image = ramp();
    for y in 0..2u32 {
        for x in 0..3u32 {
            let uv = Vec2::new((x as f32 + 0.5) / 3.0, (y as f32 + 0.5) / 2.0);
            let texel = image.texel(x, y);
            assert!((image.eval4(uv) - texel).abs().max_element() < 1e-6);
            assert_eq!(texel.x, x as f32 * 100.0 / 255.0);
            assert_eq!(texel.y, y as f32 * 200.0 / 255.0);
            assert_eq!(texel.w, (y * 3 + x) as f32 * 40.0 / 255.0);
        }
    }
    let nearest = ramp().with_filter(Filter::Nearest);
    assert_eq!(nearest.eval4(Vec2::new(0.65, 0.49)), nearest.texel(1, 0));
}

#[test]
fn filtering_happens_in_linear_light() {
    let image = ImageTexture::from_u8(2, 1, 1, vec![0, 255], Encoding::Srgb).expect("sizes agree");
    assert_eq!(image.eval4(Vec2::new(0.5, 0.5)), Vec4::new(0.5, 0.5, 0.5, 1.0));
    // The mutant filters first and decodes later: half of the code values is 0.214 of the light.
    assert!((image.eval_channel(Vec2::new(0.5, 0.5), Channel::G) - 0.214).abs() > 0.2);
}

#[test]
fn channels_spread_by_count() {
    let at = Vec2::splat(0.5);
    let of = |channels: u32| {
        let data = (1..=channels).map(|c| c as f32).collect();
        ImageTexture::from_f32(1, 1, channels, data).expect("sizes agree").eval4(at).to_array()
    };
    assert_eq!(of(1), [1.0, 1.0, 1.0, 1.0]);
    assert_eq!(of(2), [1.0, 1.0, 1.0, 2.0]);
    assert_eq!(of(3), [1.0, 2.0, 3.0, 1.0]);
    assert_eq!(of(4), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn errors_name_the_place() {
    let bytes = |w, h, c, n: usize| ImageTexture::from_u8(w, h, c, vec![0; n], Encoding::Linear).err();
    assert_eq!(bytes(0, 4, 3, 0), Some(TextureError::Empty { width: 0, height: 4 }));
    assert_eq!(bytes(2, 2, 5, 20), Some(TextureError::Channels { channels: 5 }));
    assert!(matches!(bytes(1 << 17, 1, 1, 0), Some(TextureError::TooLarge { max: 65_536, .. })));
    assert!(matches!(bytes(2, 2, 3, 11), Some(TextureError::SizeMismatch { expected: 12, found: 11, .. })));
    let mut floats = vec![0.0; 2 * 3 * 3];
    floats[3 * 3 + 2] = f32::INFINITY;
    let error = ImageTexture::from_f32(2, 3, 3, floats).err();
    assert_eq!(error, Some(TextureError::NotFinite { x: 1, y: 1, channel: 2 }));
}

#[test]
fn a_use_scales_maps_and_counts() {
    let image = Arc::new(ramp());
    let fetches = Cell::new(0);
    let at = TexPoint { uv: [Vec2::new(0.1, 0.2), Vec2::new(0.7, 0.8)], p: Vec3A::ZERO, fetches: &fetches };
    let shift = UvTransform { offset: Vec2::new(0.25, 0.0), ..UvTransform::IDENTITY };
    let usage = ImageUse {
        uv_set: 1,
        transform: Some(shift),
        scale: Spectrum::gray(2.0),
        ..ImageUse::new(image.clone())
    };
    let expected = image.eval4(Vec2::new(0.95, 0.8));
    let tex = Tex::from(usage.clone());
    assert_eq!(tex.eval(&at), Spectrum::rgb(expected.x, expected.y, expected.z) * 2.0);
    assert_eq!(tex.max(), image.max() * 2.0);
    let alpha = ScalarTex::image(usage, Channel::A).scaled(0.5);
    assert_eq!(alpha.eval(&at), expected.w * 0.5);
    assert_eq!((alpha.min(), alpha.max()), (0.0, 100.0 / 255.0));
    assert_eq!(fetches.get(), 2);
    assert_eq!((Tex::gray(0.3).eval(&at).g(), ScalarTex::Constant(0.2).eval(&at)), (0.3, 0.2));
    assert_eq!(fetches.get(), 2, "constants are not look-ups");
    assert!(Tex::gray(0.3).is_constant() && !tex.is_constant());
}

#[test]
fn fingerprints_tell_images_apart() {
    let digest = |t: &dyn Texture| {
        let mut f = Fingerprint::default();
        t.fingerprint(&mut f);
        assert!(!f.is_opaque());
        f.value()
    };
    let plain = digest(&ramp());
    assert_eq!(plain, digest(&ramp()));
    assert_ne!(plain, digest(&ramp().with_filter(Filter::Nearest)));
    assert_ne!(plain, digest(&ramp().with_wrap(Wrap::Clamp, Wrap::Repeat)));
    assert_ne!(digest(&Tex::gray(0.5)), digest(&Tex::gray(0.25)));
    let image = Arc::new(ramp());
    assert_ne!(digest(&Tex::image(image.clone())), digest(&Tex::image(image).scaled(Spectrum::gray(0.5))));
}

fn any_wrap() -> impl Strategy<Value = Wrap> {
    prop_oneof![Just(Wrap::Repeat), Just(Wrap::Clamp), Just(Wrap::Mirror)]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        rng_seed: prop::test_runner::RngSeed::Fixed(3),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Whatever the coordinate, the value lies within the bounds, one channel reads as all four do, and the average
    /// over a fine grid is the mean.
    #[test]
    fn values_stay_in_bounds(
        (w, h, c) in (1u32..6, 1u32..6, 1u32..5),
        seed in any::<u64>(),
        wrap in (any_wrap(), any_wrap()),
        nearest in any::<bool>(),
        uv in prop_oneof![(-3.0f32..3.0, -3.0f32..3.0), (any::<f32>(), any::<f32>())],
    ) {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            (state >> 40) as f32 / 8e6
        };
        let data: Vec<f32> = (0..w * h * c).map(|_| next()).collect();
        let filter = if nearest { Filter::Nearest } else { Filter::Bilinear };
        let image = ImageTexture::from_f32(w, h, c, data).expect("finite")
            .with_wrap(wrap.0, wrap.1)
            .with_filter(filter);
        let uv = Vec2::new(uv.0, uv.1);
        let v = image.eval4(uv);
        prop_assert!(v.cmple(image.max4()).all() && v.cmpge(image.min4()).all(), "{v} at {uv}");
        for (k, channel) in [Channel::R, Channel::G, Channel::B, Channel::A].into_iter().enumerate() {
            prop_assert_eq!(image.eval_channel(uv, channel), v[k]);
        }
        let n = 60;
        let mut sum = [0.0f64; 4];
        for i in 0..n * n {
            let at = Vec2::new(((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32);
            for (s, x) in sum.iter_mut().zip(image.eval4(at).to_array()) {
                *s += f64::from(x) / f64::from(n * n);
            }
        }
        for (s, m) in sum.iter().zip(image.mean4().to_array()) {
            prop_assert!((s - f64::from(m)).abs() < 2e-3 * f64::from(image.max4().max_element()), "{s} {m}");
        }
    }
}
