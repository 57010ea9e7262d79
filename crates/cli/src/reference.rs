//! `etendue reference`: a render in independent parts whose scatter tells its own error.

use std::path::{Path, PathBuf};

use etendue::camera::Film;
use etendue::core::UVec2;
use etendue::measure::{Reference, Residual};
use serde_json::json;

use crate::args::{MethodArgs, ReferenceArgs, RenderArgs, SamplerName, Tone};
use crate::error::CliError;
use crate::outputs::{check_place, write_json};
use crate::picture::is_film;
use crate::render::{self, Rendered};
use crate::session::print;

/// Independent parts of the point set. Two would do for the whole picture; four also tell of each pixel.
const REPLICATES: u32 = 4;
/// The key by which a file of facts is known.
const RESIDUAL: &str = "residual_relmse";

pub(crate) fn run(args: &ReferenceArgs) -> Result<(), CliError> {
    let output = with_film(args);
    let besides: Vec<PathBuf> =
        output.iter().filter(|p| is_exact(p)).map(|p| p.with_extension("json")).collect();
    for path in &besides {
        check_place(path)?;
        refuse_others(path)?;
        if args.json.as_ref() == Some(path) {
            let why = "is where the picture's own error goes; choose another name for the report";
            return Err(CliError::Usage(format!("'--json {}' {why}", path.display())));
        }
    }
    let there = output.iter().find(|p| is_film(p) && p.exists()).cloned();
    let Rendered { outcome, interrupted } = render::render(&RenderArgs {
        first: Some(args.scene.clone()),
        output,
        spp: args.spp,
        view: args.view.clone(),
        // A render of this seed must not be a part of its own reference: the first replicate is such a render.
        method: MethodArgs { seed: !args.method.seed, ..args.method.clone() },
        integrator: args.integrator.clone(),
        sampler: SamplerName::Sobol,
        reference: Some(None),
        curve: None,
        time: args.time,
        shard: None,
        resume: there,
        json: args.json.clone(),
        exposure: 0.0,
        tone_map: Tone::Clip,
        aov: Vec::new(),
        replicates: REPLICATES,
    })?;
    let film = outcome.picture();
    let Some(reference) = Reference::from_film(film) else {
        // What is said there is of an earlier picture.
        if film.total_samples() > 0 {
            besides.iter().for_each(|path| drop(std::fs::remove_file(path)));
        }
        if let Some(e) = interrupted {
            return Err(e);
        }
        let cure = format!("it needs at least {REPLICATES} samples per pixel");
        return Err(CliError::Usage(format!("the reference does not tell its error yet: {cure}")));
    };
    let spp = outcome.info.samples.count();
    for path in &besides {
        write_json(path, &facts(&args.scene, film, spp, &reference))?;
    }
    let Residual { relative, trimmed, absolute } = reference.residual;
    print(&format!("residual relMSE {relative:.3e}, trimmed {trimmed:.3e}, RMSE {:.3e}", absolute.sqrt()))?;
    interrupted.map_or(Ok(()), Err)
}

/// The outputs, with a film among them.
fn with_film(args: &ReferenceArgs) -> Vec<PathBuf> {
    let mut output = args.output.clone();
    if !output.iter().any(|p| is_film(p)) {
        let beside = output.first().map(|p| p.with_extension("film"));
        let own = || PathBuf::from(render::stem_of(&args.scene)).with_extension("film");
        output.push(beside.unwrap_or_else(own));
    }
    output
}

/// Whether a picture can be a reference again: those of 8 bits cannot, and the rounding of .hdr would pass for bias.
fn is_exact(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr"))
}

/// A file that has the name by chance is not overwritten.
fn refuse_others(path: &Path) -> Result<(), CliError> {
    let ours = |text: String| text.contains(RESIDUAL);
    if path.exists() && !std::fs::read_to_string(path).is_ok_and(ours) {
        let why = "is in the way and holds something else; choose another name for the picture";
        return Err(CliError::Usage(format!("'{}' {why}", path.display())));
    }
    Ok(())
}

/// What is written beside a picture, which cannot tell its error itself.
fn facts(scene: &Path, film: &Film, spp: u64, reference: &Reference) -> serde_json::Value {
    let size = film.size();
    let pixels = f64::from(size.x) * f64::from(size.y);
    let all = (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
    let sum = all.fold([0.0; 3], |sum, p| {
        let l = film.mean(p).to_array();
        [sum[0] + f64::from(l[0]), sum[1] + f64::from(l[1]), sum[2] + f64::from(l[2])]
    });
    let Residual { relative, trimmed, absolute } = reference.residual;
    json!({
        "scene": scene.display().to_string(),
        "by": format!("etendue {}", env!("CARGO_PKG_VERSION")),
        "spp": spp,
        "mean": sum.map(|s| s / pixels),
        RESIDUAL: relative,
        "residual_relmse_trim": trimmed,
        "residual_rmse": absolute.sqrt(),
    })
}
