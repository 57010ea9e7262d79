//! The pose that the file itself is in: morph targets and skins, applied to the vertices.

use etendue_core::glam::{DMat3, DMat4, DVec3};

use super::GltfError;
use super::accessor::{Accessors, Which};
use super::document::Document;
use super::mesh::Vertices;

/// Joint matrices of a skin: from the mesh's space as it was bound to the world.
pub(super) fn joints(
    doc: &Document<'_>,
    accessors: &Accessors<'_>,
    skin: usize,
    world: &[Option<DMat4>],
) -> Result<Vec<DMat4>, GltfError> {
    let Some(skin) = doc.root.skins.get(skin) else {
        return Err(doc.unusable(format!("/skins/{skin}"), "there is no such skin".into()));
    };
    let bind = match skin.inverse_bind_matrices {
        Some(index) => accessors.floats::<16>(index, Which::All)?,
        None => Vec::new(),
    };
    let of = |(i, joint): (usize, &gltf::json::Index<gltf::json::Node>)| {
        let bind = bind.get(i).map_or(DMat4::IDENTITY, |m| DMat4::from_cols_array(&m.map(f64::from)));
        // A joint outside of the scene stands where nothing moved it.
        world.get(joint.value()).copied().flatten().unwrap_or(DMat4::IDENTITY) * bind
    };
    Ok(skin.joints.iter().enumerate().map(of).collect())
}

/// Adds the weighted displacements of one morph target.
pub(super) fn morph(vertices: &mut Vertices, weight: f32, positions: &[[f32; 3]], normals: &[[f32; 3]]) {
    for (to, by) in [(&mut vertices.positions, positions), (&mut vertices.normals, normals)] {
        for (t, d) in to.iter_mut().zip(by) {
            for (t, d) in t.iter_mut().zip(d) {
                *t += weight * d;
            }
        }
    }
}

/// Moves the vertices to where their joints take them: into world space. Says of each whether it was mirrored.
pub(super) fn pose(
    vertices: &mut Vertices,
    joints: &[DMat4],
    influences: &[([u32; 4], [f32; 4])],
) -> Vec<bool> {
    let mut mirrored = vec![false; influences.len()];
    for (i, ((ids, weights), mirrored)) in influences.iter().zip(&mut mirrored).enumerate() {
        let total: f64 = weights.iter().map(|w| f64::from(*w)).sum();
        if !(total > 0.0) {
            continue;
        }
        let mut m = DMat4::ZERO;
        for (id, w) in ids.iter().zip(weights) {
            m += joints.get(*id as usize).copied().unwrap_or(DMat4::IDENTITY) * (f64::from(*w) / total);
        }
        *mirrored = DMat3::from_mat4(m).determinant() < 0.0;
        vertices.transform_one(i, &m);
    }
    mirrored
}

/// A direction through the linear part.
pub(super) fn vector(m: &DMat4, v: [f32; 3]) -> DVec3 {
    m.transform_vector3(DVec3::from_array(v.map(f64::from)))
}
