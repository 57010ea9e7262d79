//! A scene that someone exported: a `.glb` or `.gltf` file into PNG and EXR.
//!
//! `cargo run --release --example gltf -- scene.glb` writes `scene.png` and `scene.exr`; without a name it takes
//! `examples/data/features.gltf`. Options: `--size N` (pixels, the longer side), `--spp N`, `--out FOLDER`.

use std::error::Error;
use std::path::PathBuf;

use etendue::io::{self, ExrInfo, LoadOptions, ToneMap};
use etendue::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let mut file = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/data/features.gltf"));
    let (mut longest, mut spp, mut out) = (640u32, 64, PathBuf::from("."));
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or(format!("{arg} needs a value"));
        match arg.as_str() {
            "--size" => longest = value()?.parse()?,
            "--spp" => spp = value()?.parse()?,
            "--out" => out = value()?.into(),
            _ => file = arg.into(),
        }
    }

    let mut b = SceneBuilder::new();
    let loaded = io::load_scene(&file, &LoadOptions::default(), &mut b)?;
    for warning in &loaded.report.warnings {
        eprintln!("warning: {warning}");
    }
    if b.has_no_light() {
        io::fallback::light(&mut b);
    }
    // The first camera of the file, in its own shape; or one that sees everything.
    let aspect = loaded.cameras.first().and_then(|c| c.aspect).unwrap_or(1.5);
    let side = |part: f32| ((longest as f32 * part.min(1.0)).round() as u32).max(1);
    let size = UVec2::new(side(aspect), side(1.0 / aspect));
    let camera: Box<dyn Camera> = match loaded.cameras.first() {
        Some(c) => c.at_size(size)?,
        None => Box::new(io::fallback::camera(&b.bounds(), size)?),
    };
    let scene = b.build()?;
    println!("{}: {}", file.display(), scene.report());

    let mut film = Film::with_planes(size, 1, Planes::ALL)?;
    let options = RenderOptions::default();
    render(&scene, &*camera, &PathTracer::default(), Sobol::new(1, spp), &mut film, &options)?;
    let to = out.join(file.file_stem().ok_or("the scene has no name")?);
    io::write_png(&to.with_extension("png"), &film, &ToneMap::default())?;
    io::write_exr(&to.with_extension("exr"), &film, &ExrInfo::default())?;
    println!("wrote {} and the same as .exr", to.with_extension("png").display());
    Ok(())
}
