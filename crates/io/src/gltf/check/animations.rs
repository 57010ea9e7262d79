//! Animations.

use std::collections::HashMap;

use serde_json::Value;

use super::attributes::allows_animation;
use super::meshes::MeshFacts;
use super::model::{Accessor, AccessorUse, Component, Format, Model, SCALAR, ViewUse};
use super::report::{At, Report};
use super::storage::{use_accessor, use_view};
use super::values::{index_of, list, text_of};

/// Checks all animations.
pub(super) fn check(model: &mut Model<'_>, meshes: &[MeshFacts], report: &mut Report) {
    let array = At::Root.key("animations");
    for (i, animation) in model.list("animations").iter().enumerate() {
        let here = array.index(i);
        let samplers = list(animation, "samplers");
        let within = here.key("samplers");
        for (k, sampler) in samplers.iter().enumerate() {
            check_sampler(model, sampler, &within.index(k), report);
        }
        let channels = list(animation, "channels");
        let mut last: HashMap<(usize, &str), usize> = HashMap::new();
        let within = here.key("channels");
        for (k, channel) in channels.iter().enumerate().rev() {
            let here = within.index(k);
            let Some(target) = channel.get("target") else { continue };
            let place = here.key("target");
            let (node, path) = (index_of(target, "node"), text_of(target, "path").unwrap_or(""));
            if let Some(other) = node.and_then(|n| last.insert((n, path), k)) {
                report.error("ANIMATION_DUPLICATE_TARGETS", &place, || {
                    format!("channel {other} moves the same; only one may")
                });
            }
            let node = node.and_then(|n| model.list("nodes").get(n));
            let mesh = node.and_then(|n| index_of(n, "mesh")).and_then(|m| meshes.get(m));
            if let Some(node) = node {
                check_target(node, path, mesh, &place, report);
            }
            check_channel(model, channel, samplers, path, mesh, &here.key("sampler"), report);
        }
    }
}

fn check_sampler(model: &mut Model<'_>, sampler: &Value, at: &At<'_>, report: &mut Report) {
    for (name, usage) in [("input", AccessorUse::AnimationInput), ("output", AccessorUse::AnimationOutput)] {
        let Some(index) = index_of(sampler, name) else { continue };
        let Some(accessor) = model.accessors.get(index).copied() else { continue };
        let here = at.key(name);
        use_accessor(model, index, usage, &here, report);
        use_view(model, accessor.view, ViewUse::Other, &here, report);
        if model.view_of(&accessor).is_some_and(|v| v.stride.is_some()) {
            report.error("ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE", &here, || {
                "the view of an animation's data has a byteStride; leave it out".into()
            });
        }
        if usage == AccessorUse::AnimationInput {
            check_input(&accessor, sampler, &here, report);
        }
    }
}

fn check_input(accessor: &Accessor, sampler: &Value, at: &At<'_>, report: &mut Report) {
    if let Some(format) = accessor.format.filter(|f| *f != Format::new(SCALAR, Component::F32, false)) {
        report.error("ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT", at, || {
            format!("{format} where times must be SCALAR of FLOAT")
        });
    } else if !accessor.bounded {
        report.error("ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS", at, || {
            "the accessor of times must have 'min' and 'max'; add them".into()
        });
    }
    if text_of(sampler, "interpolation") == Some("CUBICSPLINE") && accessor.count < 2 {
        report.error("ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS", at, || {
            format!("{} times; a spline needs 2", accessor.count)
        });
    }
}

fn check_target(node: &Value, path: &str, mesh: Option<&MeshFacts>, at: &At<'_>, report: &mut Report) {
    if path == "weights" {
        if mesh.is_none_or(|m| m.targets == 0) {
            report.error("ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS", at, || {
                "the node's mesh has no morph targets".into()
            });
        }
    } else if ["translation", "rotation", "scale"].contains(&path) {
        if node.get("matrix").is_some() {
            report.error("ANIMATION_CHANNEL_TARGET_NODE_MATRIX", at, || {
                "the node has a matrix, which cannot be animated; give it translation, rotation and scale"
                    .into()
            });
        }
        if node.get("skin").is_some() {
            report.warning("ANIMATION_CHANNEL_TARGET_NODE_SKIN", &at.key("path"), || {
                "a skinned mesh is placed by its joints alone; moving its node has no effect".into()
            });
        }
    }
}

fn check_channel(
    model: &Model<'_>,
    channel: &Value,
    samplers: &[Value],
    path: &str,
    mesh: Option<&MeshFacts>,
    at: &At<'_>,
    report: &mut Report,
) {
    let Some(index) = index_of(channel, "sampler") else { return };
    let Some(sampler) = samplers.get(index) else {
        return report.error("UNRESOLVED_REFERENCE", at, || {
            format!("there is no sampler {index} in this animation, which has {}", samplers.len())
        });
    };
    let accessor = |name: &str| index_of(sampler, name).and_then(|a| model.accessors.get(a));
    let Some(output) = accessor("output") else { return };
    if let Some(format) = output.format.filter(|f| !allows_animation(path, f)) {
        report.error("ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT", at, || {
            format!("{format} is not allowed for an animation of '{path}'")
        });
    }
    let Some(input) = accessor("input") else { return };
    let each = match path {
        "weights" => match mesh {
            Some(mesh) => mesh.targets as u64,
            None => return,
        },
        "translation" | "rotation" | "scale" => 1,
        _ => return,
    };
    let keys = if text_of(sampler, "interpolation") == Some("CUBICSPLINE") { 3 } else { 1 };
    let wanted = input.count.saturating_mul(each).saturating_mul(keys);
    if each > 0 && output.count != wanted {
        report.error("ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT", at, || {
            format!("{} values for {} times; there must be {wanted}", output.count, input.count)
        });
    }
}
