use std::fmt;

use etendue_core::Needs;

/// What building found, dropped and built. Nothing is dropped silently.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneReport {
    /// The census.
    pub needs: Needs,
    /// Triangles kept, each mesh counted once however often it is instanced.
    pub triangles: u64,
    /// Other shapes.
    pub shapes: u64,
    /// Instances.
    pub instances: u64,
    /// Of these, how many move while the shutter is open.
    pub moving: u64,
    /// Triangles without area, dropped.
    pub degenerate_triangles: u64,
    /// Triangles with the corners of an earlier one of their mesh, dropped.
    pub duplicate_triangles: u64,
    /// Triangles with a vertex that is not finite or beyond 2⁶⁰, dropped.
    pub non_finite_triangles: u64,
    /// Lights kept.
    pub lights: u64,
    /// Parts of all lights.
    pub light_parts: u64,
    /// Lights that emit nothing, dropped.
    pub zero_power_lights: u64,
    /// Emitting geometry that is placed nowhere and so gives no light.
    pub unplaced_emitters: u64,
    /// Bytes held.
    pub memory: MemoryReport,
}

/// Bytes held by the parts of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryReport {
    /// Vertices, indices and attributes.
    pub geometry: usize,
    /// Hierarchies.
    pub hierarchy: usize,
    /// Materials and their textures.
    pub materials: usize,
    /// Lights and the tables that choose among them.
    pub lights: usize,
}

impl MemoryReport {
    /// The sum.
    pub fn total(&self) -> usize {
        self.geometry + self.hierarchy + self.materials + self.lights
    }
}

impl fmt::Display for SceneReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} triangles, {} shapes, {} instances, {} lights ({} parts), {:.1} MB",
            self.triangles,
            self.shapes,
            self.instances,
            self.lights,
            self.light_parts,
            self.memory.total() as f64 / 1e6
        )?;
        for (n, what) in [
            (self.moving, "instances moving"),
            (self.degenerate_triangles, "triangles without area dropped"),
            (self.duplicate_triangles, "triangles that stand twice dropped"),
            (self.non_finite_triangles, "triangles with unusable vertices dropped"),
            (self.zero_power_lights, "lights that emit nothing dropped"),
            (self.unplaced_emitters, "emitting geometries placed nowhere"),
        ] {
            if n > 0 {
                write!(f, "; {n} {what}")?;
            }
        }
        Ok(())
    }
}
