//! Accuracy of the portable transcendental functions against the standard library in double precision.
#![allow(clippy::disallowed_methods)]

use etendue_core::math;

/// Error of `got` against `want` in units in the last place of f32 at `want` (subnormal spacing below 2^-126).
fn ulps(got: f32, want: f64) -> f64 {
    if want.is_nan() {
        return if got.is_nan() { 0.0 } else { f64::INFINITY };
    }
    let rounded = want as f32;
    if rounded.is_infinite() || rounded == 0.0 {
        return if got == rounded { 0.0 } else { f64::INFINITY };
    }
    let exponent = ((want.abs().to_bits() >> 52) as i32 - 1023).max(-126) - 23;
    (f64::from(got) - want).abs() / 2f64.powi(exponent)
}

/// Every finite pattern of f32 with this stride (odd, so that mantissas vary), both signs.
fn patterns(stride: u32) -> impl Iterator<Item = f32> {
    (0..=u32::MAX / stride).map(move |i| f32::from_bits(i * stride)).filter(|x| x.is_finite())
}

/// Random numbers for sweeps: a Weyl sequence, mixed.
fn unit(i: u64) -> f64 {
    let x = i.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((x ^ (x >> 32)) >> 11) as f64 / (1u64 << 53) as f64
}

fn worst(name: &str, f: impl Fn(f32) -> f32, g: impl Fn(f64) -> f64, xs: impl Iterator<Item = f32>) {
    let mut worst = (0.0, 0.0f32);
    for x in xs {
        let e = ulps(f(x), g(f64::from(x)));
        if e > worst.0 {
            worst = (e, x);
        }
    }
    println!("{name}: {:.4} ulp at {:e}", worst.0, worst.1);
    assert!(worst.0 <= 0.51, "{name}: {} ulp at {:e} ({:#x})", worst.0, worst.1, worst.1.to_bits());
}

#[test]
fn unary_functions_round_once_over_all_magnitudes() {
    let stride = 2003;
    worst("sin", math::sin, f64::sin, patterns(stride));
    worst("cos", math::cos, f64::cos, patterns(stride));
    worst("tan", math::tan, f64::tan, patterns(stride));
    worst("asin", math::asin, f64::asin, patterns(stride));
    worst("acos", math::acos, f64::acos, patterns(stride));
    worst("atan", math::atan, f64::atan, patterns(stride));
    worst("exp", math::exp, f64::exp, patterns(stride));
    worst("exp2", math::exp2, f64::exp2, patterns(stride));
    worst("exp_m1", math::exp_m1, f64::exp_m1, patterns(stride));
    worst("ln", math::ln, f64::ln, patterns(stride));
    worst("log2", math::log2, f64::log2, patterns(stride));
    worst("ln_1p", math::ln_1p, f64::ln_1p, patterns(stride));
    worst("cbrt", math::cbrt, f64::cbrt, patterns(stride));
}

#[test]
fn unary_functions_round_once_on_ordinary_ranges() {
    let n = 1_000_000;
    let range = |a: f64, b: f64| (0..n).map(move |i| (a + (b - a) * unit(i)) as f32);
    worst("sin", math::sin, f64::sin, range(-10.0, 10.0));
    worst("cos", math::cos, f64::cos, range(-10.0, 10.0));
    worst("tan", math::tan, f64::tan, range(-10.0, 10.0));
    worst("asin", math::asin, f64::asin, range(-1.0, 1.0));
    worst("acos", math::acos, f64::acos, range(-1.0, 1.0));
    worst("atan", math::atan, f64::atan, range(-4.0, 4.0));
    worst("exp", math::exp, f64::exp, range(-105.0, 90.0));
    worst("exp2", math::exp2, f64::exp2, range(-150.0, 129.0));
    worst("exp_m1", math::exp_m1, f64::exp_m1, range(-2.0, 2.0));
    worst("ln", math::ln, f64::ln, range(0.0, 3.0));
    worst("log2", math::log2, f64::log2, range(0.0, 3.0));
    worst("ln_1p", math::ln_1p, f64::ln_1p, range(-1.0, 2.0));
    worst("cbrt", math::cbrt, f64::cbrt, range(-3.0, 3.0));
}

#[test]
fn turns_are_exact_at_quarters_and_round_once_between() {
    use std::f64::consts::{PI, TAU};
    // Reduced by hand, as TAU * u itself is rounded: the remainder to the nearest quarter is exact.
    let turns = |u: f64| {
        let k = (4.0 * u).round();
        let (s, c) = ((4.0 * u - k) * (PI / 2.0)).sin_cos();
        match (k as i64).rem_euclid(4) {
            0 => (s, c),
            1 => (c, -s),
            2 => (-s, -c),
            _ => (-c, s),
        }
    };
    let us = (0..1_000_000).map(|i| ((unit(i) * 16_777_216.0) as u32) as f32 / 16_777_216.0);
    worst("sin turns", |u| math::sin_cos_turns(u).0, |u| turns(u).0, us.clone());
    worst("cos turns", |u| math::sin_cos_turns(u).1, |u| turns(u).1, us.clone());
    worst("sin pi", |u| math::sin_cos_pi(u).0, |u| turns(0.5 * u).0, us.clone());
    let many = patterns(20_011).filter(|x| x.abs() < 1e15);
    worst("sin turns, all", |u| math::sin_cos_turns(u).0, |u| turns(u % 1.0).0, many);
    assert!((turns(0.1).0 - (0.1 * TAU).sin()).abs() < 1e-15);
    for (u, s, c) in [(0.0, 0.0, 1.0), (0.25, 1.0, 0.0), (0.5, 0.0, -1.0), (0.75, -1.0, 0.0)] {
        assert_eq!(math::sin_cos_turns(u), (s, c), "{u}");
        assert_eq!(math::sin_cos_pi(2.0 * u), (s, c), "{u}");
    }
    for u in us {
        let (s, c) = math::sin_cos_turns(u);
        let (s, c) = (f64::from(s), f64::from(c));
        assert!((s * s + c * c - 1.0).abs() < 1.2e-7);
    }
}

#[test]
fn binary_functions_round_once() {
    let mut worst_pow = (0.0, 0.0, 0.0);
    let mut worst_atan2 = (0.0, 0.0, 0.0);
    for i in 0..2_000_000u64 {
        // pow: bases over all magnitudes, exponents that keep the result representable, and small plain ones.
        let (x, y) = if i % 2 == 0 {
            let x = ((unit(i) * 250.0 - 125.0) as f32).exp2();
            (x, ((unit(i + 77) * 300.0 - 150.0) / f64::from(x).log2()) as f32)
        } else {
            ((unit(i) * 2.0) as f32, (unit(i + 77) * 20.0 - 10.0) as f32)
        };
        let e = ulps(math::pow(x, y), f64::from(x).powf(f64::from(y)));
        if e > worst_pow.0 {
            worst_pow = (e, x, y);
        }
        let (y, x) = if i % 2 == 0 {
            (
                f32::from_bits((unit(i) * 4_294_967_296.0) as u32),
                f32::from_bits((unit(i + 5) * 4_294_967_296.0) as u32),
            )
        } else {
            ((unit(i) - 0.5) as f32, (unit(i + 5) - 0.5) as f32)
        };
        let e = ulps(math::atan2(y, x), f64::from(y).atan2(f64::from(x)));
        if e > worst_atan2.0 {
            worst_atan2 = (e, y, x);
        }
    }
    println!("pow {worst_pow:?} atan2 {worst_atan2:?}");
    assert!(worst_pow.0 <= 0.51, "{worst_pow:?}");
    assert!(worst_atan2.0 <= 0.51, "{worst_atan2:?}");
}

#[test]
fn special_values_follow_ieee() {
    let specials = [
        0.0f32,
        -0.0,
        1.0,
        -1.0,
        2.0,
        -2.0,
        3.0,
        -3.0,
        0.5,
        -0.5,
        1.5,
        -1.5,
        1e-45,
        -1e-45,
        1e-38,
        1e38,
        -1e38,
        16_777_215.0,
        16_777_216.0,
        -16_777_217.0,
        f32::MAX,
        f32::MIN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
    ];
    let same = |a: f32, b: f32| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    for x in specials {
        for y in specials {
            let want = f64::from(x).powf(f64::from(y)) as f32;
            assert!(same(math::pow(x, y), want), "pow({x:e}, {y:e}) = {:e}, not {want:e}", math::pow(x, y));
            let want = f64::from(x).atan2(f64::from(y)) as f32;
            assert!(
                same(math::atan2(x, y), want),
                "atan2({x:e}, {y:e}) = {:e}, not {want:e}",
                math::atan2(x, y)
            );
        }
        type Pair = (&'static str, fn(f32) -> f32, fn(f64) -> f64);
        let table: [Pair; 13] = [
            ("sin", math::sin, f64::sin),
            ("cos", math::cos, f64::cos),
            ("tan", math::tan, f64::tan),
            ("asin", math::asin, f64::asin),
            ("acos", math::acos, f64::acos),
            ("atan", math::atan, f64::atan),
            ("exp", math::exp, f64::exp),
            ("exp2", math::exp2, f64::exp2),
            ("exp_m1", math::exp_m1, f64::exp_m1),
            ("ln", math::ln, f64::ln),
            ("log2", math::log2, f64::log2),
            ("ln_1p", math::ln_1p, f64::ln_1p),
            ("cbrt", math::cbrt, f64::cbrt),
        ];
        for (name, f, g) in table {
            let want = g(f64::from(x)) as f32;
            assert!(same(f(x), want), "{name}({x:e}) = {:e}, not {want:e}", f(x));
        }
    }
}

#[test]
fn large_angles_stay_in_range() {
    for x in patterns(99_991) {
        let (s, c) = math::sin_cos(x);
        assert!(s.abs() <= 1.0 && c.abs() <= 1.0);
    }
}

#[test]
fn wide_functions_keep_double_precision() {
    use math::wide;
    let close = |name: &str, got: f64, want: f64, x: f64| {
        let bound = 4.0 * f64::EPSILON * want.abs() + 1e-16;
        assert!(got == want || (got - want).abs() <= bound, "{name}({x:e}) = {got:e}, not {want:e}");
    };
    for i in 0..200_000 {
        let u = unit(i);
        let x = (u - 0.5) * 200.0;
        let (s, c) = wide::sin_cos(x);
        close("sin", s, x.sin(), x);
        close("cos", c, x.cos(), x);
        let x = 2.0 * u - 1.0;
        close("asin", wide::asin(x), x.asin(), x);
        close("acos", wide::acos(x), x.acos(), x);
        let y = 2.0 * unit(i + 1_000_000) - 1.0;
        close("atan2", wide::atan2(y, x), y.atan2(x), x);
        close("exp", wide::exp(x), x.exp(), x);
        let big = x * 700.0;
        assert!((wide::exp(big) / big.exp() - 1.0).abs() < 1e-13, "exp({big})");
        close("ln", wide::ln(u), u.ln(), u);
        let wild = (x * 1000.0).exp2();
        close("ln", wide::ln(wild), wild.ln(), wild);
    }
    for (y, x) in [
        (0.0, 1.0),
        (-0.0, 1.0),
        (0.0, -1.0),
        (-0.0, -1.0),
        (0.0, 0.0),
        (0.0, -0.0),
        (1e308, 1e308),
        (-1e-310, 1e-310),
    ] {
        assert_eq!(wide::atan2(y, x).to_bits(), f64::atan2(y, x).to_bits(), "atan2({y:e}, {x:e})");
    }
    assert_eq!(wide::atan2(f64::INFINITY, f64::NEG_INFINITY), f64::atan2(f64::INFINITY, f64::NEG_INFINITY));
    assert!(
        wide::ln(-1.0).is_nan()
            && wide::acos(1.0 + 1e-15).is_nan()
            && wide::sin_cos(f64::INFINITY).0.is_nan()
    );
    assert_eq!(wide::ln(0.0), f64::NEG_INFINITY);
    assert_eq!(wide::ln(5e-324), f64::ln(5e-324));
}

/// The bits themselves, over all magnitudes: equal on x86-64 with and without wide vectors, and in WebAssembly. A
/// deliberate change of an algorithm changes this number; nothing else may.
#[test]
fn bits_are_the_same_on_every_target() {
    let mut digest = etendue_core::Fingerprint::default();
    for x in patterns(200_003) {
        let ((s, c), (a, b)) = (math::sin_cos(x), math::sin_cos_turns(x));
        let values = [
            [s, c, a, b, math::tan(x)],
            [math::asin(x), math::acos(x), math::atan(x), math::atan2(x, 0.3), math::atan2(0.3, x)],
            [math::exp(x), math::exp2(x), math::exp_m1(x), math::pow(1.3, x), math::pow(x.abs(), 1.7)],
            [math::ln(x), math::log2(x), math::ln_1p(x), math::cbrt(x), math::pow(x, -3.0)],
        ];
        for v in values.into_iter().flatten() {
            // Which NaN it is, IEEE 754 leaves open.
            digest.f32(if v.is_nan() { f32::NAN } else { v });
        }
    }
    assert_eq!(digest.value(), PINNED, "{:#034x}", digest.value());
}

const PINNED: u128 = 0x262b_b44f_8d11_0388_c8c5_347b_5784_a322;
