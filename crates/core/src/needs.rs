bitflags::bitflags! {
    /// What a scene, camera or material asks of the renderer. The union over a scene is its *census*: whatever bit
    /// is absent is neither built nor run.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Needs: u32 {
        /// Shapes that enter by the [`Shape`](https://docs.rs/etendue-geometry) door and need their own hierarchy.
        const OPEN_SHAPES = 1 << 0;
        /// At least one object is placed through a transform.
        const INSTANCES = 1 << 1;
        /// Something moves while the shutter is open.
        const MOTION = 1 << 2;
        /// Some material lets rays through by its opacity.
        const CUTOUTS = 1 << 3;
        /// Something emits light.
        const LIGHTS = 1 << 4;
        /// More than one light, or a light of more than one part: one has to be picked.
        const MANY_LIGHTS = 1 << 5;
        /// A light at infinity: escaped rays carry radiance.
        const ENVIRONMENT = 1 << 6;
        /// Some material reads the tangent frame.
        const TANGENTS = 1 << 7;
        /// Some mesh has vertex normals.
        const SHADING_NORMALS = 1 << 8;
        /// Some material, light or cut-out looks a texture up.
        const TEXTURES = 1 << 9;
        /// The camera has an aperture.
        const LENS = 1 << 10;
        /// Some material lets light through.
        const TRANSMISSION = 1 << 11;
        /// Some material scatters into single directions.
        const DELTA = 1 << 12;
        /// Some mesh has vertex colours that a material reads.
        const VERTEX_COLORS = 1 << 13;
        /// A light that area or solid-angle sampling can reach but that rays can hit too (so that MIS has two sides).
        const AREA_LIGHTS = 1 << 14;
        /// Some body absorbs light on its way through.
        const ABSORPTION = 1 << 15;
        /// Some material turns the shading normal by a texture.
        const NORMAL_MAPS = 1 << 16;
    }
}
