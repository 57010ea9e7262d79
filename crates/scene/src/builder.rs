use std::sync::Arc;

use etendue_bvh::{Accel, BuildError, BuildOptions, Instance, TreeAccel, World};
use etendue_core::{Aabb, Motion, Needs, Progress, Transform};
use etendue_geometry::Geometry;
use etendue_light::{Light, LightPicker, PowerPicker, SinglePicker};
use etendue_material::Material;
use etendue_texture::Tex;

use crate::scene::Parts;
use crate::{Scene, SceneError, SceneReport, census, emitters};

/// A material of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub(crate) u32);

/// A mesh or shape of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GeomId(pub(crate) u32);

impl GeomId {
    /// The number that hits and films carry.
    pub fn index(self) -> u32 {
        self.0
    }
}

/// Geometry that is placed together, any number of times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GroupId(pub(crate) u32);

/// One placement of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct InstanceId(pub(crate) u32);

impl InstanceId {
    /// The number that hits and films carry.
    pub fn index(self) -> u32 {
        self.0
    }
}

/// Light leaving a surface, diffusely.
#[derive(Clone, Debug)]
pub struct Emission {
    /// Emitted radiance, W·m⁻²·sr⁻¹.
    pub radiance: Tex,
    /// Whether the back emits too; by default only the front does (counter-clockwise).
    pub two_sided: bool,
}

impl Emission {
    /// Emission from the front side.
    pub fn new(radiance: impl Into<Tex>) -> Self {
        Self { radiance: radiance.into(), two_sided: false }
    }

    /// Emission from both sides.
    #[must_use]
    pub fn two_sided(mut self) -> Self {
        self.two_sided = true;
        self
    }
}

pub(crate) type AccelMaker = Box<dyn FnOnce(&World) -> Result<Box<dyn Accel>, BuildError> + Send>;
pub(crate) type PickerMaker = Box<dyn FnOnce(&[Arc<dyn Light>], f32) -> Option<Box<dyn LightPicker>> + Send>;

/// Collects geometry, materials and lights, then builds the [`Scene`].
///
/// A scene without geometry or without lights is valid.
#[derive(Default)]
pub struct SceneBuilder {
    pub(crate) materials: Vec<Arc<dyn Material>>,
    pub(crate) geometries: Vec<Geometry>,
    pub(crate) geom_materials: Vec<u32>,
    pub(crate) emission: Vec<Option<Emission>>,
    pub(crate) masks: Vec<u32>,
    pub(crate) direct: Vec<u32>,
    pub(crate) groups: Vec<Arc<[u32]>>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) instance_groups: Vec<u32>,
    pub(crate) lights: Vec<Arc<dyn Light>>,
    unknown: Option<SceneError>,
    accel: Option<AccelMaker>,
    picker: Option<PickerMaker>,
}

impl SceneBuilder {
    /// An empty scene.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a material.
    pub fn material(&mut self, material: impl Material + 'static) -> MaterialId {
        self.material_arc(Arc::new(material))
    }

    /// Adds a material that is shared with others.
    pub fn material_arc(&mut self, material: Arc<dyn Material>) -> MaterialId {
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    fn push_geometry(&mut self, geometry: Geometry, material: MaterialId) -> u32 {
        self.geometries.push(geometry);
        self.geom_materials.push(material.0);
        self.emission.push(None);
        self.masks.push(u32::MAX);
        self.geometries.len() as u32 - 1
    }

    /// Adds a mesh or shape that stands in the world itself.
    pub fn add(&mut self, geometry: impl Into<Geometry>, material: MaterialId) -> GeomId {
        let id = self.push_geometry(geometry.into(), material);
        self.direct.push(id);
        GeomId(id)
    }

    /// Adds geometry that [`SceneBuilder::group`] will gather: it is in the scene only where its group is placed.
    pub fn add_grouped(&mut self, geometry: impl Into<Geometry>, material: MaterialId) -> GeomId {
        GeomId(self.push_geometry(geometry.into(), material))
    }

    /// Gathers geometry to be placed together.
    pub fn group(&mut self, geometry: &[GeomId]) -> GroupId {
        for g in geometry {
            self.check("geometry", g.0, self.geometries.len());
        }
        // A geometry named twice stands there once.
        let mut ids: Vec<u32> = geometry.iter().map(|g| g.0).collect();
        ids.sort_unstable();
        ids.dedup();
        self.groups.push(ids.into());
        GroupId(self.groups.len() as u32 - 1)
    }

    /// Places a group.
    pub fn instance(&mut self, group: GroupId, to_world: Transform) -> InstanceId {
        let Some(geoms) = self.groups.get(group.0 as usize) else {
            self.check("group", group.0, self.groups.len());
            return InstanceId(u32::MAX);
        };
        self.instances.push(Instance::new(geoms.clone(), to_world));
        self.instance_groups.push(group.0);
        InstanceId(self.instances.len() as u32 - 1)
    }

    /// Places a group that moves while the shutter is open: by `to_world` at time 0, and from there by `motion`, which acts
    /// in world space. A motion that moves nothing gives a plain instance.
    pub fn moving_instance(&mut self, group: GroupId, to_world: Transform, motion: Motion) -> InstanceId {
        let id = self.instance(group, to_world);
        if let Some(instance) = self.instances.get_mut(id.0 as usize) {
            *instance = instance.clone().with_motion(motion);
        }
        id
    }

    /// Makes geometry emit. Every placement of it becomes a light.
    ///
    /// Where its material has an opacity, what it lets through it does not emit either, and rays alone find it: right
    /// in every mode, and noisier than a light that is sampled.
    pub fn emit(&mut self, geometry: GeomId, emission: Emission) {
        match self.emission.get_mut(geometry.0 as usize) {
            Some(slot) => *slot = Some(emission),
            None => self.check("geometry", geometry.0, self.geometries.len()),
        }
    }

    /// Lets only rays that share a bit with `mask` see the geometry.
    pub fn visible_to(&mut self, geometry: GeomId, mask: u32) {
        match self.masks.get_mut(geometry.0 as usize) {
            Some(slot) => *slot = mask,
            None => self.check("geometry", geometry.0, self.geometries.len()),
        }
    }

    /// Adds a light that is not a surface of the scene: a point, an environment, a user's own.
    pub fn light(&mut self, light: impl Light + 'static) {
        self.light_arc(Arc::new(light));
    }

    /// Adds a light that is shared with others.
    pub fn light_arc(&mut self, light: Arc<dyn Light>) {
        self.lights.push(light);
    }

    /// Uses another ray-query structure than ours.
    pub fn accel_with(
        &mut self,
        make: impl FnOnce(&World) -> Result<Box<dyn Accel>, BuildError> + Send + 'static,
    ) {
        self.accel = Some(Box::new(make));
    }

    /// Uses another choice of lights than by power. The function gets the scene's lights and its radius in metres.
    /// A light that the picker never picks is found by rays alone, if at all.
    pub fn picker_with(
        &mut self,
        make: impl FnOnce(&[Arc<dyn Light>], f32) -> Option<Box<dyn LightPicker>> + Send + 'static,
    ) {
        self.picker = Some(Box::new(make));
    }

    /// Whether nothing emits yet.
    pub fn has_no_light(&self) -> bool {
        self.lights.is_empty() && self.emission.iter().all(Option::is_none)
    }

    /// A box around everything bounded that has been placed so far, wherever it moves.
    pub fn bounds(&self) -> Aabb {
        let of = |g: u32| self.geometries.get(g as usize).map_or(Aabb::EMPTY, Geometry::bounds);
        let placed = |i: &Instance| i.geoms.iter().fold(Aabb::EMPTY, |b, &g| b.union(i.bounds_of(&of(g))));
        let boxes = self.direct.iter().map(|&g| of(g)).chain(self.instances.iter().map(placed));
        boxes.filter(Aabb::is_finite).fold(Aabb::EMPTY, Aabb::union)
    }

    /// Ids are remembered, not checked where they are used: the first wrong one becomes the error of `build`.
    fn check(&mut self, what: &'static str, id: u32, count: usize) {
        if id as usize >= count && self.unknown.is_none() {
            self.unknown = Some(SceneError::UnknownId { what, id, count });
        }
    }

    /// Builds the scene.
    ///
    /// # Errors
    /// [`SceneError`], naming the part.
    pub fn build(self) -> Result<Scene, SceneError> {
        self.build_with_progress(&())
    }

    /// Builds the scene under a progress-and-cancel handle.
    ///
    /// # Errors
    /// As [`SceneBuilder::build`]; a cancelled build is an error too.
    pub fn build_with_progress(mut self, progress: &dyn Progress) -> Result<Scene, SceneError> {
        if let Some(e) = self.unknown.take() {
            return Err(e);
        }
        for (geom, &material) in self.geom_materials.iter().enumerate() {
            if material as usize >= self.materials.len() {
                let count = self.materials.len();
                return Err(SceneError::UnknownMaterial { geom: geom as u32, material, count });
            }
        }
        for (i, instance) in self.instances.iter().enumerate() {
            if !instance.to_world.columns().iter().all(|c| c.is_finite()) {
                return Err(SceneError::BadPlacement { instance: i });
            }
            for &geom in instance.geoms.iter() {
                let bounds = self.geometries[geom as usize].bounds();
                if bounds == Aabb::INFINITE {
                    return Err(SceneError::InfiniteInstance { group: self.instance_groups[i], geom });
                }
                if let Some(motion) = &instance.motion {
                    let end = motion.placement(&instance.to_world, 1.0);
                    let path = instance.bounds_of(&bounds);
                    if !end.is_finite() || !(path.is_finite() || path.is_empty()) {
                        return Err(SceneError::BadMotion { instance: i });
                    }
                }
            }
        }

        let mut report = SceneReport::default();
        let emitters = emitters::collect(&self, &mut report)?;
        let world = World {
            geometries: std::mem::take(&mut self.geometries),
            masks: std::mem::take(&mut self.masks),
            direct: std::mem::take(&mut self.direct),
            instances: std::mem::take(&mut self.instances),
        };
        let accel = match self.accel.take() {
            Some(make) => make(&world)?,
            None => Box::new(TreeAccel::build(&world, &BuildOptions::default(), &|| progress.cancelled())?),
        };
        let radius = accel.bounds().radius();
        let picking_radius = picking_radius(radius, &emitters.lights);
        let (picked, only) = emitters.picked();
        let picker = match self.picker.take() {
            Some(make) => make(&emitters.lights, picking_radius),
            // One light of one part needs no choice.
            None if picked == 1 => Some(Box::new(SinglePicker::new(only)) as Box<dyn LightPicker>),
            None => PowerPicker::new(&emitters.lights, picking_radius)
                .map(|p| Box::new(p) as Box<dyn LightPicker>),
        };
        census::take(&world, &self.materials, &self.geom_materials, &emitters, &mut report);
        report.memory.hierarchy = accel.bytes();
        report.memory.lights += picker.as_ref().map_or(0, |p| p.bytes());
        let mut cut = Vec::new();
        if report.needs.contains(Needs::CUTOUTS) {
            let opaque = |m: &u32| !self.materials[*m as usize].needs().contains(Needs::CUTOUTS);
            cut = self.geom_materials.iter().map(|m| !opaque(m)).collect();
        }
        Ok(Scene::assemble(Parts {
            world,
            cut,
            accel,
            picker,
            materials: self.materials,
            geom_materials: self.geom_materials,
            emitters,
            report,
            radius,
        }))
    }
}

/// The radius by which lights at infinity are compared with others. Where nothing is bounded (a plane under a sky) the
/// lights' own places give it, or else it is 1: a sky must never be worth nothing.
fn picking_radius(radius: f32, lights: &[Arc<dyn Light>]) -> f32 {
    if radius > 0.0 {
        return radius;
    }
    let places = lights.iter().flat_map(|l| (0..l.parts()).filter_map(|p| l.bounds(p)));
    let around = places.fold(etendue_core::Aabb::EMPTY, |b, l| b.union(l.bounds)).radius();
    if around > 0.0 && around.is_finite() { around } else { 1.0 }
}
