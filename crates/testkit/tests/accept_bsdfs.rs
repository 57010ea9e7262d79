//! Right BSDFs are accepted, from mirrors over lobes of a thousandth of a radian to full roughness.

mod support;

use etendue_bsdf::{
    Black, BlinnPhong, Bsdf, BsdfAt, Conductor, Ggx, Lambert, Masking, Meaning, MetalFresnel, Mirror,
    OrenNayar, Phong, Principled, RoughDielectric, SmoothDielectric, ThinDielectric,
};
use etendue_core::Spectrum;
use etendue_testkit::{check_bsdf, check_bsdf_up_to};
use support::{Case, FEW, MANY, accept};

fn cases() -> Vec<Case<'static>> {
    let mut out = Vec::new();
    let mut add =
        |name: String, bsdf: Box<dyn Bsdf>| out.push(Case::new(name, move |b| check_bsdf(&*bsdf, b)));
    let color = Spectrum::rgb(0.2, 0.5, 0.95);
    add("black".into(), Box::new(Black));
    add("lambert".into(), Box::new(Lambert::new(color)));
    add("lambert behind the door".into(), Box::new(BsdfAt::Open(Box::new(Lambert::new(Spectrum::ONE)))));
    add("mirror".into(), Box::new(Mirror::new(color)));
    for eta in [1.5, 1.0 / 1.5, 1.0, 1.01, 2.4] {
        add(format!("smooth dielectric, eta {eta}"), Box::new(SmoothDielectric::new(eta)));
    }
    let separable = Masking::Separable;
    let correlated = Masking::HeightCorrelated;
    let shapes = [
        (1e-3, 1e-3, correlated),
        (1e-2, 1e-2, correlated),
        (0.1, 0.1, separable),
        (0.5, 0.5, correlated),
        (1.0, 1.0, separable),
        (0.02, 0.6, correlated),
    ];
    for (x, y, masking) in shapes {
        let ggx = Ggx::anisotropic(x, y);
        let metal = Conductor { ggx, masking, fresnel: MetalFresnel::Schlick { f0: color } };
        add(format!("conductor, alpha {x} {y}, {masking:?}"), Box::new(metal));
        for eta in [1.5f32, 1.0 / 1.5, 1.1, 2.4] {
            let glass = RoughDielectric { ggx, eta, masking, tint: Spectrum::ONE };
            add(format!("rough dielectric, alpha {x} {y}, eta {eta:.2}, {masking:?}"), Box::new(glass));
        }
    }
    for masking in [separable, correlated] {
        let metal = Conductor::copper(0.5).with_masking(masking);
        add(format!("copper, {masking:?}"), Box::new(metal));
    }
    add("conductor, roughness 0".into(), Box::new(Conductor::gold(0.0)));
    add("conductor, roughness 0.01, the first rough one".into(), Box::new(Conductor::silver(0.01)));
    add("rough dielectric, roughness 0".into(), Box::new(RoughDielectric::new(0.0, 1.5)));
    for alpha in [0.0, 1e-3, 0.05, 0.5, 1.0] {
        let tint = Spectrum::rgb(0.9, 0.5, 0.3);
        for eta in [1.5, 1.0] {
            let wall =
                ThinDielectric { ggx: Ggx::anisotropic(alpha, alpha), tint, ..ThinDielectric::new(0.0, eta) };
            add(format!("thin dielectric, alpha {alpha}, eta {eta}"), Box::new(wall));
        }
    }
    for r in [0.0, 0.05, 0.3, 1.0] {
        for (kind, rho) in [("white", Spectrum::ONE), ("coloured", color)] {
            add(format!("{kind} EON, roughness {r}"), Box::new(OrenNayar::new(rho, r)));
        }
    }
    for n in [1.0, 10.0, 100.0, 1e4] {
        for (base, lobe) in [(Spectrum::BLACK, Spectrum::ONE), (color, Spectrum::ONE - color)] {
            let kind = if base.is_black() { "lobe alone" } else { "lobe and base" };
            add(format!("phong, {kind}, n {n}"), Box::new(Phong::new(base, lobe, n)));
            add(format!("blinn-phong, {kind}, n {n}"), Box::new(BlinnPhong::new(base, lobe, n)));
        }
    }
    out
}

/// glTF's surface over its parameters, and how much light each meaning may make: none beyond the error of a table
/// (0.5 %), or with appendix B up to as much again.
fn principled() -> Vec<Case<'static>> {
    let mut out = Vec::new();
    let mut add = |p: Principled| {
        let most = if p.meaning == Meaning::GltfB { 2.0 } else { 1.005 };
        out.push(Case::new(format!("{p:?}"), move |b| check_bsdf_up_to(&p, most, b)));
    };
    let colors = [Spectrum::ONE, Spectrum::rgb(0.9, 0.3, 0.02), Spectrum::BLACK];
    for (i, alpha) in [0.0, 1e-3, 0.01, 0.1, 0.5, 1.0].into_iter().enumerate() {
        for (j, metallic) in [0.0, 0.5, 1.0].into_iter().enumerate() {
            for meaning in [Meaning::EnergyPreserving, Meaning::GltfB] {
                let opaque = Principled {
                    ggx: Ggx::anisotropic(alpha, alpha),
                    specular: [1.0, 0.5, 0.0][(i + j) % 3],
                    specular_color: colors[(i + 2 * j) % 3] * 2.0,
                    meaning,
                    ..Principled::new(colors[(i + j) % 2], metallic, 0.0)
                };
                add(Principled { specular_color: Spectrum::ONE, ..opaque });
                add(opaque);
                for (transmission, thin) in [(0.5, false), (0.5, true), (1.0, false), (1.0, true)] {
                    if metallic < 1.0 {
                        add(Principled { transmission, thin, ior: [1.5, 1.33, 2.4][i % 3], ..opaque });
                    }
                }
            }
        }
    }
    out
}

#[test]
fn principled_one_seed() {
    accept(&principled(), 1, 0.1);
}

#[test]
#[ignore = "minutes"]
fn principled_twenty_seeds() {
    accept(&principled(), 20, 0.1);
}

#[test]
fn few_seeds() {
    accept(&cases(), FEW, 0.05);
}

#[test]
#[ignore = "minutes"]
fn hundred_seeds() {
    accept(&cases(), MANY, 0.05);
}
