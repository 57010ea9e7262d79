//! Joints and weights.

use std::collections::{HashMap, HashSet};

use serde_json::Value;

use super::super::model::Model;
use super::super::report::{At, Report};
use super::super::values::{index, index_of, list};
use super::elements::{Cursor, Elements, fraction};

/// What the rounding of unsigned bytes can add to a sum, for each two weights beyond the first two.
const SUM_STEP: f64 = 0.003_921_6;

/// Rounding of a sum of floats.
const SUM_TOLERANCE: f64 = 1e-5;

/// What `seen` has for an accessor of weights.
const WEIGHTS: u8 = u8::MAX;

/// The joints of the smallest skin that a mesh is shown with.
pub(super) fn joints_of_meshes(model: &Model<'_>) -> HashMap<usize, u64> {
    let mut out: HashMap<usize, u64> = HashMap::new();
    for node in model.list("nodes") {
        let Some((mesh, skin)) = index_of(node, "mesh").zip(index_of(node, "skin")) else { continue };
        let Some(skin) = model.list("skins").get(skin) else { continue };
        let count = list(skin, "joints").len() as u64;
        out.entry(mesh).and_modify(|n| *n = count.min(*n)).or_insert(count);
    }
    out
}

/// One set of joints and weights.
struct Set<'e, 'a> {
    name: String,
    joints: Cursor<'e, 'a>,
    weights: Cursor<'e, 'a>,
    faults: Faults,
}

/// The first fault of each kind in a set.
#[derive(Clone, Copy, Default)]
struct Faults {
    outside: Option<(u64, f64)>,
    doubled: Option<(u64, f64)>,
    idle: Option<(u64, f64)>,
    negative: Option<(u64, f64)>,
    sum: Option<(u64, f64)>,
}

/// Checks the joints and weights of a primitive, whose sets belong together. A primitive that shares any with
/// another one is passed over.
pub(super) fn check(
    elements: &Elements<'_>,
    primitive: &Value,
    joints: Option<u64>,
    seen: &mut HashSet<(usize, u8)>,
    at: &At<'_>,
    report: &mut Report,
) {
    let mut sets = Vec::new();
    for n in 0.. {
        let accessor = |name: &str| primitive.get("attributes")?.get(format!("{name}_{n}")).and_then(index);
        let Some((joints, weights)) = accessor("JOINTS").zip(accessor("WEIGHTS")) else { break };
        if !seen.insert((weights, WEIGHTS)) || !seen.insert((joints, WEIGHTS)) {
            return;
        }
        let Some((joints, weights)) = elements.cursor(joints).zip(elements.cursor(weights)) else { return };
        sets.push(Set { name: n.to_string(), joints, weights, faults: Faults::default() });
    }
    if !sets.is_empty() {
        while check_vertex(&mut sets, joints).is_some() {}
    }
    for set in &sets {
        say(set, at, report);
    }
}

/// Checks the next vertex; none if there is no more.
fn check_vertex(sets: &mut [Set<'_, '_>], joints: Option<u64>) -> Option<()> {
    // Few, so that looking through them all is quick; beyond these, repetition is not looked for.
    let mut used = [None; 32];
    let mut free = used.len();
    let (mut sum, mut positive, mut vertex) = (0.0, 0u32, 0);
    for set in sets.iter_mut() {
        vertex = set.joints.next()?;
        set.weights.next()?;
        let faults = &mut set.faults;
        for (j, w) in set.joints.element().iter().zip(set.weights.element()) {
            let w = fraction(*w, &set.weights.format);
            sum += w;
            positive = positive.saturating_add(u32::from(w != 0.0));
            if joints.is_some_and(|n| *j >= n as f64) {
                faults.outside.get_or_insert((vertex, *j));
            } else if w == 0.0 && *j != 0.0 {
                faults.idle.get_or_insert((vertex, *j));
            } else if w != 0.0 {
                if used.contains(&Some(*j)) {
                    faults.doubled.get_or_insert((vertex, *j));
                }
                free = free.saturating_sub(1);
                if let Some(slot) = used.get_mut(free) {
                    *slot = Some(*j);
                }
            }
            if w < 0.0 {
                faults.negative.get_or_insert((vertex, w));
            }
        }
    }
    let tolerance = SUM_TOLERANCE + SUM_STEP * f64::from(positive.div_ceil(2).saturating_sub(1));
    if positive > 0 && (sum - 1.0).abs() > tolerance {
        for set in sets {
            set.faults.sum.get_or_insert((vertex, sum));
        }
    }
    Some(())
}

fn say(set: &Set<'_, '_>, at: &At<'_>, report: &mut Report) {
    let faults = &set.faults;
    let (joints, weights) = (format!("JOINTS_{}", set.name), format!("WEIGHTS_{}", set.name));
    if let Some((vertex, j)) = faults.outside {
        report.error("ACCESSOR_JOINTS_INDEX_OOB", &at.key(&joints), || {
            format!("vertex {vertex} names joint {j}, which a skin of the mesh does not have")
        });
    }
    if let Some((vertex, j)) = faults.doubled {
        report.error("ACCESSOR_JOINTS_INDEX_DUPLICATE", &at.key(&joints), || {
            format!("vertex {vertex} names joint {j} twice")
        });
    }
    if let Some((vertex, j)) = faults.idle {
        report.warning("ACCESSOR_JOINTS_USED_ZERO_WEIGHT", &at.key(&joints), || {
            format!("vertex {vertex} names joint {j} with a weight of 0; such joints should be 0")
        });
    }
    if let Some((vertex, w)) = faults.negative {
        report.error("ACCESSOR_WEIGHTS_NEGATIVE", &at.key(&weights), || {
            format!("vertex {vertex} has the weight {w}; weights are not negative")
        });
    }
    if let Some((vertex, sum)) = faults.sum {
        report.error("ACCESSOR_WEIGHTS_NON_NORMALIZED", &at.key(&weights), || {
            format!("the weights of vertex {vertex} sum up to {sum}; it must be 1")
        });
    }
}
