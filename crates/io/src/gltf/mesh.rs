//! Primitives into triangle meshes.

use etendue_core::glam::{DMat3, DMat4, DVec3};
use etendue_core::{Vec2, Vec3, Vec4};
use etendue_geometry::TriangleMesh;
use gltf::json::accessor::Type;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::accessor::{Accessors, Which};
use super::document::Document;
use super::{GltfError, skin, tangents};

/// What a material reads of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Wanted {
    /// The sets of texture coordinates, by their numbers in the file, in the slots they take.
    pub(super) sets: Vec<u32>,
    /// The set along which the normal map lies.
    pub(super) tangents_of: Option<u32>,
}

/// The vertices of a primitive while it is being made.
#[derive(Clone, Debug, Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) tangents: Vec<[f32; 4]>,
    pub(super) uv: Vec<Vec<[f32; 2]>>,
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// The colours at the vertices of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Colors {
    None,
    Opaque,
    WithAlpha,
}

/// How a primitive is moved before it becomes a mesh.
pub(super) enum Pose<'a> {
    /// It stays in object space.
    Object,
    /// Its only placement is worked into it.
    Baked(&'a DMat4),
    /// Its joints take it into the world.
    Skinned(&'a [DMat4]),
}

impl Vertices {
    /// Vertex `i` of the result is vertex `sources[i]` of before.
    pub(super) fn gather(&mut self, sources: &[u32]) {
        fn pick<T: Copy>(values: &mut Vec<T>, sources: &[u32]) {
            if !values.is_empty() {
                *values = sources.iter().filter_map(|&i| values.get(i as usize).copied()).collect();
            }
        }
        pick(&mut self.positions, sources);
        pick(&mut self.normals, sources);
        pick(&mut self.tangents, sources);
        pick(&mut self.colors, sources);
        for uv in &mut self.uv {
            pick(uv, sources);
        }
    }

    /// Numbers the corners anew if many of the `count` vertices are not used; the ones that are, ascending.
    fn only_used(&mut self, count: usize) -> Option<Vec<u32>> {
        if self.triangles.len().saturating_mul(3) >= count {
            return None;
        }
        let mut used: Vec<u32> = self.triangles.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        for corner in self.triangles.iter_mut().flatten() {
            let place = used.binary_search(corner).ok().and_then(|i| u32::try_from(i).ok());
            *corner = place.unwrap_or(u32::MAX);
        }
        Some(used)
    }

    /// Moves one vertex with its normal and tangent.
    pub(super) fn transform_one(&mut self, i: usize, m: &DMat4) {
        let narrow = |v: DVec3| [v.x as f32, v.y as f32, v.z as f32];
        if let Some(p) = self.positions.get_mut(i) {
            *p = narrow(m.transform_point3(DVec3::from_array(p.map(f64::from))));
        }
        if let Some(n) = self.normals.get_mut(i) {
            let moved = cofactors(m) * DVec3::from_array(n.map(f64::from));
            let longest = moved.abs().max_element();
            // Lengths mean nothing; keep them in range however large the placement is.
            *n = narrow(if longest > 0.0 { moved / longest } else { moved });
        }
        if let Some([x, y, z, w]) = self.tangents.get_mut(i) {
            let t = skin::vector(m, [*x, *y, *z]);
            let longest = t.abs().max_element();
            [*x, *y, *z] = narrow(if longest > 0.0 { t / longest } else { t });
            if DMat3::from_mat4(*m).determinant() < 0.0 {
                *w = -*w;
            }
        }
    }

    fn bake(&mut self, m: &DMat4) {
        for i in 0..self.positions.len() {
            self.transform_one(i, m);
        }
        let mirrors = DMat3::from_mat4(*m).determinant() < 0.0;
        self.turn(|_| mirrors);
    }

    /// A mirror turns the order of corners around; the front stays the front. Says of each vertex whether it was mirrored.
    fn turn(&mut self, mirrored: impl Fn(u32) -> bool) {
        for t in &mut self.triangles {
            if t.iter().filter(|&&i| mirrored(i)).count() > 1 {
                t.swap(1, 2);
            }
        }
    }

    fn into_mesh(self) -> Result<TriangleMesh, etendue_geometry::MeshError> {
        let vec3 = |v: Vec<[f32; 3]>| v.into_iter().map(Vec3::from_array).collect::<Vec<_>>();
        let vec4 = |v: Vec<[f32; 4]>| v.into_iter().map(Vec4::from_array).collect::<Vec<_>>();
        let mut mesh = TriangleMesh::new(vec3(self.positions), self.triangles)?;
        if !self.normals.is_empty() {
            mesh = mesh.with_normals(vec3(self.normals))?;
        }
        if !self.tangents.is_empty() {
            mesh = mesh.with_tangents(vec4(self.tangents))?;
        }
        for (slot, uv) in self.uv.into_iter().enumerate() {
            if !uv.is_empty() {
                mesh = mesh.with_uv(slot, uv.into_iter().map(Vec2::from_array).collect())?;
            }
        }
        if !self.colors.is_empty() {
            mesh = mesh.with_colors(vec4(self.colors))?;
        }
        Ok(mesh)
    }
}

/// The matrix by which normals go: transposed inverse times the determinant, which a flat placement has too.
fn cofactors(m: &DMat4) -> DMat3 {
    let m = DMat3::from_mat4(*m);
    let (a, b, c) = (m.x_axis, m.y_axis, m.z_axis);
    let side = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b)) * side
}

/// Whether a primitive is made of triangles.
pub(super) fn is_surface(p: &Primitive) -> bool {
    matches!(p.mode, Checked::Valid(Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan))
}

/// Whether a primitive hangs on joints.
pub(super) fn is_skinned(p: &Primitive) -> bool {
    p.attributes.contains_key(&Checked::Valid(Semantic::Joints(0)))
        && p.attributes.contains_key(&Checked::Valid(Semantic::Weights(0)))
}

/// Whether more than four joints pull at a vertex.
pub(super) fn has_more_joints(p: &Primitive) -> bool {
    p.attributes.contains_key(&Checked::Valid(Semantic::Joints(1)))
}

/// What colours a primitive has at its vertices.
pub(super) fn colors(doc: &Document<'_>, p: &Primitive) -> Colors {
    let accessor = p.attributes.get(&Checked::Valid(Semantic::Colors(0)));
    match accessor.map(|a| doc.root.accessors.get(a.value()).map(|a| a.type_)) {
        None => Colors::None,
        Some(Some(Checked::Valid(Type::Vec3))) => Colors::Opaque,
        Some(_) => Colors::WithAlpha,
    }
}

/// One primitive of `/meshes/{mesh}` as a mesh; `None` where it has no triangle.
#[allow(clippy::too_many_arguments)]
pub(super) fn build(
    doc: &Document<'_>,
    accessors: &Accessors<'_>,
    pointer: &str,
    p: &Primitive,
    weights: &[f32],
    wanted: &Wanted,
    pose: &Pose<'_>,
    warnings: &mut Vec<String>,
) -> Result<Option<TriangleMesh>, GltfError> {
    let fail = |message: String| doc.unusable(pointer.into(), message);
    let attribute = |s: Semantic| p.attributes.get(&Checked::Valid(s)).copied();
    let Some(positions) = attribute(Semantic::Positions) else { return Ok(None) };
    let count = usize::try_from(accessors.count(positions)).unwrap_or(usize::MAX);
    accessors.vouch::<3>(positions)?;
    let mut v = Vertices { triangles: triangles(accessors, p, positions, count)?, ..Vertices::default() };
    if v.triangles.is_empty() {
        return Ok(None);
    }
    if let Some(&index) = v.triangles.iter().flatten().find(|&&i| i as usize >= count) {
        return Err(fail(format!("index {index} is beyond the {count} vertices")));
    }
    // Primitives may share the vertices of a whole scene: each takes its own.
    let used = v.only_used(count);
    let which = used.as_deref().map_or(Which::All, Which::These);
    let fits = |what: &str, index: Index<_>| match accessors.count(index) {
        n if n == count as u64 => Ok(index),
        n => Err(fail(format!("it has {n} {what} for {count} vertices"))),
    };
    v.positions = accessors.floats::<3>(positions, which)?;
    if let Some(index) = attribute(Semantic::Normals) {
        v.normals = accessors.floats::<3>(fits("normals", index)?, which)?;
    }
    for &set in &wanted.sets {
        v.uv.push(match attribute(Semantic::TexCoords(set)) {
            Some(index) => accessors.floats::<2>(fits("texture coordinates", index)?, which)?,
            None => Vec::new(),
        });
    }
    if let Some(index) = attribute(Semantic::Colors(0)) {
        v.colors = accessors.colors(fits("colours", index)?, which)?;
    }
    // Given tangents belong to given normals.
    let needs_tangents = wanted.tangents_of.is_some() && !v.normals.is_empty();
    if let Some(index) = attribute(Semantic::Tangents).filter(|_| needs_tangents) {
        v.tangents = accessors.floats::<4>(fits("tangents", index)?, which)?;
    }
    if apply_targets(accessors, p, weights, which, &mut v)? {
        // They lay along the surface as it was.
        v.tangents.clear();
    }
    if let Pose::Skinned(joints) = pose {
        apply_skin(accessors, p, joints, which, &mut v)?;
    }
    if let Some(set) = wanted.tangents_of.filter(|_| v.tangents.is_empty())
        && !make_tangents(&mut v, wanted, set)
    {
        warnings.push(format!(
            "{}, at '{pointer}': too many triangles meet in one point for MikkTSpace; tangents follow the texture \
             coordinates of each triangle",
            doc.name
        ));
    }
    if let Pose::Baked(m) = pose {
        v.bake(m);
    }
    if !v.positions.iter().flatten().all(|c| c.is_finite()) && !doc.options.lenient {
        let message = "a vertex is not a finite number where it is placed; a lenient load (--lenient) leaves its \
                       triangles out";
        return Err(fail(message.into()));
    }
    v.into_mesh().map(Some).map_err(|e| fail(e.to_string()))
}

/// False where it cannot be done. Without normals the mesh is flat, and so is each triangle's tangent: the geometry
/// derives it by itself, from the set in the first slot, which is the normal map's.
fn make_tangents(v: &mut Vertices, wanted: &Wanted, set: u32) -> bool {
    let slot = wanted.sets.iter().position(|&s| s == set);
    let Some(uv) = slot.and_then(|s| v.uv.get(s)).filter(|uv| !uv.is_empty()).cloned() else { return true };
    v.normals.is_empty() || tangents::generate(v, &uv)
}

/// Whether a target has moved anything.
fn apply_targets(
    accessors: &Accessors<'_>,
    p: &Primitive,
    weights: &[f32],
    which: Which<'_>,
    v: &mut Vertices,
) -> Result<bool, GltfError> {
    let mut moved = false;
    for (target, &weight) in p.targets.iter().flatten().zip(weights).filter(|(_, w)| **w != 0.0) {
        let read =
            |index: Option<Index<_>>| index.map_or(Ok(Vec::new()), |i| accessors.floats::<3>(i, which));
        moved = true;
        skin::morph(v, weight, &read(target.positions)?, &read(target.normals)?);
    }
    Ok(moved)
}

fn apply_skin(
    accessors: &Accessors<'_>,
    p: &Primitive,
    joints: &[DMat4],
    which: Which<'_>,
    v: &mut Vertices,
) -> Result<(), GltfError> {
    let attribute = |s: Semantic| p.attributes.get(&Checked::Valid(s)).copied();
    let (Some(j), Some(w)) = (attribute(Semantic::Joints(0)), attribute(Semantic::Weights(0))) else {
        return Ok(());
    };
    let influences: Vec<_> =
        accessors.joints(j, which)?.into_iter().zip(accessors.floats::<4>(w, which)?).collect();
    let mirrored = skin::pose(v, joints, &influences);
    v.turn(|i| mirrored.get(i as usize).copied().unwrap_or(false));
    Ok(())
}

/// The corners of all triangles, strips and fans taken apart with their winding.
fn triangles(
    accessors: &Accessors<'_>,
    p: &Primitive,
    positions: Index<Accessor>,
    count: usize,
) -> Result<Vec<[u32; 3]>, GltfError> {
    let indices: Vec<u32> = match p.indices {
        Some(index) => accessors.indices(index)?,
        None => {
            accessors.charge(positions, count as u64)?;
            (0..u32::try_from(count).unwrap_or(u32::MAX)).collect()
        }
    };
    let triple = |w: &[u32]| <[u32; 3]>::try_from(w).ok();
    Ok(match p.mode {
        Checked::Valid(Mode::TriangleStrip) => {
            let turned = |(i, w): (usize, &[u32])| {
                let [a, b, c] = triple(w)?;
                Some(if i % 2 == 0 { [a, b, c] } else { [b, a, c] })
            };
            indices.windows(3).enumerate().filter_map(turned).collect()
        }
        Checked::Valid(Mode::TriangleFan) => match indices.split_first() {
            Some((&first, rest)) => rest
                .windows(2)
                .filter_map(|w| <[u32; 2]>::try_from(w).ok())
                .map(|[a, b]| [first, a, b])
                .collect(),
            None => Vec::new(),
        },
        Checked::Valid(Mode::Triangles) => indices.chunks_exact(3).filter_map(triple).collect(),
        _ => Vec::new(),
    })
}
