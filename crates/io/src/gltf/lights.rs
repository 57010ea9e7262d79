//! Punctual lights and cameras.
//!
//! `KHR_lights_punctual` counts in candela (lm·sr⁻¹) and lux (lm·m⁻²); this library counts in watts. Blender, and with
//! it nearly every file, converts with 683 lm·W⁻¹, the luminous efficacy of green light of 555 nm, whatever the colour:
//! a lamp of 100 W is written as 683 · 100 / 4π cd, and comes back as 100 / 4π W·sr⁻¹. Emissive materials have no such
//! factor: their numbers are radiance, W·m⁻²·sr⁻¹.

use etendue_core::glam::{DMat3, DMat4, DVec4};
use etendue_core::{Spectrum, Transform, Vec3A, vector};
use etendue_light::{DirectionalLight, PointLight, SpotLight};
use etendue_scene::SceneBuilder;
use gltf::json::camera::Type;
use gltf::json::validation::Checked;

use super::document::Document;
use super::extensions::{self, PunctualLight, PunctualLights};
use super::nodes::Walked;
use crate::{SceneCamera, View};

/// Lumens in a watt, as exporters convert.
pub(super) const LUMENS_PER_WATT: f32 = 683.0;

fn point(m: &DMat4) -> Vec3A {
    m.w_axis.truncate().as_vec3a()
}

/// Adds the punctual lights of the scene; how many there were.
pub(super) fn add(
    doc: &Document<'_>,
    walked: &Walked,
    builder: &mut SceneBuilder,
    warnings: &mut Vec<String>,
) -> u64 {
    let all = doc.root.extensions.as_ref().map(|e| &e.others);
    let all: Vec<PunctualLight> =
        extensions::get::<PunctualLights>(all, "KHR_lights_punctual").map_or(Vec::new(), |l| l.lights);
    let mut count = 0u64;
    for &(light, node) in &walked.lights {
        let (Some(light), Some(Some(to_world))) = (all.get(light), walked.world.get(node)) else { continue };
        let position = point(to_world);
        let axis = vector::try_normalize((-to_world.z_axis.truncate()).as_vec3a());
        let power = Spectrum::from(light.color) * (light.intensity / LUMENS_PER_WATT);
        let usable = position.is_finite() && power.is_finite();
        let added = match (light.kind.as_str(), axis) {
            _ if !usable => false,
            ("point", _) => {
                builder.light(PointLight::new(position, power));
                true
            }
            ("spot", Some(axis)) => {
                let s = light.spot.clone().unwrap_or_default();
                builder.light(SpotLight::new(position, axis, power, s.inner_cone_angle, s.outer_cone_angle));
                true
            }
            ("directional", Some(axis)) => {
                builder.light(DirectionalLight::new(axis, power));
                true
            }
            _ => false,
        };
        if added {
            count = count.saturating_add(1);
        } else {
            let name = &light.name;
            warnings.push(format!(
                "{}, at '/nodes/{node}': the light '{name}' cannot be placed; left out",
                doc.name
            ));
        }
    }
    count
}

/// The cameras of the scene, in the order of its nodes.
pub(super) fn cameras(doc: &Document<'_>, walked: &Walked, warnings: &mut Vec<String>) -> Vec<SceneCamera> {
    let mut out = Vec::new();
    for &(index, node) in &walked.cameras {
        let (Some(camera), Some(Some(m))) = (doc.root.cameras.get(index), walked.world.get(node)) else {
            continue;
        };
        let named = |n: &Option<String>| n.clone().filter(|n| !n.is_empty());
        let name = doc.root.nodes.get(node).and_then(|n| named(&n.name)).or_else(|| named(&camera.name));
        let mut warn = |what: &str| {
            warnings.push(format!("{}, at '/nodes/{node}': its camera {what}; left out", doc.name));
        };
        // Scale means nothing to a camera, not even a negative one: its axes are set up again from where it looks and
        // which way is up.
        let unit = |a: DVec4| a.truncate().try_normalize();
        let (right, up, back) = (unit(m.x_axis), unit(m.y_axis), unit(m.z_axis));
        let back = back.or_else(|| right?.cross(up?).try_normalize());
        let right = back.and_then(|b| up.and_then(|u| u.cross(b).try_normalize()).or(right));
        let to_world = match (right, back) {
            (Some(x), Some(z)) => {
                Transform::from_f64(DMat3::from_cols(x, z.cross(x), z), m.w_axis.truncate()).ok()
            }
            _ => None,
        };
        let Some(to_world) = to_world else {
            warn("is placed by a matrix that flattens space");
            continue;
        };
        let (view, aspect) = match (camera.type_, &camera.perspective, &camera.orthographic) {
            (Checked::Valid(Type::Perspective), Some(p), _) => {
                (View::Perspective { vertical_fov_deg: p.yfov.to_degrees() }, p.aspect_ratio)
            }
            (Checked::Valid(Type::Orthographic), _, Some(o)) => {
                let (half_width, half_height) = (o.xmag.abs(), o.ymag.abs());
                (View::Orthographic { half_width, half_height }, Some(half_width / half_height))
            }
            _ => {
                warn("is of no known type");
                continue;
            }
        };
        let aspect = aspect.filter(|a| *a > 0.0 && a.is_finite());
        out.push(SceneCamera { name: name.unwrap_or_default(), aspect, to_world, view });
    }
    out
}
