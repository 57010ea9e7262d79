use etendue_bvh::BuildError;

/// Why a scene cannot be built. Ids count in the order of addition, from 0.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A material id of another builder.
    #[error("geometry {geom} names material {material}, but the scene has {count} materials")]
    UnknownMaterial {
        /// The geometry.
        geom: u32,
        /// The id it names.
        material: u32,
        /// Materials there are.
        count: usize,
    },
    /// An id of another builder.
    #[error("{what} {id} was not made by this builder (it has {count})")]
    UnknownId {
        /// Kind of thing.
        what: &'static str,
        /// The id.
        id: u32,
        /// How many there are.
        count: usize,
    },
    /// Emission from something without an area.
    #[error("geometry {geom} cannot emit: {why}")]
    CannotEmit {
        /// The geometry.
        geom: u32,
        /// The reason and the cure.
        why: &'static str,
    },
    /// Emission that is negative or not a number.
    #[error("geometry {geom} emits radiance that is negative or not finite")]
    BadEmission {
        /// The geometry.
        geom: u32,
    },
    /// A placement of something that has no bounds.
    #[error(
        "group {group} holds geometry {geom}, which is infinite and cannot be instanced; add it to the world instead"
    )]
    InfiniteInstance {
        /// The group.
        group: u32,
        /// The geometry.
        geom: u32,
    },
    /// A light at infinity in several parts: an escaped ray could not tell which it met.
    #[error("light {light} is at infinity and has {parts} parts; add each part as a light of its own")]
    PartsAtInfinity {
        /// The light, in the order of addition.
        light: usize,
        /// Its parts.
        parts: u32,
    },
    /// A placement with an entry that is not a number.
    #[error("instance {instance} is placed by a transform that is not finite")]
    BadPlacement {
        /// The instance.
        instance: usize,
    },
    /// A motion that leads out of the numbers.
    #[error(
        "instance {instance} moves out of what single precision can hold; place it nearer or move it less"
    )]
    BadMotion {
        /// The instance.
        instance: usize,
    },
    /// The hierarchy could not be built, or its building was cancelled.
    #[error("building the hierarchy: {0}")]
    Hierarchy(#[from] BuildError),
}
