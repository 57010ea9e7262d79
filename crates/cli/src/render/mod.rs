//! `etendue render`.

mod prepare;
mod sampling;
mod settings;
mod work;

use std::path::PathBuf;

use etendue::integrator::Ended;
use etendue::io::{FilmFile, read_film};

use crate::args::RenderArgs;
use crate::error::CliError;
use crate::outputs::{self, Output, Written};
use crate::picture::film_limits;
use crate::report::RenderReport;
use crate::session::{Interrupt, Stopwatch, print, say};
use settings::Settings;
use work::{Outcome, Work};

pub(crate) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let outputs = outputs::check(&wanted(args))?;
    if let Some(path) = &args.json {
        outputs::check_place(path)?;
    }
    let settings = Settings::of(args)?;
    let interrupt = Interrupt::listen();
    match args.threads {
        None => in_pool(args, &settings, &outputs, &interrupt),
        Some(n) => rayon::ThreadPoolBuilder::new()
            .num_threads(n.0)
            .build()
            .map_err(|e| CliError::Threads(n.0, e))?
            .install(|| in_pool(args, &settings, &outputs, &interrupt)),
    }
}

/// The outputs named, or the one that is written where none is.
fn wanted(args: &RenderArgs) -> Vec<PathBuf> {
    if !args.output.is_empty() {
        return args.output.clone();
    }
    let name = args.scene.file_stem().unwrap_or_default();
    vec![PathBuf::from(name).with_extension("png")]
}

fn in_pool(
    args: &RenderArgs,
    settings: &Settings,
    outputs: &[Output],
    interrupt: &Interrupt,
) -> Result<(), CliError> {
    let mut watch = Stopwatch::start();
    // Read first: a film that is damaged should not cost the time to load a scene.
    let resumed: Option<FilmFile> =
        args.resume.as_ref().map(|path| read_film(path, &film_limits())).transpose()?;
    let nothing = || CliError::Interrupted("nothing was rendered or written yet".into());
    let mut prepared = match prepare::load(args, interrupt) {
        Err(_) if interrupt.requested() => return Err(nothing()),
        loaded => loaded?,
    };
    let load = watch.lap();
    prepared.warnings.dedup();
    for warning in &prepared.warnings {
        say(&format!("warning: {warning}"));
    }
    if interrupt.requested() {
        return Err(nothing());
    }
    let scene = match std::mem::take(&mut prepared.builder).build_with_progress(interrupt) {
        Err(_) if interrupt.requested() => return Err(nothing()),
        built => built.map_err(|source| CliError::Scene { path: args.scene.clone(), source })?,
    };
    let build = watch.lap();

    let work = Work {
        scene: &scene,
        camera: &*prepared.camera,
        settings,
        words: settings.words(&prepared),
        outputs,
        interrupt,
    };
    let outcome = sampling::run(&work, resumed)?;
    let render = watch.lap();
    let mut warnings = prepared.warnings.clone();
    warnings.extend(late_warnings(&outcome));

    let bias = outcome.totals.bias.clone();
    let what = Written {
        film: outcome.picture(),
        whole: outcome.whole(),
        info: &outcome.info,
        bias: &bias,
        tone: outputs::tone(args.exposure, args.tone_map),
    };
    let drawn = what.film.total_samples() > 0;
    let mut written = Vec::new();
    for output in outputs {
        if drawn && outputs::write(output, &what)? {
            written.push(output.path.display().to_string());
        }
    }
    if let Some(path) = &args.json {
        let report = RenderReport {
            scene: args.scene.display().to_string(),
            load,
            build,
            render,
            size: settings.size_of(&prepared).to_array(),
            seed: settings.seed,
            sampler: settings.sampler_word(),
            integrator: settings.integrator_word().into(),
            filter: settings.filter_word(),
            camera: prepared.camera_name.clone(),
            info: &outcome.info,
            totals: &outcome.totals,
            skipped: &prepared.skipped,
            warnings: &warnings,
            outputs: written.clone(),
            threads: rayon::current_num_threads(),
        };
        outputs::write_json(path, &report.json())?;
    }
    let spp = outcome.info.samples.count();
    if outcome.totals.ended == Ended::Cancelled {
        let what = if written.is_empty() {
            "nothing was written: no pass was finished".to_owned()
        } else {
            format!("written with {spp} whole samples per pixel: {}", written.join(", "))
        };
        return Err(CliError::Interrupted(what));
    }
    for path in &written {
        print(&format!("{path}: {spp} samples per pixel in {:.2} s", render.wall))?;
    }
    if written.len() < outputs.len() {
        return Err(CliError::Usage("some outputs were not written: there are no samples".into()));
    }
    Ok(())
}

/// What is known only after the work; told here, each once.
fn late_warnings(outcome: &Outcome) -> Vec<String> {
    let mut out = Vec::new();
    let totals = &outcome.totals;
    if totals.rejected > 0 {
        let places = totals.rejected_at.join(", ");
        out.push(format!("{} samples are no usable numbers and count as black: {places}", totals.rejected));
    }
    if outcome.info.is_opaque() {
        out.push(
            "not every part of the scene describes itself: a film cannot prove that it shows this one".into(),
        );
    }
    if totals.samples == 0 && totals.ended == Ended::Complete {
        out.push("every sample asked for was in the film already".into());
    }
    out.iter().for_each(|w| say(&format!("warning: {w}")));
    out
}
