//! Materials: what they need of the meshes that wear them.

use serde_json::Value;

use super::model::Model;
use super::report::{At, Report};
use super::values::{extension, index_of, list, number_of, numbers, text_of, whole_of};

/// A texture of a material.
#[derive(Clone, Debug)]
struct Binding {
    /// Where it is.
    pointer: String,
    /// The texture coordinates that it uses.
    set: u64,
}

/// A material as the meshes see it.
#[derive(Clone, Debug, Default)]
pub(super) struct Material {
    bindings: Vec<Binding>,
    /// Whether there is a normal map, by which tangents can be made.
    normal_map: bool,
    /// Whether something else needs tangents.
    tangents: bool,
}

/// Where the textures are: an extension or none, an object or none, the property.
const TEXTURES: &[(&str, &str)] = &[
    ("pbrMetallicRoughness", "baseColorTexture"),
    ("pbrMetallicRoughness", "metallicRoughnessTexture"),
    ("", "normalTexture"),
    ("", "occlusionTexture"),
    ("", "emissiveTexture"),
];

const EXTENSION_TEXTURES: &[(&str, &[&str])] = &[
    ("KHR_materials_anisotropy", &["anisotropyTexture"]),
    ("KHR_materials_clearcoat", &["clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"]),
    ("KHR_materials_iridescence", &["iridescenceTexture", "iridescenceThicknessTexture"]),
    ("KHR_materials_pbrSpecularGlossiness", &["diffuseTexture", "specularGlossinessTexture"]),
    ("KHR_materials_sheen", &["sheenColorTexture", "sheenRoughnessTexture"]),
    ("KHR_materials_specular", &["specularTexture", "specularColorTexture"]),
    ("KHR_materials_transmission", &["transmissionTexture"]),
    ("KHR_materials_volume", &["thicknessTexture"]),
];

/// Checks all materials.
pub(super) fn check(model: &Model<'_>, report: &mut Report) -> Vec<Material> {
    let array = At::Root.key("materials");
    let materials = model.list("materials").iter().enumerate();
    materials.map(|(i, material)| check_one(model, material, &array.index(i), report)).collect()
}

fn check_one(model: &Model<'_>, value: &Value, at: &At<'_>, report: &mut Report) -> Material {
    if value.get("alphaCutoff").is_some() && text_of(value, "alphaMode") != Some("MASK") {
        report.warning("MATERIAL_ALPHA_CUTOFF_INVALID_MODE", &at.key("alphaCutoff"), || {
            "it has an effect only with the alpha mode MASK".into()
        });
    }
    let mut out = Material { normal_map: value.get("normalTexture").is_some(), ..Material::default() };
    for (object, name) in TEXTURES {
        let (owner, place) = match *object {
            "" => (Some(value), *at),
            object => (value.get(object), at.key(object)),
        };
        if let Some(texture) = owner.and_then(|o| o.get(*name)) {
            out.bindings.push(binding(model, texture, &place.key(name)));
        }
    }
    let within = at.key("extensions");
    let declared = |name: &str| extension(value, name).filter(|_| model.uses(name));
    for (name, textures) in EXTENSION_TEXTURES {
        let Some(object) = declared(name) else { continue };
        let here = within.key(name);
        for name in *textures {
            if let Some(texture) = object.get(*name) {
                out.bindings.push(binding(model, texture, &here.key(name)));
            }
        }
    }
    let of = |extension: &str, texture: &str| declared(extension).is_some_and(|e| e.get(texture).is_some());
    out.tangents = declared("KHR_materials_anisotropy").is_some()
        || of("KHR_materials_clearcoat", "clearcoatNormalTexture");
    combinations(value, &declared, &within, report);
    out
}

fn binding(model: &Model<'_>, texture: &Value, at: &At<'_>) -> Binding {
    let own = whole_of(texture, "texCoord").unwrap_or(0);
    let transform =
        extension(texture, "KHR_texture_transform").filter(|_| model.uses("KHR_texture_transform"));
    match transform.and_then(|t| whole_of(t, "texCoord")) {
        Some(set) => {
            let within = at.key("extensions");
            Binding { pointer: within.key("KHR_texture_transform").to_string(), set }
        }
        None => Binding { pointer: at.to_string(), set: own },
    }
}

/// Extensions that mean nothing without, or together with, others.
fn combinations<'v>(
    material: &'v Value,
    declared: &dyn Fn(&str) -> Option<&'v Value>,
    at: &At<'_>,
    report: &mut Report,
) {
    let known = material.get("extensions").and_then(Value::as_object).map_or(0, serde_json::Map::len);
    for name in ["KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness"] {
        if declared(name).is_some() && known > 1 {
            report.warning("MULTIPLE_EXTENSIONS", &at.key(name), || {
                "it may contradict the material's other extensions".into()
            });
        }
    }
    let strength = declared("KHR_materials_emissive_strength").and_then(|e| number_of(e, "emissiveStrength"));
    if strength.is_some_and(|s| s >= 0.0)
        && numbers::<3>(material, "emissiveFactor").is_none_or(|e| e == [0.0; 3])
    {
        report.warning(
            "KHR_MATERIALS_EMISSIVE_STRENGTH_ZERO_FACTOR",
            &at.key("KHR_materials_emissive_strength"),
            || "a strength without an emissiveFactor has no effect".into(),
        );
    }
    if declared("KHR_materials_dispersion").is_some() && declared("KHR_materials_volume").is_none() {
        report.warning("KHR_MATERIALS_DISPERSION_NO_VOLUME", &at.key("KHR_materials_dispersion"), || {
            "dispersion without a volume has no effect".into()
        });
    }
    if let Some(volume) = declared("KHR_materials_volume") {
        let transmits = |name: &String| name.contains("transmission");
        let any =
            material.get("extensions").and_then(Value::as_object).is_some_and(|e| e.keys().any(transmits));
        if !any {
            report.warning("KHR_MATERIALS_VOLUME_NO_TRANSMISSION", &at.key("KHR_materials_volume"), || {
                "no light enters the volume; add KHR_materials_transmission".into()
            });
        }
        let thick = number_of(volume, "thicknessFactor").is_some_and(|t| t > 0.0);
        if thick && material.get("doubleSided").and_then(Value::as_bool) == Some(true) {
            report.warning("KHR_MATERIALS_VOLUME_DOUBLE_SIDED", &at.key("KHR_materials_volume"), || {
                "a volume has an inside, so its surface should not be double-sided".into()
            });
        }
    }
    let normal = material.get("normalTexture").map(|t| whole_of(t, "texCoord").unwrap_or(0));
    for (name, texture, code) in [
        (
            "KHR_materials_anisotropy",
            "anisotropyTexture",
            "KHR_MATERIALS_ANISOTROPY_ANISOTROPY_TEXTURE_TEXCOORD",
        ),
        (
            "KHR_materials_clearcoat",
            "clearcoatNormalTexture",
            "KHR_MATERIALS_CLEARCOAT_CLEARCOAT_NORMAL_TEXTURE_TEXCOORD",
        ),
    ] {
        let set = declared(name).and_then(|e| e.get(texture)).map(|t| whole_of(t, "texCoord").unwrap_or(0));
        if let Some((set, normal)) = set.zip(normal).filter(|(a, b)| a != b) {
            let here = at.key(name);
            report.warning(code, &here.key(texture), || {
                format!(
                    "it uses TEXCOORD_{set} but the normal map TEXCOORD_{normal}, by which tangents are made"
                )
            });
        }
    }
}

impl Material {
    /// Checks that a primitive has what the material needs; `at` is where it names the material.
    pub(super) fn check(&self, texcoords: u64, mode: u64, tangents: bool, at: &At<'_>, report: &mut Report) {
        for binding in self.bindings.iter().filter(|b| b.set >= texcoords) {
            report.error("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", at, || {
                format!("the texture at {} needs TEXCOORD_{}, which is missing", binding.pointer, binding.set)
            });
        }
        if tangents || mode < 4 {
            return;
        }
        if self.tangents && !self.normal_map {
            report.error("MESH_PRIMITIVE_NO_TANGENT_SPACE", at, || {
                "the material needs tangents, which the primitive lacks; add TANGENT".into()
            });
        } else if self.normal_map {
            report.warning("MESH_PRIMITIVE_GENERATED_TANGENT_SPACE", at, || {
                "the normal map needs tangents, which the primitive lacks; they are made with MikkTSpace"
                    .into()
            });
        }
    }
}

/// Checks what images and textures say of their formats.
pub(super) fn check_textures(model: &Model<'_>, mimes: &[Option<String>], report: &mut Report) {
    let array = At::Root.key("textures");
    for (i, texture) in model.list("textures").iter().enumerate() {
        let here = array.index(i);
        source(texture, &["image/jpeg", "image/png"], mimes, &here, report);
        if let Some(webp) = extension(texture, "EXT_texture_webp").filter(|_| model.uses("EXT_texture_webp"))
        {
            let within = here.key("extensions");
            source(webp, &["image/webp"], mimes, &within.key("EXT_texture_webp"), report);
        }
    }
}

fn source(texture: &Value, valid: &[&str], mimes: &[Option<String>], at: &At<'_>, report: &mut Report) {
    let Some(mime) = index_of(texture, "source").and_then(|s| mimes.get(s)?.as_deref()) else { return };
    if ["image/jpeg", "image/png", "image/webp"].contains(&mime) && !valid.contains(&mime) {
        report.error("TEXTURE_INVALID_IMAGE_MIME_TYPE", &at.key("source"), || {
            format!("the image is {mime} where {} must be", valid.join(" or "))
        });
    }
}

/// Checks the extension of variants in meshes.
pub(super) fn check_variants(model: &Model<'_>, report: &mut Report) {
    const NAME: &str = "KHR_materials_variants";
    if !model.uses(NAME) {
        return;
    }
    let root = extension(model.root, NAME).is_some();
    let meshes = At::Root.key("meshes");
    for (i, mesh) in model.list("meshes").iter().enumerate() {
        let at = meshes.index(i);
        let at = at.key("primitives");
        for (k, primitive) in list(mesh, "primitives").iter().enumerate() {
            let Some(variants) = extension(primitive, NAME) else { continue };
            let at = at.index(k);
            let at = at.key("extensions");
            let at = at.key(NAME);
            let at = at.key("mappings");
            let mut seen = std::collections::HashSet::new();
            for (m, mapping) in list(variants, "mappings").iter().enumerate() {
                let at = at.index(m);
                if !root && mapping.get("variants").is_some() {
                    report.error("UNSATISFIED_DEPENDENCY", &at, || {
                        "the document has no list of variants; add KHR_materials_variants to its extensions".into()
                    });
                }
                let at = at.key("variants");
                let mut own = std::collections::HashSet::new();
                for (v, variant) in list(mapping, "variants").iter().enumerate() {
                    let Some(variant) = super::values::index(variant).filter(|v| own.insert(*v)) else {
                        continue;
                    };
                    if !seen.insert(variant) {
                        report.error("KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT", &at.index(v), || {
                            format!("variant {variant} already has a material here")
                        });
                    }
                }
            }
        }
    }
}
