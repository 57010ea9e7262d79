//! EON and the Phong lobes against closed forms, and what they draw.

mod support;

use etendue_bsdf::{BlinnPhong, Bsdf, BsdfAt, Lambert, Lobes, Mode, OrenNayar, Phong};
use etendue_core::{Spectrum, Vec2, Vec3A};
use support::{Rng, at_cosine, chi_square, direction, integrate, triples};

const TURN: [f64; 2] = [0.0, std::f64::consts::TAU];

/// ∫ f cos over the upper hemisphere by midpoints in the polar angle around `around`, denser there.
fn lobe_integral(f: impl Fn(Vec3A) -> f64, rows: u32) -> f64 {
    let mut sum = 0.0;
    for i in 0..rows {
        let s = (f64::from(i) + 0.5) / f64::from(rows);
        let theta = std::f64::consts::FRAC_PI_2 * s * s;
        let weight = theta.sin() * std::f64::consts::PI * s / f64::from(rows);
        for j in 0..8 {
            sum += f(direction(theta, (f64::from(j) + 0.5) * TURN[1] / 8.0)) * weight * TURN[1] / 8.0;
        }
    }
    sum
}

fn albedo(bsdf: &dyn Bsdf, mu: f64, n: [u32; 2]) -> f64 {
    let wo = at_cosine(mu);
    integrate([0.0, 1.0], TURN, n, |wi| f64::from(bsdf.eval(wo, wi, Mode::Radiance).r()))
}

/// Both lobes return exactly what they are given at normal incidence: ∫ (n + 2)/2π cosⁿ⁺¹ = 1, and Blinn's, whose
/// half vector halves the angle. The often quoted (n + 8)/8π is the mutant.
#[test]
fn lobes_are_normalised() {
    for n in [1.0f32, 10.0, 100.0, 1e4] {
        let wo = Vec3A::Z;
        let phong = Phong::new(Spectrum::BLACK, Spectrum::ONE, n);
        let blinn = BlinnPhong::new(Spectrum::BLACK, Spectrum::ONE, n);
        for (name, bsdf) in [("phong", &phong as &dyn Bsdf), ("blinn", &blinn)] {
            let e = lobe_integral(|wi| f64::from(bsdf.eval(wo, wi, Mode::Radiance).r()), 20_000);
            println!("{name} n {n}: {:.1e} from 1", e - 1.0);
            assert!((e - 1.0).abs() < 5e-6, "{name} n {n}: {e}");
            let mass = lobe_integral(|wi| f64::from(bsdf.pdf(wo, wi, Mode::Radiance)), 20_000);
            assert!(mass < 1.0 + 5e-6, "{name} n {n}: mass {mass}");
            // Of half vectors drawn around the normal, those beyond 45° reflect below the surface.
            let expected = if name == "phong" { 1.0 } else { 1.0 - 0.5f64.powf((f64::from(n) + 2.0) / 2.0) };
            assert!((mass - expected).abs() < 5e-6, "{name} n {n}: mass {mass} for {expected}");
        }
        let quoted = (f64::from(n) + 8.0) / (8.0 * std::f64::consts::PI);
        let exact = f64::from(blinn.eval(Vec3A::Z, Vec3A::Z, Mode::Radiance).r());
        assert!(n > 1000.0 || (quoted / exact - 1.0).abs() > 1e-3, "n {n}: {quoted} for {exact}");
    }
}

/// At exponent 0 Phong's lobe is the part of Lambert's within a right angle of the mirrored direction, Blinn's is
/// Lambert's.
#[test]
fn exponent_zero_is_closed_form() {
    for mu in [0.2, 0.6, 1.0] {
        let phong = albedo(&Phong::new(Spectrum::BLACK, Spectrum::ONE, 0.0), mu, [2000, 2000]);
        // The projected area of the lune between the surface and the plane across the mirrored direction.
        assert!((phong - 0.5 * (1.0 + mu)).abs() < 1e-3, "mu {mu}: {phong}");
        let (wo, wi) = (at_cosine(mu), direction(0.4, 1.0));
        let blinn = BlinnPhong::new(Spectrum::BLACK, Spectrum::ONE, 0.0).eval(wo, wi, Mode::Radiance).r();
        let lambert = Lambert::new(Spectrum::ONE).eval(wo, wi, Mode::Radiance).r();
        assert!((blinn / lambert - 1.0).abs() < 1e-6);
    }
}

/// No direction returns more than arrives, and the normal returns the most.
#[test]
fn lobes_make_no_light() {
    for n in [0.0f32, 0.3, 1.0, 3.0, 10.0, 100.0] {
        let phong = Phong::new(Spectrum::BLACK, Spectrum::ONE, n);
        let blinn = BlinnPhong::new(Spectrum::BLACK, Spectrum::ONE, n);
        for bsdf in [&phong as &dyn Bsdf, &blinn] {
            let mut last = 0.0;
            for mu in [0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
                let e = albedo(bsdf, mu, [1000, 500]);
                assert!(e < 1.0 + 2e-4 && e > last - 2e-4, "{:?} mu {mu}: {e}", bsdf.at());
                last = e;
            }
        }
    }
    // Narrow lobes: Phong's returns about 2π · (n + 2)/2π · cos θo / (n + 1), Blinn's about cos² θo.
    let n = 1e4f32;
    for mu in [0.3f64, 0.7] {
        let mean = |bsdf: &dyn Bsdf| {
            let draws = triples(40_000).filter_map(|(l, u)| bsdf.sample(at_cosine(mu), l, u, Mode::Radiance));
            draws.map(|s| f64::from(s.weight.r())).sum::<f64>() / 40_000.0
        };
        let phong = mean(&Phong::new(Spectrum::BLACK, Spectrum::ONE, n));
        let blinn = mean(&BlinnPhong::new(Spectrum::BLACK, Spectrum::ONE, n));
        assert!((phong / mu - 1.0).abs() < 1e-3, "mu {mu}: {phong}");
        assert!((blinn / (mu * mu) - 1.0).abs() < 5e-3, "mu {mu}: {blinn}");
    }
}

#[test]
fn parameters_are_brought_into_range() {
    let nan = f32::NAN;
    let p = Phong::new(Spectrum::rgb(0.7, 2.0, nan), Spectrum::rgb(0.5, 0.5, -1.0), nan);
    assert_eq!(p.diffuse(), Spectrum::rgb(0.7, 1.0, 0.0));
    assert_eq!((p.specular(), p.exponent()), (Spectrum::rgb(1.0 - 0.7, 0.0, 0.0), 0.0));
    let b = BlinnPhong::new(Spectrum::BLACK, Spectrum::gray(7.0), 1e9);
    assert_eq!((b.diffuse(), b.specular(), b.exponent()), (Spectrum::BLACK, Spectrum::ONE, 1e6));
    assert!(!b.lobes().contains(Lobes::DIFFUSE) && p.lobes().contains(Lobes::GLOSSY));
    assert!(
        Phong::new(Spectrum::BLACK, Spectrum::BLACK, 3.0)
            .sample(Vec3A::Z, 0.5, Vec2::ZERO, Mode::Radiance)
            .is_none()
    );
    let rough = [nan, -1.0, 7.0].map(|r| OrenNayar::new(Spectrum::ONE, r).roughness());
    assert_eq!(rough, [0.0, 0.0, 1.0]);
}

/// A white surface returns all light, a coloured one what the closed form says, here by quadrature of the value.
#[test]
fn eon_keeps_all_light() {
    let mut worst = 0.0f64;
    for r in [0.05f32, 0.3, 0.6, 1.0] {
        for mu in [0.05, 0.2, 0.5, 0.7, 0.9, 1.0] {
            let white = OrenNayar::new(Spectrum::ONE, r);
            // The closed form of its albedo to rounding, the integral of its value to that of the quadrature.
            let closed = f64::from(white.albedo(at_cosine(mu)).r());
            worst = worst.max((closed - 1.0).abs());
            let e = albedo(&white, mu, [2000, 400]);
            assert!((e - 1.0).abs() < 2e-5, "r {r} mu {mu}: {e}");
        }
    }
    println!("closed albedo of white off by {worst:.1e}");
    assert!(worst < 1e-6, "{worst}");
    for (mu, r, e) in [
        (0.2, 1.0, 0.485_598_84),
        (0.7, 1.0, 0.450_318_92),
        (0.2, 0.3, 0.495_162_79),
        (0.7, 0.3, 0.483_312_62),
    ] {
        let gray = OrenNayar::new(Spectrum::gray(0.5), r);
        assert!((f64::from(gray.albedo(at_cosine(mu)).r()) - e).abs() < 2e-7);
        let integral = albedo(&gray, mu, [2000, 400]);
        assert!((integral - e).abs() < 2e-5, "r {r} mu {mu}: {integral} for {e}");
    }
    assert_eq!(OrenNayar::new(Spectrum::ONE, 1.0).eval(Vec3A::Z, -Vec3A::Z, Mode::Radiance), Spectrum::BLACK);
}

#[test]
fn eon_of_roughness_zero_is_lambert() {
    let (eon, lambert) = (OrenNayar::new(Spectrum::gray(0.6), 0.0), Lambert::new(Spectrum::gray(0.6)));
    let mut rng = Rng(3);
    for (l, u) in triples(2000) {
        let wo = direction(f64::from(rng.next()) * 3.1, f64::from(rng.next()) * 6.3);
        let Some(s) = eon.sample(wo, l, u, Mode::Radiance) else { continue };
        let (f, pdf) = lambert.eval_pdf(wo, s.wi, Mode::Radiance);
        assert!((s.pdf / pdf - 1.0).abs() < 1e-5 && (s.weight.r() / 0.6 - 1.0).abs() < 1e-5, "{s:?} {pdf}");
        assert!((eon.eval(wo, s.wi, Mode::Radiance).r() / f.r() - 1.0).abs() < 1e-5);
    }
}

/// What the transformed cosine is for: weights near 1. The cosine's reach further and scatter more.
#[test]
fn eon_weights_are_even() {
    let roughnesses = [0.01f32, 0.1, 0.3, 0.6, 1.0];
    for (r, mu) in roughnesses.into_iter().flat_map(|r| [0.001, 0.02, 0.1, 0.3, 0.6, 0.98].map(|mu| (r, mu)))
    {
        let (eon, wo) = (OrenNayar::new(Spectrum::ONE, r), at_cosine(mu));
        let n = 40_000;
        let (mut first, mut second, mut most) = (0.0, 0.0, 0.0f64);
        let (mut cosine_second, mut cosine_most) = (0.0, 0.0f64);
        for (l, u) in triples(n) {
            if let Some(s) = eon.sample(wo, l, u, Mode::Radiance) {
                let w = f64::from(s.weight.r());
                first += w / f64::from(n);
                second += w * w / f64::from(n);
                most = most.max(w);
            }
            let Some(s) = Lambert::new(Spectrum::ONE).sample(wo, l, u, Mode::Radiance) else { continue };
            let w = f64::from(eon.eval(wo, s.wi, Mode::Radiance).r() / s.pdf);
            cosine_second += w * w / f64::from(n);
            cosine_most = cosine_most.max(w);
        }
        let (variance, of_cosine) = (second - first * first, cosine_second - 1.0);
        println!(
            "r {r} mu {mu}: variance {variance:.4} most {most:.3}; cosine {of_cosine:.4} {cosine_most:.3}"
        );
        assert!((first - 1.0).abs() < 2e-3, "r {r} mu {mu}: {first}");
        assert!(most < MOST_WEIGHT && (variance < of_cosine || of_cosine < 0.01), "r {r} mu {mu}");
    }
}

/// Bound on the weights of a white EON surface that the documentation promises.
const MOST_WEIGHT: f64 = 1.5;

#[test]
fn draws_follow_the_density() {
    let eon = OrenNayar::new(Spectrum::ONE, 0.9);
    let phong = Phong::new(Spectrum::gray(0.3), Spectrum::gray(0.6), 8.0);
    let blinn = BlinnPhong::new(Spectrum::gray(0.3), Spectrum::gray(0.6), 20.0);
    let cases: [(&str, &dyn Bsdf, Vec3A); 6] = [
        ("eon", &eon, at_cosine(0.5)),
        ("eon, grazing from below", &eon, direction(1.65, 2.0)),
        ("phong", &phong, at_cosine(0.8)),
        ("phong, grazing", &phong, direction(1.5, -1.0)),
        ("blinn", &blinn, at_cosine(0.5)),
        ("blinn from below", &blinn, direction(2.2, 0.7)),
    ];
    for (seed, (name, bsdf, wo)) in cases.into_iter().enumerate() {
        let pdf = |wi: Vec3A| f64::from(bsdf.pdf(wo, wi, Mode::Radiance));
        let honest = chi_square(bsdf, &pdf, wo, seed as u64 + 31);
        assert!(honest < 5.0, "{name}: {honest} sigma");
        let mutant = chi_square(bsdf, &|wi| pdf(wi) * (1.0 + 0.1 * f64::from(wi.x)), wo, seed as u64 + 31);
        assert!(mutant > 5.0, "{name}: a leaning density stays hidden ({mutant} sigma)");
    }
}

#[test]
fn held_by_value() {
    let eon = OrenNayar::new(Spectrum::gray(0.4), 0.3);
    let phong = Phong::new(Spectrum::gray(0.4), Spectrum::gray(0.3), 20.0);
    let blinn = BlinnPhong::new(Spectrum::gray(0.4), Spectrum::gray(0.3), 20.0);
    assert!(matches!(eon.at(), BsdfAt::OrenNayar(b) if b == eon));
    assert!(matches!(phong.at(), BsdfAt::Phong(b) if b == phong));
    assert!(matches!(blinn.at(), BsdfAt::BlinnPhong(b) if b == blinn));
    let (wo, wi) = (at_cosine(0.5), direction(0.3, 2.0));
    let [base, lobe, ..] = phong.at().eval_classes(wo, wi, Mode::Radiance);
    assert_eq!(base + lobe, phong.eval(wo, wi, Mode::Radiance));
    assert!(!base.is_black() && !lobe.is_black());
}
