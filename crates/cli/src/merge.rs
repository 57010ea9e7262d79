use etendue::io::{FilmFile, read_film};

use crate::args::MergeArgs;
use crate::error::CliError;
use crate::outputs::{self, Written};
use crate::picture::film_limits;
use crate::session::{print, say};

pub(crate) fn run(args: &MergeArgs) -> Result<(), CliError> {
    let outputs = outputs::check(&args.output)?;
    let mut merged: Option<FilmFile> = None;
    for path in &args.parts {
        // One part at a time beside the sum: memory does not grow with their number.
        let part = read_film(path, &film_limits())?;
        merged = Some(match merged {
            None => part,
            Some(sum) => sum.merge(&part)?,
        });
    }
    // The parser asks for at least one.
    let Some(whole) = merged else { return Err(CliError::Usage("name at least one film".into())) };
    if whole.info().is_opaque() {
        say(
            "warning: not every part of the scene describes itself; that the films show the same one is not proved",
        );
    }
    let bias = bias_of(whole.info().words.get("bias"));
    let what = Written {
        film: whole.film(),
        whole: Some(&whole),
        info: whole.info(),
        bias: &bias,
        tone: outputs::tone(args.exposure, args.tone_map),
    };
    for output in &outputs {
        if !outputs::write(output, &what)? {
            let help = "the films hold no samples";
            return Err(CliError::Usage(format!("'{}' was not written: {help}", output.path.display())));
        }
        print(&format!("{}: samples {}", output.path.display(), whole.info().samples))?;
    }
    Ok(())
}

/// The biased options that a film's words name.
fn bias_of(word: Option<&String>) -> Vec<String> {
    word.filter(|w| *w != "none").map(|w| w.split("; ").map(str::to_owned).collect()).unwrap_or_default()
}
