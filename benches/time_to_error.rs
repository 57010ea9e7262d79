//! Run time against error on the built-in scenes: `cargo bench --bench time_to_error`.
//!
//! For each scene a reference is rendered, then the samplers and the ways to find direct light race, in turns. The
//! columns are the fall of relMSE with the samples, seconds to an error that all reach, and efficiency
//! against the first contender, which runs twice: what it differs from itself by is noise. All with 95 % intervals.
//! For files and for more, see `etendue bench`.

use std::error::Error;

use etendue::SystemClock;
use etendue::measure::{
    Axis, Budget, Clocks, Contender, Curve, Estimator, Measured, Metric, Reference, RenderRun, race,
};
use etendue::prelude::*;
use etendue::scene::presets::{Preset, cornell_box, empty_cornell_box, veach_mis};

const RUNS: u64 = 5;

/// How much work it is: all of it, or just enough to see that it runs.
struct Effort {
    size: UVec2,
    reference_spp: u32,
    budget: Budget,
}

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo bench` says so; `cargo test --benches` does not.
    let effort = if std::env::args().any(|a| a == "--bench") {
        let budget = Budget { spp: 256, seconds: Some(4.0) };
        Effort { size: UVec2::new(96, 72), reference_spp: 8192, budget }
    } else {
        Effort { size: UVec2::new(8, 6), reference_spp: 16, budget: Budget { spp: 2, seconds: None } }
    };
    for (name, preset) in
        [("empty box", empty_cornell_box()), ("cornell box", cornell_box()), ("veach mis", veach_mis())]
    {
        println!("{name}, {}x{} pixels, {RUNS} runs each", effort.size.x, effort.size.y);
        measure(preset, &effort)?;
        println!();
    }
    Ok(())
}

fn measure(preset: Preset, effort: &Effort) -> Result<(), Box<dyn Error>> {
    let Preset { builder, eye, target, vertical_fov_deg } = preset;
    let scene = builder.build()?;
    let camera = Perspective::look_at(eye, target, Vec3A::Y, vertical_fov_deg, effort.size)?;
    let mis = PathTracer::default();
    let lights = PathTracer { direct: DirectLight::Light, ..mis };
    let chance = PathTracer { direct: DirectLight::Bsdf, ..mis };

    let mut film = Film::new(effort.size, 4)?;
    let sampler = Sobol::new(u64::MAX, effort.reference_spp).with_replicates(4);
    render(&scene, &camera, &mis, sampler, &mut film, &RenderOptions::default())?;
    let reference = Reference::from_film(&film).ok_or("the reference has no replicates")?;

    let sobol = |seed| move |spp| Sobol::new(seed, spp);
    let mut field = [
        contender("Sobol, MIS", 0, |seed| RenderRun::new(&scene, &camera, &mis, sobol(seed)))?,
        contender("the same again", RUNS, |seed| RenderRun::new(&scene, &camera, &mis, sobol(seed)))?,
        contender("independent, MIS", 0, |seed| {
            RenderRun::new(&scene, &camera, &mis, move |spp| Independent::new(seed, spp))
        })?,
        contender("stratified, MIS", 0, |seed| {
            RenderRun::new(&scene, &camera, &mis, move |spp| Stratified::new(seed, spp)).map(RenderRun::anew)
        })?,
        contender("Sobol, lights", 0, |seed| RenderRun::new(&scene, &camera, &lights, sobol(seed)))?,
        contender("Sobol, BSDF", 0, |seed| RenderRun::new(&scene, &camera, &chance, sobol(seed)))?,
    ];
    let clock = SystemClock::default();
    let clocks = Clocks { wall: &clock, cpu: None };
    let curves = race(&mut field, Some(&reference), &effort.budget, clocks, &())?;
    show(&curves, reference.residual.relative);
    Ok(())
}

fn contender<'a, S: Sampler + 'a>(
    name: &str,
    first_seed: u64,
    run: impl Fn(u64) -> Result<RenderRun<'a, S>, etendue::camera::FilmError>,
) -> Result<Contender<'a>, etendue::camera::FilmError> {
    let runs: Result<Vec<_>, _> = (first_seed..first_seed + RUNS)
        .map(|seed| run(seed).map(|r| Box::new(r) as Box<dyn Estimator + 'a>))
        .collect();
    Ok(Contender { name: name.into(), runs: runs? })
}

fn show(curves: &[Curve], residual: f64) {
    let errors = curves.iter().map(|c| Some(c.points.last()?.corrected(Metric::Relative)?.value));
    let target = errors.flatten().fold(0.0, f64::max);
    let seconds = format!("s to {target:.2e}");
    println!(
        "{:18} {:>5} {:>10} {:>24} {seconds:>24} {:>24}",
        "", "spp", "relMSE", "slope", "efficiency ratio"
    );
    let Some(first) = curves.first() else { return };
    for c in curves {
        let Some(last) = c.points.last() else { continue };
        let error = last.error(Metric::Relative).map_or(f64::NAN, |m| m.value);
        let ratio =
            c.last_common(first).and_then(|(a, b)| a.efficiency_over(b, Metric::Relative, Axis::Seconds));
        println!(
            "{:18} {:>5} {error:>10.3e} {:>24} {:>24} {:>24}",
            c.name,
            last.spp,
            text(c.slope(Metric::Relative, Axis::Samples)),
            text(c.to_error(Metric::Relative, target, Axis::Seconds).map(|t| t.cost)),
            text(ratio),
        );
    }
    println!("the reference's own relMSE: {residual:.1e}");
}

fn text(m: Option<Measured>) -> String {
    match m {
        None => "-".into(),
        Some(Measured { value, interval: None }) => format!("{value:.3}"),
        Some(Measured { value, interval: Some([low, high]) }) => {
            format!("{value:.3} [{low:.3}, {high:.3}]")
        }
    }
}
