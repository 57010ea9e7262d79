/// Why a hierarchy was not built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// The caller asked to stop.
    #[error("the build was cancelled")]
    Cancelled,
    /// Something refers to a geometry that does not exist.
    #[error("{place} refers to geometry {geom}, but there are {count}; geometries are counted from 0")]
    UnknownGeometry {
        /// What refers to it.
        place: Place,
        /// The number it uses.
        geom: u32,
        /// How many geometries there are.
        count: usize,
    },
    /// More of something than 32-bit numbers can name.
    #[error(
        "{count} {what} are more than one hierarchy can hold ({limit}); split the scene or use instances"
    )]
    TooMany {
        /// What there are too many of.
        what: &'static str,
        /// How many.
        count: usize,
        /// The most there may be.
        limit: usize,
    },
}

/// A place in a world that refers to a geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Entry of [`World::direct`](crate::World::direct).
    Direct(usize),
    /// Instance.
    Instance(usize),
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Direct(i) => write!(f, "entry {i} of the geometries that stand in the world"),
            Self::Instance(i) => write!(f, "instance {i}"),
        }
    }
}
