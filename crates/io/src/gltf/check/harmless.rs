/// Whether a static picture can be made in spite of an error: animations and skins are not shown, bounds and unit
/// lengths are recomputed, bytes are read wherever they lie, factors are clamped, a texture that does not decode is
/// replaced.
pub(super) fn harmless(code: &str, pointer: &str) -> bool {
    let part = pointer.split('/').nth(1).unwrap_or("");
    if matches!(part, "animations" | "skins") {
        return true;
    }
    // A node that is there twice is drawn twice, and what is below it four times: 2^n times in all.
    if matches!(part, "nodes" | "scenes") && code == "DUPLICATE_ELEMENTS" {
        return false;
    }
    // What is clamped or left out, whereas a wrong count or offset is data that cannot be found.
    if matches!(part, "materials" | "extensions" | "samplers" | "cameras")
        && matches!(
            code,
            "VALUE_NOT_IN_RANGE" | "TYPE_MISMATCH" | "UNDEFINED_PROPERTY" | "ARRAY_LENGTH_NOT_IN_LIST"
        )
        && pointer.matches('/').count() > 2
    {
        return part != "cameras" || code == "VALUE_NOT_IN_RANGE";
    }
    HARMLESS.contains(&code)
}

const HARMLESS: &[&str] = &[
    "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND",
    "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND",
    "ACCESSOR_INVALID_IBM",
    "ACCESSOR_INVALID_SIGN",
    "ACCESSOR_JOINTS_INDEX_DUPLICATE",
    "ACCESSOR_JOINTS_INDEX_OOB",
    "ACCESSOR_MATRIX_ALIGNMENT",
    "ACCESSOR_MAX_MISMATCH",
    "ACCESSOR_MIN_MISMATCH",
    "ACCESSOR_NON_CLAMPED",
    "ACCESSOR_OFFSET_ALIGNMENT",
    "ACCESSOR_TOTAL_OFFSET_ALIGNMENT",
    "ACCESSOR_USAGE_OVERRIDE",
    "ACCESSOR_VECTOR3_NON_UNIT",
    "ACCESSOR_WEIGHTS_NEGATIVE",
    "ACCESSOR_WEIGHTS_NON_NORMALIZED",
    "ASSET_MIN_VERSION_GREATER_THAN_VERSION",
    "BUFFER_DATA_URI_MIME_TYPE_INVALID",
    "BUFFER_VIEW_INVALID_BYTE_STRIDE",
    "BUFFER_VIEW_TARGET_OVERRIDE",
    "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE",
    "CAMERA_ZFAR_LEQUAL_ZNEAR",
    "DUPLICATE_ELEMENTS",
    "EMPTY_ENTITY",
    "IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE",
    "IMAGE_DATA_INVALID",
    "IMAGE_MIME_TYPE_INVALID",
    "IMAGE_NON_ENABLED_MIME_TYPE",
    "IMAGE_UNEXPECTED_EOS",
    "INVALID_IBM_ACCESSOR_COUNT",
    "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES",
    "KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT",
    "MESH_INVALID_WEIGHTS_COUNT",
    "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
    "MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
    "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
    "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
    "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE",
    "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
    "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
    "MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
    "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
    "MESH_PRIMITIVE_NO_TANGENT_SPACE",
    "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
    "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
    "NODE_MATRIX_NON_TRS",
    "NODE_MATRIX_TRS",
    "NODE_SKIN_NO_SCENE",
    "NODE_SKIN_WITH_NON_SKINNED_MESH",
    "NODE_WEIGHTS_INVALID",
    "NON_REQUIRED_EXTENSION",
    "ROTATION_NON_UNIT",
    "SCENE_NON_ROOT_NODE",
    "TEXTURE_INVALID_IMAGE_MIME_TYPE",
    "UNDECLARED_EXTENSION",
    "UNEXPECTED_EXTENSION_OBJECT",
    "UNUSED_EXTENSION_REQUIRED",
];
