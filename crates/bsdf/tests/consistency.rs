//! What every BSDF has to satisfy, over random parameters, directions and draws.

mod support;

use etendue_bsdf::{
    BlinnPhong, Bsdf, BsdfAt, Conductor, Ggx, Lambert, Lobes, Masking, MetalFresnel, Mode, OrenNayar, Phong,
    RoughDielectric, SmoothDielectric,
};
use etendue_core::{Spectrum, Vec2, Vec3A, math};
use proptest::prelude::*;
use support::{Rng, at_cosine, chi_square, direction, integrate, triples};

/// A direction anywhere, denser toward the poles.
fn any(rng: &mut Rng) -> Vec3A {
    direction(f64::from(rng.next()) * std::f64::consts::PI, f64::from(rng.next()) * std::f64::consts::TAU)
}

/// Every rough model over a spread of parameters.
fn rough_models() -> Vec<(String, Box<dyn Bsdf>)> {
    let mut out: Vec<(String, Box<dyn Bsdf>)> =
        vec![("lambert".into(), Box::new(Lambert::new(Spectrum::rgb(0.2, 0.5, 0.9))))];
    let (base, lobe) = (Spectrum::rgb(0.3, 0.6, 0.1), Spectrum::rgb(0.6, 0.2, 0.9));
    for n in [1.0, 10.0, 100.0, 1e4] {
        out.push((format!("phong {n}"), Box::new(Phong::new(base, lobe, n))));
        out.push((format!("blinn {n}"), Box::new(BlinnPhong::new(base, lobe, n))));
    }
    for r in [0.05, 0.5, 1.0] {
        out.push((format!("eon {r}"), Box::new(OrenNayar::new(Spectrum::rgb(0.2, 0.5, 1.0), r))));
    }
    for masking in [Masking::Separable, Masking::HeightCorrelated] {
        for (ax, ay) in [(0.05, 0.05), (0.3, 0.3), (1.0, 1.0), (0.1, 0.6)] {
            let ggx = Ggx::anisotropic(ax, ay);
            let metal = Conductor { ggx, ..Conductor::gold(0.5) }.with_masking(masking);
            out.push((format!("gold {ax} {ay} {masking:?}"), Box::new(metal)));
            for eta in [1.5, 1.0 / 1.5, 1.1, 2.4] {
                let glass = RoughDielectric { ggx, eta, masking, tint: Spectrum::ONE };
                out.push((format!("glass {ax} {ay} eta {eta} {masking:?}"), Box::new(glass)));
            }
        }
    }
    out
}

/// The weight, density and direction of a sample agree with what eval and pdf say of that direction.
#[test]
fn samples_agree_with_eval_and_pdf() {
    for (name, bsdf) in rough_models() {
        let mut rng = Rng(7);
        let mut seen = 0;
        for (u_lobe, u) in triples(4000) {
            let wo = any(&mut rng);
            for mode in [Mode::Radiance, Mode::Importance] {
                let Some(s) = bsdf.sample(wo, u_lobe, u, mode) else { continue };
                seen += 1;
                assert!((s.wi.dot(s.wi) - 1.0).abs() < 4e-6, "{name}: |wi|² {}", s.wi.dot(s.wi));
                assert_eq!(s.lobe.contains(Lobes::TRANSMISSION), wo.z * s.wi.z < 0.0, "{name}");
                let (f, pdf) = bsdf.eval_pdf(wo, s.wi, mode);
                // The density is that of a facet found again from rounded directions: its slopes are known to about
                // 2⁻²³ / cos, which D magnifies by up to 4 / alpha, and the refraction by 1 / |eta − 1|.
                let steep = wo.z.abs().min(s.wi.z.abs()).min((s.wi + wo * s.eta).length());
                if steep < 0.05 {
                    continue;
                }
                assert!((pdf / s.pdf - 1.0).abs() < 2e-3, "{name} wo {wo}: pdf {pdf} sampled {}", s.pdf);
                for c in 0..3 {
                    let weight = f[c] / pdf;
                    assert!(
                        (weight - s.weight[c]).abs() <= 2e-4 * s.weight[c].max(0.1),
                        "{name}: {weight} {s:?}"
                    );
                }
                assert_eq!((bsdf.eval(wo, s.wi, mode), bsdf.pdf(wo, s.wi, mode)), (f, pdf), "{name}");
            }
        }
        assert!(seen > 4000, "{name}: {seen} samples");
    }
}

/// f(wo, wi) = f(wi, wo), across an interface over the squares of the indices (Veach 1997, equation 5.14).
#[test]
fn reciprocity() {
    for (name, bsdf) in rough_models() {
        let mut rng = Rng(11);
        let mut seen = 0;
        for (u_lobe, u) in triples(2000) {
            let wo = any(&mut rng);
            let Some(s) = bsdf.sample(wo, u_lobe, u, Mode::Radiance) else { continue };
            if wo.z.abs().min(s.wi.z.abs()).min((s.wi + wo * s.eta).length()) < 0.05 {
                continue;
            }
            let forth = bsdf.eval(wo, s.wi, Mode::Radiance) / s.wi.z.abs();
            let back = bsdf.eval(s.wi, wo, Mode::Radiance) / wo.z.abs();
            // In radiance f carries 1/eta² of the far side: f(wo, wi) eta² = f(wi, wo) with eta = ηi/ηo.
            let ratio = forth.r() * s.eta * s.eta / back.r();
            assert!((ratio - 1.0).abs() < 2e-3, "{name} wo {wo} {s:?}: {ratio}");
            // Radiance one way is importance the other way (the adjoint).
            let adjoint = bsdf.eval(s.wi, wo, Mode::Importance) / wo.z.abs();
            assert!((forth.r() / adjoint.r() - 1.0).abs() < 2e-3, "{name}: {forth:?} {adjoint:?}");
            seen += 1;
        }
        assert!(seen > 800, "{name}: {seen}");
    }
}

/// Draws follow the density. Power: see `chi_square`; the mutant density leans by 10 % and must stand out.
#[test]
fn draws_follow_the_density() {
    let ggx = Ggx::anisotropic(0.3, 0.6);
    let metal = Conductor { ggx, ..Conductor::gold(0.5) };
    let glass = RoughDielectric { ggx, ..RoughDielectric::new(0.5, 1.5) };
    let lambert = Lambert::new(Spectrum::gray(0.5));
    let cases: [(&str, &dyn Bsdf, Vec3A); 5] = [
        ("lambert", &lambert, at_cosine(0.5)),
        ("metal", &metal, direction(0.8, 0.4)),
        ("metal from below", &metal, direction(2.4, 1.4)),
        ("glass from outside", &glass, direction(0.9, -2.0)),
        ("glass from inside", &glass, direction(2.6, 0.3)),
    ];
    for (seed, (name, bsdf, wo)) in cases.into_iter().enumerate() {
        let pdf = |wi: Vec3A| f64::from(bsdf.pdf(wo, wi, Mode::Radiance));
        let honest = chi_square(bsdf, &pdf, wo, seed as u64 + 1);
        assert!(honest < 5.0, "{name}: {honest} sigma");
        let mutant = chi_square(bsdf, &|wi| pdf(wi) * (1.0 + 0.1 * f64::from(wi.x)), wo, seed as u64 + 1);
        assert!(mutant > 5.0, "{name}: a leaning density stays hidden ({mutant} sigma)");
    }
}

/// The transmitted part of the density holds the mass that transmits.
#[test]
fn glass_density_integrates_to_the_mass_drawn() {
    for eta in [1.5f32, 1.0 / 1.5] {
        let glass = RoughDielectric { ggx: Ggx::anisotropic(0.4, 0.4), ..RoughDielectric::new(0.5, eta) };
        for mu in [0.3, 0.8] {
            let wo = at_cosine(mu);
            let pdf = |wi: Vec3A| f64::from(glass.pdf(wo, wi, Mode::Radiance));
            let turn = [0.0, std::f64::consts::TAU];
            let mass = [[-1.0, 0.0], [0.0, 1.0]].map(|half| integrate(half, turn, [3000, 600], pdf));
            let n = 400_000;
            let mut hits = [0.0f64; 2];
            for s in triples(n).filter_map(|(l, u)| glass.sample(wo, l, u, Mode::Radiance)) {
                hits[usize::from(s.wi.z > 0.0)] += 1.0 / f64::from(n);
            }
            for side in 0..2 {
                assert!((mass[side] - hits[side]).abs() < 2e-3, "eta {eta} mu {mu}: {mass:?} {hits:?}");
            }
        }
    }
}

#[test]
fn by_value_and_by_door_are_the_same() {
    let metal = Conductor::copper(0.4);
    let (wo, wi) = (at_cosine(0.5), direction(0.3, 2.0));
    let held = metal.at();
    assert!(matches!(held, BsdfAt::Conductor(c) if c == metal));
    let (door, boxed) = (BsdfAt::Ref(&metal), BsdfAt::Open(Box::new(metal)));
    for b in [&held, &door, &boxed] {
        assert_eq!(b.eval_pdf(wo, wi, Mode::Radiance), metal.eval_pdf(wo, wi, Mode::Radiance));
        assert_eq!(b.lobes(), metal.lobes());
        let u = Vec2::new(0.3, 0.9);
        let both = b.scatter(wo, Some(wi), 0.1, u, Mode::Radiance);
        assert_eq!(both.sample, metal.sample(wo, 0.1, u, Mode::Radiance));
        assert_eq!((both.eval, both.pdf), metal.eval_pdf(wo, wi, Mode::Radiance));
        assert_eq!(b.scatter(wo, None, 0.1, u, Mode::Radiance).pdf, 0.0);
    }
}

fn any_unit_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(0.0f32),
        Just(1.0 / 16_777_216.0),
        Just(1.0 - 1.0 / 16_777_216.0),
        Just(0.5f32),
        0.0f32..1.0,
    ]
}

fn any_direction() -> impl Strategy<Value = Vec3A> {
    let z =
        prop_oneof![-1.0f32..=1.0, Just(1e-7), Just(-1e-7), Just(0.0), Just(1.0), Just(-1.0), Just(1e-38)];
    (z, 0.0f32..1.0).prop_map(|(z, turn)| {
        let s = (1.0 - z * z).clamp(0.0, 1.0).sqrt();
        let (sin, cos) = math::sin_cos_turns(turn);
        Vec3A::new(s * cos, s * sin, z)
    })
}

fn any_bsdf() -> impl Strategy<Value = BsdfAt<'static>> {
    let alpha = || prop_oneof![Just(0.0f32), Just(1e-4), Just(1.0), 1e-6f32..2.0];
    let masking = prop_oneof![Just(Masking::Separable), Just(Masking::HeightCorrelated)];
    let eta = prop_oneof![Just(1.0f32), Just(0.0), Just(f32::NAN), 0.2f32..4.0, Just(1.000_001)];
    (0..5, alpha(), alpha(), masking, eta, 0.0f32..5.0).prop_map(|(kind, ax, ay, masking, eta, k)| {
        let ggx = Ggx::anisotropic(ax, ay);
        let index = MetalFresnel::Index { eta: Spectrum::rgb(0.1, 1.0, 3.0), k: Spectrum::gray(k) };
        match kind {
            0 => BsdfAt::Lambert(Lambert::new(Spectrum::gray(0.8))),
            1 => BsdfAt::SmoothDielectric(SmoothDielectric::new(eta)),
            2 => BsdfAt::RoughDielectric(RoughDielectric { ggx, eta, masking, tint: Spectrum::ONE }),
            3 => BsdfAt::Conductor(Conductor { ggx, fresnel: index, masking }),
            _ => BsdfAt::Conductor(Conductor {
                ggx,
                fresnel: MetalFresnel::Schlick { f0: Spectrum::ONE },
                masking,
            }),
        }
    })
}

fn any_lobe() -> impl Strategy<Value = BsdfAt<'static>> {
    let n = prop_oneof![Just(0.0f32), Just(1.0), Just(1e6), Just(f32::NAN), 0.0f32..2e4];
    (0..3, n, 0.0f32..=1.0, prop_oneof![Just(0.0f32), Just(1.0), 0.0f32..=1.0]).prop_map(
        |(kind, n, kd, ks)| {
            let (kd, ks) = (Spectrum::rgb(kd, 0.5 * kd, 0.0), Spectrum::gray(ks));
            match kind {
                0 => BsdfAt::Phong(Phong::new(kd, ks, n)),
                1 => BsdfAt::BlinnPhong(BlinnPhong::new(kd, ks, n)),
                _ => BsdfAt::OrenNayar(OrenNayar::new(kd, ks.r())),
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40_000,
        rng_seed: prop::test_runner::RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Weights stay in [0, 1] in importance, everything is finite, densities are positive where drawn.
    #[test]
    fn nothing_breaks_anywhere(
        bsdf in any_bsdf(),
        wo in any_direction(),
        wi in any_direction(),
        l in any_unit_number(),
        (a, b) in (any_unit_number(), any_unit_number()),
    ) {
        for mode in [Mode::Radiance, Mode::Importance] {
            let (f, pdf) = bsdf.eval_pdf(wo, wi, mode);
            prop_assert!(f.is_finite() && pdf.is_finite() && pdf >= 0.0);
            prop_assert!(f.r() >= 0.0 && f.g() >= 0.0 && f.b() >= 0.0);
            if let Some(s) = bsdf.sample(wo, l, Vec2::new(a, b), mode) {
                prop_assert!(s.wi.is_finite() && s.wi.z != 0.0);
                prop_assert!((s.wi.dot(s.wi) - 1.0).abs() < 1e-5, "{}", s.wi);
                prop_assert!(s.pdf > 0.0 && s.pdf.is_finite() && s.eta > 0.0);
                let most = if mode == Mode::Radiance { 1.0 / (s.eta * s.eta) } else { 1.0 };
                prop_assert!(s.weight.max_channel() <= most * (1.0 + 1e-5), "{s:?}");
                prop_assert!(s.weight.r() >= 0.0 && s.weight.is_finite());
            }
            prop_assert!(bsdf.albedo(wo).is_finite());
        }
    }

    /// Lobes whose weights may be more than 1: as finite.
    #[test]
    fn nothing_breaks_in_lobes(
        bsdf in any_lobe(),
        wo in any_direction(),
        wi in any_direction(),
        l in any_unit_number(),
        (a, b) in (any_unit_number(), any_unit_number()),
    ) {
        let (f, pdf) = bsdf.eval_pdf(wo, wi, Mode::Radiance);
        prop_assert!(f.is_finite() && pdf.is_finite() && pdf >= 0.0);
        prop_assert!(f.r() >= 0.0 && f.g() >= 0.0 && f.b() >= 0.0);
        if let Some(s) = bsdf.sample(wo, l, Vec2::new(a, b), Mode::Radiance) {
            prop_assert!(s.wi.is_finite() && s.wi.z != 0.0);
            prop_assert!((s.wi.dot(s.wi) - 1.0).abs() < 1e-5, "{}", s.wi);
            prop_assert!(s.pdf > 0.0 && s.pdf.is_finite() && s.eta == 1.0);
            // Half vectors are drawn evenly for n = 0: 4 (wo·h) cos θi / cos θh, up to 8.
            prop_assert!(s.weight.max_channel() <= 8.001 && s.weight.r() >= 0.0, "{s:?}");
        }
        prop_assert!(bsdf.albedo(wo).is_finite());
    }

    #[test]
    fn nonsense_stays_finite_in_lobes(bsdf in any_lobe(), bad in 0..4usize, wi in any_direction()) {
        let nan = f32::NAN;
        let nonsense =
            [Vec3A::splat(nan), Vec3A::splat(f32::INFINITY), Vec3A::splat(1e30), Vec3A::new(nan, 0.0, 1.0)][bad];
        for (o, i) in [(nonsense, wi), (wi, nonsense)] {
            let (f, pdf) = bsdf.eval_pdf(o, i, Mode::Radiance);
            prop_assert!(f.is_finite() && pdf.is_finite(), "{f:?} {pdf}");
        }
    }

    /// Directions that are not directions: no panic, nothing but finite numbers.
    #[test]
    fn nonsense_stays_finite(bsdf in any_bsdf(), bad in 0..4usize, wi in any_direction()) {
        let nonsense = [
            Vec3A::splat(f32::NAN),
            Vec3A::splat(f32::INFINITY),
            Vec3A::ZERO,
            Vec3A::new(f32::NAN, 0.0, 1.0),
        ][bad];
        for (o, i) in [(nonsense, wi), (wi, nonsense)] {
            let (f, pdf) = bsdf.eval_pdf(o, i, Mode::Radiance);
            prop_assert!(f.is_finite() && pdf.is_finite(), "{f:?} {pdf}");
        }
    }
}
