use std::sync::Arc;

use etendue_bvh::World;
use etendue_core::Needs;
use etendue_geometry::Geometry;
use etendue_material::Material;

use crate::SceneReport;
use crate::emitters::Emitters;

/// Looks the scene over once: what it uses is built and run, what it does not use is neither.
pub(crate) fn take(
    world: &World,
    materials: &[Arc<dyn Material>],
    geom_materials: &[u32],
    emitters: &Emitters,
    report: &mut SceneReport,
) {
    let mut needs = Needs::empty();
    // Only materials that something placed uses count.
    let mut used = vec![false; materials.len()];
    let mut placed = vec![false; world.geometries.len()];
    let ids = world.direct.iter().chain(world.instances.iter().flat_map(|i| i.geoms.iter()));
    for &g in ids {
        placed[g as usize] = true;
        used[geom_materials[g as usize] as usize] = true;
    }
    for (m, used) in materials.iter().zip(&used) {
        report.memory.materials += m.bytes();
        if *used {
            needs |= m.needs();
        }
    }
    for (g, placed) in world.geometries.iter().zip(&placed) {
        report.memory.geometry += g.bytes();
        if !placed {
            continue;
        }
        match g {
            Geometry::Mesh(mesh) => {
                let r = mesh.report();
                report.degenerate_triangles += r.degenerate as u64;
                report.non_finite_triangles += r.non_finite as u64;
                report.duplicate_triangles += r.duplicate as u64;
                report.triangles +=
                    (mesh.triangle_count() - r.degenerate - r.non_finite - r.duplicate) as u64;
                if !mesh.normals().is_empty() {
                    needs |= Needs::SHADING_NORMALS;
                }
            }
            Geometry::Open(_) => {
                report.shapes += 1;
                needs |= Needs::OPEN_SHAPES;
            }
            _ => report.shapes += 1,
        }
    }
    if !world.instances.is_empty() {
        needs |= Needs::INSTANCES;
        report.instances = world.instances.len() as u64;
    }
    report.moving =
        world.instances.iter().filter(|i| i.motion.is_some() && !i.geoms.is_empty()).count() as u64;
    if report.moving > 0 {
        needs |= Needs::MOTION;
    }
    for (light, left_to_rays) in emitters.lights.iter().zip(&emitters.unpicked) {
        needs |= light.needs() | Needs::LIGHTS;
        if light.is_infinite() {
            needs |= Needs::ENVIRONMENT;
        }
        if !light.is_delta() && !left_to_rays {
            needs |= Needs::AREA_LIGHTS;
        }
    }
    if emitters.picked().0 > 1 {
        needs |= Needs::MANY_LIGHTS;
    }
    report.needs = needs;
}
