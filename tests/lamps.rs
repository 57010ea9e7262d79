//! Spot lights, directional lights, and emitters with holes.

mod support;

use std::f64::consts::PI;
use std::sync::Arc;

use etendue::material::{Absorber, Cutout};
use etendue::prelude::*;
use etendue::texture::{Channel, ImageUse, ScalarTex};
use etendue_testkit::stats::{mean_test, welch_test};
use support::{DIRECT, assert_mean, path, radiance};

/// A matte floor under one light, seen from straight above at `x`: the radiance there.
fn floor(light: impl Light + 'static, x: f32) -> f64 {
    let mut b = SceneBuilder::new();
    let m = b.material(Diffuse::new(Spectrum::gray(0.5)));
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    b.light(light);
    let scene = b.build().unwrap();
    let view = move |_: &Independent| Ray::new(Vec3A::new(x, 1.0, 0.0), Vec3A::NEG_Y);
    let xs = radiance(&scene, &PathTracer::default(), 1, 4, &view);
    assert!(xs.iter().all(|v| *v == xs[0]), "one direction has no noise");
    xs[0]
}

/// ρ/π · I f(θ) cos³θ / h² with f = ((cos θ − cos o) / (cos i − cos o))² between the angles.
#[test]
fn a_spot_fades_as_gltf_says() {
    let (inner, outer, h) = (0.3f64, 0.8f64, 2.0f64);
    let spot = |inner: f64, outer: f64| {
        SpotLight::new(
            Vec3A::Y * h as f32,
            Vec3A::NEG_Y * 3.0,
            Spectrum::gray(7.0),
            inner as f32,
            outer as f32,
        )
    };
    for theta in [0.0f64, 0.2, 0.29, 0.35, 0.5, 0.7, 0.79, 0.81, 1.2] {
        let c = theta.cos();
        let t = ((c - outer.cos()) / (inner.cos() - outer.cos())).clamp(0.0, 1.0);
        let truth = 0.5 / PI * 7.0 * t * t * c.powi(3) / (h * h);
        let got = floor(spot(inner, outer), (h * theta.tan()) as f32);
        assert!((got - truth).abs() <= 1e-4 * truth + 1e-6, "θ {theta}: {got} for {truth}");
        // Mutant: a fall-off that is not squared.
        let linear = truth / t;
        assert!(!(0.45..0.75).contains(&theta) || (got - linear).abs() > 0.1 * linear, "θ {theta}");
    }
    // A hard edge falls off over a thousandth of the cosine.
    let hard = |cos: f64| floor(spot(0.5, 0.5), (h * cos.acos().tan()) as f32);
    assert_eq!(hard(0.5f64.cos() - 1e-4), 0.0);
    assert!(hard(0.5f64.cos() + 1.1e-3) > 0.9 * 0.5 / PI * 7.0 * 0.5f64.cos().powi(3) / (h * h));
    assert_eq!(floor(SpotLight::new(Vec3A::Y, Vec3A::ZERO, Spectrum::ONE, 0.1, 0.2), 0.0), 0.0);
}

/// The power is the intensity's integral, here by a sum over the cosine.
#[test]
fn a_spots_power_is_its_integral() {
    for (inner, outer) in [(0.0f64, 0.785f64), (0.3, 0.8), (0.5, 0.5), (0.0, 0.01), (1.0, 3.0), (0.0, PI)] {
        let spot = SpotLight::new(Vec3A::ZERO, Vec3A::X, Spectrum::ONE, inner as f32, outer as f32);
        let (co, w) = (outer.cos(), (inner.cos() - outer.cos()).max(1e-3));
        let n = 2_000_000;
        let sum: f64 = (0..n)
            .map(|i| 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(n))
            .map(|c| ((c - co) / w).clamp(0.0, 1.0).powi(2))
            .sum();
        let truth = 4.0 * PI * sum / f64::from(n);
        let got = f64::from(spot.power(0, 0.0).r());
        assert!((got / truth - 1.0).abs() < 2e-3, "{inner} {outer}: {got} for {truth}");
    }
}

/// ρ/π · E cos θ; nothing beyond the horizon; shadows are sharp; no ray meets it.
#[test]
fn a_directional_light_is_a_cosine() {
    for theta in [0.0f64, 0.4, 1.0, 1.5] {
        let along = Vec3A::new(theta.sin() as f32, -theta.cos() as f32, 0.0);
        let truth = 0.5 / PI * 3.0 * theta.cos();
        let got = floor(DirectionalLight::new(along * 5.0, Spectrum::gray(3.0)), 0.3);
        assert!((got - truth).abs() <= 1e-5 * truth + 1e-7, "θ {theta}: {got} for {truth}");
    }
    assert_eq!(floor(DirectionalLight::new(Vec3A::Y, Spectrum::ONE), 0.0), 0.0);
    let mut b = SceneBuilder::new();
    let m = b.material(Diffuse::new(Spectrum::gray(0.5)));
    b.add(Parallelogram::new(Vec3A::new(-1.0, 0.0, 1.0), Vec3A::X * 2.0, Vec3A::Z * -2.0).unwrap(), m);
    b.add(Sphere::new(Vec3A::Y * 3.0, 0.5).unwrap(), m);
    b.light(DirectionalLight::new(Vec3A::NEG_Y, Spectrum::ONE));
    let scene = b.build().unwrap();
    assert!(!scene.needs().intersects(Needs::ENVIRONMENT | Needs::AREA_LIGHTS | Needs::MANY_LIGHTS));
    assert!(scene.has_hidden_lights() && scene.infinite_lights().count() == 0);
    for (x, lit) in [(0.49, false), (0.51, true)] {
        let view = move |_: &Independent| Ray::new(Vec3A::new(x, 1.0, 0.0), Vec3A::NEG_Y);
        let xs = radiance(&scene, &PathTracer { max_depth: Some(1), ..PathTracer::default() }, 1, 1, &view);
        assert!((xs[0] > 0.1) == lit, "x {x}: {xs:?}");
    }
}

/// A lamp with holes over a floor, and how it is described: as it is, as a solid lamp of the same mean (what it must
/// equal), and wrongly as a solid one that is sampled.
fn holey(opacity: Option<ScalarTex>, radiance: f32, other: bool) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.material(Diffuse::new(Spectrum::gray(0.5)));
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    let lamp = match opacity {
        Some(o) => b.material(Cutout::new(Absorber, o)),
        None => b.material(Absorber),
    };
    let g = b.add(Parallelogram::new(Vec3A::new(-0.5, 1.0, -0.5), Vec3A::X, Vec3A::Z).unwrap(), lamp);
    b.emit(g, Emission::new(Spectrum::gray(radiance)));
    if other {
        let black = b.material(Absorber);
        let g = b.add(Sphere::new(Vec3A::new(1.5, 1.0, 0.0), 0.2).unwrap(), black);
        b.emit(g, Emission::new(Spectrum::gray(5.0)));
    }
    b.build().unwrap()
}

/// Every way of finding light agrees about a lamp with holes: of opacity 0.4 everywhere it is a lamp of 0.4 times the
/// radiance, alone and beside another; the mutant that counts both ways in full is far off.
#[test]
fn emitters_with_holes_agree_in_all_ways() {
    let view = |_: &Independent| Ray::new(Vec3A::new(0.3, 0.5, 0.1), Vec3A::NEG_Y);
    let n = 120_000;
    for other in [false, true] {
        let truth = radiance(&holey(None, 0.4 * 3.0, other), &PathTracer::default(), 3, n, &view);
        let scene = holey(Some(0.4.into()), 3.0, other);
        assert!(scene.needs().contains(Needs::CUTOUTS) && !scene.needs().contains(Needs::MANY_LIGHTS));
        assert_eq!(scene.needs().contains(Needs::AREA_LIGHTS), other);
        for (seed, direct) in DIRECT.into_iter().enumerate() {
            let xs = radiance(&scene, &path(direct), 20 + seed as u64, n, &view);
            let test = welch_test(&xs, &truth);
            assert!(!test.rejects(1e-6), "{direct:?}, other {other}: {test:?}");
            // Mutant: what light sampling finds counted as well.
            let both: Vec<f64> = xs.iter().zip(&truth).map(|(a, b)| a + b).collect();
            assert!(welch_test(&both, &truth).rejects(1e-6), "{direct:?}");
        }
    }
    // A pattern of holes: half of the lamp is solid.
    let image = ImageTexture::from_f32(2, 1, 1, vec![0.0, 1.0]).unwrap();
    let image = ImageUse::new(Arc::new(image.with_filter(etendue::texture::Filter::Nearest)));
    let scene = holey(Some(ScalarTex::image(image, Channel::R)), 3.0, false);
    let mut half = SceneBuilder::new();
    let m = half.material(Diffuse::new(Spectrum::gray(0.5)));
    half.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    let black = half.material(Absorber);
    let g =
        half.add(Parallelogram::new(Vec3A::new(0.0, 1.0, -0.5), Vec3A::X * 0.5, Vec3A::Z).unwrap(), black);
    half.emit(g, Emission::new(Spectrum::gray(3.0)));
    let truth = radiance(&half.build().unwrap(), &PathTracer::default(), 4, n, &view);
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    for direct in [DirectLight::MisPower, DirectLight::Light] {
        let xs = radiance(&scene, &path(direct), 5, n, &view);
        assert!(!welch_test(&xs, &truth).rejects(1e-6), "{direct:?}");
        assert_mean(&xs, mean, 0.1, "half a lamp");
        assert!(mean_test(&xs, 2.0 * mean).rejects(1e-6));
    }
}
