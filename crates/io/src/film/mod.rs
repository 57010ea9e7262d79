//! The `.film` format: a film with every bit of its sums, and the knowledge of which samples are in it.
//!
//! A film file holds whole passes only: each pixel has exactly the samples of [`FilmInfo::samples`]. A render that
//! was stopped in the middle of a pass has more samples of some pixels; whoever wants to go on later keeps a film of
//! whole passes beside it: render range after range, each into a fresh film, and merge a range when its
//! `Report::complete` covers it. The price of stopping is the unfinished range, never a wrong sum.
//!
//! Layout, all little-endian: eight magic bytes, a version (u32), then blocks of tag (4 bytes), payload length (u64),
//! CRC-32 of both and the payload (u32), payload. First one `INFO`, then the vectors of the film in a fixed order
//! (sums, counts, albedo, normal, depth, hits, alpha, ids) in blocks of at most 65,536 entries, then an empty `END `.
//! The whole length follows from `INFO` and is compared with the file before memory is asked for. Equal films give
//! equal bytes.

mod error;
mod info;
mod layout;
mod merge;
mod ranges;
mod read;
mod write;

use etendue_camera::Film;

pub use error::{FilmMergeError, FilmReadError, SamplesError};
pub use info::{Digest, FilmInfo};
pub use ranges::IndexRanges;
pub use read::{read_film, read_film_bytes};
pub use write::{film_bytes, write_film};

/// A film with what it was made of: what a `.film` file holds.
#[derive(Clone, Debug)]
pub struct FilmFile {
    info: FilmInfo,
    film: Film,
    /// Which file brought which samples, so that an overlap can be named.
    origins: Vec<Origin>,
}

#[derive(Clone, Debug)]
struct Origin {
    name: String,
    samples: IndexRanges,
}

impl PartialEq for FilmFile {
    /// Names do not count.
    fn eq(&self, other: &Self) -> bool {
        self.info == other.info && self.film == other.film
    }
}

impl FilmFile {
    /// A film whose every pixel has exactly the samples of `info`. `name` stands for it in messages.
    ///
    /// # Errors
    /// [`SamplesError`], naming the first pixel that has other samples.
    pub fn new(name: impl Into<String>, info: FilmInfo, film: Film) -> Result<Self, SamplesError> {
        check_samples(&film, &info.samples)?;
        let origins = vec![Origin { name: name.into(), samples: info.samples.clone() }];
        Ok(Self { info, film, origins })
    }

    /// What it was made of.
    pub fn info(&self) -> &FilmInfo {
        &self.info
    }

    /// The sums.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// Both, taken apart.
    pub fn into_parts(self) -> (FilmInfo, Film) {
        (self.info, self.film)
    }

    /// The name in messages: that of the first file.
    pub fn name(&self) -> &str {
        self.origins.first().map_or("", |o| o.name.as_str())
    }
}

fn check_samples(film: &Film, samples: &IndexRanges) -> Result<(), SamplesError> {
    let (view, replicates, width) = (film.view(), film.replicates(), film.size().x as usize);
    let expected: Vec<u64> = (0..replicates).map(|k| samples.count_of_replicate(k, replicates)).collect();
    let place = |pixel: usize| {
        let at = |v: Option<usize>| v.unwrap_or(0) as u32;
        [at(pixel.checked_rem(width)), at(pixel.checked_div(width))]
    };
    for (pixel, counts) in view.counts.chunks_exact(expected.len().max(1)).enumerate() {
        for (replicate, (&found, &expected)) in (0..).zip(counts.iter().zip(&expected)) {
            if found != expected {
                let ([x, y], samples) = (place(pixel), samples.to_string());
                return Err(SamplesError::Count { x, y, replicate, found, expected, samples });
            }
        }
    }
    for (pixel, seen) in view.ids.iter().enumerate() {
        if let Some((index, _)) = *seen
            && !samples.contains(index)
        {
            let ([x, y], samples) = (place(pixel), samples.to_string());
            return Err(SamplesError::Ids { x, y, index, samples });
        }
    }
    Ok(())
}
