use std::path::Path;

use etendue::io::{Limits, read_film, read_picture};

use crate::error::CliError;

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

/// Films are checked against their own length, and are large.
pub(crate) fn film_limits() -> Limits {
    Limits { file_bytes: u64::MAX, ..Limits::default() }
}
