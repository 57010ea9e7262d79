//! Right samplers, cameras, shapes and integrators are accepted.

mod support;

use etendue_bvh::World;
use etendue_camera::{Camera, Orthographic, Perspective};
use etendue_core::{Aabb, Ray, Spectrum, Transform, UVec2, Vec2, Vec3A};
use etendue_geometry::{Parallelogram, Plane, Shape, ShapeHit, ShapeSample, Sphere, Surface};
use etendue_integrator::{DirectLight, PathTracer, Roulette};
use etendue_light::{ConstantEnvironment, PointLight};
use etendue_material::{Diffuse, Glass, Metal};
use etendue_sampling::{Independent, Sampler, Sobol, Stratified};
use etendue_scene::{Emission, Scene, SceneBuilder, presets};
use etendue_testkit::{
    Budget, Outcome, Passed, Radiance, check_camera, check_integrator, check_sampler, check_shape,
};
use support::{Case, FEW, MANY, accept};

fn sampler<S: Sampler + 'static>(name: &str, make: impl Fn(u64) -> S + 'static) -> Case<'static> {
    Case::new(name, move |b| check_sampler(&make, b))
}

fn samplers() -> Vec<Case<'static>> {
    vec![
        sampler("independent", |seed| Independent::new(seed, 64)),
        sampler("independent, 4 replicates", |seed| Independent::new(seed, 64).with_replicates(4)),
        sampler("stratified, 64", |seed| Stratified::new(seed, 64)),
        sampler("stratified, 37", |seed| Stratified::new(seed, 37)),
        sampler("stratified, 1", |seed| Stratified::new(seed, 1)),
        sampler("stratified, 4 replicates of 11", |seed| Stratified::new(seed, 44).with_replicates(4)),
        sampler("sobol, 64", |seed| Sobol::new(seed, 64)),
        sampler("sobol, 100", |seed| Sobol::new(seed, 100)),
        sampler("sobol, 4 replicates of 16", |seed| Sobol::new(seed, 64).with_replicates(4)),
    ]
}

fn cameras() -> Vec<Case<'static>> {
    let size = UVec2::new(64, 48);
    let place = Transform::rotation(Vec3A::new(0.2, 1.0, 0.1), 2.0);
    let of = |fov| Perspective::new(place, fov, size).expect("a camera");
    let far =
        Perspective::look_at(Vec3A::new(3e3, 1e3, -2e3), Vec3A::ZERO, Vec3A::Y, 5.0, size).expect("a camera");
    let all: Vec<(&str, Box<dyn Camera>)> = vec![
        ("pinhole", Box::new(of(40.0))),
        ("pinhole, 150°", Box::new(of(150.0))),
        ("pinhole far away", Box::new(far)),
        ("lens", Box::new(of(40.0).with_lens(0.05, 3.0).expect("a lens"))),
        ("orthographic", Box::new(Orthographic::new(place, 2.0, size).expect("a camera"))),
        ("orthographic, not square", {
            Box::new(Orthographic::stretched(place, 0.3, 200.0, size).expect("a camera"))
        }),
        ("one pixel", Box::new(of(60.0).with_resolution(UVec2::ONE).expect("a pixel"))),
    ];
    all.into_iter().map(|(name, camera)| Case::new(name, move |b| check_camera(&*camera, b))).collect()
}

/// A thin box without lid and bottom: four parallelograms through the open door, not convex as seen by a line.
struct Frame4([Parallelogram; 4]);

impl Frame4 {
    fn new() -> Self {
        let (x, y, z) = (Vec3A::X, Vec3A::Y * 0.5, Vec3A::Z);
        let side = |o, u, v| Parallelogram::new(o, u, v).expect("an area");
        Self([side(-z, x, y), side(x - z, z, y), side(x, -x, y), side(Vec3A::ZERO, -z, y)])
    }
}

impl Shape for Frame4 {
    fn bounds(&self) -> Aabb {
        self.0.iter().fold(Aabb::EMPTY, |b, s| b.union(s.bounds()))
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let hits = self.0.iter().enumerate().filter_map(|(i, s)| s.intersect(ray).map(|h| (i, h)));
        let (i, h) = hits.min_by(|a, b| a.1.t.total_cmp(&b.1.t))?;
        Some(ShapeHit { t: h.t, uv: Vec2::new(h.uv.x + 2.0 * i as f32, h.uv.y) })
    }

    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let side = &self.0[((hit.uv.x * 0.5) as usize).min(3)];
        // Packing the side away has cost digits of the parameters.
        let own = side.intersect(ray).unwrap_or(*hit);
        side.surface(ray, &own)
    }

    fn area(&self) -> f32 {
        self.0.iter().map(Shape::area).sum()
    }

    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let i = ((u.x * 4.0) as usize).min(3);
        let s = self.0[i].sample(Vec2::new(u.x * 4.0 - i as f32, u.y))?;
        Some(ShapeSample { pdf_area: s.pdf_area * 0.25, ..s })
    }
}

fn shapes() -> Vec<Case<'static>> {
    let skew = Parallelogram::new(Vec3A::new(-0.3, 0.1, -0.5), Vec3A::X, Vec3A::new(0.4, 0.2, 0.8))
        .expect("an area");
    let flat =
        Parallelogram::new(Vec3A::new(5.0, 2.0, -3.0), Vec3A::X * 0.2, Vec3A::Z * 0.7).expect("an area");
    let all: Vec<(&str, Box<dyn Shape>)> = vec![
        ("sphere", Box::new(Sphere::new(Vec3A::ZERO, 1.0).expect("a ball"))),
        (
            "small sphere far away",
            Box::new(Sphere::new(Vec3A::new(100.0, -70.0, 30.0), 0.3).expect("a ball")),
        ),
        ("huge sphere", Box::new(Sphere::new(Vec3A::new(0.0, -1e6, 0.0), 1e6).expect("a ball"))),
        ("parallelogram", Box::new(skew)),
        ("flat rectangle", Box::new(flat)),
        ("four sides", Box::new(Frame4::new())),
        (
            "plane",
            Box::new(Plane::new(Vec3A::new(0.1, 0.2, 0.3), Vec3A::new(0.3, 1.0, 0.2)).expect("a plane")),
        ),
    ];
    all.into_iter().map(|(name, shape)| Case::new(name, move |b| check_shape(&*shape, b))).collect()
}

/// A ball of a material in a sky of radiance 1, a point light and a lamp beside it.
fn scene(lit: bool) -> Scene {
    let mut b = SceneBuilder::new();
    let clay = b.material(Diffuse::new(Spectrum::gray(0.7)));
    let gold = b.material(Metal::gold(0.4));
    let glass = b.material(Glass::new(1.5));
    let floor =
        Parallelogram::new(Vec3A::new(-2.0, -0.5, 2.0), Vec3A::X * 4.0, Vec3A::Z * -4.0).expect("a floor");
    b.add(floor, clay);
    for (x, m) in [(-1.0, gold), (0.0, glass), (1.0, clay)] {
        b.add(Sphere::new(Vec3A::X * x, 0.45).expect("a ball"), m);
    }
    if lit {
        b.light(PointLight::new(Vec3A::new(1.0, 2.0, 1.5), Spectrum::gray(2.0)));
        let lamp = Parallelogram::new(Vec3A::new(-1.5, 1.5, -0.5), Vec3A::X, Vec3A::Z).expect("a lamp");
        let lamp = b.add(lamp, clay);
        b.emit(lamp, Emission::new(Spectrum::gray(3.0)));
    }
    b.light(ConstantEnvironment::new(Spectrum::gray(0.5)));
    b.build().expect("a scene")
}

fn integrators() -> Vec<Case<'static>> {
    let outcome = |r: Result<etendue_testkit::stats::MeanTest, etendue_testkit::Failure>| -> Outcome {
        r.map(|t| Passed { tests: 1, statistical: 1, smallest_p: t.p })
    };
    let view = || {
        Perspective::look_at(Vec3A::new(0.0, 0.8, 4.0), Vec3A::ZERO, Vec3A::Y, 35.0, UVec2::new(6, 4))
            .expect("a view")
    };
    let mut out = Vec::new();
    for direct in [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisBalance, DirectLight::MisPower] {
        for roulette in [Roulette::Off, Roulette::Throughput { from: 1 }] {
            let own = PathTracer { direct, roulette, max_depth: Some(5), ..PathTracer::default() };
            let reference =
                PathTracer { max_depth: Some(5), roulette: Roulette::Off, ..PathTracer::default() };
            let scene = scene(direct != DirectLight::Light);
            out.push(Case::new(format!("{direct:?}, {roulette:?}"), move |b: &Budget| {
                let truth = Radiance::Same(&reference);
                outcome(check_integrator(&own, &|s| Sobol::new(s, 16), &scene, &view(), &truth, 24, b))
            }));
        }
    }
    // A furnace: the walls emit 1 and reflect a half.
    let mut b = SceneBuilder::new();
    let wall = b.material(Diffuse::new(Spectrum::gray(0.5)));
    let id = b.add(Sphere::new(Vec3A::ZERO, 1.0).expect("a ball"), wall);
    b.emit(id, Emission::new(Spectrum::ONE).two_sided());
    let furnace = b.build().expect("a furnace");
    let inside =
        Perspective::look_at(Vec3A::new(0.1, 0.2, 0.3), Vec3A::ZERO, Vec3A::Y, 90.0, UVec2::splat(4));
    let inside = inside.expect("a view");
    out.push(Case::new("furnace", move |b: &Budget| {
        let truth = Radiance::Known(2.0);
        outcome(check_integrator(
            &PathTracer::default(),
            &|s| Stratified::new(s, 9),
            &furnace,
            &inside,
            &truth,
            40,
            b,
        ))
    }));
    out
}

#[test]
fn few_seeds() {
    accept(&samplers(), FEW, 0.25);
    accept(&cameras(), FEW, 0.25);
    accept(&shapes(), FEW, 0.25);
    accept(&integrators(), FEW, 1.0);
}

#[test]
#[ignore = "minutes"]
fn hundred_seeds() {
    accept(&samplers(), MANY, 0.25);
    accept(&cameras(), MANY, 0.25);
    accept(&shapes(), MANY, 0.25);
    accept(&integrators(), MANY, 1.0);
}

/// The structures of `bench_accel` see the same hits whatever is under them.
#[test]
fn ray_queries_are_timed_on_the_same_rays() {
    struct Ticks(std::sync::atomic::AtomicU64);
    impl etendue_core::Clock for Ticks {
        fn seconds(&self) -> f64 {
            self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed) as f64
        }
    }
    let preset = presets::cornell_box();
    let scene = preset.builder.build().expect("the preset builds");
    let brute = etendue_bvh::BruteForce::build(scene.world()).expect("a list");
    let clock = Ticks(std::sync::atomic::AtomicU64::new(0));
    let tree = etendue_testkit::bench_accel(scene.accel(), 2000, &clock);
    let list = etendue_testkit::bench_accel(&brute, 2000, &clock);
    let _: &World = scene.world();
    for (a, b) in tree.iter().zip(&list) {
        assert_eq!((a.kind, a.rays, a.hits), (b.kind, b.rays, b.hits));
        assert!(a.hits > 100 && a.seconds > 0.0 && a.mrays() > 0.0, "{a:?}");
    }
    assert_eq!(tree.len(), 4);
}
