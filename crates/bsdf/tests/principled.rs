//! glTF's surface: albedos, and what it is at the ends of its parameters.

mod support;

use etendue_bsdf::{
    Bsdf, BsdfAt, Conductor, Ggx, Lambert, Lobes, Masking, Meaning, MetalFresnel, Mode, Principled,
    RoughDielectric, SmoothDielectric, ThinDielectric,
};
use etendue_core::{Spectrum, Vec2, Vec3A};
use support::{Rng, at_cosine, direction, integrate, triples};

const ALPHAS: [f32; 9] = [0.0, 1e-4, 1e-3, 0.01, 0.05, 0.2, 0.5, 0.8, 1.0];
const COSINES: [f64; 7] = [1e-3, 0.01, 0.05, 0.2, 0.5, 0.8, 1.0];

fn surface(base: f32, metallic: f32, alpha: f32) -> Principled {
    Principled { ggx: Ggx::anisotropic(alpha, alpha), ..Principled::new(Spectrum::gray(base), metallic, 0.0) }
}

/// Mean weight of importance over a fixed sequence.
fn albedo(bsdf: &dyn Bsdf, wo: Vec3A) -> f64 {
    let n = 40_000;
    let drawn = triples(n).filter_map(|(l, u)| bsdf.sample(wo, l, u, Mode::Importance));
    drawn.map(|s| f64::from(s.weight.r())).sum::<f64>() / f64::from(n)
}

/// The furnace: a white surface returns all light, whatever it is made of, from any angle. The same with the
/// compensation of another roughness is far off.
#[test]
fn white_returns_all() {
    for metallic in [0.0, 0.5, 1.0] {
        for alpha in ALPHAS {
            for mu in COSINES {
                for (ior, specular) in [(1.5, 1.0), (2.5, 0.7), (0.0, 1.0), (1.5, 0.0)] {
                    let white = Principled { ior, specular, ..surface(1.0, metallic, alpha) };
                    let e = albedo(&white, at_cosine(mu));
                    assert!((e - 1.0).abs() < 5e-3, "metal {metallic} alpha {alpha} mu {mu} ior {ior}: {e}");
                    let told = f64::from(white.albedo(at_cosine(mu)).r());
                    assert!((told - 1.0).abs() < 5e-3, "{white:?} mu {mu}: says {told}");
                }
            }
        }
    }
    // Mutant: the base coupled without dividing by the mean.
    let dielectric = surface(1.0, 0.0, 0.2);
    let wo = at_cosine(0.5);
    let reflected = f64::from(surface(0.0, 0.0, 0.2).albedo(wo).r());
    let uncoupled: f64 = triples(40_000)
        .filter_map(|(l, u)| dielectric.sample(wo, l, u, Mode::Importance))
        .map(|s| {
            let [base, facets, ..] = dielectric.eval_classes(wo, s.wi, Mode::Importance);
            (f64::from(base.r()) * (1.0 - reflected) + f64::from(facets.r())) / f64::from(s.pdf)
        })
        .sum::<f64>()
        / 40_000.0;
    assert!(uncoupled < 0.97, "{uncoupled}");
    // Mutant: single scattering alone.
    let bare = Conductor { ggx: Ggx::anisotropic(0.5, 0.5), ..Conductor::gold(0.0) };
    let bare = Conductor { fresnel: MetalFresnel::Schlick { f0: Spectrum::ONE }, ..bare };
    assert!(albedo(&bare, at_cosine(0.8)) < 0.7);
}

/// The albedo told is the mean weight, for colours too.
#[test]
fn albedo_is_what_comes_back() {
    for metallic in [0.0, 0.5, 1.0] {
        for alpha in ALPHAS {
            for mu in [0.05, 0.3, 0.9] {
                let p = surface(0.4, metallic, alpha);
                let (told, found) = (f64::from(p.albedo(at_cosine(mu)).r()), albedo(&p, at_cosine(mu)));
                assert!((told - found).abs() < 4e-3, "{p:?} mu {mu}: {told} told, {found} found");
            }
        }
    }
}

/// Appendix B in double precision, as it is written.
fn appendix_b(p: &Principled, wo: Vec3A, wi: Vec3A) -> [f64; 3] {
    let wide = |v: Vec3A| [f64::from(v.x), f64::from(v.y), f64::from(v.z).abs()];
    let (o, i) = (wide(wo), wide(wi));
    let h = [o[0] + i[0], o[1] + i[1], o[2] + i[2]];
    let length = (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]).sqrt();
    let h = h.map(|c| c / length);
    let v_h = o[0] * h[0] + o[1] * h[1] + o[2] * h[2];
    let a = f64::from(p.ggx.alpha_x()).max(0.001);
    let a2 = a * a;
    let d = a2 / (std::f64::consts::PI * (h[2] * h[2] * (a2 - 1.0) + 1.0).powi(2));
    let g1 = |z: f64| 2.0 * z / (z + (a2 + (1.0 - a2) * z * z).sqrt());
    let lobe = d * g1(o[2]) * g1(i[2]) / (4.0 * o[2] * i[2]);
    let (m, s) = (f64::from(p.metallic), f64::from(p.specular));
    let w = (1.0 - v_h).powi(5);
    let root = ((f64::from(p.ior) - 1.0) / (f64::from(p.ior) + 1.0)).powi(2);
    let mix = |a: f64, b: f64, t: f64| a * (1.0 - t) + b * t;
    let dielectric: Vec<f64> =
        (0..3).map(|c| mix((root * f64::from(p.specular_color[c])).min(1.0) * s, s, w)).collect();
    let most = dielectric.iter().copied().fold(0.0, f64::max);
    [0, 1, 2].map(|c| {
        let base = f64::from(p.base_color[c]);
        let metal = mix(base, 1.0, w);
        let f = mix(dielectric[c], metal, m);
        (f * lobe + (1.0 - mix(most, metal, m)) * (1.0 - m) * base / std::f64::consts::PI) * i[2]
    })
}

#[test]
fn gltf_is_appendix_b() {
    let mut rng = Rng(3);
    for metallic in [0.0, 0.3, 1.0] {
        for (specular, tint) in
            [(1.0, Spectrum::ONE), (0.4, Spectrum::ONE), (1.0, Spectrum::rgb(3.0, 0.5, 1.0))]
        {
            for roughness in [0.1, 0.5, 1.0] {
                let p = Principled {
                    specular,
                    specular_color: tint,
                    meaning: Meaning::GltfB,
                    ..Principled::new(Spectrum::rgb(0.9, 0.4, 0.0), metallic, roughness)
                };
                for _ in 0..200 {
                    let at =
                        |r: &mut Rng| direction(0.05 + 1.4 * f64::from(r.next()), 6.0 * f64::from(r.next()));
                    let (wo, wi) = (at(&mut rng), at(&mut rng));
                    let (got, exact) = (p.eval(wo, wi, Mode::Radiance), appendix_b(&p, wo, wi));
                    for c in 0..3 {
                        let off = (f64::from(got[c]) - exact[c]).abs();
                        assert!(off <= 1e-3 * exact[c] + 1e-6, "{p:?} {wo} {wi}: {got:?} for {exact:?}");
                    }
                }
            }
        }
    }
}

/// At the ends of its parameters it is one of the others.
#[test]
fn ends_are_the_simple_models() {
    let color = Spectrum::rgb(0.8, 0.5, 0.1);
    let (wo, wi) = (at_cosine(0.6), direction(0.4, 2.0));
    let u = Vec2::new(0.3, 0.8);
    for meaning in [Meaning::GltfB, Meaning::EnergyPreserving] {
        let matte = Principled { specular: 0.0, meaning, ..Principled::new(color, 0.0, 0.5) };
        let lambert = Lambert::new(color);
        assert_eq!(matte.lobes(), lambert.lobes());
        let (a, b) = (matte.eval(wo, wi, Mode::Radiance), lambert.eval(wo, wi, Mode::Radiance));
        assert!((a - b).map(f32::abs).max_channel() < 1e-7, "{a:?} {b:?}");
        assert_eq!(
            matte.sample(wo, 0.7, u, Mode::Radiance).map(|s| s.wi),
            lambert.sample(wo, 0.7, u, Mode::Radiance).map(|s| s.wi)
        );

        let mirror = Principled { meaning, ..Principled::new(color, 1.0, 0.0) };
        assert_eq!(mirror.lobes(), Lobes::REFLECTION | Lobes::DELTA | Lobes::RECIPROCAL);
        let s = mirror.sample(wo, 0.5, u, Mode::Radiance).expect("reflects");
        let f = MetalFresnel::Schlick { f0: color }.reflectance(0.6);
        assert!((s.weight - f).map(f32::abs).max_channel() < 1e-6 && s.pdf == 1.0, "{s:?} {f:?}");

        for thin in [false, true] {
            let clear = Principled { transmission: 1.0, thin, meaning, ..Principled::new(color, 0.0, 0.0) };
            let glass: Box<dyn Bsdf> = if thin {
                Box::new(ThinDielectric { tint: color, ..ThinDielectric::new(0.0, 1.5) })
            } else {
                Box::new(SmoothDielectric { tint: color, ..SmoothDielectric::new(1.5) })
            };
            for l in [0.01, 0.5] {
                assert_eq!(clear.sample(wo, l, u, Mode::Radiance), glass.sample(wo, l, u, Mode::Radiance));
            }
            assert_eq!(clear.lobes(), glass.lobes());
        }
    }
    let metal = Principled { meaning: Meaning::GltfB, ..Principled::new(color, 1.0, 0.4) };
    let same = Conductor::new(0.4, MetalFresnel::Schlick { f0: color }).with_masking(Masking::Separable);
    let (a, b) = (metal.eval_pdf(wo, wi, Mode::Radiance), same.eval_pdf(wo, wi, Mode::Radiance));
    assert!((a.0 - b.0).map(f32::abs).max_channel() < 1e-6 && (a.1 - b.1).abs() < 1e-6, "{a:?} {b:?}");
    let rough = Principled { transmission: 1.0, ..Principled::new(color, 0.0, 0.4) };
    let same = RoughDielectric { tint: color, ..RoughDielectric::new(0.4, 1.5) };
    assert_eq!(rough.eval_pdf(wo, -wi, Mode::Radiance), same.eval_pdf(wo, -wi, Mode::Radiance));
}

/// A thin wall keeps no more than single scattering loses; what it sends through is what reflection has, mirrored.
#[test]
fn thin_walls_keep_light() {
    for roughness in [0.2, 0.5, 0.9] {
        let wall = ThinDielectric::new(roughness, 1.5);
        let metal = Conductor::new(roughness, MetalFresnel::Schlick { f0: Spectrum::ONE });
        for mu in [0.2, 0.7, 1.0] {
            let wo = at_cosine(mu);
            let turn = [0.0, std::f64::consts::TAU];
            let all = |b: &dyn Bsdf, half| {
                integrate(half, turn, [2000, 300], |wi| f64::from(b.eval(wo, wi, Mode::Radiance).r()))
            };
            let both = all(&wall, [0.0, 1.0]) + all(&wall, [-1.0, 0.0]);
            assert!((both - all(&metal, [0.0, 1.0])).abs() < 1e-3, "roughness {roughness} mu {mu}: {both}");
            assert!((albedo(&wall, wo) - albedo(&metal, wo)).abs() < 4e-3, "roughness {roughness} mu {mu}");
        }
    }
    let smooth = ThinDielectric::new(0.0, 1.5);
    let s = smooth.sample(at_cosine(0.6), 0.9, Vec2::ZERO, Mode::Radiance).expect("goes on");
    assert_eq!((s.wi, s.weight, s.eta), (-at_cosine(0.6), Spectrum::ONE, 1.0));
}

/// No mixture makes light, in importance, over its parameters.
#[test]
fn mixtures_make_no_light() {
    for thin in [false, true] {
        for transmission in [0.3, 1.0] {
            for alpha in [0.0, 0.03, 0.4] {
                for mu in [-0.7, -0.1, 0.05, 0.5, 1.0] {
                    let p = Principled { thin, transmission, ..surface(1.0, 0.3, alpha) };
                    let e = albedo(&p, at_cosine(mu));
                    assert!(e < 1.005 && (alpha > 0.1 || e > 0.9), "{p:?} mu {mu}: {e}");
                }
            }
        }
    }
}

/// What an integrator copies at every vertex.
#[test]
fn held_by_value_it_is_small() {
    assert!(size_of::<BsdfAt<'_>>() <= 80, "{}", size_of::<BsdfAt<'_>>());
}
