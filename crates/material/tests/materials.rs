//! Materials say what they need, stay in range, and tell themselves apart.

use std::cell::Cell;
use std::sync::Arc;

use etendue_bsdf::{Bsdf, BsdfAt, BsdfSample, Lobes, Meaning, Mode};
use etendue_core::{Fingerprint, Needs, Spectrum, Vec2, Vec3A, Vec4};
use etendue_geometry::Surface;
use etendue_material::{
    Absorber, AlphaPoint, BlinnPhong, Cutout, Diffuse, Glass, Material, Metal, MirrorMaterial, NormalMapped,
    OrenNayar, Phong, Principled, RoughGlass,
};
use etendue_texture::{Channel, Checker, Encoding, ImageTexture, ImageUse, Noise, ScalarTex, Tex, TexSpace};

fn surface() -> Surface {
    let mut at = Surface::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::Y);
    at.uv = [Vec2::new(0.25, 0.5), Vec2::ZERO];
    at.color = Vec4::new(0.5, 1.0, 2.0, 0.25);
    at
}

/// Two texels, alpha 0 and 1.
fn image() -> ImageUse {
    let data = vec![255, 0, 0, 0, 0, 255, 0, 255];
    ImageUse::new(Arc::new(ImageTexture::from_u8(2, 1, 4, data, Encoding::Linear).expect("sizes agree")))
}

fn textured() -> ScalarTex {
    ScalarTex::image(image(), Channel::A)
}

/// A pattern between two numbers.
fn grain(low: f32, high: f32) -> Noise {
    Noise::fractal(TexSpace::uv(9.0), 3, Spectrum::gray(low), Spectrum::gray(high))
}

#[test]
fn needs_say_what_is_used() {
    let white = Spectrum::ONE;
    let across = Metal { roughness_across: Some(0.1.into()), ..Metal::gold(0.3) };
    let tinted = Diffuse { vertex_color: true, ..Diffuse::new(white) };
    let ink = Spectrum::rgb(1.0, 0.5, 0.0);
    let plain = |metallic: f32, roughness: f32| Principled::new(white, metallic, roughness);
    let cases: Vec<(Box<dyn Material>, Needs)> = vec![
        (Box::new(Diffuse::new(white)), Needs::empty()),
        (Box::new(Diffuse::new(Tex::from(image()))), Needs::TEXTURES),
        (Box::new(tinted), Needs::VERTEX_COLORS),
        (Box::new(Absorber), Needs::empty()),
        (Box::new(MirrorMaterial::new(white)), Needs::DELTA),
        (Box::new(Glass::new(1.5)), Needs::DELTA | Needs::TRANSMISSION),
        (Box::new(RoughGlass::new(1.5, 0.4)), Needs::TRANSMISSION),
        (Box::new(RoughGlass::new(1.5, 0.001)), Needs::TRANSMISSION | Needs::DELTA),
        (Box::new(Metal::silver(0.2)), Needs::empty()),
        (Box::new(Metal::silver(0.0)), Needs::DELTA),
        (Box::new(Metal::silver(textured())), Needs::TEXTURES | Needs::DELTA),
        (Box::new(across), Needs::TANGENTS),
        (Box::new(Metal::schlick(Tex::from(image()), 0.2)), Needs::TEXTURES),
        (Box::new(Cutout::new(Diffuse::new(white), 0.5)), Needs::CUTOUTS),
        (Box::new(Cutout::new(Diffuse::new(white), 1.0)), Needs::empty()),
        (Box::new(Cutout::new(Diffuse::new(white), 0.7).with_threshold(0.5)), Needs::empty()),
        (Box::new(Cutout::new(Glass::new(1.3), textured())), {
            Needs::CUTOUTS | Needs::TEXTURES | Needs::DELTA | Needs::TRANSMISSION
        }),
        (Box::new(Glass { absorption: ink, ..Glass::new(1.5) }), {
            Needs::DELTA | Needs::TRANSMISSION | Needs::ABSORPTION
        }),
        (Box::new(NormalMapped::new(Diffuse::new(white), image())), {
            Needs::TEXTURES | Needs::TANGENTS | Needs::NORMAL_MAPS
        }),
        (Box::new(OrenNayar::new(white, 0.5)), Needs::empty()),
        (Box::new(OrenNayar::new(white, textured())), Needs::TEXTURES),
        (Box::new(OrenNayar::new(Tex::from(image()), 0.5)), Needs::TEXTURES),
        (Box::new(OrenNayar { vertex_color: true, ..OrenNayar::new(white, 0.5) }), Needs::VERTEX_COLORS),
        (Box::new(Phong::new(white, white, 10.0)), Needs::empty()),
        (Box::new(Phong::new(white, white, textured().scaled(100.0))), Needs::TEXTURES),
        (Box::new(Phong::new(white, Tex::from(image()), 10.0)), Needs::TEXTURES),
        (Box::new(Phong { vertex_color: true, ..Phong::new(white, ink, 10.0) }), Needs::VERTEX_COLORS),
        (Box::new(BlinnPhong::new(white, white, 10.0)), Needs::empty()),
        (Box::new(BlinnPhong::new(Tex::from(image()), white, 10.0)), Needs::TEXTURES),
        (
            Box::new(BlinnPhong { vertex_color: true, ..BlinnPhong::new(white, ink, 10.0) }),
            Needs::VERTEX_COLORS,
        ),
        (Box::new(Metal::brass(0.2)), Needs::empty()),
        (Box::new(Metal::iron(0.0)), Needs::DELTA),
        (Box::new(Diffuse::new(Checker::new(TexSpace::uv(4.0), white, ink))), Needs::TEXTURES),
        (Box::new(Metal::silver(grain(0.3, 0.6))), Needs::TEXTURES),
        (Box::new(Metal::silver(grain(0.0, 0.6))), Needs::TEXTURES | Needs::DELTA),
        (Box::new(plain(0.0, 0.5)), Needs::empty()),
        (Box::new(plain(0.0, 0.0)), Needs::DELTA),
        (Box::new(Principled { meaning: Meaning::GltfB, ..plain(0.0, 0.0) }), Needs::empty()),
        (Box::new(Principled { meaning: Meaning::GltfB, ..plain(1.0, 0.0) }), Needs::DELTA),
        (Box::new(Principled { specular: 0.0.into(), ..plain(0.0, 0.0) }), Needs::empty()),
        (Box::new(Principled { roughness: textured(), ..plain(0.0, 0.5) }), Needs::TEXTURES | Needs::DELTA),
        (Box::new(Principled { transmission: 0.5.into(), ..plain(0.0, 0.5) }), Needs::TRANSMISSION),
        (Box::new(Principled { transmission: 0.5.into(), absorption: ink, ..plain(0.0, 0.5) }), {
            Needs::TRANSMISSION | Needs::ABSORPTION
        }),
        (
            Box::new(Principled { transmission: 1.0.into(), absorption: ink, thin: true, ..plain(0.0, 0.5) }),
            { Needs::TRANSMISSION },
        ),
        (
            Box::new(Principled { transmission: 1.0.into(), absorption: ink, ..plain(1.0, 0.5) }),
            Needs::empty(),
        ),
        (Box::new(Principled { transmission: 1.0.into(), ..plain(0.0, 0.0) }), {
            Needs::TRANSMISSION | Needs::DELTA
        }),
    ];
    let mut seen = std::collections::BTreeSet::new();
    for (i, (material, needs)) in cases.iter().enumerate() {
        assert_eq!(material.needs(), *needs, "case {i}");
        let lobes = material.bsdf(&surface()).lobes();
        if lobes.contains(Lobes::DELTA) {
            assert!(needs.contains(Needs::DELTA), "case {i}");
        }
        if material.is_delta() {
            assert!(lobes.contains(Lobes::DELTA), "case {i}");
            assert!(!lobes.intersects(Lobes::DIFFUSE | Lobes::GLOSSY), "case {i}");
        }
        assert_eq!(lobes.contains(Lobes::TRANSMISSION), needs.contains(Needs::TRANSMISSION), "case {i}");
        let mut f = Fingerprint::default();
        material.fingerprint(&mut f);
        assert!(!f.is_opaque() && seen.insert(f.value()), "case {i} has another's fingerprint");
    }
}

#[test]
fn reflectances_are_clamped() {
    let at = surface();
    for (value, expected) in [(3.0, 1.0), (-1.0, 0.0), (f32::NAN, 0.0), (0.25, 0.25)] {
        let BsdfAt::Lambert(b) = Diffuse::new(Tex::gray(value)).bsdf(&at) else { panic!("not Lambert") };
        assert_eq!(b.albedo, Spectrum::gray(expected));
        let metal = Metal::schlick(Tex::gray(value), 0.0);
        assert_eq!(metal.bsdf(&at).albedo(Vec3A::Z), Spectrum::gray(expected));
    }
    let tinted = Diffuse { vertex_color: true, ..Diffuse::new(Tex::gray(0.8)) };
    let BsdfAt::Lambert(b) = tinted.bsdf(&at) else { panic!("not Lambert") };
    assert_eq!(b.albedo, Spectrum::rgb(0.4, 0.8, 1.0));
}

/// Parameters are looked up at the point, held in range, and tinted by the vertex colour where asked for.
#[test]
fn lobes_get_their_parameters() {
    let mut at = surface();
    at.uv[0] = Vec2::new(0.75, 0.5);
    let green = Spectrum::rgb(0.0, 1.0, 0.0);
    let base = Tex::from(image()).scaled(Spectrum::gray(0.5));
    let phong =
        Phong { vertex_color: true, ..Phong::new(base.clone(), Tex::gray(0.75), textured().scaled(40.0)) };
    let BsdfAt::Phong(b) = phong.bsdf(&at) else { panic!("not Phong") };
    assert_eq!((b.diffuse(), b.exponent()), (green * 0.5, 40.0));
    assert_eq!(b.specular(), Spectrum::rgb(0.75, 0.5, 0.75), "no more than the base leaves");
    let blinn = BlinnPhong::new(base.clone(), Tex::gray(f32::NAN), f32::NAN);
    let BsdfAt::BlinnPhong(b) = blinn.bsdf(&at) else { panic!("not Blinn-Phong") };
    assert_eq!((b.diffuse(), b.specular(), b.exponent()), (green * 0.5, Spectrum::BLACK, 0.0));
    let clay = OrenNayar { vertex_color: true, ..OrenNayar::new(Tex::gray(0.8), textured().scaled(3.0)) };
    let BsdfAt::OrenNayar(b) = clay.bsdf(&at) else { panic!("not Oren-Nayar") };
    assert_eq!((b.rho, b.roughness()), (Spectrum::rgb(0.4, 0.8, 1.0), 1.0));
    assert_eq!(at.fetches.get(), 4, "one look-up for each image");
}

#[test]
fn metals_have_their_conductor() {
    use etendue_bsdf::Conductor;
    let pairs = [
        (Metal::chromium(0.3), Conductor::chromium(0.3)),
        (Metal::iron(0.3), Conductor::iron(0.3)),
        (Metal::nickel(0.3), Conductor::nickel(0.3)),
        (Metal::titanium(0.3), Conductor::titanium(0.3)),
        (Metal::platinum(0.3), Conductor::platinum(0.3)),
        (Metal::tungsten(0.3), Conductor::tungsten(0.3)),
        (Metal::brass(0.3), Conductor::brass(0.3)),
    ];
    for (metal, conductor) in pairs {
        let BsdfAt::Conductor(b) = metal.bsdf(&surface()) else { panic!("not a conductor") };
        assert_eq!(b, conductor);
    }
}

#[test]
fn holes_are_where_alpha_is_low() {
    let fetches = Cell::new(0);
    let at = |u: f32, w: f32| AlphaPoint {
        uv: [Vec2::new(u, 0.5), Vec2::ZERO],
        p: Vec3A::ZERO,
        color: Vec4::new(1.0, 1.0, 1.0, w),
        fetches: &fetches,
    };
    let soft = Cutout::new(Diffuse::new(Tex::gray(0.5)), textured());
    assert_eq!([0.25, 0.5, 0.75].map(|u| soft.opacity(&at(u, 0.5))), [0.0, 0.5, 1.0]);
    assert_eq!(fetches.get(), 3);
    let sharp = soft.clone().with_threshold(0.5);
    assert_eq!([0.25, 0.49, 0.5, 0.75].map(|u| sharp.opacity(&at(u, 0.5))), [0.0, 0.0, 1.0, 1.0]);
    let veiled = Cutout { vertex_alpha: true, ..soft.clone() };
    assert_eq!(veiled.opacity(&at(0.75, 0.5)), 0.5);
    assert!(veiled.needs().contains(Needs::VERTEX_COLORS | Needs::CUTOUTS));
    let shared: Arc<dyn Material> = Arc::new(soft);
    let twice = Cutout::new(shared, 0.5);
    assert_eq!(twice.opacity(&at(0.75, 1.0)), 0.5, "holes in holes multiply");
}

/// A user's material enters by the same trait, its BSDF made for the point.
#[test]
fn a_users_own_enters_by_the_same_door() {
    struct Nothing;
    impl Bsdf for Nothing {
        fn lobes(&self) -> Lobes {
            Lobes::empty()
        }
        fn eval(&self, _: Vec3A, _: Vec3A, _: Mode) -> Spectrum {
            Spectrum::BLACK
        }
        fn pdf(&self, _: Vec3A, _: Vec3A, _: Mode) -> f32 {
            0.0
        }
        fn sample(&self, _: Vec3A, _: f32, _: Vec2, _: Mode) -> Option<BsdfSample> {
            None
        }
        fn at(&self) -> BsdfAt<'_> {
            BsdfAt::Ref(self)
        }
    }
    struct Own;
    impl Material for Own {
        fn bsdf<'a>(&'a self, _: &Surface) -> BsdfAt<'a> {
            BsdfAt::Open(Box::new(Nothing))
        }
    }
    let own: Arc<dyn Material> = Arc::new(Own);
    assert_eq!(own.bsdf(&surface()).albedo(Vec3A::Z), Spectrum::BLACK);
    let mut f = Fingerprint::default();
    own.fingerprint(&mut f);
    assert!(f.is_opaque(), "equality with an undescribed part is not proof");
}
