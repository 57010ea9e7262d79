/// Why the arrays of a mesh are not accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A triangle names a vertex that does not exist.
    #[error(
        "triangle {triangle} refers to vertex {index}, but there are {vertices} vertices; \
         check that indices start at 0 and that none was cut off"
    )]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// The vertex it names.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// An attribute array is not as long as the array of positions.
    #[error("{found} {attribute} for {expected} vertices; give one for each vertex, or none")]
    CountMismatch {
        /// The attribute's name, in the plural.
        attribute: &'static str,
        /// Entries given.
        found: usize,
        /// Vertices of the mesh.
        expected: usize,
    },
    /// A third set of texture coordinates.
    #[error("texture coordinate set {set} does not exist: a mesh has the sets 0 and 1")]
    NoSuchUvSet {
        /// The set asked for.
        set: usize,
    },
    /// More triangles or vertices than 32-bit numbers can name.
    #[error("{count} {what} are more than a mesh can hold (2^32 - 1); split it")]
    TooMany {
        /// What there are too many of.
        what: &'static str,
        /// How many.
        count: usize,
    },
}

/// Why the parameters of a shape are not accepted.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A coordinate is NaN or infinite.
    #[error("{shape}: {parameter} is not finite")]
    NotFinite {
        /// The shape.
        shape: &'static str,
        /// The parameter.
        parameter: &'static str,
    },
    /// A radius that is zero or negative.
    #[error("{shape}: the radius must be greater than zero, not {radius}")]
    Radius {
        /// The shape.
        shape: &'static str,
        /// The radius given.
        radius: f32,
    },
    /// A normal without a direction.
    #[error("{shape}: the normal is zero and gives no direction")]
    ZeroNormal {
        /// The shape.
        shape: &'static str,
    },
    /// Ends that coincide, or an axis without a direction.
    #[error("cylinder: the ends coincide or the axis is zero")]
    NoAxis,
    /// Edges that span no area.
    #[error("parallelogram: the edges are zero or parallel and span no area")]
    NoArea,
}
