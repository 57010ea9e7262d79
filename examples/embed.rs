//! A program that brings its own parts: a BSDF with its material, a shape, a light, a sampler and an integrator.
//! Nothing of the workspace is touched; everything enters by the traits the built-in parts use.
//!
//! `cargo run --release --example embed` writes `embed.png`. Options: `--size N`, `--spp N`, `--out FOLDER`.

use std::error::Error;
use std::sync::atomic::{AtomicU64, Ordering};

use etendue::core::{Aabb, Fingerprint, math, vector};
use etendue::io::{self, ToneMap};
use etendue::light::{LightBounds, LightSample, LitPoint};
use etendue::prelude::*;
use etendue::sampling::{unit_f32, warp};

/// A velvet-like BSDF: Lambert, darker where light or eye graze less. Reciprocal, and never brighter than Lambert.
#[derive(Clone, Copy)]
struct Velvet {
    albedo: Spectrum,
}

impl Velvet {
    fn shade(wo: Vec3A, wi: Vec3A) -> f32 {
        1.0 - 0.8 * (wo.z * wi.z).abs()
    }
}

impl Bsdf for Velvet {
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION | Lobes::DIFFUSE | Lobes::RECIPROCAL
    }

    fn eval(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> Spectrum {
        if wo.z * wi.z <= 0.0 {
            return Spectrum::BLACK;
        }
        self.albedo * (Self::shade(wo, wi) * wi.z.abs() * std::f32::consts::FRAC_1_PI)
    }

    fn pdf(&self, wo: Vec3A, wi: Vec3A, _mode: Mode) -> f32 {
        if wo.z * wi.z > 0.0 { wi.z.abs() * std::f32::consts::FRAC_1_PI } else { 0.0 }
    }

    fn sample(&self, wo: Vec3A, _u_lobe: f32, u: Vec2, _mode: Mode) -> Option<BsdfSample> {
        let mut wi = warp::cosine(u);
        if wo.z < 0.0 {
            wi.z = -wi.z;
        }
        let pdf = wi.z.abs() * std::f32::consts::FRAC_1_PI;
        (pdf > 0.0 && wo.z != 0.0).then(|| BsdfSample {
            wi,
            weight: self.albedo * Self::shade(wo, wi),
            pdf,
            lobe: Lobes::REFLECTION | Lobes::DIFFUSE,
            eta: 1.0,
        })
    }

    fn at(&self) -> BsdfAt<'_> {
        BsdfAt::Ref(self)
    }
}

/// The material around it: the same everywhere.
struct VelvetMaterial(Velvet);

impl Material for VelvetMaterial {
    fn bsdf<'a>(&'a self, _at: &Surface) -> BsdfAt<'a> {
        self.0.at()
    }
}

/// A disc of radius 1 in the xz plane around `center`, facing up.
struct Disc {
    center: Vec3A,
}

impl Shape for Disc {
    fn bounds(&self) -> Aabb {
        let r = Vec3A::new(1.0, 0.0, 1.0);
        Aabb { lo: self.center - r, hi: self.center + r }
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let t = (self.center.y - ray.o.y) / ray.d.y;
        let p = ray.at(t) - self.center;
        let inside = p.x * p.x + p.z * p.z <= 1.0;
        (ray.accepts(t) && inside).then_some(ShapeHit { t, uv: Vec2::new(p.x, p.z) })
    }

    fn surface(&self, _ray: &Ray, hit: &ShapeHit) -> Surface {
        // Rebuilt from the parameters, the point lies in the plane exactly; x and z are rounded once.
        let p = self.center + Vec3A::new(hit.uv.x, 0.0, hit.uv.y);
        Surface::new(p, p.abs() * f32::EPSILON, Vec3A::Y)
    }
}

/// A light at infinity that fills a cone of directions, like the sun through haze.
struct Haze {
    toward: Frame,
    one_minus_cos: f32,
    radiance: Spectrum,
}

impl Haze {
    fn holds(&self, d: Vec3A) -> bool {
        1.0 - d.dot(self.toward.z) < self.one_minus_cos
    }
}

impl Light for Haze {
    fn sample(&self, _at: &LitPoint, _part: u32, u: Vec2) -> Option<LightSample> {
        let wi = self.toward.to_world(warp::cone(u, self.one_minus_cos));
        self.holds(wi).then(|| LightSample {
            wi,
            li: self.radiance,
            pdf: warp::cone_pdf(self.one_minus_cos),
            end: None,
            is_delta: false,
        })
    }

    fn pdf(&self, _at: &LitPoint, _part: u32, wi: Vec3A, _seen: Option<&Surface>) -> f32 {
        if self.holds(wi) { warp::cone_pdf(self.one_minus_cos) } else { 0.0 }
    }

    fn power(&self, _part: u32, scene_radius: f32) -> Spectrum {
        let solid_angle = std::f32::consts::TAU * self.one_minus_cos;
        self.radiance * (solid_angle * std::f32::consts::PI * scene_radius * scene_radius)
    }

    fn bounds(&self, _part: u32) -> Option<LightBounds> {
        None
    }

    fn escaped(&self, ray: &Ray) -> Spectrum {
        if self.holds(ray.d) { self.radiance } else { Spectrum::BLACK }
    }

    fn is_infinite(&self) -> bool {
        true
    }
}

/// A sampler: the golden-ratio sequence in every dimension, shifted by a hash (Cranley & Patterson 1976).
#[derive(Clone, Copy)]
struct Golden {
    seed: u64,
    spp: u32,
    stream: u64,
    index: u64,
}

impl Golden {
    fn hash(&self, dim: u32) -> u32 {
        let mut h = self.seed ^ self.stream.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (u64::from(dim) << 40);
        h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (h >> 32) as u32
    }
}

impl Sampler for Golden {
    fn spp(&self) -> u32 {
        self.spp
    }

    fn start(self, stream: u64, index: u64) -> Self {
        Self { stream, index, ..self }
    }

    fn fork(self, key: u32) -> Self {
        Self { seed: self.seed ^ (u64::from(key) << 32 | 1), ..self }
    }

    fn bits_1d(&self, dim: Dim) -> u32 {
        // A different odd multiplier for every dimension keeps pairs from lying on one line.
        let step = 0x9e37_79b9u32.wrapping_mul(2 * dim.index() + 1) | 1;
        (self.index as u32).wrapping_mul(step).wrapping_add(self.hash(dim.index()))
    }

    fn get_2d(&self, dim: Dim) -> Vec2 {
        let shift = self.hash(dim.index());
        let x = (self.index as u32).wrapping_mul(0xc13f_a9a9).wrapping_add(shift);
        let y = (self.index as u32).wrapping_mul(0x91e1_0da5).wrapping_add(self.hash(dim.index() + 1));
        Vec2::new(unit_f32(x), unit_f32(y))
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("golden");
        f.u64(self.seed);
    }
}

/// An integrator: the path tracer's picture, faded to blue with the distance of the first surface.
struct Foggy(PathTracer);

impl<S: Sampler> Integrator<S> for Foggy {
    fn li(&self, cx: &Context<'_>, s: &CameraSample, u: S, rec: &mut dyn Recorder) -> Sample {
        let mut out = self.0.li(cx, s, u, rec);
        if let Some(hit) = cx.scene.intersect(&s.ray, 0) {
            out.l = out.l.lerp(Spectrum::rgb(0.3, 0.45, 0.7), 1.0 - math::exp(-0.04 * hit.t));
        }
        out
    }

    fn bias(&self) -> Vec<String> {
        vec!["fog: a look, not light transport".into()]
    }
}

/// Prints every tenth part of the work; would stop it after ten billion samples.
#[derive(Default)]
struct Tenths(AtomicU64);

impl Progress for Tenths {
    fn update(&self, done: u64, total: u64) {
        let tenth = 10 * done / total.max(1);
        if self.0.fetch_max(tenth, Ordering::Relaxed) < tenth {
            eprint!(" {}%", 10 * tenth);
        }
    }

    fn cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed) > 10_000_000_000
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut size, mut spp, mut out) = (256, 64, std::path::PathBuf::from("."));
    let args: Vec<String> = std::env::args().skip(1).collect();
    for pair in args.chunks(2) {
        match pair {
            [key, v] if key == "--size" => size = v.parse()?,
            [key, v] if key == "--spp" => spp = v.parse()?,
            [key, v] if key == "--out" => out = v.into(),
            _ => return Err(format!("unknown option {pair:?}").into()),
        }
    }

    let mut b = SceneBuilder::new();
    let ground = b.material(Diffuse::new(Spectrum::gray(0.5)));
    let velvet = b.material(VelvetMaterial(Velvet { albedo: Spectrum::rgb(0.7, 0.1, 0.2) }));
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y)?, ground);
    b.add(Sphere::new(Vec3A::new(0.0, 0.7, 0.0), 0.7)?, velvet);
    b.add(Geometry::open(Disc { center: Vec3A::new(1.2, 1.4, -1.5) }), velvet);
    b.light(Haze {
        toward: Frame::from_normal(vector::normalize(Vec3A::new(-1.0, 1.2, 0.6))),
        one_minus_cos: 0.01,
        radiance: Spectrum::rgb(60.0, 55.0, 45.0),
    });
    b.light(ConstantEnvironment::new(Spectrum::rgb(0.15, 0.2, 0.3)));
    let scene = b.build()?;

    let camera =
        Perspective::look_at(Vec3A::new(1.5, 1.6, 4.0), Vec3A::Y * 0.7, Vec3A::Y, 40.0, UVec2::splat(size))?;
    let mut film = Film::new(UVec2::splat(size), 1)?;
    let progress = Tenths::default();
    let options = RenderOptions { progress: &progress, ..RenderOptions::default() };
    let sampler = Golden { seed: 7, spp, stream: 0, index: 0 };
    let report = render(&scene, &camera, &Foggy(PathTracer::default()), sampler, &mut film, &options)?;
    eprintln!();

    let to = out.join("embed.png");
    io::write_png(&to, &film, &ToneMap::default())?;
    println!("wrote {} ({:?}; biased by: {})", to.display(), report.ended, report.bias.join(", "));
    Ok(())
}
