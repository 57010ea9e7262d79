//! `etendue render`.

mod curve;
mod sampling;
mod settings;
mod work;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use etendue::core::UVec2;
use etendue::integrator::Ended;
use etendue::io::{FilmFile, read_film};
use etendue::measure::Reference;

use crate::args::RenderArgs;
use crate::error::CliError;
use crate::outputs::{self, Output, Written};
use crate::picture::{self, film_limits};
use crate::prepare::{self, Built};
use crate::report::RenderReport;
use crate::session::{Interrupt, Stopwatch, in_pool, print, say};
pub(crate) use settings::Settings;
use work::{Outcome, Work};

pub(crate) fn run(args: &RenderArgs) -> Result<(), CliError> {
    render(args)?.interrupted.map_or(Ok(()), Err)
}

/// What was rendered and written.
pub(crate) struct Rendered {
    pub(crate) outcome: Outcome,
    /// That it was stopped, if it was.
    pub(crate) interrupted: Option<CliError>,
}

/// Does everything and gives what came out.
pub(crate) fn render(args: &RenderArgs) -> Result<Rendered, CliError> {
    let Some((scene, reference)) = args.scene_and_reference() else {
        return Err(CliError::Usage("name a scene".into()));
    };
    let outputs = outputs::check(&wanted(args, scene))?;
    outputs::check_distinct(args.output.iter().chain(&args.json).chain(&args.curve))?;
    for path in args.json.iter().chain(&args.curve) {
        outputs::check_place(path)?;
    }
    if args.curve.is_some() && (args.resume.is_some() || args.shard.is_some()) {
        let why = "a curve begins with the first sample";
        return Err(CliError::Usage(format!("{why}; leave '--resume' and '--shard' out beside '--curve'")));
    }
    let settings = Settings::of(args)?;
    let reference = reference.map(|path| picture::reference(path)).transpose()?;
    if args.curve.is_some() && reference.is_none() {
        let cure = "name a picture with '--reference REF' beside '--curve'";
        return Err(CliError::Usage(format!("there is nothing to measure against; {cure}")));
    }
    let interrupt = Interrupt::listen();
    let job = Job {
        args,
        path: scene,
        settings: &settings,
        outputs: &outputs,
        reference: reference.as_ref(),
        interrupt: &interrupt,
    };
    in_pool(args.method.threads, || job.run())
}

/// The outputs named, or the one that is written where none is.
fn wanted(args: &RenderArgs, scene: &Path) -> Vec<PathBuf> {
    if !args.output.is_empty() {
        return args.output.clone();
    }
    vec![PathBuf::from(stem_of(scene)).with_extension("png")]
}

/// The name of a scene without folder and ending; a built-in scene's own name.
pub(crate) fn stem_of(scene: &Path) -> OsString {
    let name = scene.file_stem().unwrap_or_default();
    let own = name.to_str().and_then(|n| n.rsplit(':').next()).map(OsString::from);
    own.unwrap_or_else(|| name.to_owned())
}

/// One render, all flags checked.
struct Job<'a> {
    args: &'a RenderArgs,
    path: &'a Path,
    settings: &'a Settings,
    outputs: &'a [Output],
    reference: Option<&'a Reference>,
    interrupt: &'a Interrupt,
}

impl Job<'_> {
    fn run(&self) -> Result<Rendered, CliError> {
        let Self { args, path, settings, outputs, reference, interrupt } = *self;
        let mut watch = Stopwatch::start();
        // Read first: a film that is damaged should not cost the time to load a scene.
        let resumed: Option<FilmFile> =
            args.resume.as_ref().map(|path| read_film(path, &film_limits())).transpose()?;
        let nothing = || CliError::Interrupted("nothing was rendered or written yet".into());
        let size = reference.map(|r| UVec2::from(r.size));
        let mut prepared = match prepare::load(path, &args.view, size, interrupt) {
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
        let Built { scene, prepared } = match prepare::build(prepared, path, interrupt) {
            Err(_) if interrupt.requested() => return Err(nothing()),
            built => built?,
        };
        if let Some(r) = reference {
            picture::check_size(r, prepared.camera.resolution())?;
        }
        let build = watch.lap();

        let work = Work {
            scene: &scene,
            camera: &*prepared.camera,
            settings,
            integrator: &settings.method.on(&scene)?,
            words: settings.words(&prepared),
            outputs,
            interrupt,
            curve: args.curve.as_deref().zip(reference),
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
        if let Some(json) = &args.json {
            let report = RenderReport {
                scene: path.display().to_string(),
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
            outputs::write_json(json, &report.json())?;
        }
        let spp = outcome.info.samples.count();
        if outcome.totals.ended == Ended::Cancelled {
            let what = if written.is_empty() {
                "nothing was written: no pass was finished".to_owned()
            } else {
                format!("written with {spp} whole samples per pixel: {}", written.join(", "))
            };
            return Ok(Rendered { outcome, interrupted: Some(CliError::Interrupted(what)) });
        }
        for path in &written {
            print(&format!("{path}: {spp} samples per pixel in {:.2} s", render.wall))?;
        }
        if written.len() < outputs.len() {
            return Err(CliError::Usage("some outputs were not written: there are no samples".into()));
        }
        Ok(Rendered { outcome, interrupted: None })
    }
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
