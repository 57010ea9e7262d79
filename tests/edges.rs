//! Edges of the contract: what an embedder may do that no preset does.

use std::time::Duration;

use etendue::integrator::FirstHitRecorder;
use etendue::light::ParallelogramLight;
use etendue::material::{Absorber, Cutout};
use etendue::prelude::*;

/// Ways of finding light that must agree wherever the light can be found at all.
const ALL: [DirectLight; 4] =
    [DirectLight::Light, DirectLight::Bsdf, DirectLight::MisBalance, DirectLight::MisPower];

fn mean(scene: &Scene, path: &PathTracer, n: u64, ray: Ray) -> f64 {
    let cx = Context::new(scene);
    let s = Independent::new(7, 1);
    let camera = CameraSample { ray, weight: 1.0, spread: 0.0 };
    (0..n).map(|i| f64::from(path.li_plain(&cx, &camera, s.start(i, 0)).l.mean())).sum::<f64>() / n as f64
}

/// The direct light of all ways, 4 % apart at most: a light counted twice, half or not at all is far beyond.
fn all_agree(scene: &Scene) {
    let ray = Ray::new(Vec3A::new(0.1, 0.5, 0.0), Vec3A::NEG_Y);
    let of =
        |direct| mean(scene, &PathTracer { direct, max_depth: Some(1), ..Default::default() }, 20_000, ray);
    let found = ALL.map(of);
    assert!(found[0] > 0.1 && found.iter().all(|x| (x / found[0] - 1.0).abs() < 0.04), "{found:?}");
}

fn floor(b: &mut SceneBuilder) {
    let m = b.material(Diffuse::new(Spectrum::gray(0.8)));
    let p = Parallelogram::new(Vec3A::new(-5.0, 0.0, -5.0), Vec3A::Z * 10.0, Vec3A::X * 10.0);
    b.add(p.unwrap(), m);
}

fn lamp() -> Parallelogram {
    Parallelogram::new(Vec3A::new(-1.0, 1.0, -1.0), Vec3A::X * 2.0, Vec3A::Z * 2.0).unwrap()
}

#[test]
fn lights_that_no_ray_finds_are_sampled_in_full() {
    let mut b = SceneBuilder::new();
    floor(&mut b);
    b.light(ParallelogramLight::new(lamp(), Spectrum::ONE));
    all_agree(&b.build().unwrap());

    let mut b = SceneBuilder::new();
    floor(&mut b);
    let m = b.material(Absorber);
    let hidden = b.add(lamp(), m);
    b.emit(hidden, Emission::new(Spectrum::ONE));
    b.visible_to(hidden, 0);
    all_agree(&b.build().unwrap());
}

#[test]
fn a_part_named_twice_in_a_group_stands_there_once() {
    let mut b = SceneBuilder::new();
    floor(&mut b);
    let m = b.material(Absorber);
    let part = b.add_grouped(lamp(), m);
    b.emit(part, Emission::new(Spectrum::ONE));
    let group = b.group(&[part, part]);
    b.instance(group, Transform::IDENTITY);
    all_agree(&b.build().unwrap());
}

#[test]
fn an_infinite_plane_under_a_sky() {
    let mut b = SceneBuilder::new();
    let m = b.material(Diffuse::new(Spectrum::gray(0.8)));
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y).unwrap(), m);
    b.light(ConstantEnvironment::new(Spectrum::ONE));
    all_agree(&b.build().unwrap());
}

#[test]
fn a_shape_that_cannot_be_sampled_cannot_emit() {
    struct AreaOnly(Parallelogram);
    impl Shape for AreaOnly {
        fn bounds(&self) -> etendue::core::Aabb {
            self.0.bounds()
        }
        fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
            self.0.intersect(ray)
        }
        fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
            self.0.surface(ray, hit)
        }
        fn area(&self) -> f32 {
            self.0.area()
        }
    }
    let mut b = SceneBuilder::new();
    let m = b.material(Absorber);
    let shape = b.add(Geometry::open(AreaOnly(lamp())), m);
    b.emit(shape, Emission::new(Spectrum::ONE));
    let error = b.build().expect_err("refused").to_string();
    assert!(error.contains("Shape::sample"), "{error}");
}

#[test]
fn both_sheets_of_a_cut_out_sphere_count() {
    let mut b = SceneBuilder::new();
    let m = b.material(Cutout::new(Absorber, 0.5));
    b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), m);
    b.light(ConstantEnvironment::new(Spectrum::ONE));
    let ray = Ray::new(Vec3A::new(0.2, 0.1, 5.0), Vec3A::NEG_Z);
    // 20,000 coins of probability 1/4: five standard errors are 0.0153.
    let through = mean(&b.build().unwrap(), &PathTracer::default(), 20_000, ray);
    assert!((through - 0.25).abs() < 0.0153, "{through}");
}

fn in_time(f: impl FnOnce() + Send + 'static) -> bool {
    let (done, wait) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        f();
        // Nobody waits any more once the time is up.
        let _ = done.send(());
    });
    wait.recv_timeout(Duration::from_secs(20)).is_ok()
}

/// A BSDF whose weight is no number: a bug of a user's that must not hang the renderer.
struct Broken;

impl Bsdf for Broken {
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION | Lobes::DIFFUSE
    }
    fn eval(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> Spectrum {
        Spectrum::BLACK
    }
    fn pdf(&self, _wo: Vec3A, _wi: Vec3A, _mode: Mode) -> f32 {
        0.0
    }
    fn sample(&self, wo: Vec3A, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let s = etendue::bsdf::Lambert::new(Spectrum::ONE).sample(wo, u_lobe, u, mode)?;
        Some(BsdfSample { weight: Spectrum::gray(f32::NAN), ..s })
    }
    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Ref(self)
    }
}

impl Material for Broken {
    fn bsdf<'a>(&'a self, _at: &Surface) -> BsdfAt<'a> {
        self.at()
    }
}

#[test]
fn a_path_that_is_no_number_ends_and_is_located() {
    assert!(in_time(|| {
        let mut b = SceneBuilder::new();
        let m = b.material(Broken);
        b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), m);
        b.light(PointLight::new(Vec3A::ZERO, Spectrum::ONE));
        let scene = b.build().unwrap();
        let size = UVec2::splat(4);
        let camera = Perspective::look_at(Vec3A::Z * 0.5, Vec3A::ZERO, Vec3A::Y, 40.0, size).unwrap();
        let mut film = Film::new(size, 1).unwrap();
        let o = RenderOptions::default();
        let report =
            render(&scene, &camera, &PathTracer::default(), Sobol::new(1, 2), &mut film, &o).unwrap();
        assert_eq!((report.rejected, report.rejected_at.len()), (32, 32));
        assert_eq!((report.rejected_at[0].pixel, report.rejected_at[0].index), (UVec2::ZERO, 0));
        assert_eq!(film.mean(UVec2::ZERO), Spectrum::BLACK);
    }));
}

#[test]
fn without_roulette_paths_still_end() {
    let mut b = SceneBuilder::new();
    let m = b.material(Diffuse::new(Spectrum::gray(0.5)));
    b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), m);
    b.light(PointLight::new(Vec3A::ZERO, Spectrum::ONE));
    let scene = b.build().unwrap();
    let cx = Context::new(&scene);
    let path = PathTracer { roulette: Roulette::Off, ..Default::default() };
    let ray = Ray::new(Vec3A::new(0.1, 0.0, 0.0), Vec3A::X);
    for i in 0..20 {
        path.li_plain(
            &cx,
            &CameraSample { ray, weight: 1.0, spread: 0.0 },
            Independent::new(1, 1).start(i, 0),
        );
    }
    assert!(cx.counts().scatter_rays / 20 < 400, "{:?}", cx.counts());
}

#[test]
fn a_recorder_changes_nothing_without_light_either() {
    let mut b = SceneBuilder::new();
    floor(&mut b);
    let scene = b.build().unwrap();
    let cx = Context::new(&scene);
    let ray = Ray::new(Vec3A::new(0.1, 0.5, 0.0), Vec3A::NEG_Y);
    let s = CameraSample { ray, weight: 1.0, spread: 0.0 };
    let (path, u) = (PathTracer::default(), Independent::new(1, 1).start(0, 0));
    assert_eq!(path.li(&cx, &s, u, &mut FirstHitRecorder::default()), path.li_plain(&cx, &s, u));
}

#[test]
fn ids_of_another_builder_are_errors() {
    let mut other = SceneBuilder::new();
    let m = other.material(Absorber);
    let foreign = [other.add_grouped(lamp(), m), other.add_grouped(lamp(), m)][1];
    let mut b = SceneBuilder::new();
    let group = b.group(&[foreign]);
    b.instance(group, Transform::IDENTITY);
    assert!(b.bounds().is_empty());
    assert!(b.build().is_err());
}

#[test]
fn a_scene_can_be_built_on_another_thread() {
    fn sendable<T: Send>(_: &T) {}
    let p = etendue::scene::presets::cornell_box();
    sendable(&p);
    let scene = std::thread::spawn(move || p.builder.build().unwrap()).join().unwrap();
    fn shareable<T: Send + Sync>(_: &T) {}
    shareable(&scene);
}

/// Listens with work of its own on the renderer's pool.
struct Busy;

impl Progress for Busy {
    fn update(&self, _done: u64, _total: u64) {
        let nap = || std::thread::sleep(Duration::from_millis(2));
        rayon::join(nap, nap);
    }
}

#[test]
fn a_listener_may_use_the_pool() {
    assert!(in_time(|| {
        let p = etendue::scene::presets::cornell_box();
        let size = UVec2::splat(64);
        let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, 40.0, size).unwrap();
        let scene = p.builder.build().unwrap();
        let mut film = Film::new(size, 1).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
        let o = RenderOptions { progress: &Busy, tile: 8, ..Default::default() };
        pool.install(|| {
            render(&scene, &camera, &PathTracer::default(), Independent::new(1, 4), &mut film, &o).unwrap()
        });
    }));
}
