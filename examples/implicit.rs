//! A shape of your own: surfaces given as f(p) = 0, beside the library's.
//!
//! `cargo run --release --example implicit` writes `implicit.png`: a ball and a ring that melt into each other, and a
//! ball cut from a gyroid, which is no distance but has a slope that is known.
//! Options: `--size N` (pixels a side), `--spp N`, `--out FOLDER`. The shape itself is in `implicit/shape.rs`.

#[path = "implicit/shape.rs"]
mod shape;

use std::error::Error;
use std::path::PathBuf;

use etendue::core::glam::DVec3;
use etendue::io::{self, ToneMap};
use etendue::prelude::*;
use shape::{Implicit, distance};

struct Options {
    size: u32,
    spp: u32,
    out: PathBuf,
}

fn options() -> Result<Options, Box<dyn Error>> {
    let mut o = Options { size: 256, spp: 64, out: ".".into() };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let value = args.next().ok_or(format!("{arg} needs a value"))?;
        match arg.as_str() {
            "--size" => o.size = value.parse()?,
            "--spp" => o.spp = value.parse()?,
            "--out" => o.out = value.into(),
            _ => return Err(format!("unknown option {arg}").into()),
        }
    }
    Ok(o)
}

/// A ball through a ring, melted together.
fn melted(p: DVec3) -> f64 {
    let ring = distance::torus(p, DVec3::new(-0.8, 0.25, 0.0), 0.55, 0.2);
    let ball = distance::ball(p, DVec3::new(-0.8, 0.75, 0.1), 0.35);
    distance::blend(ring, ball, 0.3)
}

/// A ball cut from a gyroid's walls.
fn cut(p: DVec3) -> f64 {
    let center = DVec3::new(0.75, 0.7, 0.0);
    distance::gyroid(p - center, 9.0, 0.35).max(distance::ball(p, center, 0.65))
}

fn main() -> Result<(), Box<dyn Error>> {
    let o = options()?;
    let mut b = SceneBuilder::new();
    let gray = b.material(Diffuse::new(Spectrum::gray(0.6)));
    let red = b.material(Diffuse::new(Spectrum::rgb(0.7, 0.25, 0.15)));
    let gold = b.material(Metal::gold(0.25));
    b.add(Plane::new(Vec3A::ZERO, Vec3A::Y)?, gray);
    let (lo, hi) = (Vec3A::new(-1.6, 0.0, -0.8), Vec3A::new(0.0, 1.15, 0.8));
    b.add(Geometry::open(Implicit::new(lo, hi, 1.0, melted)), gold);
    let (lo, hi) = (Vec3A::new(0.05, 0.0, -0.7), Vec3A::new(1.45, 1.4, 0.7));
    b.add(Geometry::open(Implicit::new(lo, hi, 1.0, cut)), red);
    let lamp = b.add(Disc::new(Vec3A::new(0.5, 3.0, 1.5), Vec3A::new(-0.2, -1.0, -0.5), 0.7)?, gray);
    b.emit(lamp, Emission::new(Spectrum::gray(12.0)));
    b.light(ConstantEnvironment::new(Spectrum::rgb(0.3, 0.35, 0.45)));
    let scene = b.build()?;
    let eye = Vec3A::new(0.2, 1.8, 4.0);
    let camera = Perspective::look_at(eye, Vec3A::new(0.0, 0.55, 0.0), Vec3A::Y, 36.0, UVec2::splat(o.size))?;
    let mut film = Film::new(camera.resolution(), 1)?;
    render(
        &scene,
        &camera,
        &PathTracer::default(),
        Sobol::new(1, o.spp),
        &mut film,
        &RenderOptions::default(),
    )?;
    let to = o.out.join("implicit.png");
    io::write_png(&to, &film, &ToneMap::default())?;
    println!("wrote {}", to.display());
    Ok(())
}
