//! Directional albedos against closed forms and tabulated values.

mod support;

use etendue_bsdf::{Bsdf, Conductor, Ggx, Masking, MetalFresnel, Mode, RoughDielectric, SmoothDielectric};
use etendue_core::{Spectrum, Vec2, Vec3A};
use support::{at_cosine, grid, integrate, triples};

/// A perfectly reflecting metal.
fn white(alpha: f32, masking: Masking) -> Conductor {
    Conductor {
        ggx: Ggx::anisotropic(alpha, alpha),
        fresnel: MetalFresnel::Schlick { f0: Spectrum::ONE },
        masking,
    }
}

/// Mean weight over a 600 × 600 grid of attempts, failures counting zero.
fn sampled_albedo(bsdf: &dyn Bsdf, wo: Vec3A) -> f64 {
    let n = 600;
    let sum: f64 = grid(n)
        .filter_map(|u| bsdf.sample(wo, 0.5, u, Mode::Radiance))
        .map(|s| f64::from(s.weight.r()))
        .sum();
    sum / f64::from(n * n)
}

/// ∫ f cos over the upper hemisphere, with none of the sampling code.
fn integrated_albedo(bsdf: &dyn Bsdf, wo: Vec3A) -> f64 {
    let turn = [0.0, std::f64::consts::TAU];
    integrate([0.0, 1.0], turn, [3000, 600], |wi| f64::from(bsdf.eval(wo, wi, Mode::Radiance).r()))
}

/// alpha = 1 has the closed forms f = 1/(2π(μi + μo)), E = 1 − μ ln(1 + 1/μ), and E = 2(1 − ln 2)/(1 + μ) for separable
/// masking.
#[test]
fn white_metal_of_alpha_one_is_closed_form() {
    for mu in [0.05f64, 0.1, 0.25, 0.5, 0.75, 1.0] {
        let wo = at_cosine(mu);
        let correlated = 1.0 - mu * (1.0 + 1.0 / mu).ln();
        let separable = 2.0 * (1.0 - std::f64::consts::LN_2) / (1.0 + mu);
        for (masking, exact) in [(Masking::HeightCorrelated, correlated), (Masking::Separable, separable)] {
            let metal = white(1.0, masking);
            let sampled = sampled_albedo(&metal, wo);
            assert!((sampled - exact).abs() < 3e-4, "{masking:?} mu {mu}: {sampled} for {exact}");
            let integrated = integrated_albedo(&metal, wo);
            assert!((integrated - exact).abs() < 3e-4, "{masking:?} mu {mu}: {integrated} for {exact}");
        }
        // The two maskings are each other's mutant: they agree at normal incidence only.
        assert!(mu == 1.0 || (correlated - separable).abs() > 3e-3);
    }
    let (wo, wi) = (at_cosine(0.3), at_cosine(0.6));
    let f = f64::from(white(1.0, Masking::HeightCorrelated).eval(wo, wi, Mode::Radiance).r()) / 0.6;
    assert!((f * std::f64::consts::TAU * 0.9 - 1.0).abs() < 1e-5);
}

/// Single-scattering albedos of height-correlated GGX with F = 1, and how often the bounded sampler succeeds.
#[test]
fn white_metal_has_the_tabulated_albedo() {
    let table: [(f32, [f64; 5], [f64; 3]); 5] = [
        (0.10, [0.8835, 0.9216, 0.9692, 0.9831, 0.9883], [0.975, 0.989, 1.0]),
        (0.25, [0.8916, 0.8401, 0.8573, 0.8915, 0.9158], [0.962, 0.961, 1.0]),
        (0.50, [0.8601, 0.7652, 0.6983, 0.6821, 0.6879], [0.975, 0.947, 1.0]),
        (0.75, [0.8107, 0.6803, 0.5646, 0.5014, 0.4639], [0.987, 0.964, 1.0]),
        (1.00, [0.7602, 0.5976, 0.4507, 0.3645, 0.3069], [1.0, 1.0, 1.0]),
    ];
    for (alpha, albedos, accepted) in table {
        let metal = white(alpha, Masking::HeightCorrelated);
        for (mu, e) in [0.1, 0.25, 0.5, 0.75, 1.0].into_iter().zip(albedos) {
            let sampled = sampled_albedo(&metal, at_cosine(mu));
            assert!((sampled - e).abs() < 1e-3, "alpha {alpha} mu {mu}: {sampled} for {e}");
        }
        for (mu, a) in [0.25, 0.5, 1.0].into_iter().zip(accepted) {
            let hits =
                grid(600).filter(|u| metal.sample(at_cosine(mu), 0.5, *u, Mode::Radiance).is_some()).count();
            let rate = hits as f64 / 360_000.0;
            assert!((rate - a).abs() < 2e-3, "alpha {alpha} mu {mu}: accepted {rate} for {a}");
        }
    }
}

/// The density holds exactly the mass that sampling keeps: its integral is the rate of success.
#[test]
fn density_integrates_to_the_mass_drawn() {
    for alpha in [0.2f32, 0.5, 1.0] {
        for mu in [0.1f64, 0.5, 0.9] {
            let (metal, wo) = (white(alpha, Masking::Separable), at_cosine(mu));
            let turn = [0.0, std::f64::consts::TAU];
            let mass =
                integrate([0.0, 1.0], turn, [3000, 600], |wi| f64::from(metal.pdf(wo, wi, Mode::Radiance)));
            let hits = grid(600).filter(|u| metal.sample(wo, 0.5, *u, Mode::Radiance).is_some()).count();
            let rate = hits as f64 / 360_000.0;
            assert!((mass - rate).abs() < 2e-3, "alpha {alpha} mu {mu}: mass {mass}, rate {rate}");
        }
    }
}

/// Both lobes of smooth glass return all light: exactly, for every draw, in importance; in radiance after undoing eta².
#[test]
fn smooth_glass_keeps_all_light() {
    for eta in [1.0 / 1.5, 1.0, 1.33, 2.4f32] {
        let glass = SmoothDielectric::new(eta);
        for z in [1e-7f32, 1e-3, 0.2, 0.745, 0.75, 1.0] {
            for side in [1.0, -1.0] {
                let wo = Vec3A::new((1.0 - z * z).sqrt(), 0.0, side * z);
                let (mut chosen, mut last) = (0.0, None);
                for i in 0..4096u32 {
                    let u_lobe = (i as f32 + 0.5) / 4096.0;
                    if let Some(s) = glass.sample(wo, u_lobe, Vec2::ZERO, Mode::Importance) {
                        assert_eq!(s.weight, Spectrum::ONE);
                        let other =
                            glass.sample(wo, u_lobe, Vec2::ZERO, Mode::Radiance).expect("same directions");
                        let undone = other.weight.r() * s.eta * s.eta;
                        assert!((undone - 1.0).abs() < 1e-6, "radiance is scaled by 1/eta²");
                        if last != Some(s.lobe) {
                            chosen += s.pdf;
                            last = Some(s.lobe);
                        }
                    }
                }
                // A lobe of less than 1/4096 is not met by the grid.
                assert!((chosen - 1.0f32).abs() < 2.5e-4, "eta {eta} z {z}: lobes sum to {chosen}");
            }
        }
    }
}

/// The transmitted direction obeys Snell and carries the relative index; from the other side the way back is the same.
#[test]
fn smooth_glass_refracts_both_ways() {
    let glass = SmoothDielectric::new(1.5);
    let wo = at_cosine(0.6);
    let inward = glass.sample(wo, 0.999, Vec2::ZERO, Mode::Radiance).expect("transmits");
    assert_eq!(inward.eta, 1.5);
    assert!((inward.wi.x + 0.8 / 1.5).abs() < 1e-6 && inward.wi.z < 0.0);
    let back = glass.sample(inward.wi, 0.999, Vec2::ZERO, Mode::Radiance).expect("transmits");
    assert!((back.wi - wo).abs().max_element() < 1e-6);
    assert!((inward.weight.r() * back.weight.r() - 1.0).abs() < 1e-6);
    // Beyond the critical angle nothing gets out, whatever the draw.
    let steep = Vec3A::new(0.8, 0.0, -0.6);
    let s = glass.sample(steep, 0.999_999, Vec2::ZERO, Mode::Radiance).expect("reflects");
    assert_eq!((s.wi, s.pdf), (Vec3A::new(-0.8, 0.0, -0.6), 1.0));
}

/// Single scattering: rough glass returns no more than it gets, as much as its value integrates to over the whole
/// sphere, and close to all of it when nearly smooth.
#[test]
fn rough_glass_returns_what_its_value_integrates_to() {
    let sampled = |glass: &RoughDielectric, wo: Vec3A| {
        let n = 200_000;
        let draws = triples(n).filter_map(|(l, u)| glass.sample(wo, l, u, Mode::Importance));
        draws.map(|s| f64::from(s.weight.r())).sum::<f64>() / f64::from(n)
    };
    for mu in [0.3, 0.6, 1.0, -0.3, -0.6, -1.0] {
        let wo = at_cosine(mu);
        assert!(sampled(&RoughDielectric::new(0.05, 1.5), wo) > 0.999);
        for roughness in [0.5f32, 0.7, 1.0] {
            let glass = RoughDielectric::new(roughness, 1.5);
            let turn = [0.0, std::f64::consts::TAU];
            let value = |wi| f64::from(glass.eval(wo, wi, Mode::Importance).r());
            let integral = integrate([-1.0, 1.0], turn, [4000, 400], value);
            let mean = sampled(&glass, wo);
            assert!(mean <= 1.0 + 1e-5);
            assert!((mean - integral).abs() < 2e-3, "roughness {roughness} mu {mu}: {mean} for {integral}");
        }
    }
}

/// The delta twin takes over without a jump: albedo and mean direction just above and below the threshold.
#[test]
fn smooth_limits_are_continuous() {
    let wo = at_cosine(0.7);
    let rough = white(1.01e-4, Masking::HeightCorrelated);
    assert!((sampled_albedo(&rough, wo) - 1.0).abs() < 1e-3);
    let glass = RoughDielectric {
        ggx: Ggx::anisotropic(1.01e-4, 1.01e-4),
        masking: Masking::Separable,
        ..RoughDielectric::new(0.5, 1.5)
    };
    let twin = SmoothDielectric::new(1.5);
    for (l, u) in triples(1000) {
        let (a, b) = (glass.sample(wo, l, u, Mode::Radiance), twin.sample(wo, l, u, Mode::Radiance));
        let (Some(a), Some(b)) = (a, b) else { continue };
        if a.eta == b.eta {
            assert!((a.weight.r() / b.weight.r() - 1.0).abs() < 1e-3);
            assert!((a.wi - b.wi).abs().max_element() < 0.05);
        }
    }
}

#[test]
fn presets_have_their_colour() {
    let normal = |c: Conductor| c.albedo(Vec3A::Z).to_array();
    let (gold, silver) = (normal(Conductor::gold(0.0)), normal(Conductor::silver(0.0)));
    let (copper, aluminium) = (normal(Conductor::copper(0.0)), normal(Conductor::aluminium(0.0)));
    // ((η − 1)² + k²) / ((η + 1)² + k²) from the published indices.
    let close = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-4);
    assert!(close(gold, [0.9420, 0.7044, 0.4035]), "{gold:?}");
    assert!(close(silver, [0.9882, 0.9832, 0.9791]), "{silver:?}");
    assert!(close(copper, [0.9153, 0.6020, 0.5499]), "{copper:?}");
    assert!(close(aluminium, [0.9081, 0.9165, 0.9207]), "{aluminium:?}");
    for (metal, f0) in [
        (Conductor::chromium(0.0), [0.5532, 0.5565, 0.5584]),
        (Conductor::iron(0.0), [0.5287, 0.5111, 0.4998]),
        (Conductor::nickel(0.0), [0.6903, 0.6335, 0.5831]),
        (Conductor::titanium(0.0), [0.6117, 0.5750, 0.5485]),
        (Conductor::platinum(0.0), [0.6718, 0.6322, 0.5970]),
        (Conductor::tungsten(0.0), [0.5142, 0.4934, 0.4750]),
        (Conductor::brass(0.0), [0.8772, 0.7518, 0.4934]),
    ] {
        assert!(close(normal(metal), f0), "{:?} for {f0:?}", normal(metal));
    }
}
