//! Right lights and pickers are accepted, near and far, one-sided and two-sided, in the open and half below a horizon.

mod support;

use std::sync::Arc;

use etendue_core::{Ray, Spectrum, Transform, Vec2, Vec3A, vector};
use etendue_geometry::{Disc, Geometry, Parallelogram, Shape, Sphere, Surface, presets};
use etendue_light::{
    ConstantEnvironment, DirectionalLight, DiscLight, GoniometricLight, ImageEnvironment, IntensityTable,
    Light, LightId, LightPicker, LitPoint, MeshLight, ParallelogramLight, PointLight, PowerPicker,
    ShapeLight, Sides, SinglePicker, SphereLight, SpotLight, UniformPicker,
};
use etendue_scene::{Emission, Scene, SceneBuilder};
use etendue_testkit::{check_light, check_picker, lit_point};
use etendue_texture::{ImageTexture, Tex};
use support::{Case, FEW, MANY, accept};

/// Receivers around the origin, where all lights stand.
fn points() -> Vec<LitPoint> {
    let tilted = vector::normalize(Vec3A::new(0.3, 1.0, -0.2));
    let away = vector::normalize(Vec3A::new(-1.0, 0.2, 0.1));
    let below = Vec3A::new(0.1, -2.0, 0.2);
    let mut through = lit_point(Vec3A::new(1.5, 1.8, 0.9), -tilted);
    through.sides = Sides::Both;
    vec![
        lit_point(below, Vec3A::Y),
        lit_point(Vec3A::new(-1.2, -0.8, 0.7), tilted),
        // The light is half below the horizon of this one.
        lit_point(below, away),
        through,
        lit_point(Vec3A::new(0.4, 1.1, -0.3), Vec3A::ZERO),
        lit_point(Vec3A::new(60.0, -160.0, 100.0), tilted),
    ]
}

/// A lamp that shines down more than up, and more to one side.
fn lamp() -> GoniometricLight {
    let values = vec![9.0, 4.0, 0.5, 0.2, 9.0, 7.0, 1.0, 0.2, 9.0, 3.0, 0.1, 0.2];
    let table = IntensityTable::new(vec![0.0, 40.0, 90.0, 180.0], vec![0.0, 50.0, 180.0], values);
    let place = Transform::translation(Vec3A::new(0.1, 0.5, 0.0));
    GoniometricLight::new(&place, Arc::new(table.expect("a table")), Spectrum::rgb(1.0, 2.0, 3.0))
}

fn of_shape<L: Light + 'static>(name: &str, light: L, shape: impl Shape + 'static) -> Case<'static> {
    let seen = move |ray: &Ray| shape.intersect(ray).map(|h| shape.surface(ray, &h));
    Case::new(name, move |b| check_light(&light, 0, &points(), &seen, b))
}

fn without_surface<L: Light + 'static>(name: &str, light: L) -> Case<'static> {
    Case::new(name, move |b| check_light(&light, 0, &points(), &|_| None, b))
}

/// A texture with a bright corner.
fn texture() -> Tex {
    let data = (0..8 * 4).map(|i| if i == 5 { 6.0 } else { 0.25 + (i % 3) as f32 * 0.5 }).collect();
    Tex::image(Arc::new(ImageTexture::from_f32(8, 4, 1, data).expect("an image")))
}

/// A dim sky with a sun on the seam and one at the pole.
fn sky(rotation: f32) -> ImageEnvironment {
    let (w, h) = (32u32, 16u32);
    let data = (0..w * h)
        .map(|i| match (i % w, i / w) {
            (0, 5) => 40.0,
            (20, 0) => 25.0,
            (13, 11) => 60.0,
            (x, y) => 0.05 * ((x * 7 + y * 3) % 5) as f32,
        })
        .collect();
    let image = ImageTexture::from_f32(w, h, 1, data).expect("an image");
    ImageEnvironment::new(image, 0.7, rotation).expect("a sky")
}

/// The one light of a scene, found as the scene finds it; `part` alone.
fn of_scene(name: &str, build: impl Fn(&mut SceneBuilder), part: u32) -> Case<'static> {
    let mut b = SceneBuilder::new();
    build(&mut b);
    let scene: Scene = b.build().expect("a scene");
    Case::new(name, move |budget| {
        let seen = |ray: &Ray| -> Option<Surface> {
            let hit = scene.intersect(ray, 0)?;
            Some(scene.surface(ray, &hit, 0.0)).filter(|s| s.prim == part)
        };
        check_light(&*scene.lights()[0], part, &points(), &seen, budget)
    })
}

fn lights() -> Vec<Case<'static>> {
    let square = Parallelogram::new(Vec3A::new(-0.5, 0.0, -0.4), Vec3A::Z, Vec3A::X * 0.7).expect("a square");
    let skew = Parallelogram::new(Vec3A::new(-0.3, 0.1, -0.5), Vec3A::X, Vec3A::new(0.4, 0.2, 0.8))
        .expect("an area");
    let ball = Sphere::new(Vec3A::new(0.1, 0.2, -0.1), 0.5).expect("a ball");
    let around = Sphere::new(Vec3A::new(0.1, 0.2, -0.1), 300.0).expect("a ball");
    let disc = Disc::new(Vec3A::new(0.1, 0.2, -0.1), Vec3A::new(0.3, -1.0, 0.2), 0.5).expect("a disc");
    let white = Tex::gray(3.0);
    let two = |mut l: ParallelogramLight| {
        l.two_sided = true;
        l
    };
    let spot = |name: &str, inner: f32, outer: f32| {
        let light = SpotLight::new(
            Vec3A::new(0.1, 0.5, 0.0),
            Vec3A::new(-0.2, -2.0, 0.1),
            Spectrum::rgb(1.0, 2.0, 3.0),
            inner,
            outer,
        );
        without_surface(name, light)
    };
    let mut out = vec![
        without_surface("point", PointLight::new(Vec3A::new(0.1, 0.5, 0.0), Spectrum::rgb(1.0, 2.0, 3.0))),
        spot("spot", 0.3, 1.2),
        spot("spot with a hard edge", 0.5, 0.5),
        spot("spot all around", 2.0, 4.0),
        without_surface(
            "directional",
            DirectionalLight::new(Vec3A::new(0.2, -3.0, 0.4), Spectrum::gray(2.0)),
        ),
        without_surface("constant environment", ConstantEnvironment::new(Spectrum::rgb(0.5, 1.0, 2.0))),
        without_surface("sky", sky(0.0)),
        without_surface("turned sky", sky(0.7)),
        of_shape("rectangle", ParallelogramLight::new(square, white.clone()), square),
        of_shape("two-sided rectangle", two(ParallelogramLight::new(square, white.clone())), square),
        of_shape("textured rectangle", two(ParallelogramLight::new(square, texture())), square),
        of_shape("parallelogram", two(ParallelogramLight::new(skew, white.clone())), skew),
        of_shape("sphere", SphereLight::new(ball, white.clone()), ball),
        of_shape("textured sphere", SphereLight::new(ball, texture()), ball),
        of_shape(
            "sphere from inside",
            SphereLight { two_sided: true, ..SphereLight::new(around, white.clone()) },
            around,
        ),
        of_shape("disc", DiscLight::new(disc, white.clone()), disc),
        of_shape("textured disc", DiscLight { two_sided: true, ..DiscLight::new(disc, texture()) }, disc),
        without_surface("measured lamp", lamp()),
        of_shape("shape", ShapeLight::new(Arc::new(skew), None, white.clone(), true), skew),
        of_shape("round shape", ShapeLight::new(Arc::new(ball), None, texture(), false), ball),
    ];
    for part in 0..2 {
        let quad = presets::quad(skew.origin(), skew.edge_u(), skew.edge_v());
        out.push(of_scene(
            &format!("triangle {part}"),
            move |b| {
                let m = b.material(etendue_material::Diffuse::new(Spectrum::BLACK));
                let g = b.add(Geometry::mesh(quad.clone()), m);
                b.emit(g, Emission::new(texture()).two_sided());
            },
            part,
        ));
    }
    let place = Transform::scale(Vec3A::new(1.5, -0.5, 2.0))
        .and_then(|s| Transform::rotation(Vec3A::new(1.0, 0.3, 0.2), 0.8).after(&s))
        .expect("a placement");
    out.push(of_scene(
        "placed shape",
        move |b| {
            let m = b.material(etendue_material::Diffuse::new(Spectrum::BLACK));
            let g = b.add_grouped(ball, m);
            b.emit(g, Emission::new(Spectrum::gray(2.0)));
            let group = b.group(&[g]);
            b.instance(group, place);
        },
        0,
    ));
    out.push(of_scene(
        "placed triangle",
        move |b| {
            let m = b.material(etendue_material::Diffuse::new(Spectrum::BLACK));
            let g = b.add_grouped(Geometry::mesh(presets::quad(Vec3A::ZERO, Vec3A::X, Vec3A::Z)), m);
            b.emit(g, Emission::new(Spectrum::gray(2.0)).two_sided());
            let group = b.group(&[g]);
            b.instance(group, place);
        },
        1,
    ));
    out
}

/// Three lights of nine parts with powers from nothing to much, and the pickers over them.
fn pickers() -> Vec<Case<'static>> {
    let mesh = Arc::new(presets::icosphere(0, 1.0));
    let strip = presets::quad(Vec3A::ZERO, Vec3A::X * 0.1, Vec3A::Y);
    let lights: Vec<Arc<dyn Light>> = vec![
        Arc::new(MeshLight::new(mesh, None, Tex::gray(0.2), false)),
        Arc::new(PointLight::new(Vec3A::ONE, Spectrum::gray(0.3))),
        Arc::new(MeshLight::new(Arc::new(strip), None, Tex::gray(0.01), true)),
        Arc::new(PointLight::new(Vec3A::ONE, Spectrum::BLACK)),
    ];
    let ids: Vec<LightId> = lights
        .iter()
        .enumerate()
        .flat_map(|(i, l)| (0..l.parts()).map(move |part| LightId { light: i as u32, part }))
        .collect();
    let shines = {
        let lights = lights.clone();
        move |at: &LitPoint, id: LightId| {
            let middle = Vec2::splat(0.5);
            lights[id.light as usize].sample(at, id.part, middle).is_some_and(|s| !s.li.is_black())
        }
    };
    let all: Vec<(&str, Box<dyn LightPicker>)> = vec![
        ("power", Box::new(PowerPicker::new(&lights, 10.0).expect("something shines"))),
        ("uniform", Box::new(UniformPicker::new(&lights).expect("something is there"))),
    ];
    let mut out: Vec<Case<'static>> = all
        .into_iter()
        .map(|(name, picker)| {
            let (ids, shines) = (ids.clone(), shines.clone());
            Case::new(name, move |b| check_picker(&*picker, &ids, &points(), &shines, b))
        })
        .collect();
    let only = LightId { light: 3, part: 7 };
    let single = SinglePicker::new(only);
    out.push(Case::new("single", move |b| check_picker(&single, &[only], &points(), &|_, _| true, b)));
    out
}

#[test]
fn few_seeds() {
    accept(&lights(), FEW, 0.05);
    accept(&pickers(), FEW, 0.1);
}

#[test]
#[ignore = "minutes"]
fn hundred_seeds() {
    accept(&lights(), MANY, 0.1);
    accept(&pickers(), MANY, 0.25);
}
