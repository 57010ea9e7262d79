//! Wavefront OBJ with MTL materials, parsed by `tobj` from text that has been made safe for it.

mod clean;
mod materials;
mod mesh;
mod text;

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;

use etendue_scene::SceneBuilder;

use crate::resolver::read_file;
use crate::{FolderResolver, Limits, LoadReport, ResolveError, Resolver};

/// Why an OBJ file is not a scene. `line` counts from 1.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// The file itself cannot be read.
    #[error(transparent)]
    File(#[from] ResolveError),
    /// A line that says nothing the format knows.
    #[error("{file}, line {line}: {what}; the line reads '{text}'")]
    Syntax {
        /// The file.
        file: String,
        /// The line.
        line: usize,
        /// What is wrong and what to do.
        what: String,
        /// The beginning of the line.
        text: String,
    },
    /// A line beyond the limit.
    #[error(
        "{file}, line {line}: longer than the limit of {limit} bytes; this is no OBJ file, or split the line with '\\'"
    )]
    LineTooLong {
        /// The file.
        file: String,
        /// The line.
        line: usize,
        /// The limit.
        limit: usize,
    },
    /// A file without a single triangle.
    #[error("{file}: there is not one face in it, so there is nothing to render")]
    NoFaces {
        /// The file.
        file: String,
    },
    /// A mesh that the geometry crate refuses.
    #[error("{file}, object '{object}': {source}")]
    Mesh {
        /// The file.
        file: String,
        /// The object.
        object: String,
        /// The reason.
        source: etendue_geometry::MeshError,
    },
}

impl ObjError {
    pub(crate) fn syntax(file: &str, line: usize, what: String, text: &str) -> Self {
        Self::Syntax { file: file.into(), line, what, text: text.trim().chars().take(80).collect() }
    }
}

/// What came out of a file, and what did not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ObjReport {
    /// Meshes added.
    pub meshes: usize,
    /// Triangles added.
    pub triangles: usize,
    /// Materials added.
    pub materials: usize,
    /// Images decoded.
    pub images: usize,
    /// Whether something in the file emits light.
    pub has_light: bool,
    /// What was dropped or not understood, each with its place.
    pub warnings: Vec<String>,
}

impl From<ObjReport> for LoadReport {
    fn from(report: ObjReport) -> Self {
        Self {
            meshes: report.meshes as u64,
            triangles: report.triangles as u64,
            instances: report.meshes as u64,
            materials: report.materials as u64,
            images: report.images as u64,
            has_light: report.has_light,
            warnings: report.warnings,
            ..Self::default()
        }
    }
}

/// Adds an OBJ file to a scene. Materials and textures are looked for beside it and nowhere else.
///
/// # Errors
/// [`ObjError`], naming file and line. A missing material file or texture is a warning, not an error.
pub fn load(path: &Path, limits: &Limits, builder: &mut SceneBuilder) -> Result<ObjReport, ObjError> {
    let name = path.display().to_string();
    let bytes = read_file(path, &name, limits.file_bytes)?;
    read(&name, &bytes, &FolderResolver::beside(path), limits, builder)
}

/// Adds an OBJ file that is in memory; `name` stands for it in messages.
///
/// # Errors
/// As [`load`].
pub fn read(
    name: &str,
    bytes: &[u8],
    resolver: &dyn Resolver,
    limits: &Limits,
    builder: &mut SceneBuilder,
) -> Result<ObjReport, ObjError> {
    let mut report = ObjReport::default();
    let source = text::Safe::obj(name, bytes, limits, &mut report.warnings)?;
    let mut lines = source.reader();
    let warnings = RefCell::new(Vec::new());
    let options =
        tobj::LoadOptions { triangulate: true, single_index: true, ignore_points: true, ignore_lines: true };
    let read = RefCell::new(BTreeSet::new());
    let parsed = tobj::load_obj_buf(&mut lines, &options, |mtl| {
        // A library named again and again is read once: the work stays in proportion to the files.
        if !read.borrow_mut().insert(mtl.to_path_buf()) {
            return Ok(Default::default());
        }
        Ok(materials::parse(&mtl.to_string_lossy(), resolver, limits, &mut warnings.borrow_mut()))
    });
    report.warnings.append(&mut warnings.borrow_mut());
    let (models, mtl) = parsed.map_err(|e| source.error(lines.line(), e))?;
    let mtl = mtl.unwrap_or_default();
    let known: BTreeSet<&str> = mtl.iter().map(|m| m.name.as_str()).collect();
    for (used, line) in source.used_materials() {
        if !known.contains(used) {
            report.warnings.push(format!("{name}, line {line}: no material file has a '{used}'; it is gray"));
        }
    }

    let mut made = materials::Made::new(&mtl, resolver, limits);
    for model in &models {
        mesh::add(name, model, &mut made, builder, &mut report)?;
    }
    report.materials = made.count();
    report.images = made.images();
    report.warnings.append(&mut made.warnings);
    if report.triangles == 0 {
        return Err(ObjError::NoFaces { file: name.into() });
    }
    Ok(report)
}
