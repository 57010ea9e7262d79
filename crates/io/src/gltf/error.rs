use crate::ResolveError;

/// Why a glTF file is not a scene. Places are JSON pointers.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GltfError {
    /// The file itself cannot be read.
    #[error(transparent)]
    File(#[from] ResolveError),
    /// Something that the specification forbids.
    #[error("{file}, at '{pointer}': {message} [{code}]{more}")]
    Invalid {
        /// The file.
        file: String,
        /// The place of the first fault.
        pointer: String,
        /// The fault's name, as the Khronos validator has it.
        code: String,
        /// What is wrong and what to do.
        message: String,
        /// How many further faults there are, and whether a lenient load would get past them.
        more: String,
    },
    /// An extension that the file cannot do without and this loader does not have.
    #[error("{file} requires the extension {extension}, which is not built: {cure}")]
    Extension {
        /// The file.
        file: String,
        /// The extension.
        extension: String,
        /// What to do.
        cure: &'static str,
    },
    /// A buffer or image that cannot be had.
    #[error("{file}, at '{pointer}': {source}")]
    Resource {
        /// The file.
        file: String,
        /// Who asks for it.
        pointer: String,
        /// Why not.
        source: ResolveError,
    },
    /// More than the limits allow.
    #[error(
        "{file}, at '{pointer}': {asked} {what}, but the limit is {limit}; raise it if the file is sound"
    )]
    Limit {
        /// The file.
        file: String,
        /// Who asks.
        pointer: String,
        /// Of what.
        what: &'static str,
        /// How many.
        asked: u64,
        /// The limit.
        limit: u64,
    },
    /// Something that cannot be made into a scene.
    #[error("{file}, at '{pointer}': {message}")]
    Unusable {
        /// The file.
        file: String,
        /// The place.
        pointer: String,
        /// What is wrong and what to do.
        message: String,
    },
    /// A variant of materials that the file does not have.
    #[error("{file} has no material variant '{asked}'; {there_are}")]
    Variant {
        /// The file.
        file: String,
        /// The name asked for.
        asked: String,
        /// The names there are.
        there_are: String,
    },
    /// The progress handle said stop.
    #[error("loading {0} was cancelled")]
    Cancelled(String),
}
