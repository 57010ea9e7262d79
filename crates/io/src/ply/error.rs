use crate::ResolveError;

/// Why a PLY file is not a mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlyError {
    /// The file itself cannot be read.
    #[error(transparent)]
    File(#[from] ResolveError),
    /// A header that cannot be understood. `line` counts from 1.
    #[error("{file}, line {line}: {what}")]
    Header {
        /// The file.
        file: String,
        /// The line.
        line: usize,
        /// What is wrong and what to do.
        what: String,
    },
    /// Values that cannot be read or used.
    #[error("{file}, {place}, {element} {index}: {what}")]
    Data {
        /// The file.
        file: String,
        /// The line of a text, the byte of a binary file.
        place: String,
        /// The name of the element.
        element: String,
        /// Its number, from 0.
        index: u64,
        /// What is wrong and what to do.
        what: String,
    },
    /// More than a scene may have, or more than there is memory for.
    #[error("{file}: {count} {what} are more than the limit of {limit}; split the file or raise the limit")]
    TooMany {
        /// The file.
        file: String,
        /// What there are too many of.
        what: &'static str,
        /// How many.
        count: u64,
        /// The limit.
        limit: u64,
    },
    /// A file without a single triangle.
    #[error(
        "{file}: {vertices} vertices but not one face; points are not rendered, so make a surface of them first"
    )]
    NoFaces {
        /// The file.
        file: String,
        /// Its vertices.
        vertices: u64,
    },
    /// A mesh that the geometry crate refuses.
    #[error("{file}: {source}")]
    Mesh {
        /// The file.
        file: String,
        /// The reason.
        source: etendue_geometry::MeshError,
    },
}
