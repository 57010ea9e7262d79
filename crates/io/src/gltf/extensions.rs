//! The extensions that are built, as plain structs.

use gltf::json::texture;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::GltfError;

/// Extensions whose meaning is built, or whose absence changes nothing in a picture.
const BUILT: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// What to do about an extension that is not built.
fn cure(extension: &str) -> &'static str {
    match extension {
        "KHR_draco_mesh_compression" => {
            "export without Draco compression, or decompress with `gltf-transform copy`"
        }
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            "export without meshopt compression, or decompress with `gltf-transform copy`"
        }
        "KHR_texture_basisu" => "export with PNG or JPEG textures, or convert with `gltf-transform png`",
        "EXT_texture_webp" | "EXT_texture_avif" | "MSFT_texture_dds" => "export with PNG or JPEG textures",
        "KHR_materials_pbrSpecularGlossiness" => "convert with `gltf-transform metalrough`",
        _ => "export without it",
    }
}

/// Refuses what the file cannot do without and this loader does not have.
pub(super) fn required(file: &str, root: &Value) -> Result<(), GltfError> {
    let empty = Vec::new();
    let names = root.get("extensionsRequired").and_then(Value::as_array).unwrap_or(&empty);
    match names.iter().filter_map(Value::as_str).find(|name| !BUILT.contains(name)) {
        Some(name) => {
            Err(GltfError::Extension { file: file.into(), extension: name.into(), cure: cure(name) })
        }
        None => Ok(()),
    }
}

/// Warnings for what the file uses and could do without.
pub(super) fn used(file: &str, names: &[String]) -> Vec<String> {
    let unbuilt = names.iter().filter(|name| !BUILT.contains(&name.as_str()));
    unbuilt
        .map(|name| format!("{file} uses {name}, which is not built: its effect is missing; {}", cure(name)))
        .collect()
}

/// One extension of an object. The checks have seen it; one that still has another shape counts as absent.
pub(super) fn get<T: DeserializeOwned>(all: Option<&Map<String, Value>>, name: &str) -> Option<T> {
    T::deserialize(all?.get(name)?).ok()
}

fn one() -> f32 {
    1.0
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    #[serde(default = "one")]
    pub(super) emissive_strength: f32,
}

fn window_glass() -> f32 {
    1.5
}

#[derive(Deserialize)]
pub(super) struct Ior {
    #[serde(default = "window_glass")]
    pub(super) ior: f32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Specular {
    #[serde(default = "one")]
    pub(super) specular_factor: f32,
    pub(super) specular_texture: Option<texture::Info>,
    #[serde(default = "white")]
    pub(super) specular_color_factor: [f32; 3],
    pub(super) specular_color_texture: Option<texture::Info>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Transmission {
    #[serde(default)]
    pub(super) transmission_factor: f32,
    pub(super) transmission_texture: Option<texture::Info>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Volume {
    #[serde(default)]
    pub(super) thickness_factor: f32,
    /// Absent: nothing is absorbed.
    pub(super) attenuation_distance: Option<f32>,
    #[serde(default = "white")]
    pub(super) attenuation_color: [f32; 3],
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct TextureTransform {
    pub(super) offset: [f32; 2],
    pub(super) rotation: f32,
    pub(super) scale: [f32; 2],
    pub(super) tex_coord: Option<u32>,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

#[derive(Deserialize)]
pub(super) struct Variants {
    #[serde(default)]
    pub(super) variants: Vec<VariantName>,
}

#[derive(Deserialize)]
pub(super) struct VariantName {
    #[serde(default)]
    pub(super) name: String,
}

#[derive(Deserialize)]
pub(super) struct VariantMappings {
    #[serde(default)]
    pub(super) mappings: Vec<VariantMapping>,
}

#[derive(Deserialize)]
pub(super) struct VariantMapping {
    pub(super) material: usize,
    #[serde(default)]
    pub(super) variants: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct PunctualLights {
    #[serde(default)]
    pub(super) lights: Vec<PunctualLight>,
}

#[derive(Clone, Deserialize)]
pub(super) struct PunctualLight {
    #[serde(default)]
    pub(super) name: String,
    #[serde(default = "white")]
    pub(super) color: [f32; 3],
    #[serde(default = "one")]
    pub(super) intensity: f32,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) spot: Option<Spot>,
}

#[derive(Clone, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Spot {
    pub(super) inner_cone_angle: f32,
    pub(super) outer_cone_angle: f32,
}

impl Default for Spot {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: std::f32::consts::FRAC_PI_4 }
    }
}

#[derive(Deserialize)]
pub(super) struct NodeLight {
    pub(super) light: usize,
}

#[derive(Deserialize)]
pub(super) struct Visibility {
    #[serde(default = "yes")]
    pub(super) visible: bool,
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
pub(super) struct GpuInstancing {
    #[serde(default)]
    pub(super) attributes: InstanceAttributes,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(super) struct InstanceAttributes {
    pub(super) translation: Option<u32>,
    pub(super) rotation: Option<u32>,
    pub(super) scale: Option<u32>,
}
