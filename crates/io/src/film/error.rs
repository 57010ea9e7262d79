use std::ops::Range;

use etendue_camera::{FilmError, MergeError};

use crate::ResolveError;

/// Why a `.film` file is not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmReadError {
    /// The file itself cannot be opened or is too large.
    #[error(transparent)]
    File(#[from] ResolveError),
    /// The system failed while reading.
    #[error("{file}: reading stopped at byte {at}: {source}")]
    Io {
        /// The file.
        file: String,
        /// Where.
        at: u64,
        /// The system's reason.
        source: std::io::Error,
    },
    /// Another kind of file.
    #[error(
        "{file}: not a film; films begin with the bytes 89 'ETFILM' 0a and are written by 'render -o NAME.film'"
    )]
    Magic {
        /// The file.
        file: String,
    },
    /// A film of another time.
    #[error(
        "{file}: film format {found}, and this program reads {known}; render it again or use the program that wrote it"
    )]
    Version {
        /// The file.
        file: String,
        /// Its version.
        found: u32,
        /// The version read here.
        known: u32,
    },
    /// Bytes that are not what was written.
    #[error("{file}, byte {at}: the block '{block}' is damaged ({what}); use an earlier copy")]
    Damaged {
        /// The file.
        file: String,
        /// Where the block begins.
        at: u64,
        /// Which block.
        block: &'static str,
        /// What does not hold.
        what: &'static str,
    },
    /// A length that the file does not have.
    #[error("{file}: {found} bytes long where its header asks for {expected}; it was cut off or damaged")]
    Length {
        /// The file.
        file: String,
        /// Bytes that are there.
        found: u64,
        /// Bytes that the header implies, as far as they can be counted.
        expected: u64,
    },
    /// Numbers that do not make a film.
    #[error("{file}: {source}")]
    Film {
        /// The file.
        file: String,
        /// The reason.
        source: FilmError,
    },
    /// Sums that do not belong to the indices named.
    #[error("{file}: {source}")]
    Samples {
        /// The file.
        file: String,
        /// The reason.
        source: SamplesError,
    },
    /// More memory than can be had.
    #[error("{file}: {bytes} bytes of sums do not fit in memory")]
    Memory {
        /// The file.
        file: String,
        /// What was asked for.
        bytes: u64,
    },
}

/// Why film and indices do not belong together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SamplesError {
    /// A pixel with more or fewer samples than the indices.
    #[error(
        "pixel ({x}, {y}), replicate {replicate} holds {found} samples where the sample indices {samples} make {expected}; keep whole passes only"
    )]
    Count {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// Replicate.
        replicate: u32,
        /// Samples it holds.
        found: u64,
        /// Samples that the indices make.
        expected: u64,
        /// The indices.
        samples: String,
    },
    /// A surface seen by a sample that is not there.
    #[error(
        "pixel ({x}, {y}) names the surface of sample {index}, which is not among the sample indices {samples}"
    )]
    Ids {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// The index.
        index: u64,
        /// The indices.
        samples: String,
    },
}

/// Why two films are not parts of one picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FilmMergeError {
    /// Different scenes.
    #[error("{a} and {b} show different scenes{words}; render both from the same files")]
    Scene {
        /// One file.
        a: String,
        /// The other.
        b: String,
        /// What differs in words, in brackets; may be empty.
        words: String,
    },
    /// Different camera, integrator, sampler or filter.
    #[error("{a} and {b} were rendered differently ({words}); render both with the same settings")]
    Settings {
        /// One file.
        a: String,
        /// The other.
        b: String,
        /// What differs.
        words: String,
    },
    /// The same samples twice.
    #[error("{a} and {b} both hold the samples {}..{}; each sample may be added once only", .range.start, .range.end)]
    Overlap {
        /// One file.
        a: String,
        /// The other.
        b: String,
        /// The first range that both have.
        range: Range<u64>,
    },
    /// Different size, replicates or planes.
    #[error("{a} and {b}: {source}")]
    Film {
        /// One file.
        a: String,
        /// The other.
        b: String,
        /// The difference.
        source: MergeError,
    },
}
