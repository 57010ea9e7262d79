use etendue_core::{Fingerprint, Needs, Origin, Ray, Spectrum, Vec2, Vec3A};
use etendue_geometry::Surface;

/// One part of one light: a triangle of an emissive mesh, say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LightId {
    /// Index of the light in the scene.
    pub light: u32,
    /// Part, below [`Light::parts`].
    pub part: u32,
}

/// On which sides of its surface a point can use light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sides {
    /// Only the side that `wo` is on: reflection.
    Same,
    /// Both: something transmits.
    Both,
    /// The point lies on no surface.
    Free,
}

/// A point that asks for light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitPoint {
    /// Position, world space.
    pub p: Vec3A,
    /// Bound on its absolute error per axis.
    pub p_err: Vec3A,
    /// Unit geometric normal *on the side that light leaves by* (toward `wo`); zero in free space.
    pub ng: Vec3A,
    /// Unit shading normal on the same side; zero in free space.
    pub ns: Vec3A,
    /// Which sides count.
    pub sides: Sides,
    /// Moment in the shutter interval, in `[0, 1)`.
    pub time: f32,
}

impl LitPoint {
    /// The point as rays leave from it.
    #[inline]
    pub fn origin(&self) -> Origin {
        Origin { p: self.p, p_err: self.p_err, ng: self.ng }
    }
}

/// Light arriving at a point from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction toward the light.
    pub wi: Vec3A,
    /// Radiance arriving if nothing is in between, W·m⁻²·sr⁻¹; for a delta light the irradiance on a plane facing it,
    /// W·m⁻² (its density is then 1).
    pub li: Spectrum,
    /// Density per solid angle, sr⁻¹; 1 for a delta light.
    pub pdf: f32,
    /// Where the light stands; `None` at infinity.
    pub end: Option<Origin>,
    /// Whether only this direction exists, so that no BSDF sample can find it.
    pub is_delta: bool,
}

/// Where a light part is and which way it shines, for choosing lights in a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBounds {
    /// Box around the emitter, world space.
    pub bounds: etendue_core::Aabb,
    /// Unit axis of the cone of normals.
    pub axis: Vec3A,
    /// Cosine of the cone's half angle.
    pub cos_normals: f32,
    /// Cosine of the further angle that emission spreads beyond the normals.
    pub cos_emission: f32,
    /// Emitted power, W, mean of the channels.
    pub power: f32,
}

/// A source of light. One light may have many parts (the triangles of a mesh), each picked on its own.
///
/// World space throughout. `check_light` of `etendue-testkit` tests any implementation.
pub trait Light: Send + Sync {
    /// How many parts can be picked.
    fn parts(&self) -> u32 {
        1
    }

    /// Draws a direction toward the part; `None` where it sends nothing here.
    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample>;

    /// The density with which [`Light::sample`] draws `wi`, sr⁻¹. `seen` is the point of the light that the ray along
    /// `wi` has hit, `None` for a light at infinity: the hit is never searched again.
    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32;

    /// Emitted power, W; for a light at infinity the power that enters a sphere of `scene_radius` (metres). Zero only
    /// if the part truly emits nothing, or is to be left to rays ([`Unpicked`](crate::Unpicked)).
    fn power(&self, part: u32, scene_radius: f32) -> Spectrum;

    /// Place and cone; `None` for a light at infinity.
    fn bounds(&self, part: u32) -> Option<LightBounds>;

    /// Radiance leaving the point `at` of the light along `wo` (unit, away from the surface), W·m⁻²·sr⁻¹.
    fn emitted(&self, part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        let _ = (part, at, wo);
        Spectrum::BLACK
    }

    /// Radiance arriving along a ray that left the scene, W·m⁻²·sr⁻¹.
    fn escaped(&self, ray: &Ray) -> Spectrum {
        let _ = ray;
        Spectrum::BLACK
    }

    /// Whether rays that leave the scene can meet this light: not so for a single direction, which has no extent.
    fn is_infinite(&self) -> bool {
        false
    }

    /// Whether only light sampling can find it.
    fn is_delta(&self) -> bool {
        false
    }

    /// What the light asks of the renderer.
    fn needs(&self) -> Needs {
        Needs::LIGHTS
    }

    /// What decides the light, for comparing scenes.
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.opaque();
    }

    /// Bytes held, for the memory report.
    fn bytes(&self) -> usize {
        0
    }
}
