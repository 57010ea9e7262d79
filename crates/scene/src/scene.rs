use std::sync::Arc;

use etendue_bvh::{Accel, World};
use etendue_core::{Aabb, Fingerprint, Needs, Ray, Segment, Spectrum, Vec2, Vec3A};
use etendue_geometry::{Hit, Surface};
use etendue_light::{Light, LightId, LightPicker, LightSample, LitPoint};
use etendue_material::{AlphaPoint, Material};

use crate::SceneReport;
use crate::cutout::CutoutFilter;
use crate::emitters::Emitters;

pub(crate) struct Parts {
    pub(crate) world: World,
    pub(crate) accel: Box<dyn Accel>,
    pub(crate) picker: Option<Box<dyn LightPicker>>,
    pub(crate) materials: Vec<Arc<dyn Material>>,
    pub(crate) geom_materials: Vec<u32>,
    /// By geometry: whether its material has an opacity. Empty where none has.
    pub(crate) cut: Vec<bool>,
    pub(crate) emitters: Emitters,
    pub(crate) report: SceneReport,
    pub(crate) radius: f32,
}

/// A light sample of the whole scene: which light, and the density with its choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightDraw {
    /// The part picked.
    pub id: LightId,
    /// The sample; its `pdf` is the light's own times the probability of the pick.
    pub sample: LightSample,
    /// Whether no ray of the scene can find this light, so that its samples have nothing to be weighed against: a
    /// delta light, a light that is no surface of the scene, a surface that no ray sees.
    pub only_way: bool,
}

/// A body that light can enter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Number of its material: surfaces that share it bound one body.
    pub material: u32,
    /// What it absorbs, m⁻¹.
    pub absorption: Spectrum,
}

/// An immutable scene, shared by any number of threads and renders.
pub struct Scene {
    parts: Parts,
}

impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Scene({}; {:?})", self.parts.report, self.needs())
    }
}

impl Scene {
    pub(crate) fn assemble(parts: Parts) -> Self {
        Self { parts }
    }

    /// The census.
    pub fn needs(&self) -> Needs {
        self.parts.report.needs
    }

    /// What building found, dropped and built.
    pub fn report(&self) -> &SceneReport {
        &self.parts.report
    }

    /// A box around everything bounded, wherever it moves.
    pub fn bounds(&self) -> Aabb {
        self.parts.accel.bounds()
    }

    /// Radius of the sphere around the bounds, metres.
    pub fn radius(&self) -> f32 {
        self.parts.radius
    }

    /// The ray queries.
    pub fn accel(&self) -> &dyn Accel {
        &*self.parts.accel
    }

    /// Geometry and placements.
    pub fn world(&self) -> &World {
        &self.parts.world
    }

    /// Lights, in the order that [`LightId::light`] counts.
    pub fn lights(&self) -> &[Arc<dyn Light>] {
        &self.parts.emitters.lights
    }

    /// Whether some light can be sampled only, never found by a ray (see [`LightDraw::only_way`]).
    pub fn has_hidden_lights(&self) -> bool {
        self.parts.emitters.found_by_rays.iter().any(|found| !found)
    }

    fn cutout_filter(&self, bits: u32) -> Option<CutoutFilter<'_>> {
        self.needs().contains(Needs::CUTOUTS).then(|| CutoutFilter {
            world: &self.parts.world,
            materials: &self.parts.materials,
            geom_materials: &self.parts.geom_materials,
            cut: &self.parts.cut,
            bits,
        })
    }

    /// The closest hit. `cutout_bits` are random bits that decide about partly opaque surfaces; unused without
    /// cut-outs.
    #[inline]
    pub fn intersect(&self, ray: &Ray, cutout_bits: u32) -> Option<Hit> {
        match self.cutout_filter(cutout_bits) {
            None => self.parts.accel.intersect(ray),
            Some(filter) => self.parts.accel.intersect_filtered(ray, 0, &filter),
        }
    }

    /// Everything about the point that a ray hit, world space. `footprint` is the radius of the ray's cone there.
    #[inline]
    pub fn surface(&self, ray: &Ray, hit: &Hit, footprint: f32) -> Surface {
        let mut s = self.parts.world.surface(ray, hit);
        s.footprint = footprint;
        s.time = ray.time;
        s
    }

    /// Whether anything stands in a ray's way. `cutout_bits` as in [`Scene::intersect`].
    #[inline]
    pub fn occluded(&self, ray: &Ray, cutout_bits: u32) -> bool {
        match self.cutout_filter(cutout_bits) {
            None => self.parts.accel.occluded(ray),
            Some(filter) => self.parts.accel.occluded_filtered(ray, 0, &filter),
        }
    }

    /// The fraction of light that gets from one end to the other: 0 or 1 until there are media. `cutout_bits` as in
    /// [`Scene::intersect`].
    #[inline]
    pub fn transmittance(&self, segment: &Segment, cutout_bits: u32) -> Spectrum {
        let Some(ray) = segment.ray() else { return Spectrum::BLACK };
        if self.occluded(&ray, cutout_bits) { Spectrum::BLACK } else { Spectrum::ONE }
    }

    /// The material of a surface of this scene; `None` for a surface of another.
    #[inline]
    pub fn material(&self, surface: &Surface) -> Option<&dyn Material> {
        let m = *self.parts.geom_materials.get(surface.geom as usize)?;
        self.parts.materials.get(m as usize).map(|m| &**m)
    }

    /// How much of a surface is there, in `[0, 1]`: 1 where nothing is cut out.
    pub fn opacity(&self, surface: &Surface) -> f32 {
        if !self.parts.cut.get(surface.geom as usize).is_some_and(|&cut| cut) {
            return 1.0;
        }
        let Surface { uv, p, color, ref fetches, .. } = *surface;
        let opacity =
            self.material(surface).map_or(1.0, |m| m.opacity(&AlphaPoint { uv, p, color, fetches }));
        // As a ray decides, which compares it with a number in [0, 1).
        if opacity > 0.0 { opacity.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// The body behind a surface; `None` where transmitted light enters none (see [`Material::absorption`]).
    #[inline]
    pub fn body(&self, surface: &Surface) -> Option<Body> {
        let material = *self.parts.geom_materials.get(surface.geom as usize)?;
        let absorption = self.parts.materials.get(material as usize)?.absorption()?;
        Some(Body { material, absorption })
    }

    /// The light that a surface is part of.
    #[inline]
    pub fn light_at(&self, surface: &Surface) -> Option<LightId> {
        let light = self.parts.emitters.of(surface.inst, surface.geom)?;
        Some(LightId { light, part: surface.prim })
    }

    /// Radiance that a light's surface sends along `wo`, W·m⁻²·sr⁻¹.
    #[inline]
    pub fn emitted(&self, id: LightId, surface: &Surface, wo: Vec3A) -> Spectrum {
        self.parts
            .emitters
            .lights
            .get(id.light as usize)
            .map_or(Spectrum::BLACK, |l| l.emitted(id.part, surface, wo))
    }

    /// The lights that escaped rays meet.
    #[inline]
    pub fn infinite_lights(&self) -> impl Iterator<Item = (LightId, &dyn Light)> {
        self.parts
            .emitters
            .infinite
            .iter()
            .map(|&light| (LightId { light, part: 0 }, &*self.parts.emitters.lights[light as usize]))
    }

    /// Picks a light and draws a direction toward it; the first number of `u` picks and is stretched again.
    #[inline]
    pub fn sample_light(&self, at: &LitPoint, u: Vec2) -> Option<LightDraw> {
        let pick = self.parts.picker.as_ref()?.pick(at, u.x)?;
        let light = self.parts.emitters.lights.get(pick.id.light as usize)?;
        let mut sample = light.sample(at, pick.id.part, Vec2::new(pick.u, u.y))?;
        sample.pdf *= pick.pmf;
        self.drawn(pick.id, sample)
    }

    /// Draws a direction toward one part of one light, with the light's own density.
    pub fn sample_part(&self, at: &LitPoint, id: LightId, u: Vec2) -> Option<LightDraw> {
        let light = self.parts.emitters.lights.get(id.light as usize)?;
        self.drawn(id, light.sample(at, id.part, u)?)
    }

    #[inline(always)]
    fn drawn(&self, id: LightId, sample: LightSample) -> Option<LightDraw> {
        let only_way = sample.is_delta || !self.parts.emitters.found_by_rays[id.light as usize];
        (sample.pdf > 0.0 && !sample.li.is_black()).then_some(LightDraw { id, sample, only_way })
    }

    /// The density with which [`Scene::sample_light`] draws `wi` toward this light, sr⁻¹. `seen` is the point of the
    /// light that was hit, `None` at infinity.
    #[inline]
    pub fn light_pdf(&self, at: &LitPoint, id: LightId, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        let (Some(picker), Some(light)) =
            (&self.parts.picker, self.parts.emitters.lights.get(id.light as usize))
        else {
            return 0.0;
        };
        picker.pmf(at, id) * light.pdf(at, id.part, wi, seen)
    }

    /// A digest of all that decides an image; see [`Fingerprint::is_opaque`] for what a user's parts may hide.
    pub fn fingerprint(&self) -> Fingerprint {
        let mut f = Fingerprint::default();
        let p = &self.parts;
        // Lengths go in first, so that a list's end cannot be taken for the next one's beginning.
        f.u64(p.world.geometries.len() as u64);
        for (id, (g, &m)) in p.world.geometries.iter().zip(&p.geom_materials).enumerate() {
            g.fingerprint(&mut f);
            f.u64(u64::from(m) << 32 | u64::from(p.world.mask(id as u32)));
        }
        f.u64(p.world.direct.len() as u64);
        for &d in &p.world.direct {
            f.u64(u64::from(d));
        }
        f.u64(p.world.instances.len() as u64);
        for i in &p.world.instances {
            i.to_world.fingerprint(&mut f);
            if let Some(motion) = &i.motion {
                motion.fingerprint(&mut f);
            }
            f.u64(u64::from(i.mask) << 32 | i.geoms.len() as u64);
            for &g in i.geoms.iter() {
                f.u64(u64::from(g));
            }
        }
        f.u64(p.materials.len() as u64);
        for m in &p.materials {
            m.fingerprint(&mut f);
        }
        f.u64(p.emitters.lights.len() as u64);
        for l in &p.emitters.lights {
            l.fingerprint(&mut f);
        }
        // Which surface is which light: of two equal ones a hit has to know its own.
        p.emitters.fingerprint(&mut f);
        if let Some(picker) = &p.picker {
            picker.fingerprint(&mut f);
        }
        f
    }
}
