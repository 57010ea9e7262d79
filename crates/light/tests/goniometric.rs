//! Measured intensities: interpolation, symmetries, power and irradiance.

use std::f64::consts::PI;
use std::sync::Arc;

use etendue_core::{Fingerprint, Spectrum, Transform, Vec2, Vec3A};
use etendue_light::{GoniometricLight, IntensityTable, IntensityTableError, Light};
use etendue_testkit::{Budget, check_light, lit_point};

fn table(v: &[f32], h: &[f32], values: &[f32]) -> IntensityTable {
    IntensityTable::new(v.to_vec(), h.to_vec(), values.to_vec()).expect("a table")
}

/// Every degree, from a function of the two angles in radians.
fn fine(last: u32, f: impl Fn(f64, f64) -> f64) -> IntensityTable {
    let v: Vec<f32> = (0..=180).map(|i| i as f32).collect();
    let h: Vec<f32> = (0..=last).map(|i| i as f32).collect();
    let values = h.iter().flat_map(|&h| {
        let f = &f;
        v.iter().map(move |&v| f(f64::from(v).to_radians(), f64::from(h).to_radians()) as f32)
    });
    let values = values.collect();
    IntensityTable::new(v.clone(), h.clone(), values).expect("a table")
}

#[test]
fn tables_are_bilinear() {
    let t = table(&[0.0, 30.0, 90.0], &[0.0, 120.0, 360.0], &[1.0, 2.0, 4.0, 3.0, 6.0, 0.0, 1.0, 2.0, 4.0]);
    for (v, h, truth) in [
        (0.0, 0.0, 1.0),
        (30.0, 120.0, 6.0),
        (15.0, 0.0, 1.5),
        (60.0, 0.0, 3.0),
        (30.0, 60.0, 4.0),
        (15.0, 60.0, 3.0),
        (60.0, 240.0, 3.0),
        (60.0, -120.0, 3.0),
        (90.0, 360.0, 4.0),
        // Nothing shines beyond what was measured.
        (90.1, 0.0, 0.0),
        (180.0, 77.0, 0.0),
        (f32::NAN, 0.0, 0.0),
    ] {
        assert!((t.at(v, h) - truth).abs() < 1e-6, "{v} {h}: {} for {truth}", t.at(v, h));
    }
    assert_eq!((t.max(), t.vertical().len(), t.horizontal().len(), t.values().len()), (6.0, 3, 3, 9));
    let whole = table(&[0.0, 180.0], &[0.0, 360.0], &[1.0, 3.0, 1.0, 3.0]);
    assert_eq!((whole.along(Vec3A::Z), whole.along(Vec3A::NEG_Z * 2.0)), (3.0, 1.0));
    for tiny in [1e-30f32, -1e-30, 1e-8] {
        assert!((whole.along(Vec3A::new(tiny, -tiny, 1.0)) - 3.0).abs() < 1e-6);
    }
    // The length does not matter, up to the ends of single precision.
    for length in [1e-38f32, 1e-20, 1.0, 1e20, 1e38] {
        let (low, level) = (Vec3A::new(1.0, 0.0, -1.0) * length, Vec3A::new(-1.0, 1.0, 0.0) * length);
        assert!((whole.along(low) - 1.5).abs() < 1e-6 && (whole.along(level) - 2.0).abs() < 1e-6);
    }
    let upper = table(&[90.0, 180.0], &[0.0], &[1.0, 1.0]);
    assert_eq!((upper.at(89.0, 0.0), upper.at(90.0, 0.0), upper.at(180.0, 5.0)), (0.0, 1.0, 1.0));
}

/// What is given once is found at all its mirror images.
#[test]
fn symmetries() {
    let v = [0.0, 180.0];
    let rows = |n: usize| (0..n).flat_map(|i| [i as f32; 2]).collect::<Vec<f32>>();
    let quarters = table(&v, &[0.0, 45.0, 90.0], &rows(3));
    let halves = table(&v, &[0.0, 45.0, 90.0, 180.0], &rows(4));
    let all = table(&v, &[0.0, 90.0, 180.0, 270.0, 360.0], &rows(5));
    let round = table(&v, &[0.0], &[7.0, 7.0]);
    for h in [0.0f32, 10.0, 45.0, 70.0, 90.0] {
        let truth = h / 45.0;
        for image in [h, 180.0 - h, 180.0 + h, 360.0 - h, -h] {
            assert!((quarters.at(30.0, image) - truth).abs() < 1e-6, "{h} {image}");
        }
        assert!((halves.at(30.0, 360.0 - h) - truth).abs() < 1e-6);
        assert!(
            (all.at(30.0, h) - h / 90.0).abs() < 1e-6
                && (all.at(30.0, 270.0 + h) - 3.0 - h / 90.0).abs() < 1e-6
        );
        assert_eq!(round.at(30.0, h), 7.0);
    }
    assert!((halves.at(30.0, 135.0) - 2.5).abs() < 1e-6 && (halves.at(30.0, 225.0) - 2.5).abs() < 1e-6);
    // From 90 to 270 the mirror stands across: 0 is where 180 is.
    let sides = table(&v, &[90.0, 135.0, 270.0], &rows(3));
    for (h, truth) in
        [(90.0f32, 0.0f32), (100.0, 10.0 / 45.0), (135.0, 1.0), (180.0, 4.0 / 3.0), (270.0, 2.0)]
    {
        for image in [h, 180.0 - h, 540.0 - h] {
            let found = sides.at(30.0, if image > 360.0 { image - 360.0 } else { image });
            assert!((found - truth).abs() < 1e-6, "{h} {image}: {found} for {truth}");
        }
    }
    // The integral counts the copies: constants are 4π.
    for (t, n) in [
        (&[0.0][..], 2),
        (&[0.0, 90.0], 4),
        (&[0.0, 10.0, 180.0], 6),
        (&[0.0, 360.0], 4),
        (&[90.0, 200.0, 270.0], 6),
    ] {
        let t = table(&v, t, &vec![2.0; n]);
        assert!((t.integral() / (8.0 * PI) - 1.0).abs() < 1e-12, "{}", t.integral());
    }
}

/// ∫ over the sphere: closed forms of cosines, and of any table by the midpoint rule over its own interpolation.
#[test]
fn power_is_the_integral() {
    // Downward cosine: π; cos²: 2π/3; sin: π². With 1° steps, linear interpolation is right to (π/180)² / 6.
    for (last, name, truth, f) in [
        (0, "cos", PI, (|v, _| v.cos().max(0.0)) as fn(f64, f64) -> f64),
        (90, "cos²", 2.0 * PI / 3.0, |v, _| v.cos().max(0.0).powi(2)),
        (180, "sin", PI * PI, |v, _| v.sin()),
        (360, "1 + cos φ", 4.0 * PI, |_, h| 1.0 + h.cos()),
    ] {
        let found = fine(last, f).integral();
        println!("{name}: {found} for {truth}, off by {:e}", found / truth - 1.0);
        assert!((found / truth - 1.0).abs() < 6e-5, "{name}: {found} for {truth}");
    }
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / 16_777_216.0
    };
    for h in [
        &[0.0][..],
        &[0.0, 20.0, 90.0],
        &[0.0, 100.0, 180.0],
        &[0.0, 30.0, 200.0, 360.0],
        &[90.0, 130.0, 270.0],
    ] {
        let v = [10.0, 35.0, 90.0, 140.0];
        let values: Vec<f32> = (0..v.len() * h.len()).map(|_| next()).collect();
        let t = table(&v, h, &values);
        let (n, m) = (1800, 720);
        let mut sum = 0.0;
        for i in 0..n {
            let vertical = (f64::from(i) + 0.5) * 180.0 / f64::from(n);
            for j in 0..m {
                let around = (f64::from(j) + 0.5) * 360.0 / f64::from(m);
                sum += f64::from(t.at(vertical as f32, around as f32)) * vertical.to_radians().sin();
            }
        }
        let truth = sum * PI / f64::from(n) * 2.0 * PI / f64::from(m);
        assert!((t.integral() / truth - 1.0).abs() < 1e-4, "{h:?}: {} for {truth}", t.integral());
    }
}

#[test]
fn the_suite_passes() {
    let to_world = Transform::translation(Vec3A::new(0.1, 0.5, 0.0))
        .after(&Transform::rotation(Vec3A::new(1.0, 0.3, -0.2), 0.8))
        .unwrap();
    let points = [
        lit_point(Vec3A::new(0.1, -2.0, 0.2), Vec3A::Y),
        lit_point(Vec3A::new(0.1, -2.0, 0.2), Vec3A::NEG_X),
        lit_point(Vec3A::new(30.0, -80.0, 50.0), Vec3A::ZERO),
    ];
    let values = [9.0, 4.0, 0.5, 0.2, 9.0, 7.0, 1.0, 0.2, 9.0, 3.0, 0.1, 0.2];
    for last in [90.0, 180.0, 360.0] {
        let t = Arc::new(table(&[0.0, 40.0, 90.0, 180.0], &[0.0, 50.0, last], &values));
        let light = GoniometricLight::new(&to_world, t.clone(), Spectrum::rgb(1.0, 2.0, 0.5));
        check_light(&light, 0, &points, &|_| None, &Budget::default().shared(3)).expect("the contract");
        // Mutant: a symmetry that is forgotten is a quarter or half of the power.
        struct Less(GoniometricLight);
        impl Light for Less {
            fn sample(
                &self,
                at: &etendue_light::LitPoint,
                part: u32,
                u: Vec2,
            ) -> Option<etendue_light::LightSample> {
                self.0.sample(at, part, u)
            }
            fn pdf(
                &self,
                _: &etendue_light::LitPoint,
                _: u32,
                _: Vec3A,
                _: Option<&etendue_geometry::Surface>,
            ) -> f32 {
                0.0
            }
            fn power(&self, part: u32, r: f32) -> Spectrum {
                self.0.power(part, r) * 0.5
            }
            fn bounds(&self, part: u32) -> Option<etendue_light::LightBounds> {
                self.0.bounds(part)
            }
            fn is_delta(&self) -> bool {
                true
            }
        }
        let failure = check_light(&Less(light), 0, &points, &|_| None, &Budget::default());
        assert_eq!(failure.expect_err("half the power").test, "power");
    }
}

/// E = I(θ, φ) cos / d² on the floor below, in the world's directions; turned and scaled with its placement.
#[test]
fn irradiance_below() {
    // Twice the intensity along +x than along −x, nothing upward.
    let t = Arc::new(table(&[0.0, 90.0], &[0.0, 180.0], &[4.0, 8.0, 4.0, 0.0]));
    let white = Spectrum::rgb(1.0, 0.5, 0.25);
    let place = Transform::translation(Vec3A::Y * 2.0);
    let light = GoniometricLight::new(&place, t.clone(), white);
    let down = light.sample(&lit_point(Vec3A::ZERO, Vec3A::Y), 0, Vec2::ZERO).expect("below");
    assert_eq!((down.wi, down.li, down.pdf), (Vec3A::Y, white, 1.0));
    // At 45° toward +x: I = 6, d² = 8; toward −x 2; toward −z or +z (90°) 4.
    for (p, intensity) in [(Vec3A::X, 6.0f32), (Vec3A::NEG_X, 2.0), (Vec3A::Z, 4.0), (Vec3A::NEG_Z, 4.0)] {
        let s = light.sample(&lit_point(p * 2.0, Vec3A::Y), 0, Vec2::ZERO).expect("below");
        assert!((s.li.r() - intensity / 8.0).abs() < 1e-6, "{p}: {:?}", s.li);
    }
    assert!(light.sample(&lit_point(Vec3A::Y * 3.0, Vec3A::NEG_Y), 0, Vec2::ZERO).is_none(), "above");
    // Horizontal angles go from x toward −z.
    let quarter = Arc::new(table(
        &[0.0, 180.0],
        &[0.0, 90.0, 180.0, 270.0, 360.0],
        &[0., 0., 5., 5., 0., 0., 1., 1., 0., 0.],
    ));
    let light = GoniometricLight::new(&Transform::IDENTITY, quarter.clone(), Spectrum::ONE);
    let toward = |l: &GoniometricLight, d: Vec3A| {
        l.sample(&lit_point(l.position() + d, Vec3A::ZERO), 0, Vec2::ZERO).map_or(0.0, |s| s.li.r())
    };
    assert!(
        (toward(&light, Vec3A::NEG_Z) - 5.0).abs() < 1e-5 && (toward(&light, Vec3A::Z) - 1.0).abs() < 1e-5
    );
    // Turned by a quarter around y: −z becomes −x. The placement's scale does nothing.
    let turn = Transform::rotation(Vec3A::Y, std::f32::consts::FRAC_PI_2);
    let turn = turn.after(&Transform::scale(Vec3A::splat(3.0)).unwrap()).unwrap();
    let turned = GoniometricLight::new(&turn, quarter, Spectrum::ONE);
    assert!((toward(&turned, Vec3A::NEG_X) - 5.0).abs() < 1e-5);
    // Positions × 2^k, intensity × 4^k: the same to the bit.
    for k in [-20, 7, 20] {
        let s = 2f32.powi(k);
        let at = |s: f32| {
            let place = Transform::translation(Vec3A::new(0.3, 2.0, 0.1) * s);
            let light = GoniometricLight::new(&place, t.clone(), white * (s * s));
            light
                .sample(&lit_point(Vec3A::new(0.7, 0.0, -0.4) * s, Vec3A::Y), 0, Vec2::ZERO)
                .map(|x| (x.wi, x.li))
        };
        assert_eq!(at(s), at(1.0));
    }
}

#[test]
fn what_is_no_table_is_refused() {
    let new = |v: &[f32], h: &[f32], n: usize| IntensityTable::new(v.to_vec(), h.to_vec(), vec![1.0; n]);
    for (v, h, n) in [
        (&[0.0][..], &[0.0][..], 1),
        (&[], &[0.0], 0),
        (&[0.0, 90.0], &[], 0),
        (&[90.0, 0.0], &[0.0], 2),
        (&[0.0, 0.0], &[0.0], 2),
        (&[0.0, f32::NAN], &[0.0], 2),
        (&[-1.0, 90.0], &[0.0], 2),
        (&[0.0, 181.0], &[0.0], 2),
        (&[0.0, 90.0], &[0.0, 45.0], 4),
        (&[0.0, 90.0], &[90.0], 2),
        (&[0.0, 90.0], &[90.0, 180.0], 4),
        (&[0.0, 90.0], &[10.0, 370.0], 4),
        (&[0.0, 90.0], &[45.0, 225.0], 4),
        (&[0.0, 90.0], &[0.0, 200.0, 100.0, 360.0], 8),
    ] {
        let e = new(v, h, n).expect_err("no angles");
        assert!(matches!(e, IntensityTableError::Angle { .. }), "{v:?} {h:?}: {e}");
    }
    assert!(matches!(new(&[0.0, 90.0], &[0.0], 3), Err(IntensityTableError::Count { .. })));
    for bad in [-1.0, f32::NAN, f32::INFINITY] {
        let e = IntensityTable::new(vec![0.0, 90.0], vec![0.0], vec![1.0, bad]).expect_err("no intensity");
        assert!(matches!(e, IntensityTableError::Value { index: 1, .. }), "{e}");
    }
}

#[test]
fn digests_tell_lamps_apart() {
    let digest = |t: IntensityTable, scale: f32, y: f32| {
        let place = Transform::translation(Vec3A::Y * y);
        let mut f = Fingerprint::default();
        GoniometricLight::new(&place, Arc::new(t), Spectrum::gray(scale)).fingerprint(&mut f);
        assert!(!f.is_opaque());
        f.value()
    };
    let t = |i: f32| table(&[0.0, 90.0], &[0.0], &[1.0, i]);
    let mut all = vec![
        digest(t(1.0), 1.0, 0.0),
        digest(t(2.0), 1.0, 0.0),
        digest(t(1.0), 2.0, 0.0),
        digest(t(1.0), 1.0, 1.0),
    ];
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), 4);
}
