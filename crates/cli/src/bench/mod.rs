//! `etendue bench`: error against time, contenders in turns.

mod contenders;
mod json;
mod maps;
mod page;
mod summary;
mod table;

use std::path::{Path, PathBuf};

use etendue::SystemClock;
use etendue::core::UVec2;
use etendue::io::write_atomically;
use etendue::measure::{Budget, Clocks, Reference, race};
use serde_json::json;

use crate::args::{BenchArgs, Ready};
use crate::error::CliError;
use crate::outputs::{check_distinct, check_place, write_json};
use crate::session::{CpuClock, Interrupt, in_pool, print, say};
use crate::{picture, prepare, render};
use summary::SceneResult;

/// Samples per pixel where nobody says how many.
const SPP: u64 = 64;
/// As many as no time is enough for.
const UNLIMITED: u64 = 1 << 30;

pub(crate) fn run(args: &BenchArgs) -> Result<(), CliError> {
    check_distinct(args.html.iter().chain(&args.json))?;
    for path in args.html.iter().chain(&args.json) {
        check_place(path)?;
    }
    if args.spp.is_none() && args.time.is_some() {
        // Its longest run is the last alone, and all before it together take as long again.
        for sampler in args.sampler.iter().filter(|s| s.divides()) {
            say(&format!("note: '{}' begins anew at every number of samples", sampler.word()));
        }
    }
    let interrupt = Interrupt::listen();
    let mut results = Vec::new();
    let done = in_pool(args.method.threads, || {
        for scene in &args.scenes {
            let result = measure(args, scene, &interrupt)?;
            let lines = table::lines(&result);
            results.push(result);
            lines.iter().try_for_each(|line| print(line))?;
            print("")?;
            if interrupt.requested() {
                break;
            }
        }
        Ok(())
    });
    // What a scene took hours to tell is not lost with the one after it.
    if results.is_empty() {
        return done;
    }
    let mut written = Vec::new();
    if let Some(path) = &args.json {
        let scenes: Vec<_> = results.iter().map(json::value).collect();
        let report = json!({
            "program": format!("etendue {}", env!("CARGO_PKG_VERSION")),
            "command": command(),
            "scenes": scenes,
        });
        write_json(path, &report)?;
        written.push(path.display().to_string());
    }
    if let Some(path) = &args.html {
        write_atomically(path, page::html(&results, &command())?.as_bytes())?;
        written.push(path.display().to_string());
    }
    if interrupt.requested() {
        let files = if written.is_empty() { "nothing".into() } else { written.join(", ") };
        return Err(CliError::Interrupted(format!("written with what had been measured: {files}")));
    }
    done
}

/// The command line as it was given, for a shell to read again.
fn command() -> String {
    let words = std::env::args_os().skip(1).map(|w| quoted(&w.to_string_lossy()));
    std::iter::once("etendue".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./:=,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// What is right for a scene: the file that was named, or the one in the folder that is called like the scene.
fn reference_of(args: &BenchArgs, scene: &Path) -> Result<Option<(String, Reference)>, CliError> {
    let Some(named) = &args.reference else { return Ok(None) };
    let file: PathBuf = if named.is_dir() {
        let stem = render::stem_of(scene);
        let found = ["film", "exr", "hdr"].iter().map(|e| named.join(&stem).with_extension(e));
        match found.into_iter().find(|p| p.is_file()) {
            Some(file) => file,
            None => {
                let stem = stem.to_string_lossy();
                let there = format!("there is no '{stem}.film', '{stem}.exr' or '{stem}.hdr'");
                return Err(CliError::Usage(format!("'--reference {}': {there}", named.display())));
            }
        }
    } else if args.scenes.len() > 1 {
        let cure = "name a folder with one reference for each scene";
        return Err(CliError::Usage(format!("'--reference {}': {cure}", named.display())));
    } else {
        named.clone()
    };
    let reference = picture::reference(&file)?;
    Ok(Some((file.file_name().unwrap_or_default().to_string_lossy().into_owned(), reference)))
}

fn measure(args: &BenchArgs, path: &Path, interrupt: &Interrupt) -> Result<SceneResult, CliError> {
    let reference = reference_of(args, path)?;
    let size = reference.as_ref().map(|(_, r)| UVec2::from(r.size));
    let stopped = || CliError::Interrupted("nothing was measured yet".into());
    let prepared = match prepare::load(path, &args.view, size, interrupt) {
        Err(_) if interrupt.requested() => return Err(stopped()),
        loaded => loaded?,
    };
    let mut warnings = prepared.warnings.clone();
    warnings.dedup();
    warnings.iter().for_each(|w| say(&format!("warning: {w}")));
    let built = match prepare::build(prepared, path, interrupt) {
        Err(_) if interrupt.requested() => return Err(stopped()),
        built => built?,
    };
    let size = built.prepared.camera.resolution();
    if let Some((_, r)) = &reference {
        picture::check_size(r, size)?;
    }
    let entries = contenders::entries(args);
    let ready = entries.iter().map(|e| e.method.on(&built.scene)).collect::<Result<Vec<_>, _>>()?;
    let mut field = entries
        .iter()
        .zip(&ready)
        .map(|(e, r)| contenders::contender(e, r, args.runs, args.method.filter, &built, interrupt))
        .collect::<Result<Vec<_>, _>>()?;
    let unlimited = if args.time.is_some() { UNLIMITED } else { SPP };
    let budget = Budget { spp: args.spp.map_or(unlimited, u64::from), seconds: args.time };
    let (wall, cpu) = (SystemClock::default(), CpuClock::start());
    let clocks = Clocks { wall: &wall, cpu: cpu.as_ref().map(|c| c as _) };
    let curves = race(&mut field, reference.as_ref().map(|(_, r)| r), &budget, clocks, interrupt)?;
    // A run that was stopped has more samples than its last point, and not in every pixel.
    let whole = field.iter().filter(|_| !interrupt.requested());
    let pictures = whole.map(|c| c.runs.first().map_or_else(Vec::new, |r| r.picture())).collect();
    Ok(SceneResult {
        name: built.prepared.scene_name.clone(),
        size: size.to_array(),
        runs: args.runs,
        threads: rayon::current_num_threads(),
        reference,
        curves,
        bias: ready.iter().map(Ready::bias).collect(),
        pictures,
        warnings,
    })
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn commands_can_be_given_again() {
        for (word, want) in
            [("a/b.glb", "a/b.glb"), ("my box.glb", "'my box.glb'"), ("", "''"), ("it's", "'it'\\''s'")]
        {
            assert_eq!(quoted(word), want);
        }
    }
}
