//! Two scenes with one fingerprint must be one scene: every input goes in.

mod common;

use std::sync::Arc;

use common::square;
use etendue_core::{Spectrum, Transform, Vec2, Vec3, Vec3A, Vec4};
use etendue_geometry::{Geometry, Parallelogram, Plane, Sphere, TriangleMesh, presets};
use etendue_light::{ConstantEnvironment, ImageEnvironment, Light, PointLight, UniformPicker};
use etendue_material::{Cutout, Diffuse, Glass, Material, Metal, MirrorMaterial, RoughGlass};
use etendue_scene::{Emission, MaterialId, Scene, SceneBuilder};
use etendue_texture::{Encoding, Filter, ImageTexture, Tex, Wrap};

/// Everything that decides the scene below.
struct Recipe {
    mesh: TriangleMesh,
    ball: Geometry,
    material: Arc<dyn Material>,
    other_material: Arc<dyn Material>,
    ball_material: usize,
    emission: Option<Emission>,
    grouped: [usize; 2],
    places: Vec<Transform>,
    light: Arc<dyn Light>,
    mask: u32,
    uniform_picker: bool,
}

impl Default for Recipe {
    fn default() -> Self {
        Self {
            mesh: mesh(),
            ball: Sphere::new(Vec3A::Y, 0.5).unwrap().into(),
            material: Arc::new(Diffuse::new(Spectrum::gray(0.5))),
            other_material: Arc::new(Glass::new(1.5)),
            ball_material: 0,
            emission: Some(Emission::new(Spectrum::ONE)),
            grouped: [0, 1],
            places: vec![Transform::IDENTITY, Transform::translation(Vec3A::X)],
            light: Arc::new(PointLight::new(Vec3A::Y * 4.0, Spectrum::ONE)),
            mask: u32::MAX,
            uniform_picker: false,
        }
    }
}

fn mesh() -> TriangleMesh {
    presets::quad(Vec3A::ZERO, Vec3A::X, Vec3A::Y)
}

impl Recipe {
    fn cook(self) -> Scene {
        let mut b = SceneBuilder::new();
        let materials: Vec<MaterialId> =
            [self.material, self.other_material].into_iter().map(|m| b.material_arc(m)).collect();
        let mesh = b.add(self.mesh, materials[0]);
        b.add(self.ball, materials[self.ball_material]);
        let parts = [b.add_grouped(square(3.0), materials[0]), b.add_grouped(square(4.0), materials[0])];
        let group = b.group(&self.grouped.map(|i| parts[i]));
        for place in self.places {
            b.instance(group, place);
        }
        if let Some(e) = self.emission {
            b.emit(mesh, e);
        }
        b.visible_to(mesh, self.mask);
        b.light_arc(self.light);
        if self.uniform_picker {
            b.picker_with(|lights, _| Some(Box::new(UniformPicker::new(lights)?)));
        }
        b.build().unwrap()
    }
}

fn image(value: f32) -> ImageTexture {
    ImageTexture::from_f32(2, 2, 1, vec![0.25, 0.5, 0.5, value]).unwrap()
}

fn diffuse(tex: impl Into<Tex>) -> Arc<dyn Material> {
    Arc::new(Diffuse::new(tex))
}

fn textured(image: ImageTexture) -> Arc<dyn Material> {
    diffuse(Tex::image(Arc::new(image)))
}

/// Every one of these differs from the plain recipe and from all others.
fn variants() -> Vec<(&'static str, Recipe)> {
    let r = Recipe::default;
    let [p, n, uv] = [
        TriangleMesh::new(
            mesh().positions().iter().map(|&p| p + Vec3::Z * 1e-6).collect(),
            mesh().indices().to_vec(),
        )
        .unwrap(),
        mesh().with_normals(vec![Vec3::Z; 4]).unwrap(),
        mesh().with_uv(0, vec![Vec2::ONE; 4]).unwrap(),
    ];
    let uv1 = mesh().with_uv(1, vec![Vec2::ONE; 4]).unwrap();
    let colors = mesh().with_colors(vec![Vec4::ONE; 4]).unwrap();
    let turned = TriangleMesh::new(mesh().positions().to_vec(), vec![[1, 2, 0], [0, 2, 3]]).unwrap();
    let shape = |g: Geometry| Recipe { ball: g, ..r() };
    let of = |m: Arc<dyn Material>| Recipe { material: m, ..r() };
    let glow = |e: Emission| Recipe { emission: Some(e), ..r() };
    let light = |l: Arc<dyn Light>| Recipe { light: l, ..r() };
    let cut = |c: Cutout<Diffuse>| Recipe { other_material: Arc::new(c), ..r() };
    let leaf = || Cutout::new(Diffuse::new(Spectrum::ONE), 0.5);
    let env = |i: ImageTexture, scale, rotation| {
        light(Arc::new(ImageEnvironment::new(i, scale, rotation).unwrap()))
    };
    let rgb = |v: f32| ImageTexture::from_f32(2, 1, 3, vec![v, 1.0, 1.0, 1.0, 1.0, 1.0]).unwrap();
    vec![
        ("plain", r()),
        ("positions", Recipe { mesh: p, ..r() }),
        ("normals", Recipe { mesh: n, ..r() }),
        ("uv", Recipe { mesh: uv, ..r() }),
        ("uv1", Recipe { mesh: uv1, ..r() }),
        ("colours", Recipe { mesh: colors, ..r() }),
        ("indices", Recipe { mesh: turned, ..r() }),
        ("centre", shape(Sphere::new(Vec3A::Y * 1.5, 0.5).unwrap().into())),
        ("radius", shape(Sphere::new(Vec3A::Y, 0.25).unwrap().into())),
        ("quad", shape(Parallelogram::new(Vec3A::Y, Vec3A::X, Vec3A::Z).unwrap().into())),
        ("edge", shape(Parallelogram::new(Vec3A::Y, Vec3A::X, Vec3A::Z * 2.0).unwrap().into())),
        ("plane", shape(Plane::new(Vec3A::Y, Vec3A::X).unwrap().into())),
        ("normal", shape(Plane::new(Vec3A::Y, Vec3A::Z).unwrap().into())),
        ("albedo", of(diffuse(Spectrum::gray(0.4)))),
        ("mirror", of(Arc::new(MirrorMaterial::new(Spectrum::gray(0.5))))),
        ("gold", of(Arc::new(Metal::gold(0.5)))),
        ("smoother gold", of(Arc::new(Metal::gold(0.4)))),
        ("rough glass", of(Arc::new(RoughGlass::new(1.5, 0.5)))),
        ("rougher glass", of(Arc::new(RoughGlass::new(1.5, 0.6)))),
        ("texture", of(textured(image(0.75)))),
        ("texel", of(textured(image(0.76)))),
        ("wrap", of(textured(image(0.75).with_wrap(Wrap::Clamp, Wrap::Repeat)))),
        ("other wrap", of(textured(image(0.75).with_wrap(Wrap::Repeat, Wrap::Clamp)))),
        ("filter", of(textured(image(0.75).with_filter(Filter::Nearest)))),
        ("bytes", of(textured(ImageTexture::from_u8(1, 1, 1, vec![9], Encoding::Srgb).unwrap()))),
        ("encoding", of(textured(ImageTexture::from_u8(1, 1, 1, vec![9], Encoding::Linear).unwrap()))),
        ("scaled texture", of(diffuse(Tex::image(Arc::new(image(0.75))).scaled(Spectrum::gray(0.5))))),
        ("vertex colour", of(Arc::new(Diffuse { vertex_color: true, ..Diffuse::new(Spectrum::gray(0.5)) }))),
        ("eta", Recipe { other_material: Arc::new(Glass::new(1.4)), ..r() }),
        ("opacity", cut(leaf())),
        ("less opacity", cut(Cutout::new(Diffuse::new(Spectrum::ONE), 0.4))),
        ("threshold", cut(leaf().with_threshold(0.25))),
        ("vertex alpha", cut(Cutout { vertex_alpha: true, ..leaf() })),
        ("assignment", Recipe { ball_material: 1, ..r() }),
        ("no emission", Recipe { emission: None, ..r() }),
        ("emission", glow(Emission::new(Spectrum::gray(2.0)))),
        ("two-sided", glow(Emission::new(Spectrum::ONE).two_sided())),
        ("textured emission", glow(Emission::new(Tex::image(Arc::new(image(0.75)))))),
        ("half the group", Recipe { grouped: [1, 1], ..r() }),
        ("fewer places", Recipe { places: vec![Transform::IDENTITY], ..r() }),
        (
            "other places",
            Recipe { places: vec![Transform::translation(Vec3A::X), Transform::IDENTITY], ..r() },
        ),
        ("mask", Recipe { mask: 1, ..r() }),
        ("light's place", light(Arc::new(PointLight::new(Vec3A::Y * 5.0, Spectrum::ONE)))),
        ("light's power", light(Arc::new(PointLight::new(Vec3A::Y * 4.0, Spectrum::gray(2.0))))),
        ("sky", light(Arc::new(ConstantEnvironment::new(Spectrum::ONE)))),
        ("brighter sky", light(Arc::new(ConstantEnvironment::new(Spectrum::gray(2.0))))),
        ("picture sky", env(rgb(1.0), 1.0, 0.0)),
        ("another picture", env(rgb(0.5), 1.0, 0.0)),
        ("scale of the sky", env(rgb(1.0), 2.0, 0.0)),
        ("turned sky", env(rgb(1.0), 1.0, 0.5)),
        ("picker", Recipe { uniform_picker: true, ..r() }),
    ]
}

#[test]
fn every_input_changes_it() {
    let mut seen: Vec<(u128, &str)> = Vec::new();
    for (name, recipe) in variants() {
        let f = recipe.cook().fingerprint();
        assert!(!f.is_opaque(), "{name}: all parts are ours");
        if let Some((_, other)) = seen.iter().find(|(v, _)| *v == f.value()) {
            panic!("'{name}' has the fingerprint of '{other}'");
        }
        seen.push((f.value(), name));
    }
}

#[test]
fn the_same_scene_has_it_twice() {
    for ((name, a), (_, b)) in variants().into_iter().zip(variants()) {
        assert_eq!(a.cook().fingerprint(), b.cook().fingerprint(), "{name}");
    }
}

/// A group is a set: neither the order in which its parts are named nor naming one twice changes anything.
#[test]
fn groups_are_sets() {
    let plain = Recipe::default().cook().fingerprint();
    assert_eq!(Recipe { grouped: [1, 0], ..Recipe::default() }.cook().fingerprint(), plain);
}

/// Which of two equal meshes shines is a difference too.
#[test]
fn emitters_are_told_apart() {
    let build = |which: usize| {
        let mut b = SceneBuilder::new();
        let m = common::gray(&mut b);
        let ids = [b.add(mesh(), m), b.add(mesh(), m)];
        b.emit(ids[which], Emission::new(Spectrum::ONE));
        b.build().unwrap().fingerprint()
    };
    assert_ne!(build(0), build(1));
}

/// A part that does not describe itself leaves a mark.
#[test]
fn a_user_s_part_marks_the_digest() {
    struct Mine;
    impl Material for Mine {
        fn bsdf<'a>(&'a self, _at: &etendue_geometry::Surface) -> etendue_bsdf::BsdfAt<'a> {
            etendue_bsdf::BsdfAt::Black(etendue_bsdf::Black)
        }
    }
    let scene = Recipe { material: Arc::new(Mine), ..Recipe::default() }.cook();
    assert!(scene.fingerprint().is_opaque());
}
