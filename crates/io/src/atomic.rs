use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Why a picture is not on disk. The target is then as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The system refused.
    #[error("'{path}' cannot be written: {source}")]
    Io {
        /// The target.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The encoder refused.
    #[error("'{path}' cannot be encoded: {reason}")]
    Encode {
        /// The target.
        path: PathBuf,
        /// The encoder's reason.
        reason: String,
    },
}

/// Writes a file so that the target is either what it was or all of `bytes`: into a new file beside it, flushed to
/// the disk, then renamed.
///
/// # Errors
/// [`WriteError::Io`]; no temporary file is left behind.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    write_with(path, |out| out.write_all(bytes))
}

/// As [`write_atomically`], for what is too large to be made in memory first.
pub(crate) fn write_with(
    path: &Path,
    put: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), WriteError> {
    static COUNTER: AtomicU64 = AtomicU64::new(0);
    let fail = |source| WriteError::Io { path: path.into(), source };
    let name = path.file_name().ok_or_else(|| fail(std::io::ErrorKind::InvalidInput.into()))?;
    let mut beside = std::ffi::OsString::from(".");
    beside.push(name);
    beside.push(format!(".{}.{}.part", std::process::id(), COUNTER.fetch_add(1, Ordering::Relaxed)));
    let temporary = path.with_file_name(beside);
    let written = File::options()
        .write(true)
        .create_new(true)
        .open(&temporary)
        .and_then(|file| {
            let mut out = BufWriter::new(file);
            put(&mut out)?;
            out.flush()?;
            out.get_ref().sync_all()
        })
        .and_then(|()| fs::rename(&temporary, path));
    if let Err(source) = written {
        // Best effort: the error that matters is the first.
        let _ = fs::remove_file(&temporary);
        return Err(fail(source));
    }
    sync_folder(path);
    Ok(())
}

/// Flushes the folder's entry, so that the new name survives a power cut. The target is complete already, and not
/// every file system can do this: a refusal is no error.
fn sync_folder(path: &Path) {
    #[cfg(unix)]
    {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if let Ok(folder) = File::open(folder) {
            let _ = folder.sync_all();
        }
    }
    #[cfg(not(unix))]
    let _ = path;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn target_is_old_or_new_and_nothing_is_left() {
        let dir = std::env::temp_dir().join(format!("etendue-atomic-{}", std::process::id()));
        fs::create_dir_all(&dir).unwrap();
        let target = dir.join("a.bin");
        write_atomically(&target, b"one").unwrap();
        write_atomically(&target, b"two").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"two");
        // A folder in the way: the rename fails, the folder stays, no temporary file is left.
        let blocked = dir.join("b");
        fs::create_dir_all(blocked.join("inner")).unwrap();
        assert!(write_atomically(&blocked, b"x").is_err());
        assert!(write_atomically(&dir.join("missing/c"), b"x").is_err());
        let left: Vec<_> = fs::read_dir(&dir).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(left.len(), 2, "{left:?}");
        fs::remove_dir_all(&dir).unwrap();
    }
}
