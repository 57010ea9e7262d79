use crate::ResolveError;

/// Why an IES file is not a lamp.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IesError {
    /// The file itself cannot be read.
    #[error(transparent)]
    File(#[from] ResolveError),
    /// A line that cannot be understood. `line` counts from 1.
    #[error("{file}, line {line}: {what}")]
    Line {
        /// The file.
        file: String,
        /// The line.
        line: usize,
        /// What is wrong and what to do.
        what: String,
    },
}
