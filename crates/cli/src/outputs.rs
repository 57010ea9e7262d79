use std::fs::File;
use std::path::{Path, PathBuf};

use etendue::camera::Film;
use etendue::io::{
    ExrInfo, FilmFile, FilmInfo, ToneMap, WriteError, write_atomically, write_exr, write_film, write_hdr,
    write_png,
};

use crate::args::Tone;
use crate::error::CliError;

/// What a file is to hold, by its ending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Exr,
    Png,
    Hdr,
    Film,
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Output {
    pub(crate) path: PathBuf,
    pub(crate) kind: Kind,
}

/// What a picture takes from the render.
pub(crate) struct Written<'a> {
    pub(crate) film: &'a Film,
    /// The film of whole passes; `None` where nobody wanted one.
    pub(crate) whole: Option<&'a FilmFile>,
    pub(crate) info: &'a FilmInfo,
    pub(crate) bias: &'a [String],
    pub(crate) tone: ToneMap,
}

/// The files to be written, each of a known kind and in a folder that takes files: what can go wrong later is known
/// before the work begins.
pub(crate) fn check(paths: &[PathBuf]) -> Result<Vec<Output>, CliError> {
    check_distinct(paths)?;
    let mut out: Vec<Output> = Vec::new();
    for path in paths {
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        let kind = match ending.as_str() {
            "exr" => Kind::Exr,
            "png" => Kind::Png,
            "hdr" => Kind::Hdr,
            "film" => Kind::Film,
            _ => {
                let help = "write a name that ends in .exr, .png, .hdr or .film";
                return Err(CliError::Usage(format!("output '{}': {help}", path.display())));
            }
        };
        check_place(path)?;
        out.push(Output { path: path.clone(), kind });
    }
    Ok(out)
}

/// Refuses two outputs of one name: the later would be all that is left.
pub(crate) fn check_distinct<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), CliError> {
    let mut seen: Vec<&PathBuf> = Vec::new();
    for path in paths {
        if seen.contains(&path) {
            return Err(CliError::Usage(format!("output '{}' is named twice; name it once", path.display())));
        }
        seen.push(path);
    }
    Ok(())
}

/// Whether a file can be written there.
pub(crate) fn check_place(path: &Path) -> Result<(), CliError> {
    let refuse = |why: String| Err(CliError::Usage(format!("output '{}': {why}", path.display())));
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if path.is_dir() {
        return refuse("this is a folder; add a file name".into());
    }
    if !folder.is_dir() {
        return refuse(format!("there is no folder '{}'; create it first", folder.display()));
    }
    let Some(name) = path.file_name() else { return refuse("there is no file name in it".into()) };
    let mut trial = std::ffi::OsString::from(".");
    trial.push(name);
    trial.push(format!(".{}.trial", std::process::id()));
    let trial = path.with_file_name(trial);
    match File::create_new(&trial) {
        Ok(_) => {
            let _ = std::fs::remove_file(&trial);
            Ok(())
        }
        Err(e) => refuse(format!("no file can be written there: {e}")),
    }
}

pub(crate) fn tone(exposure: f32, tone: Tone) -> ToneMap {
    ToneMap { exposure, filmic: tone == Tone::Filmic }
}

/// Writes one file; true where there was something to write.
pub(crate) fn write(output: &Output, what: &Written<'_>) -> Result<bool, WriteError> {
    let path = &output.path;
    match output.kind {
        Kind::Png => write_png(path, what.film, &what.tone)?,
        Kind::Hdr => {
            let mut notes = ExrInfo::of(what.info, Vec::new()).notes;
            notes.push((
                "bias".into(),
                if what.bias.is_empty() { "none".into() } else { what.bias.join("; ") },
            ));
            write_hdr(path, what.film, &notes)?;
        }
        Kind::Exr => write_exr(path, what.film, &ExrInfo::of(what.info, what.bias.to_vec()))?,
        Kind::Film => match what.whole.filter(|w| !w.info().samples.is_empty()) {
            Some(whole) => write_film(path, whole)?,
            None => return Ok(false),
        },
    }
    Ok(true)
}

/// Writes a report.
pub(crate) fn write_json(path: &Path, value: &serde_json::Value) -> Result<(), WriteError> {
    write_atomically(path, format!("{value:#}\n").as_bytes())
}
