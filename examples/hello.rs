//! The main job: a picture of the built-in scene, or of any OBJ file.
//!
//! `cargo run --release --example hello` writes `cornell.png`;
//! `cargo run --release --example hello -- model.obj` writes `model.png` and `model.exr`.
//! Options: `--size N` (pixels a side), `--spp N`, `--out FOLDER`.

use std::error::Error;
use std::path::{Path, PathBuf};

use etendue::SystemClock;
use etendue::camera::Planes;
use etendue::io::{self, ExrInfo, Limits, ToneMap};
use etendue::prelude::*;

struct Options {
    model: Option<PathBuf>,
    size: u32,
    spp: u32,
    out: PathBuf,
}

fn options() -> Result<Options, Box<dyn Error>> {
    let mut o = Options { model: None, size: 256, spp: 128, out: ".".into() };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or(format!("{arg} needs a value"));
        match arg.as_str() {
            "--size" => o.size = value()?.parse()?,
            "--spp" => o.spp = value()?.parse()?,
            "--out" => o.out = value()?.into(),
            _ if arg.starts_with('-') => return Err(format!("unknown option {arg}").into()),
            _ => o.model = Some(arg.into()),
        }
    }
    Ok(o)
}

fn main() -> Result<(), Box<dyn Error>> {
    let o = options()?;
    let size = UVec2::splat(o.size);
    match &o.model {
        None => {
            let p = etendue::scene::presets::cornell_box();
            let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, size)?;
            let film = picture(&p.builder.build()?, &camera, o.spp, Planes::default())?;
            save(&o.out.join("cornell.png"), |to| io::write_png(to, &film, &ToneMap::default()))
        }
        Some(path) => {
            let mut b = SceneBuilder::new();
            let report = io::obj::load(path, &Limits::default(), &mut b)?;
            for warning in &report.warnings {
                eprintln!("warning: {warning}");
            }
            // OBJ files carry no camera and seldom a light.
            let camera = io::fallback::camera(&b.bounds(), size)?;
            if b.has_no_light() {
                io::fallback::light(&mut b);
            }
            let film = picture(&b.build()?, &camera, o.spp, Planes::ALL)?;
            let name = path.file_stem().ok_or("the model has no name")?;
            let to = o.out.join(name);
            save(&to.with_extension("png"), |to| io::write_png(to, &film, &ToneMap::default()))?;
            save(&to.with_extension("exr"), |to| io::write_exr(to, &film, &ExrInfo::default()))
        }
    }
}

fn picture(scene: &Scene, camera: &dyn Camera, spp: u32, planes: Planes) -> Result<Film, Box<dyn Error>> {
    let clock = SystemClock::default();
    let mut film = Film::with_planes(camera.resolution(), 1, planes)?;
    let options = RenderOptions { clock: Some(&clock), ..RenderOptions::default() };
    let report = render(scene, camera, &PathTracer::default(), Sobol::new(1, spp), &mut film, &options)?;
    println!("scene: {}", scene.report());
    println!(
        "{} samples, {} rays in {:.2} s; {} samples rejected",
        report.samples,
        report.counts.rays(),
        report.seconds.unwrap_or(0.0),
        report.rejected
    );
    Ok(film)
}

fn save(to: &Path, write: impl Fn(&Path) -> Result<(), io::WriteError>) -> Result<(), Box<dyn Error>> {
    write(to)?;
    println!("wrote {}", to.display());
    Ok(())
}
