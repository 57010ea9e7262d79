//! Measured lamps: IES photometry files (ANSI/IES LM-63, of 1986, 1991, 1995, 2002 and 2019), type C.
//!
//! Intensities are candelas: the table times the file's multiplier, ballast factor and ballast-lamp factor (in a file
//! of 2019 that place says how the file came about, and is no factor). Horizontal angles are 0 (round), 0 to 90,
//! 0 to 180, 90 to 270, or all around with 360 or without it. Tilt tables, in the file or in another, are passed over,
//! which is right for a lamp that hangs as it was measured.
//!
//! ```
//! use etendue_core::{Spectrum, Transform, Vec3A};
//! use etendue_io::{Limits, ies};
//! use etendue_scene::SceneBuilder;
//!
//! # let dir = std::env::temp_dir().join(format!("etendue-ies-{}", std::process::id()));
//! # std::fs::create_dir_all(&dir)?;
//! # let path = dir.join("lamp.ies");
//! # std::fs::write(&path, "IESNA:LM-63-2002\n[TEST] none\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 60\n0 90\n0\n683 0\n")?;
//! let mut b = SceneBuilder::new();
//! let lamp = ies::load(&path, &Limits::default())?;
//! b.light(lamp.light(&Transform::translation(Vec3A::Y * 2.0), Spectrum::ONE));
//! assert_eq!((lamp.keyword("TEST"), lamp.table.max()), (Some("none"), 683.0));
//! assert!(!b.has_no_light());
//! # std::fs::remove_dir_all(&dir)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Through the facade: `etendue::io::ies`, with the feature `ies`.

mod error;
mod numbers;
mod profile;

use std::path::Path;

pub use error::IesError;
pub use profile::IesProfile;

use crate::Limits;
use crate::resolver::read_file;

/// Reads an IES file.
///
/// # Errors
/// [`IesError`], naming the file and the line.
pub fn load(path: &Path, limits: &Limits) -> Result<IesProfile, IesError> {
    let name = path.display().to_string();
    let bytes = read_file(path, &name, limits.file_bytes)?;
    read(&name, &bytes, limits)
}

/// Reads an IES file that is in memory; `name` stands for it in messages. Text that is not UTF-8 is only lost within
/// keywords.
///
/// # Errors
/// As [`load`].
pub fn read(name: &str, bytes: &[u8], limits: &Limits) -> Result<IesProfile, IesError> {
    profile::read(name, bytes, limits)
}
