//! One picture from many machines: each renders some of the samples, and the sum has the bits of the undivided render.
//!
//! `cargo run --release --example film_merge` writes `film_merge-0.film` and so on, one from each machine, and
//! `film_merge.png`. Options: `--size N` (pixels a side), `--spp N`, `--machines N`, `--out FOLDER`.

use std::error::Error;
use std::ops::Range;
use std::path::PathBuf;

use etendue::core::Fingerprint;
use etendue::io::{self, Digest, FilmFile, FilmInfo, IndexRanges, Limits, ToneMap};
use etendue::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut size, mut spp, mut machines, mut out) = (256u32, 64u32, 4u32, PathBuf::from("."));
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or(format!("{arg} needs a value"));
        match arg.as_str() {
            "--size" => size = value()?.parse()?,
            "--spp" => spp = value()?.parse()?,
            "--machines" => machines = value()?.parse()?,
            "--out" => out = value()?.into(),
            _ => return Err(format!("unknown option {arg}").into()),
        }
    }
    // A machine without a sample would have nothing to say.
    let machines = machines.clamp(1, spp.max(1));

    let p = etendue::scene::presets::cornell_box();
    let size = UVec2::splat(size);
    let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, size)?;
    let scene = p.builder.build()?;
    let (sampler, integrator) = (Sobol::new(1, spp), PathTracer::default());
    let part = |name: &str, samples: Range<u64>| -> Result<FilmFile, Box<dyn Error>> {
        let mut film = Film::with_planes(size, 1, Planes::ALL)?;
        let options = RenderOptions { samples: Some(samples.clone()), ..RenderOptions::default() };
        render(&scene, &camera, &integrator, sampler, &mut film, &options)?;
        // What decides the picture goes into the file, so that parts of other pictures are told apart.
        let mut settings = Fingerprint::default();
        camera.fingerprint(&mut settings);
        Integrator::<Sobol>::fingerprint(&integrator, &mut settings);
        sampler.fingerprint(&mut settings);
        options.filter.fingerprint(&mut settings);
        let info = FilmInfo {
            scene: Digest::from(&scene.fingerprint()),
            settings: Digest::from(&settings),
            words: [("seed".into(), "1".into())].into(),
            samples: IndexRanges::from(samples),
        };
        Ok(FilmFile::new(name, info, film)?)
    };

    // Each machine's share, in a file of its own.
    let cut = |machine: u32| u64::from(spp) * u64::from(machine) / u64::from(machines);
    let files: Vec<PathBuf> = (0..machines).map(|m| out.join(format!("film_merge-{m}.film"))).collect();
    for (file, m) in files.iter().zip(0..) {
        let share = part("", cut(m)..cut(m + 1))?;
        io::write_film(file, &share)?;
        println!("machine {m} drew the samples {} into {}", share.info().samples, file.display());
    }

    // The last comes first: the order does not matter.
    let read = |file: &PathBuf| io::read_film(file, &Limits::default());
    let mut merged = read(files.last().ok_or("no machine")?)?;
    for file in files.iter().rev().skip(1) {
        merged = merged.merge(&read(file)?)?;
    }
    let undivided = part("undivided", 0..u64::from(spp))?;
    assert!(merged == undivided, "the sum of the parts differs from the whole");
    println!("merged: the samples {}, bit for bit those of the undivided render", merged.info().samples);

    // A part that is already in would weigh twice.
    match merged.clone().merge(&read(&files[0])?) {
        Ok(_) => return Err("a part was added twice".into()),
        Err(e) => println!("once more is refused: {e}"),
    }
    let to = out.join("film_merge.png");
    io::write_png(&to, merged.film(), &ToneMap::default())?;
    println!("wrote {}", to.display());
    Ok(())
}
