//! The objects of the extensions that are known here (Khronos, "glTF 2.0 Extension Registry").

use std::f64::consts::FRAC_PI_2;

use super::core_types::{NORMAL_TEXTURE, TEXTURE_INFO, TEXTURE_REFERENCE};
use super::kinds::{
    ANY, FROM_ONE, Field, Kind, NOT_NEGATIVE, POSITIVE, Range, Target, Type, UNIT, may, must,
};

/// An extension of one kind of object.
pub(super) struct Extension {
    pub name: &'static str,
    /// The kind of object that it extends.
    pub of: &'static str,
    pub object: Type,
}

const fn extension(name: &'static str, of: &'static str, fields: &'static [Field]) -> Extension {
    Extension { name, of, object: Type { name, named: false, fields } }
}

const fn texture(name: &'static str) -> Field {
    may(name, Kind::Object(&TEXTURE_INFO))
}

const fn number(name: &'static str, range: Range) -> Field {
    may(name, Kind::Number(range))
}

pub(super) const LIGHTS: Target = Target::Extension("KHR_lights_punctual", "lights");
pub(super) const VARIANTS: Target = Target::Extension("KHR_materials_variants", "variants");

/// Known extensions that have no object: what they change, they change by being there.
pub(super) const WITHOUT_OBJECTS: &[&str] = &["KHR_mesh_quantization"];

/// Extensions without which a document cannot be read, so that it must say that it needs them.
pub(super) const NEVER_OPTIONAL: &[&str] = &["KHR_mesh_quantization"];

pub(super) static EXTENSIONS: &[Extension] = &[
    extension("KHR_lights_punctual", "glTF", &[must("lights", Kind::List(&LIGHT))]),
    extension("KHR_lights_punctual", "node", &[must("light", Kind::Ref(LIGHTS))]),
    extension("KHR_materials_variants", "glTF", &[must("variants", Kind::List(&VARIANT))]),
    extension("KHR_materials_variants", "mesh.primitive", &[must("mappings", Kind::List(&MAPPING))]),
    extension(
        "KHR_materials_anisotropy",
        "material",
        &[
            number("anisotropyStrength", UNIT),
            number("anisotropyRotation", ANY),
            texture("anisotropyTexture"),
        ],
    ),
    extension(
        "KHR_materials_clearcoat",
        "material",
        &[
            number("clearcoatFactor", UNIT),
            texture("clearcoatTexture"),
            number("clearcoatRoughnessFactor", UNIT),
            texture("clearcoatRoughnessTexture"),
            may("clearcoatNormalTexture", Kind::Object(&NORMAL_TEXTURE)),
        ],
    ),
    extension("KHR_materials_dispersion", "material", &[number("dispersion", NOT_NEGATIVE)]),
    extension("KHR_materials_emissive_strength", "material", &[number("emissiveStrength", NOT_NEGATIVE)]),
    extension("KHR_materials_ior", "material", &[number("ior", Range { or_zero: true, ..FROM_ONE })]),
    extension(
        "KHR_materials_iridescence",
        "material",
        &[
            number("iridescenceFactor", UNIT),
            texture("iridescenceTexture"),
            number("iridescenceIor", FROM_ONE),
            number("iridescenceThicknessMinimum", NOT_NEGATIVE),
            number("iridescenceThicknessMaximum", NOT_NEGATIVE),
            texture("iridescenceThicknessTexture"),
        ],
    ),
    extension(
        "KHR_materials_pbrSpecularGlossiness",
        "material",
        &[
            may("diffuseFactor", Kind::Numbers(&[4], UNIT)),
            texture("diffuseTexture"),
            may("specularFactor", Kind::Numbers(&[3], UNIT)),
            number("glossinessFactor", UNIT),
            texture("specularGlossinessTexture"),
        ],
    ),
    extension(
        "KHR_materials_sheen",
        "material",
        &[
            may("sheenColorFactor", Kind::Numbers(&[3], UNIT)),
            texture("sheenColorTexture"),
            number("sheenRoughnessFactor", UNIT),
            texture("sheenRoughnessTexture"),
        ],
    ),
    extension(
        "KHR_materials_specular",
        "material",
        &[
            number("specularFactor", UNIT),
            texture("specularTexture"),
            may("specularColorFactor", Kind::Numbers(&[3], NOT_NEGATIVE)),
            texture("specularColorTexture"),
        ],
    ),
    extension(
        "KHR_materials_transmission",
        "material",
        &[number("transmissionFactor", UNIT), texture("transmissionTexture")],
    ),
    extension("KHR_materials_unlit", "material", &[]),
    extension(
        "KHR_materials_volume",
        "material",
        &[
            number("thicknessFactor", NOT_NEGATIVE),
            texture("thicknessTexture"),
            number("attenuationDistance", POSITIVE),
            may("attenuationColor", Kind::Numbers(&[3], UNIT)),
        ],
    ),
    extension("KHR_node_visibility", "node", &[may("visible", Kind::Bool)]),
    extension(
        "KHR_texture_transform",
        TEXTURE_REFERENCE,
        &[
            may("offset", Kind::Numbers(&[2], ANY)),
            number("rotation", ANY),
            may("scale", Kind::Numbers(&[2], ANY)),
            may("texCoord", Kind::Whole(0, u64::MAX, 1)),
        ],
    ),
    extension("EXT_mesh_gpu_instancing", "node", &[must("attributes", Kind::Attributes)]),
    extension("EXT_texture_webp", "texture", &[may("source", Kind::Ref(Target::Root("images")))]),
];

static LIGHT: Type = Type {
    name: "light",
    named: true,
    fields: &[
        may("color", Kind::Numbers(&[3], UNIT)),
        number("intensity", NOT_NEGATIVE),
        may("spot", Kind::Object(&SPOT)),
        must("type", Kind::OneOf(&["directional", "point", "spot"])),
        number("range", POSITIVE),
    ],
};

static SPOT: Type = Type {
    name: "light.spot",
    named: false,
    fields: &[
        number("innerConeAngle", Range { to: FRAC_PI_2, below: true, ..NOT_NEGATIVE }),
        // Exporters round π/2 up in its last place.
        number("outerConeAngle", Range { to: 1.570_797, ..POSITIVE }),
    ],
};

static VARIANT: Type = Type { name: "variant", named: false, fields: &[must("name", Kind::Text)] };

static MAPPING: Type = Type {
    name: "variant.mapping",
    named: true,
    fields: &[must("variants", Kind::Refs(VARIANTS)), must("material", Kind::Ref(Target::Root("materials")))],
};
