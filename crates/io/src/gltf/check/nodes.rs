//! Nodes, scenes and skins.

use std::collections::HashMap;

use serde_json::Value;

use super::graph::Forest;
use super::meshes::MeshFacts;
use super::model::{AccessorUse, Component, Format, MAT4, Model, ViewUse};
use super::report::{At, Report};
use super::storage::{use_accessor, use_view};
use super::values::{index, index_of, list, numbers};

/// Beyond the greatest error of a quaternion in signed bytes.
pub(super) const QUATERNION_TOLERANCE: f64 = 0.00769;

/// Checks nodes, scenes and skins.
pub(super) fn check(model: &mut Model<'_>, meshes: &[MeshFacts], report: &mut Report) {
    let forest = Forest::new(model, report);
    let array = At::Root.key("nodes");
    for (i, node) in model.list("nodes").iter().enumerate() {
        let here = array.index(i);
        check_transform(node, &here, report);
        check_mesh(node, meshes, &here, report);
    }
    let scenes = check_scenes(model, &forest, report);
    let roots = check_skins(model, &forest, report);
    let mut seen = HashMap::new();
    for (i, node) in model.list("nodes").iter().enumerate() {
        let Some(skin) = index_of(node, "skin").filter(|_| node.get("mesh").is_some()) else { continue };
        let (Some(own), Some(joints)) = (forest.root_of(i), roots.get(skin).copied().flatten()) else {
            continue;
        };
        let together = *seen.entry((own, joints)).or_insert_with(|| {
            let of = |root: usize| scenes.get(&root).map_or(&[][..], Vec::as_slice);
            own == joints || contains(of(joints), of(own))
        });
        if !together {
            report.error("NODE_SKIN_NO_SCENE", &array.index(i), || {
                format!("a scene has this node but not the joints of skin {skin}; add their root to it")
            });
        }
        if ["matrix", "translation", "rotation", "scale"].iter().any(|k| node.get(*k).is_some()) {
            report.warning("NODE_SKINNED_MESH_LOCAL_TRANSFORMS", &array.index(i), || {
                "a skinned mesh is placed by its joints alone; its node's own transform has no effect".into()
            });
        }
    }
}

/// Whether a sorted list has all of another.
fn contains(all: &[usize], some: &[usize]) -> bool {
    let mut all = all.iter();
    some.len() <= all.len() && some.iter().all(|s| all.by_ref().any(|a| a == s))
}

fn check_transform(node: &Value, at: &At<'_>, report: &mut Report) {
    if let Some(q) = numbers::<4>(node, "rotation") {
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (length - 1.0).abs() > QUATERNION_TOLERANCE {
            report.error("ROTATION_NON_UNIT", &at.key("rotation"), || {
                format!("the quaternion's length is {length}; it must be 1")
            });
        }
    }
    if node.get("matrix").is_none() {
        return;
    }
    let here = at.key("matrix");
    if ["translation", "rotation", "scale"].iter().any(|k| node.get(*k).is_some()) {
        report.error("NODE_MATRIX_TRS", &here, || {
            "beside a matrix there is a translation, rotation or scale; only one way is allowed".into()
        });
    }
    if numbers::<16>(node, "matrix").is_some_and(|m| !is_trs(&m)) {
        report.error("NODE_MATRIX_NON_TRS", &here, || {
            "the matrix shears or projects; it must be a product of translation, rotation and scale".into()
        });
    }
}

/// Whether a matrix is a product of translation, rotation and scale: the last row is plain and the columns are at
/// right angles.
fn is_trs(m: &[f64; 16]) -> bool {
    let [a0, a1, a2, a3, b0, b1, b2, b3, c0, c1, c2, c3, _, _, _, d3] = *m;
    let columns = [[a0, a1, a2], [b0, b1, b2], [c0, c1, c2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let right = |a: [f64; 3], b: [f64; 3]| dot(a, b).abs() <= 1e-3 * (dot(a, a) * dot(b, b)).sqrt();
    let [a, b, c] = columns;
    a3 == 0.0 && b3 == 0.0 && c3 == 0.0 && d3 == 1.0 && right(a, b) && right(b, c) && right(c, a)
}

fn check_mesh(node: &Value, meshes: &[MeshFacts], at: &At<'_>, report: &mut Report) {
    let Some(mesh) = index_of(node, "mesh").and_then(|m| meshes.get(m)) else { return };
    if let Some(weights) = node.get("weights").and_then(Value::as_array).filter(|w| w.len() != mesh.targets) {
        report.error("NODE_WEIGHTS_INVALID", &at.key("weights"), || {
            format!(
                "{} weights for {} morph targets; there must be one for each",
                weights.len(),
                mesh.targets
            )
        });
    }
    match (node.get("skin").is_some(), mesh.joints) {
        (true, false) => report.error("NODE_SKIN_WITH_NON_SKINNED_MESH", at, || {
            "it has a skin but its mesh has no JOINTS_0; leave the skin out".into()
        }),
        (false, true) => report.warning("NODE_SKINNED_MESH_WITHOUT_SKIN", at, || {
            "its mesh has joints but it has no skin; the mesh is shown as it is stored".into()
        }),
        _ => {}
    }
}

/// The scenes of each root node, in rising order.
fn check_scenes(model: &Model<'_>, forest: &Forest, report: &mut Report) -> HashMap<usize, Vec<usize>> {
    let mut of: HashMap<usize, Vec<usize>> = HashMap::new();
    let array = At::Root.key("scenes");
    for (i, scene) in model.list("scenes").iter().enumerate() {
        let here = array.index(i);
        let here = here.key("nodes");
        for (k, node) in list(scene, "nodes").iter().enumerate() {
            let Some(node) = index(node) else { continue };
            if let Some(parent) = forest.parent.get(node).copied().flatten() {
                report.error("SCENE_NON_ROOT_NODE", &here.index(k), || {
                    format!("node {node} is a child of node {parent}; a scene lists only roots")
                });
            }
            let scenes = of.entry(node).or_default();
            if scenes.last() != Some(&i) {
                scenes.push(i);
            }
        }
    }
    of
}

/// The root above the joints of each skin.
fn check_skins(model: &mut Model<'_>, forest: &Forest, report: &mut Report) -> Vec<Option<usize>> {
    let array = At::Root.key("skins");
    let skins = model.list("skins");
    let mut roots = Vec::with_capacity(skins.len());
    for (i, skin) in skins.iter().enumerate() {
        let here = array.index(i);
        let joints = list(skin, "joints");
        let mut above = joints.iter().map(|j| index(j).and_then(|j| forest.root_of(j)));
        let first = above.next().flatten();
        let common = first.filter(|_| above.all(|root| root == first));
        if !joints.is_empty() && common.is_none() {
            report.error("SKIN_NO_COMMON_ROOT", &here.key("joints"), || {
                "the joints have no common root; put them below one node".into()
            });
        }
        roots.push(common);
        let skeleton = index_of(skin, "skeleton").filter(|s| model.list("nodes").get(*s).is_some());
        let is_above = |s: usize| joints.iter().filter_map(index).all(|j| forest.is_above(s, j));
        if let Some(skeleton) = skeleton.filter(|s| !is_above(*s)) {
            report.error("SKIN_SKELETON_INVALID", &here.key("skeleton"), || {
                format!("node {skeleton} is not above all joints; name a node that is, or none")
            });
        }
        check_matrices(model, skin, joints.len(), &here, report);
    }
    roots
}

fn check_matrices(model: &mut Model<'_>, skin: &Value, joints: usize, at: &At<'_>, report: &mut Report) {
    let Some(accessor_index) = index_of(skin, "inverseBindMatrices") else { return };
    let Some(accessor) = model.accessors.get(accessor_index).copied() else { return };
    let here = at.key("inverseBindMatrices");
    use_accessor(model, accessor_index, AccessorUse::Matrices, &here, report);
    use_view(model, accessor.view, ViewUse::Matrices, &here, report);
    if model.view_of(&accessor).is_some_and(|v| v.stride.is_some()) {
        report.error("SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE", &here, || {
            "the matrices' view has a byteStride; leave it out".into()
        });
    }
    if let Some(format) = accessor.format.filter(|f| *f != Format::new(MAT4, Component::F32, false)) {
        report.error("SKIN_IBM_INVALID_FORMAT", &here, || format!("{format} where MAT4 of FLOAT must be"));
    }
    if accessor.count < joints as u64 {
        report.error("INVALID_IBM_ACCESSOR_COUNT", &here, || {
            format!("{} matrices for {joints} joints; there must be one for each", accessor.count)
        });
    }
}
