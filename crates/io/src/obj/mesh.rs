use std::sync::Arc;

use etendue_core::{Vec2, Vec3, Vec4};
use etendue_geometry::{Geometry, TriangleMesh};
use etendue_scene::SceneBuilder;

use crate::obj::materials::{Made, add_geometry};
use crate::obj::{ObjError, ObjReport};

/// Adds one model. Attributes that do not fit the vertices are dropped with a warning.
pub(crate) fn add(
    file: &str,
    model: &tobj::Model,
    made: &mut Made<'_>,
    builder: &mut SceneBuilder,
    report: &mut ObjReport,
) -> Result<(), ObjError> {
    let m = &model.mesh;
    let indices: Vec<[u32; 3]> = m.indices.as_chunks().0.to_vec();
    if indices.is_empty() {
        return Ok(());
    }
    let vec3 = |v: &[f32]| -> Vec<Vec3> { v.as_chunks().0.iter().copied().map(Vec3::from_array).collect() };
    let positions = vec3(&m.positions);
    let count = positions.len();
    let fail = |source| ObjError::Mesh { file: file.into(), object: model.name.clone(), source };
    let mut mesh = TriangleMesh::new(positions, indices).map_err(fail)?;
    let mut fits = |what: &str, n: usize| {
        if n != 0 && n != count {
            report
                .warnings
                .push(format!("{file}, object '{}': {n} {what} for {count} vertices; dropped", model.name));
        }
        n == count
    };
    if fits("normals", m.normals.len() / 3) {
        mesh = mesh.with_normals(vec3(&m.normals)).map_err(fail)?;
    }
    if fits("texture coordinates", m.texcoords.len() / 2) {
        // OBJ counts v upward, pictures are stored from the top.
        let uv = m.texcoords.as_chunks().0.iter().map(|&[u, v]| Vec2::new(u, 1.0 - v)).collect();
        mesh = mesh.with_uv(0, uv).map_err(fail)?;
    }
    if fits("colours", m.vertex_color.len() / 3) {
        let colors = m.vertex_color.as_chunks().0.iter().map(|&[r, g, b]| Vec4::new(r, g, b, 1.0)).collect();
        mesh = mesh.with_colors(colors).map_err(fail)?;
    }
    report.meshes = report.meshes.saturating_add(1);
    report.triangles = report.triangles.saturating_add(mesh.triangle_count());
    report.has_light |= add_geometry(Geometry::Mesh(Arc::new(mesh)), m.material_id, made, builder);
    Ok(())
}
