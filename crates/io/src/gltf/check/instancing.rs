//! EXT_mesh_gpu_instancing.

use serde_json::Value;

use super::attributes::allows_animation;
use super::model::Model;
use super::report::{At, Report};
use super::values::{extension, index, members};

const NAME: &str = "EXT_mesh_gpu_instancing";

/// Checks the instances of all nodes.
pub(super) fn check(model: &Model<'_>, report: &mut Report) {
    if !model.uses(NAME) {
        return;
    }
    let array = At::Root.key("nodes");
    for (i, node) in model.list("nodes").iter().enumerate() {
        let Some(instancing) = extension(node, NAME) else { continue };
        let here = array.index(i);
        let here = here.key("extensions");
        let here = here.key(NAME);
        if node.get("mesh").is_none() {
            report.error("UNSATISFIED_DEPENDENCY", &here, || {
                "instances need a 'mesh', which the node lacks; add it or leave this out".into()
            });
        }
        let here = here.key("attributes");
        let mut count = None;
        for (name, value) in members(instancing, "attributes") {
            check_attribute(model, name, value, &mut count, &here.key(name), report);
        }
    }
}

fn check_attribute(
    model: &Model<'_>,
    name: &str,
    value: &Value,
    count: &mut Option<u64>,
    at: &At<'_>,
    report: &mut Report,
) {
    let path = match name {
        "TRANSLATION" => "translation",
        "ROTATION" => "rotation",
        "SCALE" => "scale",
        _ if name.starts_with('_') => "",
        _ => {
            return report.warning("MESH_PRIMITIVE_INVALID_ATTRIBUTE", at, || {
                "no such attribute of instances; the names of attributes of one's own begin with '_'".into()
            });
        }
    };
    let Some(accessor) = index(value).and_then(|a| model.accessors.get(a)) else { return };
    if accessor.format.is_none_or(|f| !allows_animation(path, &f)) {
        report.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", at, || {
            format!("this type of accessor is not allowed for the {path} of instances")
        });
    }
    let first = *count.get_or_insert(accessor.count);
    if first != accessor.count {
        report.error("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", at, || {
            format!("{} elements for {first} instances; there must be one for each", accessor.count)
        });
    }
}
