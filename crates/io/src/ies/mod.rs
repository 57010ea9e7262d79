//! Measured lamps: IES photometry files (ANSI/IES LM-63, of 1991, 1995, 2002 and 2019), type C.
//!
//! Intensities are candelas: the table times the file's multiplier, ballast factor and ballast-lamp factor. A tilt table
//! within the file is passed over, which is right for a lamp that hangs as it was measured; one in another file is an
//! error.
//!
//! ```
//! use etendue_core::{Spectrum, Transform, Vec3A};
//! use etendue_io::{Limits, ies};
//! use etendue_light::{GoniometricLight, Light};
//!
//! let text = "IESNA:LM-63-2002\n[TEST] none\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 60\n0 90\n0\n683 0\n";
//! let lamp = ies::read("a lamp", text.as_bytes(), &Limits::default())?;
//! assert_eq!(lamp.keyword("TEST"), Some("none"));
//! let place = Transform::translation(Vec3A::Y * 2.0);
//! let light = GoniometricLight::new(&place, lamp.table, Spectrum::gray(1.0 / 683.0));
//! assert!(light.power(0, 1.0).g() > 2.0);
//! # Ok::<(), ies::IesError>(())
//! ```

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
