use std::path::PathBuf;

use etendue::camera::{CameraError, FilmError};
use etendue::integrator::RenderError;
use etendue::io::{
    FilmMergeError, FilmReadError, LoadError, PictureError, PngError, SamplesError, WriteError,
};
use etendue::light::EnvironmentError;
use etendue::measure::{CompareError, MeasureError};
use etendue::scene::SceneError;

/// Why a command did not do what it was asked for.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CliError {
    /// Words that cannot be followed; says what would work.
    #[error("{0}")]
    Usage(String),
    /// Ctrl-C or SIGTERM; says what was written.
    #[error("interrupted; {0}")]
    Interrupted(String),
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error("{path}: the scene cannot be built: {source}")]
    Scene { path: PathBuf, source: SceneError },
    #[error(transparent)]
    Camera(#[from] CameraError),
    #[error("'--env {path}': {source}")]
    Environment { path: PathBuf, source: EnvironmentError },
    #[error("'--env {path}': {source}")]
    EnvironmentFile { path: PathBuf, source: PictureError },
    #[error(transparent)]
    Picture(#[from] PictureError),
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error("{0}; choose a smaller '--size'")]
    Film(#[from] FilmError),
    #[error(transparent)]
    FilmRead(#[from] FilmReadError),
    #[error(transparent)]
    FilmMerge(#[from] FilmMergeError),
    #[error(transparent)]
    Samples(#[from] SamplesError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// A picture for the report.
    #[error("the report: {0}")]
    Png(#[from] PngError),
    #[error(transparent)]
    Measure(#[from] MeasureError),
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Standard output is closed.
    #[error("the result cannot be written to standard output: {0}")]
    Output(#[from] std::io::Error),
    #[error("{0} threads cannot be started: {1}")]
    Threads(usize, rayon::ThreadPoolBuildError),
}

impl CliError {
    /// The exit status: 2 as for flags that make no sense, 130 as a shell does for a process that was interrupted.
    pub(crate) fn status(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Interrupted(_) => 130,
            _ => 1,
        }
    }
}
