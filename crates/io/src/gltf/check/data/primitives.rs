//! Indices and attributes of the primitives.

use std::collections::{HashMap, HashSet};

use serde_json::Value;

use super::super::attributes::Semantic;
use super::super::model::Component;
use super::super::report::{At, Report};
use super::super::values::{index, index_of, list, members};
use super::elements::Elements;
use super::skinning;

/// Beyond the greatest error of a unit vector in signed bytes.
const UNIT_TOLERANCE: f64 = 0.00674;

/// What is in an accessor of indices.
#[derive(Clone, Copy, Debug, Default)]
struct Indices {
    /// The greatest, but for the value that restarts a primitive.
    greatest: Option<(u64, u64)>,
    /// Where the value that restarts a primitive is.
    restart: Option<u64>,
}

/// Checks all primitives. What several share is checked once.
pub(super) fn check(elements: &Elements<'_>, report: &mut Report) {
    let mut seen = HashSet::new();
    let mut indices = HashMap::new();
    let joints = skinning::joints_of_meshes(elements.model);
    let array = At::Root.key("meshes");
    for (i, mesh) in elements.model.list("meshes").iter().enumerate() {
        let here = array.index(i);
        let within = here.key("primitives");
        for (k, primitive) in list(mesh, "primitives").iter().enumerate() {
            let here = within.index(k);
            check_indices(elements, primitive, &mut indices, &here.key("indices"), report);
            let here = here.key("attributes");
            for (name, value) in members(primitive, "attributes") {
                let Some(accessor) = index(value) else { continue };
                let semantic = Semantic::new(name);
                let kind = semantic.rank().0;
                if !matches!(semantic, Semantic::Own(_) | Semantic::Unknown(_))
                    && seen.insert((accessor, kind))
                {
                    check_attribute(elements, accessor, &semantic, &here.key(name), report);
                }
            }
            skinning::check(elements, primitive, joints.get(&i).copied(), &mut seen, &here, report);
        }
    }
}

fn check_indices(
    elements: &Elements<'_>,
    primitive: &Value,
    known: &mut HashMap<usize, Indices>,
    at: &At<'_>,
    report: &mut Report,
) {
    let Some(accessor) = index_of(primitive, "indices") else { return };
    let found = *known.entry(accessor).or_insert_with(|| scan(elements, accessor));
    if let Some(n) = found.restart {
        report.error("ACCESSOR_INDEX_PRIMITIVE_RESTART", at, || {
            format!("index {n} is the greatest of its type, which is not allowed; use a wider type")
        });
    }
    let first = members(primitive, "attributes").filter_map(|(_, a)| elements.model.accessors.get(index(a)?));
    let Some(vertices) = first.map(|a| a.count).min() else { return };
    if let Some((value, n)) = found.greatest.filter(|(value, _)| *value >= vertices) {
        report.error("ACCESSOR_INDEX_OOB", at, || {
            format!("index {n} names vertex {value}, but there are {vertices}, counted from 0")
        });
    }
}

fn scan(elements: &Elements<'_>, accessor: usize) -> Indices {
    let mut out = Indices::default();
    let component = elements.model.accessors.get(accessor).and_then(|a| a.format).map(|f| f.component);
    let Some(component) = component.filter(|c| matches!(c, Component::U8 | Component::U16 | Component::U32))
    else {
        return out;
    };
    let restart = component.range().1;
    elements.each(accessor, &mut |n, element| {
        let value = element.first().copied().unwrap_or(0.0);
        if value == restart {
            out.restart.get_or_insert(n);
        } else if out.greatest.is_none_or(|(greatest, _)| value as u64 > greatest) {
            out.greatest = Some((value as u64, n));
        }
    });
    out
}

fn check_attribute(
    elements: &Elements<'_>,
    accessor: usize,
    semantic: &Semantic<'_>,
    at: &At<'_>,
    report: &mut Report,
) {
    let float = elements.model.accessors.get(accessor).and_then(|a| a.format);
    match semantic {
        Semantic::Normal | Semantic::Tangent => {
            let (mut length, mut sign) = (None, None);
            elements.each_normalized(accessor, &mut |n, v| {
                let l = v.iter().take(3).map(|x| x * x).sum::<f64>().sqrt();
                if (l - 1.0).abs() > UNIT_TOLERANCE {
                    length.get_or_insert((n, l));
                }
                if let Some(w) = v.get(3).filter(|w| w.abs() != 1.0) {
                    sign.get_or_insert((n, *w));
                }
            });
            if let Some((n, l)) = length {
                report.error("ACCESSOR_VECTOR3_NON_UNIT", at, || {
                    format!("the length of vector {n} is {l}; it must be 1")
                });
            }
            if let Some((n, w)) = sign {
                report.error("ACCESSOR_INVALID_SIGN", at, || {
                    format!("w of vector {n} is {w}; it must be 1 or -1")
                });
            }
        }
        Semantic::Numbered("COLOR", _) if float.is_some_and(|f| f.component == Component::F32) => {
            let mut bad = None;
            elements.each(accessor, &mut |n, v| {
                if let Some(x) = v.iter().find(|x| !(0.0..=1.0).contains(*x)) {
                    bad.get_or_insert((n, *x));
                }
            });
            if let Some((n, x)) = bad {
                report.error("ACCESSOR_NON_CLAMPED", at, || {
                    format!("colour {n} has the component {x}; they go from 0 to 1")
                });
            }
        }
        _ => {}
    }
}
