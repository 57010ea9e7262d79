use std::path::Path;

use etendue::core::UVec2;
use etendue::io::{Limits, read_film, read_picture};
use etendue::measure::{Reference, Residual};
use serde_json::Value;

use crate::error::CliError;
use crate::session::say;

/// Linear pixels of a picture or a film.
pub(crate) struct Pixels {
    pub(crate) size: [u32; 2],
    pub(crate) rgb: Vec<[f32; 3]>,
}

pub(crate) fn is_film(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("film"))
}

/// Reads a picture, or the means of a film.
pub(crate) fn read(path: &Path) -> Result<Pixels, CliError> {
    if is_film(path) {
        let film = read_film(path, &film_limits())?;
        let size = film.film().size();
        return Ok(Pixels { size: [size.x, size.y], rgb: film.film().to_rgb() });
    }
    let picture = read_picture(path, &Limits::default())?;
    Ok(Pixels { size: [picture.width, picture.height], rgb: picture.rgb })
}

/// What is right, and how wrong it may be: a film tells by its replicates, a picture by the file beside it that
/// `etendue reference` writes.
pub(crate) fn reference(path: &Path) -> Result<Reference, CliError> {
    let reference = read_reference(path)?;
    let bad = reference.rgb.iter().filter(|p| p.iter().any(|c| !c.is_finite())).count();
    if bad == reference.rgb.len() {
        return Err(CliError::Usage(format!("'{}' has no pixel that is a number", path.display())));
    }
    if bad > 0 {
        say(&format!("warning: {bad} pixels of '{}' are no numbers; they are left out", path.display()));
    }
    Ok(reference)
}

fn read_reference(path: &Path) -> Result<Reference, CliError> {
    let name = path.display();
    if is_film(path) {
        let film = read_film(path, &film_limits())?;
        if let Some(r) = Reference::from_film(film.film()) {
            return Ok(r);
        }
        say(&format!(
            "warning: '{name}' has one replicate and does not tell its own error; it is taken for 0"
        ));
        let size = film.film().size().to_array();
        return Ok(Reference::exact(size, film.film().to_rgb()));
    }
    let Pixels { size, rgb } = read(path)?;
    let beside = path.with_extension("json");
    if !beside.is_file() {
        say(&format!("warning: nothing is known of the error of '{name}'; it is taken for 0"));
        return Ok(Reference::exact(size, rgb));
    }
    let limits = Limits { file_bytes: 1 << 20, ..Limits::default() };
    let refuse = |why: String| CliError::Usage(format!("'{}': {why}", beside.display()));
    let bytes = etendue::io::read_bytes(&beside, &limits).map_err(|e| refuse(e.to_string()))?;
    let facts: Value = serde_json::from_slice(&bytes).map_err(|e| refuse(format!("no JSON: {e}")))?;
    let number = |key: &str| {
        let n = facts.get(key).and_then(Value::as_f64).filter(|n| *n >= 0.0 && n.is_finite());
        n.ok_or_else(|| refuse(format!("'{key}' is missing, or no number that is not below 0")))
    };
    let residual = Residual {
        relative: number("residual_relmse")?,
        trimmed: number("residual_relmse_trim")?,
        absolute: number("residual_rmse")?.powi(2),
    };
    if let Some(mean) = facts.get("mean").and_then(|m| serde_json::from_value::<[f64; 3]>(m.clone()).ok())
        && !is_mean_of(mean, &rgb)
    {
        return Err(refuse(format!(
            "its 'mean' is that of another picture than '{name}'; remove or renew it"
        )));
    }
    Ok(Reference { size, rgb, residual })
}

/// Up to the rounding of 16-bit pixels.
fn is_mean_of(mean: [f64; 3], rgb: &[[f32; 3]]) -> bool {
    (0..3).all(|c| {
        let own = rgb.iter().map(|p| f64::from(p[c])).sum::<f64>() / rgb.len().max(1) as f64;
        // A picture with pixels that are no numbers has no mean to compare.
        !own.is_finite() || (own - mean[c]).abs() <= 1e-3 * own.abs().max(mean[c].abs())
    })
}

/// Whether a picture of this size can be measured against the reference.
pub(crate) fn check_size(reference: &Reference, size: UVec2) -> Result<(), CliError> {
    let [w, h] = reference.size;
    if [w, h] == size.to_array() {
        return Ok(());
    }
    let both = format!("the reference has {w}x{h} pixels and the picture {}x{}", size.x, size.y);
    Err(CliError::Usage(format!("{both}; leave '--size' out or write --size {w}x{h}")))
}

/// Films are checked against their own length, and are large.
pub(crate) fn film_limits() -> Limits {
    Limits { file_bytes: u64::MAX, ..Limits::default() }
}
