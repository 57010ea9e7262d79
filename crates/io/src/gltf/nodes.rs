//! The node graph: which meshes, cameras and lights stand where.

use etendue_core::glam::{DMat4, DQuat, DVec3};
use gltf::json::Index;
use gltf::json::scene::Node;

use super::GltfError;
use super::accessor::Accessors;
use super::document::Document;
use super::extensions::{self, GpuInstancing, NodeLight, Visibility};

/// A mesh at a place.
pub(super) struct Placement {
    pub(super) node: usize,
    pub(super) mesh: usize,
    pub(super) to_world: DMat4,
}

/// Everything the scene holds, in world space.
pub(super) struct Walked {
    pub(super) meshes: Vec<Placement>,
    /// Camera and the node that holds it.
    pub(super) cameras: Vec<(usize, usize)>,
    /// Punctual light and the node that holds it.
    pub(super) lights: Vec<(usize, usize)>,
    /// By node; `None` for nodes that are not in the scene.
    pub(super) world: Vec<Option<DMat4>>,
}

/// A node whose parent has been placed.
struct Step {
    node: usize,
    parent: DMat4,
    depth: usize,
    visible: bool,
}

/// Walks the scene without recursion. A node that is met twice, by a cycle or by two parents, is an error: it is what
/// keeps the work in proportion to the file.
pub(super) fn walk(doc: &Document<'_>, accessors: &Accessors<'_>) -> Result<Walked, GltfError> {
    let nodes = &doc.root.nodes;
    let mut out = Walked {
        meshes: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
        world: vec![None; nodes.len()],
    };
    let mut placed = 0u64;
    let root = |node: usize| Step { node, parent: DMat4::IDENTITY, depth: 1, visible: true };
    // Depth first in the order of the file: the stack holds what comes later.
    let mut stack: Vec<Step> = roots(doc)?.into_iter().rev().map(root).collect();
    while let Some(step) = stack.pop() {
        let pointer = || format!("/nodes/{}", step.node);
        let node =
            nodes.get(step.node).ok_or_else(|| doc.unusable(pointer(), "there is no such node".into()))?;
        if step.depth > doc.limits().node_depth {
            return Err(GltfError::Limit {
                file: doc.name.into(),
                pointer: pointer(),
                what: "nodes in a chain",
                asked: step.depth as u64,
                limit: doc.limits().node_depth as u64,
            });
        }
        let to_world = step.parent * local(node);
        match out.world.get_mut(step.node) {
            Some(slot @ None) => *slot = Some(to_world),
            _ => {
                let message = "the node is reached twice: by a cycle, or from two parents; copy it instead";
                return Err(doc.unusable(pointer(), message.into()));
            }
        }
        let others = node.extensions.as_ref().map(|e| &e.others);
        let visible = step.visible
            && extensions::get::<Visibility>(others, "KHR_node_visibility").is_none_or(|v| v.visible);
        if visible {
            if let Some(mesh) = node.mesh {
                let each = copies(node, to_world, accessors)?;
                placed = placed.saturating_add(each.len() as u64);
                if placed > doc.limits().instances {
                    return Err(GltfError::Limit {
                        file: doc.name.into(),
                        pointer: pointer(),
                        what: "placements",
                        asked: placed,
                        limit: doc.limits().instances,
                    });
                }
                let place = |to_world| Placement { node: step.node, mesh: mesh.value(), to_world };
                out.meshes.extend(each.into_iter().map(place));
            }
            if let Some(light) = extensions::get::<NodeLight>(others, "KHR_lights_punctual") {
                out.lights.push((light.light, step.node));
            }
        }
        if let Some(camera) = node.camera {
            out.cameras.push((camera.value(), step.node));
        }
        let children: &[Index<Node>] = node.children.as_deref().unwrap_or(&[]);
        let depth = step.depth.saturating_add(1);
        stack.extend(children.iter().rev().map(|c| Step {
            node: c.value(),
            parent: to_world,
            depth,
            visible,
        }));
    }
    Ok(out)
}

/// Where the walk begins: the default scene, else the first, else every node that is nobody's child.
fn roots(doc: &Document<'_>) -> Result<Vec<usize>, GltfError> {
    let root = &doc.root;
    let scene = root.scene.map_or(0, |s| s.value());
    if let Some(scene) = root.scenes.get(scene) {
        return Ok(scene.nodes.iter().map(Index::value).collect());
    }
    if root.scene.is_some() {
        return Err(doc.unusable("/scene".into(), format!("there is no scene {scene}")));
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().filter_map(|n| n.children.as_ref()).flatten() {
        if let Some(flag) = is_child.get_mut(child.value()) {
            *flag = true;
        }
    }
    Ok(is_child.iter().enumerate().filter(|(_, child)| !**child).map(|(i, _)| i).collect())
}

fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}

/// A node's own placement, in double precision so that long chains stay exact to the last single-precision digit.
fn local(node: &Node) -> DMat4 {
    if let Some(m) = node.matrix {
        return DMat4::from_cols_array(&m.map(f64::from));
    }
    trs(
        node.translation.unwrap_or([0.0; 3]),
        node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |r| r.0),
        node.scale.unwrap_or([1.0; 3]),
    )
}

fn trs(translation: [f32; 3], rotation: [f32; 4], scale: [f32; 3]) -> DMat4 {
    let [x, y, z, w] = rotation.map(f64::from);
    let length = (x * x + y * y + z * z + w * w).sqrt();
    // A quaternion without length turns nothing.
    let q = if length > 0.0 && length.is_finite() {
        DQuat::from_xyzw(x / length, y / length, z / length, w / length)
    } else {
        DQuat::IDENTITY
    };
    DMat4::from_scale_rotation_translation(wide(scale), q, wide(translation))
}

/// One placement, or those that `EXT_mesh_gpu_instancing` asks for.
fn copies(node: &Node, to_world: DMat4, accessors: &Accessors<'_>) -> Result<Vec<DMat4>, GltfError> {
    let others = node.extensions.as_ref().map(|e| &e.others);
    let Some(gpu) = extensions::get::<GpuInstancing>(others, "EXT_mesh_gpu_instancing") else {
        return Ok(vec![to_world]);
    };
    let a = gpu.attributes;
    let t = a.translation.map(|i| accessors.floats::<3>(Index::new(i))).transpose()?;
    let r = a.rotation.map(|i| accessors.floats::<4>(Index::new(i))).transpose()?;
    let s = a.scale.map(|i| accessors.floats::<3>(Index::new(i))).transpose()?;
    let lengths = [t.as_ref().map(Vec::len), r.as_ref().map(Vec::len), s.as_ref().map(Vec::len)];
    let count = lengths.into_iter().flatten().min().unwrap_or(0);
    Ok((0..count)
        .map(|i| {
            to_world
                * trs(
                    t.as_ref().and_then(|t| t.get(i)).copied().unwrap_or([0.0; 3]),
                    r.as_ref().and_then(|r| r.get(i)).copied().unwrap_or([0.0, 0.0, 0.0, 1.0]),
                    s.as_ref().and_then(|s| s.get(i)).copied().unwrap_or([1.0; 3]),
                )
        })
        .collect())
}
