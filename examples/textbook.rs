//! The experiments of a textbook's chapters on Monte Carlo ray tracing and importance sampling, with numbers.
//!
//! `cargo run --release --example textbook -- mis` writes `textbook-mis.png` and prints a table. The names are `samples`
//! (Fig. 15.3), `stratified` (15.4), `direct` (16.1), `mis` (16.3) and `bounces` (15.2); without one all are made.
//! Options: `--size N` (pixels, the width of a panel), `--spp N` (of the references), `--out FOLDER`.
//! `docs/textbook.md` shows what comes out and what it says.

#[path = "textbook/study.rs"]
mod study;

use std::path::PathBuf;

use etendue::prelude::*;
use etendue::scene::presets;
use study::{Outcome, Study, View};

const NAMES: [&str; 5] = ["samples", "stratified", "direct", "mis", "bounces"];

fn main() -> Outcome<()> {
    let (mut size, mut spp, mut out, mut names) = (128, 2048, PathBuf::from("."), Vec::new());
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or(format!("{arg} needs a value"));
        match arg.as_str() {
            "--size" => size = value()?.parse::<u32>()?.max(4),
            "--spp" => spp = value()?.parse::<u32>()?.max(1),
            "--out" => out = value()?.into(),
            name if NAMES.contains(&name) => names.push(arg),
            _ => return Err(format!("{arg} is none of {NAMES:?}").into()),
        }
    }
    if names.is_empty() {
        names = NAMES.map(String::from).to_vec();
    }
    let picture = |bounces| {
        let way = path(DirectLight::MisPower, bounces);
        View::new(presets::cornell_box(), UVec2::splat(size), way, spp)
    };
    // Most are about one picture, whose reference is rendered once.
    let mut full = None;
    for name in names {
        if full.is_none() && name != "mis" {
            full = Some(picture(None)?);
        }
        let to = out.join(format!("textbook-{name}.png"));
        match (name.as_str(), &full) {
            ("samples", Some(full)) => samples(full)?.report(Some(&to))?,
            ("stratified", Some(full)) => {
                stratified(&picture(Some(1))?, Some(1))?.report(Some(&to))?;
                stratified(full, None)?.report(None)?;
            }
            ("direct", Some(full)) => direct(full)?.report(Some(&to))?,
            ("bounces", Some(full)) => bounces(full)?.report(Some(&to))?,
            _ => {
                let size = UVec2::new(size, size * 3 / 4);
                let way = path(DirectLight::MisPower, Some(1));
                mis(&View::new(presets::veach_mis(), size, way, spp)?)?.report(Some(&to))?;
            }
        }
    }
    Ok(())
}

fn samples(view: &View) -> Outcome<Study<'_>> {
    let mut study = Study::new(
        view,
        "Fig. 15.3: light sampling with 1, 4 and 16 samples a pixel. The variance falls with their number.",
    );
    for spp in [1, 4, 16] {
        study.panel("light sampling", path(DirectLight::Light, None), spp, Independent::new)?;
    }
    Ok(study)
}

/// Of the light that comes from the lamp directly, or of all.
fn stratified(view: &View, bounces: Option<u32>) -> Outcome<Study<'_>> {
    let mut study = Study::new(
        view,
        match bounces {
            Some(_) => {
                "Fig. 15.4: reference, without, with stratified samples (and Sobol's). Stratified is less noisy."
            }
            None => "The same with all bounces.",
        },
    );
    let there = if bounces.is_some() { "shadow" } else { "caustic" };
    study.regions = vec![(there, [0.08, 0.88, 0.35, 0.96]), ("back wall", [0.25, 0.25, 0.75, 0.5])];
    let way = path(DirectLight::Light, bounces);
    study.show(&view.reference);
    for spp in [16, 4, 64] {
        let pictures = [
            study.measure("independent", way, spp, Independent::new)?,
            study.measure("stratified", way, spp, Stratified::new)?,
            study.measure("Sobol", way, spp, Sobol::new)?,
        ];
        if spp == 16 {
            pictures.iter().for_each(|p| study.show(p));
        }
    }
    Ok(study)
}

fn direct(view: &View) -> Outcome<Study<'_>> {
    let mut study = Study::new(
        view,
        "Fig. 16.1: 1, 4, 16 samples a pixel, above without direct illumination, below with. Above is severe noise.",
    );
    study.across = 3;
    for (name, way) in [("paths only", DirectLight::None), ("light sampling", DirectLight::Light)] {
        for spp in [1, 4, 16] {
            study.panel(name, path(way, None), spp, Independent::new)?;
        }
    }
    Ok(study)
}

fn mis(view: &View) -> Outcome<Study<'_>> {
    let mut study = Study::new(
        view,
        "Fig. 16.3: sampling lights, the BSDF, and both with MIS. Each alone fails somewhere, both together nowhere.",
    );
    study.regions = vec![
        ("smooth, large lamp", [0.68, 0.41, 0.77, 0.475]),
        ("rough, small lamp", [0.24, 0.75, 0.31, 0.8]),
    ];
    let ways = [
        ("light sampling", DirectLight::Light),
        ("BSDF sampling", DirectLight::Bsdf),
        ("both, power", DirectLight::MisPower),
    ];
    for (name, way) in ways {
        study.panel(name, path(way, Some(1)), 16, Independent::new)?;
    }
    // Looks the same.
    study.measure("both, balance", path(DirectLight::MisBalance, Some(1)), 16, Independent::new)?;
    Ok(study)
}

fn bounces(view: &View) -> Outcome<Study<'_>> {
    let mut study = Study::new(
        view,
        "Fig. 15.2: emission, then one, two and three bounces (and all of them). Each adds light.",
    );
    let limits = [
        ("emission", Some(0)),
        ("1 bounce", Some(1)),
        ("2 bounces", Some(2)),
        ("3 bounces", Some(3)),
        ("all", None),
    ];
    for (name, limit) in limits {
        study.panel(name, path(DirectLight::MisPower, limit), 64, Sobol::new)?;
    }
    Ok(study)
}

fn path(direct: DirectLight, max_depth: Option<u32>) -> PathTracer {
    PathTracer { direct, max_depth, ..PathTracer::default() }
}
