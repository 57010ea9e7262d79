//! Wrong samplers, cameras and shapes are rejected, each by the test meant for it; beside each the true
//! part is accepted. The defects that a suite's docs state as its power are made just that large.

mod support;

use std::sync::atomic::{AtomicU32, Ordering};

use etendue_camera::{Camera, CameraSample, Perspective};
use etendue_core::{Aabb, Fingerprint, Needs, Ray, UVec2, Vec2, Vec3A};
use etendue_geometry::{Parallelogram, Shape, ShapeHit, ShapeSample, Sphere, Surface};
use etendue_sampling::{Dim, Independent, Sampler, Slot, Sobol, unit_f32};
use etendue_testkit::{Budget, Outcome, Passed, check_camera, check_sampler, check_shape};
use support::{Case, MANY, accept, reject};

/// Seeds of the ordinary run.
const FIVE: u64 = 5;

/// A mutant that has to be found by one of the `by` tests: being found by another one would prove nothing.
fn mutant(
    name: &str,
    by: &'static [&'static str],
    check: impl Fn(&Budget) -> Outcome + 'static,
) -> Case<'static> {
    let label = name.to_owned();
    Case::new(name, move |b| match check(b) {
        Err(f) if !by.contains(&f.test) => {
            println!("{label}: not by {by:?} but by {f}");
            Ok(Passed { tests: 0, statistical: 0, smallest_p: 1.0 })
        }
        outcome => outcome,
    })
}

#[derive(Clone, Copy, PartialEq)]
enum SamplerDefect {
    None,
    Squared,
    Bent,
    Diagonal,
    Correlated,
    OneStream,
    IndicesInPairs,
    Impure,
    One,
    OneFork,
    NoFork,
    SeedsInPairs,
}

/// A sampler with a defect.
#[derive(Clone, Copy)]
struct WrongSampler<S> {
    s: S,
    /// The same point of stream 0.
    first: S,
    seed: u64,
    defect: SamplerDefect,
}

/// What an impure sampler hides.
static CURSOR: AtomicU32 = AtomicU32::new(0);

impl<S: Sampler> Sampler for WrongSampler<S> {
    fn spp(&self) -> u32 {
        self.s.spp()
    }
    fn replicates(&self) -> u32 {
        self.s.replicates()
    }
    fn start(self, stream: u64, index: u64) -> Self {
        // Three of eight pairs of samples are one sample: the mean square error grows by 3/8.
        let twice = self.defect == SamplerDefect::IndicesInPairs && (index / 2 % 8).is_multiple_of(3);
        let index = if twice { index & !1 } else { index };
        Self { s: self.s.start(stream, index), first: self.s.start(0, index), ..self }
    }
    fn fork(self, key: u32) -> Self {
        let s = match self.defect {
            SamplerDefect::OneFork => self.s.fork(0),
            SamplerDefect::NoFork => self.s,
            _ => self.s.fork(key),
        };
        Self { s, ..self }
    }
    fn bits_1d(&self, dim: Dim) -> u32 {
        let bits = self.s.bits_1d(dim);
        match self.defect {
            // F(x) is off by 0.04 at most.
            SamplerDefect::Bent if dim == Dim::TIME => {
                let x = f64::from(bits) / 4_294_967_296.0;
                ((x - 0.16 * x * (1.0 - x)) * 4_294_967_296.0) as u32
            }
            SamplerDefect::Impure if CURSOR.fetch_add(1, Ordering::Relaxed) % 1000 == 999 => !bits,
            _ => bits,
        }
    }
    fn get_1d(&self, dim: Dim) -> f32 {
        let bits = self.bits_1d(dim);
        // The well-known slip: 2³² − 1 rounds to 2³².
        if self.defect == SamplerDefect::One { bits as f32 / 4_294_967_296.0 } else { unit_f32(bits) }
    }
    fn get_2d(&self, dim: Dim) -> Vec2 {
        let p = self.s.get_2d(dim);
        match self.defect {
            SamplerDefect::Squared => Vec2::new((p.x * p.x * 16_777_216.0).floor() / 16_777_216.0, p.y),
            SamplerDefect::Diagonal => Vec2::splat(p.x),
            // A correlation of 0.07 in one pair alone.
            SamplerDefect::Correlated
                if dim == Dim::bounce(1, Slot::Bsdf)
                    && self.s.get_1d(Dim::bounce(999, Slot::Spare0)) < 0.07 =>
            {
                Vec2::splat(p.x)
            }
            SamplerDefect::OneStream => self.first.get_2d(dim),
            SamplerDefect::One => Vec2::new(self.get_1d(dim), self.get_1d(dim.next())),
            _ => p,
        }
    }
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("wrong sampler");
        f.u64(self.seed);
    }
}

fn sampler_check<S: Sampler>(make: fn(u64) -> S, defect: SamplerDefect, b: &Budget) -> Outcome {
    let of = |seed: u64| {
        let s = make(if defect == SamplerDefect::SeedsInPairs { seed / 2 } else { seed });
        WrongSampler { s, first: s, seed, defect }
    };
    check_sampler(&of, b)
}

fn independent(seed: u64) -> Independent {
    Independent::new(seed, 16)
}

fn sobol(seed: u64) -> Sobol {
    Sobol::new(seed, 16)
}

/// Power: Bent, Correlated and samples drawn twice are what `check_sampler` says it just sees; the others are far larger.
/// Sobol points drawn twice are still better than independent ones, so nothing is said of them.
fn sampler_mutants() -> Vec<Case<'static>> {
    let mut out = Vec::new();
    let mut add = |name: &str, defect, by: &'static [&'static str]| {
        out.push(mutant(&format!("independent: {name}"), by, move |b| sampler_check(independent, defect, b)));
        out.push(mutant(&format!("sobol: {name}"), by, move |b| sampler_check(sobol, defect, b)));
    };
    add("first of a pair squared", SamplerDefect::Squared, &["pair"]);
    add("distribution off by 0.04", SamplerDefect::Bent, &["uniform"]);
    add("second of a pair is the first", SamplerDefect::Diagonal, &["pair"]);
    add("a correlation of 0.07", SamplerDefect::Correlated, &["pair"]);
    add("get_2d ignores the stream", SamplerDefect::OneStream, &["pair"]);
    add("one draw in 1000 is impure", SamplerDefect::Impure, &["pure", "bits", "bounce", "fork"]);
    add("1 is possible", SamplerDefect::One, &["range", "bits"]);
    add("forks ignore the key", SamplerDefect::OneFork, &["fork"]);
    add("a fork is its origin", SamplerDefect::NoFork, &["fork"]);
    add("seeds 2k and 2k + 1 are equal", SamplerDefect::SeedsInPairs, &["seeds"]);
    out.push(mutant("independent: some samples drawn twice", &["error"], |b| {
        sampler_check(independent, SamplerDefect::IndicesInPairs, b)
    }));
    out.push(mutant("independent: seeds 2k and 2k + 1 are one sampler", &["fingerprint"], |b| {
        check_sampler(&|seed| independent(seed / 2), b)
    }));
    out
}

fn true_samplers() -> Vec<Case<'static>> {
    vec![
        Case::new("independent", |b: &Budget| sampler_check(independent, SamplerDefect::None, b)),
        Case::new("sobol", |b: &Budget| sampler_check(sobol, SamplerDefect::None, b)),
    ]
}

#[derive(Clone, Copy, PartialEq)]
enum CameraDefect {
    None,
    LensHidden,
    NotUnit,
    NanAtLensEdge,
    NanAtLensCorner,
    NanAtLensMiddle,
}

/// A camera with a lens and a defect.
struct WrongCamera {
    camera: Perspective,
    defect: CameraDefect,
}

impl Camera for WrongCamera {
    fn resolution(&self) -> UVec2 {
        self.camera.resolution()
    }
    fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Option<CameraSample> {
        let mut s = self.camera.ray(film, lens, time)?;
        let broken = match self.defect {
            CameraDefect::NanAtLensEdge => lens.x == 0.0,
            CameraDefect::NanAtLensCorner => lens == Vec2::ZERO,
            // The concentric map of a square to a disc divides 0 by 0 there.
            CameraDefect::NanAtLensMiddle => lens == Vec2::splat(0.5),
            _ => false,
        };
        if broken {
            s.ray.o = Vec3A::NAN;
        }
        if self.defect == CameraDefect::NotUnit {
            s.ray.d *= 1.0001;
        }
        Some(s)
    }
    fn needs(&self) -> Needs {
        if self.defect == CameraDefect::LensHidden { Needs::empty() } else { self.camera.needs() }
    }
}

fn camera_check(defect: CameraDefect, b: &Budget) -> Outcome {
    let (eye, size) = (Vec3A::new(1.0, 2.0, 3.0), UVec2::new(32, 20));
    let camera = Perspective::look_at(eye, Vec3A::ZERO, Vec3A::Y, 40.0, size);
    let camera = camera.and_then(|c| c.with_lens(0.1, 3.0)).expect("a camera");
    check_camera(&WrongCamera { camera, defect }, b)
}

/// Power: no chance but in the positions; 5000 rays, 700 of them through the corners of the lens's square.
fn camera_mutants() -> Vec<Case<'static>> {
    let kinds: [(&str, CameraDefect, &'static [&'static str]); 5] = [
        ("lens not declared", CameraDefect::LensHidden, &["lens"]),
        ("direction 0.01 % too long", CameraDefect::NotUnit, &["ray"]),
        ("NaN where the lens is (0, y)", CameraDefect::NanAtLensEdge, &["ray", "pure"]),
        ("NaN where the lens is (0, 0)", CameraDefect::NanAtLensCorner, &["ray", "pure"]),
        ("NaN where the lens is (½, ½)", CameraDefect::NanAtLensMiddle, &["ray", "pure"]),
    ];
    kinds
        .map(|(name, defect, by)| mutant(&format!("camera: {name}"), by, move |b| camera_check(defect, b)))
        .into()
}

fn true_cameras() -> Vec<Case<'static>> {
    vec![Case::new("thin lens", |b: &Budget| camera_check(CameraDefect::None, b))]
}

#[derive(Clone, Copy, PartialEq)]
enum ShapeDefect {
    None,
    Area,
    Density,
    Crowded,
    NormalLong,
    NormalTilted,
    NormalTiltedInPlaces,
    NoErrorBound,
    UnitLengths,
}

/// A shape with a defect.
struct WrongShape<T> {
    shape: T,
    defect: ShapeDefect,
}

impl<T: Shape> Shape for WrongShape<T> {
    fn bounds(&self) -> Aabb {
        self.shape.bounds()
    }
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        if self.defect != ShapeDefect::UnitLengths || !ray.is_valid() {
            return self.shape.intersect(ray);
        }
        let length = etendue_core::vector::length(ray.d);
        let unit = Ray { d: ray.d / length, ..*ray };
        self.shape.intersect(&unit)
    }
    fn surface(&self, ray: &Ray, hit: &ShapeHit) -> Surface {
        let mut s = self.shape.surface(ray, hit);
        match self.defect {
            ShapeDefect::NormalLong => s.ng *= 1.001,
            // The shading frame stays true: it may differ from the geometric normal. Rays that leave at a grazing
            // angle are mostly the first to notice.
            ShapeDefect::NormalTilted => {
                s.ng = etendue_core::vector::normalize(s.ng + s.shading.x * 0.2);
            }
            ShapeDefect::NormalTiltedInPlaces if hit.uv.x < 0.02 => {
                s.ng = etendue_core::vector::normalize(s.ng + s.shading.x * 0.1);
            }
            ShapeDefect::NoErrorBound => (s.p, s.p_err) = (ray.at(hit.t), Vec3A::ZERO),
            _ => {}
        }
        s
    }
    fn area(&self) -> f32 {
        self.shape.area() * if self.defect == ShapeDefect::Area { 1.05 } else { 1.0 }
    }
    fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        // Density 1 / (1 + a (1 − 2x)): 20 % off (rms) for a = 0.35.
        let bent = Vec2::new(u.x + 0.35 * u.x * (1.0 - u.x), u.y);
        let mut s = self.shape.sample(if self.defect == ShapeDefect::Crowded { bent } else { u })?;
        match self.defect {
            ShapeDefect::Area => s.pdf_area /= 1.05,
            ShapeDefect::Density => s.pdf_area *= 1.05,
            _ => {}
        }
        Some(s)
    }
}

fn shape_check(defect: ShapeDefect, round: bool, b: &Budget) -> Outcome {
    if round {
        let shape = Sphere::new(Vec3A::new(3.0, -2.0, 1.0), 0.7).expect("has a radius");
        return check_shape(&WrongShape { shape, defect }, b);
    }
    // It fills a third of its bounds' silhouette.
    let edge = Vec3A::new(0.0, 0.8, 0.6);
    let shape = Parallelogram::new(Vec3A::new(3.0, -2.0, 1.0), Vec3A::X, edge).expect("has an area");
    check_shape(&WrongShape { shape, defect }, b)
}

/// Power: an area 5 % off, a density 20 % (rms) off and a normal 0.1 off on 2 % of it are what `check_shape` says it just sees.
fn shape_mutants() -> Vec<Case<'static>> {
    let kinds: [(&str, ShapeDefect, &'static [&'static str]); 8] = [
        ("area 5 % too large", ShapeDefect::Area, &["area"]),
        ("density of samples 5 % too large", ShapeDefect::Density, &["density"]),
        ("samples crowd by 20 % (rms)", ShapeDefect::Crowded, &["distribution"]),
        ("normal 0.1 % too long", ShapeDefect::NormalLong, &["frame"]),
        ("normal off by 0.2", ShapeDefect::NormalTilted, &["normal", "self-hit", "endless"]),
        ("normal off by 0.1 on 2 %", ShapeDefect::NormalTiltedInPlaces, &["normal", "self-hit", "endless"]),
        ("no error bound", ShapeDefect::NoErrorBound, &["self-hit"]),
        ("t in metres", ShapeDefect::UnitLengths, &["non-unit"]),
    ];
    let mut out = Vec::new();
    for (name, defect, by) in kinds {
        out.push(mutant(&format!("sphere: {name}"), by, move |b| shape_check(defect, true, b)));
        out.push(mutant(&format!("parallelogram: {name}"), by, move |b| shape_check(defect, false, b)));
    }
    out
}

fn true_shapes() -> Vec<Case<'static>> {
    vec![
        Case::new("sphere", |b: &Budget| shape_check(ShapeDefect::None, true, b)),
        Case::new("parallelogram", |b: &Budget| shape_check(ShapeDefect::None, false, b)),
    ]
}

fn mutants() -> Vec<Case<'static>> {
    [sampler_mutants(), camera_mutants(), shape_mutants()].into_iter().flatten().collect()
}

fn true_parts() -> Vec<Case<'static>> {
    [true_samplers(), true_cameras(), true_shapes()].into_iter().flatten().collect()
}

#[test]
fn wrong_parts_are_rejected() {
    reject(&mutants(), FIVE, 1.0);
}

#[test]
fn true_parts_are_accepted() {
    accept(&true_parts(), FIVE, 1.0);
}

#[test]
#[ignore = "minutes"]
fn wrong_parts_over_a_hundred_seeds() {
    reject(&mutants(), MANY, 1.0);
}

#[test]
#[ignore = "minutes"]
fn true_parts_over_a_hundred_seeds() {
    accept(&true_parts(), MANY, 1.0);
}
