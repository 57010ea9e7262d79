use std::sync::Arc;

use etendue_core::{Fingerprint, Needs, Transform};
use etendue_geometry::{Geometry, Shape};
use etendue_light::{
    DiscLight, Light, LightId, MeshLight, MovingLight, ParallelogramLight, ShapeLight, SphereLight, Unpicked,
};
use etendue_texture::Texture;

use crate::{Emission, SceneBuilder, SceneError, SceneReport};

/// The lights of a scene and the way from a surface to its light.
pub(crate) struct Emitters {
    pub(crate) lights: Vec<Arc<dyn Light>>,
    /// Indices of the lights that escaped rays meet.
    pub(crate) infinite: Vec<u32>,
    /// By light: whether rays of the scene can find it at all. Delta lights, lights that are no surface of the
    /// scene, and surfaces that no ray sees can only be sampled.
    pub(crate) found_by_rays: Vec<bool>,
    /// By light: whether it is never sampled, because a ray has to decide about its holes.
    pub(crate) unpicked: Vec<bool>,
    /// Light of geometry that stands in the world itself, by geometry id; empty when nothing emits.
    direct: Vec<Option<u32>>,
    /// (geometry, light) pairs per instance, ascending; empty when nothing instanced emits.
    instanced: Vec<Vec<(u32, u32)>>,
}

impl Emitters {
    /// The parts that a picker chooses among: how many, and the first.
    pub(crate) fn picked(&self) -> (u64, LightId) {
        let picked = || self.lights.iter().zip(&self.unpicked).enumerate().filter(|(_, (_, left))| !**left);
        let parts = picked().map(|(_, (l, _))| u64::from(l.parts())).sum();
        (parts, LightId { light: picked().next().map_or(0, |(i, _)| i as u32), part: 0 })
    }

    /// The light that this surface is part of.
    #[inline]
    pub(crate) fn of(&self, inst: u32, geom: u32) -> Option<u32> {
        if inst == etendue_geometry::Hit::NO_INSTANCE {
            return self.direct.get(geom as usize).copied().flatten();
        }
        let pairs = self.instanced.get(inst as usize)?;
        let at = pairs.binary_search_by_key(&geom, |(g, _)| *g).ok()?;
        pairs.get(at).map(|(_, light)| *light)
    }

    pub(crate) fn fingerprint(&self, f: &mut Fingerprint) {
        for (geom, light) in self.direct.iter().enumerate() {
            if let Some(light) = light {
                f.u64((geom as u64) << 32 | u64::from(*light));
            }
        }
        for pairs in &self.instanced {
            f.u64(pairs.len() as u64);
            for &(geom, light) in pairs {
                f.u64(u64::from(geom) << 32 | u64::from(light));
            }
        }
    }
}

/// Turns emitting surfaces into lights and drops lights that emit nothing.
pub(crate) fn collect(b: &SceneBuilder, report: &mut SceneReport) -> Result<Emitters, SceneError> {
    let mut out = Emitters {
        lights: Vec::new(),
        infinite: Vec::new(),
        found_by_rays: Vec::new(),
        unpicked: Vec::new(),
        direct: Vec::new(),
        instanced: Vec::new(),
    };
    for (geom, emission) in b.emission.iter().enumerate() {
        let Some(e) = emission else { continue };
        let (mean, max) = (e.radiance.mean(), e.radiance.max());
        let sound = |v: f32| v >= 0.0 && v.is_finite();
        if !(mean.to_array().into_iter().all(sound) && max.to_array().into_iter().all(sound)) {
            return Err(SceneError::BadEmission { geom: geom as u32 });
        }
        let material = &b.materials[b.geom_materials[geom] as usize];
        if material.needs().contains(Needs::CUTOUTS) && b.masks[geom] == 0 {
            let why = "its material has an opacity, so that rays alone find its light, and no ray sees it";
            return Err(SceneError::CannotEmit { geom: geom as u32, why });
        }
    }
    let has_holes = |geom: u32| {
        let material = &b.materials[b.geom_materials[geom as usize] as usize];
        material.needs().contains(Needs::CUTOUTS)
    };
    let mut keep = |light: Arc<dyn Light>, seen: bool, holes: bool| -> Option<u32> {
        // The radius only scales; any positive one tells zero from nonzero.
        if (0..light.parts()).all(|p| light.power(p, 1.0).is_black()) {
            report.zero_power_lights += 1;
            return None;
        }
        if light.is_infinite() {
            out.infinite.push(out.lights.len() as u32);
        }
        out.found_by_rays.push(seen && !light.is_delta());
        out.unpicked.push(holes);
        out.lights.push(if holes { Arc::new(Unpicked(light)) } else { light });
        Some(out.lights.len() as u32 - 1)
    };
    for (i, light) in b.lights.iter().enumerate() {
        if light.is_infinite() && light.parts() != 1 {
            return Err(SceneError::PartsAtInfinity { light: i, parts: light.parts() });
        }
        keep(light.clone(), light.is_infinite(), false);
    }
    if b.emission.iter().any(Option::is_some) {
        out.direct = vec![None; b.geometries.len()];
        for &geom in &b.direct {
            if let Some(e) = &b.emission[geom as usize] {
                let light = light_of(&b.geometries[geom as usize], geom, None, e)?;
                out.direct[geom as usize] = keep(light, b.masks[geom as usize] != 0, has_holes(geom));
            }
        }
        if b.instances.iter().any(|i| i.geoms.iter().any(|&g| b.emission[g as usize].is_some())) {
            for instance in &b.instances {
                let mut pairs = Vec::new();
                for &geom in instance.geoms.iter() {
                    if let Some(e) = &b.emission[geom as usize] {
                        let geometry = &b.geometries[geom as usize];
                        let mut light = light_of(geometry, geom, Some(&instance.to_world), e)?;
                        if let Some(motion) = &instance.motion {
                            light = Arc::new(MovingLight::of_instance(light, &instance.to_world, **motion));
                        }
                        let seen = b.masks[geom as usize] & instance.mask != 0;
                        pairs.extend(keep(light, seen, has_holes(geom)).map(|l| (geom, l)));
                    }
                }
                pairs.sort_unstable();
                out.instanced.push(pairs);
            }
        }
    }
    let mut unplaced: Vec<bool> = b.emission.iter().map(Option::is_some).collect();
    for &g in b.direct.iter().chain(b.instances.iter().flat_map(|i| i.geoms.iter())) {
        unplaced[g as usize] = false;
    }
    report.unplaced_emitters = unplaced.into_iter().filter(|&u| u).count() as u64;
    report.lights = out.lights.len() as u64;
    report.light_parts = out.lights.iter().map(|l| u64::from(l.parts())).sum();
    report.memory.lights = out.lights.iter().map(|l| l.bytes()).sum();
    Ok(out)
}

fn light_of(
    geometry: &Geometry,
    geom: u32,
    to_world: Option<&Transform>,
    e: &Emission,
) -> Result<Arc<dyn Light>, SceneError> {
    let cannot = |why| SceneError::CannotEmit { geom, why };
    let (radiance, two_sided) = (e.radiance.clone(), e.two_sided);
    let to_world = to_world.copied();
    // A placed shape may be sheared out of its family: it is sampled by area, like a shape from outside.
    let by_area = |shape: Arc<dyn Shape>| -> Result<Arc<dyn Light>, SceneError> {
        let drawn = shape.sample(etendue_core::Vec2::splat(0.5));
        if !(shape.area() > 0.0) || drawn.is_none() {
            return Err(cannot(
                "the shape gives no area or no samples; implement Shape::area and Shape::sample",
            ));
        }
        Ok(Arc::new(ShapeLight::new(shape, to_world, radiance.clone(), two_sided)))
    };
    Ok(match geometry {
        Geometry::Mesh(mesh) => Arc::new(MeshLight::new(mesh.clone(), to_world, radiance, two_sided)),
        Geometry::Sphere(s) if to_world.is_some() => by_area(Arc::new(*s))?,
        Geometry::Parallelogram(p) if to_world.is_some() => by_area(Arc::new(*p))?,
        Geometry::Sphere(s) => Arc::new(SphereLight { two_sided, ..SphereLight::new(*s, radiance) }),
        Geometry::Parallelogram(p) => {
            Arc::new(ParallelogramLight::new(*p, radiance).with_two_sided(two_sided))
        }
        Geometry::Disc(s) if to_world.is_some() => by_area(Arc::new(*s))?,
        Geometry::Disc(s) => Arc::new(DiscLight { two_sided, ..DiscLight::new(*s, radiance) }),
        Geometry::Cylinder(s) if s.length().is_finite() => by_area(Arc::new(*s))?,
        Geometry::Cylinder(_) => {
            return Err(cannot("a cylinder without ends has no finite power; give it ends"));
        }
        Geometry::Plane(_) => {
            return Err(cannot("an infinite plane has no finite power; use a parallelogram"));
        }
        Geometry::Open(shape) => by_area(shape.clone())?,
    })
}
