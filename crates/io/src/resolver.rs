use std::io::Read;
use std::path::{Component, Path, PathBuf};

use crate::Limits;

/// Why a file that a scene names is not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResolveError {
    /// The name is not a plain relative path.
    #[error("'{0}' is not a path below the scene's folder; copy the file there and name it relatively")]
    Outside(String),
    /// The file is not there.
    #[error("'{name}' cannot be opened: {source}")]
    Open {
        /// The name in the scene.
        name: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A device, a pipe, a folder.
    #[error("'{0}' is not a regular file")]
    NotAFile(String),
    /// More than the limit.
    #[error("'{name}' is larger than the limit of {limit} bytes")]
    TooLarge {
        /// The name in the scene.
        name: String,
        /// The limit.
        limit: u64,
    },
}

/// Finds the files that a scene names.
pub trait Resolver {
    /// The bytes of a file, at most `limit` of them.
    ///
    /// # Errors
    /// [`ResolveError`], naming the file.
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, ResolveError>;
}

/// Knows no files: for scenes that must stand alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Resolver for NoFiles {
    fn read(&self, name: &str, _limit: u64) -> Result<Vec<u8>, ResolveError> {
        Err(ResolveError::Outside(name.into()))
    }
}

/// Reads regular files below one folder, and nothing else: no absolute paths, no `..`, no links that lead out.
#[derive(Clone, Debug)]
pub struct FolderResolver {
    root: PathBuf,
}

impl FolderResolver {
    /// Reads below `root`.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// Reads beside a file.
    pub fn beside(file: &Path) -> Self {
        let parent = file.parent().filter(|p| !p.as_os_str().is_empty());
        Self::new(parent.unwrap_or(Path::new(".")))
    }
}

impl Resolver for FolderResolver {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, ResolveError> {
        let outside = || ResolveError::Outside(name.into());
        let open = |source| ResolveError::Open { name: name.into(), source };
        // Exporters on Windows write backslashes.
        let name_here = name.replace('\\', "/");
        let relative = Path::new(&name_here);
        let plain = relative.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
        if !plain || name_here.contains(':') || name_here.contains('\0') || name_here.is_empty() {
            return Err(outside());
        }
        let root = self.root.canonicalize().map_err(open)?;
        let path = root.join(relative).canonicalize().map_err(open)?;
        if !path.starts_with(&root) {
            return Err(outside());
        }
        read_file(&path, name, limit)
    }
}

/// The bytes of a file that the user named, not a scene: anywhere, but regular and within `Limits::file_bytes`.
///
/// # Errors
/// [`ResolveError`], naming the file.
pub fn read_bytes(path: &Path, limits: &Limits) -> Result<Vec<u8>, ResolveError> {
    read_file(path, &path.display().to_string(), limits.file_bytes)
}

/// A regular file of at most `limit` bytes, opened, and its length.
pub(crate) fn open_file(path: &Path, name: &str, limit: u64) -> Result<(std::fs::File, u64), ResolveError> {
    let open = |source| ResolveError::Open { name: name.into(), source };
    // Asked by the path first: opening a pipe would wait for its other end.
    if !std::fs::metadata(path).map_err(open)?.is_file() {
        return Err(ResolveError::NotAFile(name.into()));
    }
    let file = std::fs::File::open(path).map_err(open)?;
    let length = file.metadata().map_err(open)?.len();
    if length > limit {
        return Err(ResolveError::TooLarge { name: name.into(), limit });
    }
    Ok((file, length))
}

/// The bytes of a regular file of at most `limit` bytes; never more is read or allocated than is there.
pub(crate) fn read_file(path: &Path, name: &str, limit: u64) -> Result<Vec<u8>, ResolveError> {
    let open = |source| ResolveError::Open { name: name.into(), source };
    let (file, length) = open_file(path, name, limit)?;
    let mut bytes = Vec::new();
    let room = usize::try_from(length).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(room).map_err(|_| open(std::io::ErrorKind::OutOfMemory.into()))?;
    // The file may grow while it is read; one byte beyond the limit tells.
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(open)?;
    if bytes.len() as u64 > limit {
        return Err(ResolveError::TooLarge { name: name.into(), limit });
    }
    Ok(bytes)
}
