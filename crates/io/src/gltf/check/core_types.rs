//! The objects of glTF 2.0 (Khronos, "glTF 2.0 Specification", section 5).

use super::kinds::{
    ANY, Field, Kind, NOT_NEGATIVE, POSITIVE, SIGNED_UNIT, Target, Type, UNIT, may, must, with,
};

const MOST: u64 = u64::MAX;
const SIZE: Kind = Kind::Whole(0, MOST, 1);
const SOME: Kind = Kind::Whole(1, MOST, 1);

const fn to(array: &'static str) -> Kind {
    Kind::Ref(Target::Root(array))
}

const fn named(name: &'static str, fields: &'static [Field]) -> Type {
    Type { name, named: true, fields }
}

const fn plain(name: &'static str, fields: &'static [Field]) -> Type {
    Type { name, named: false, fields }
}

pub(super) static ROOT: Type = plain(
    "glTF",
    &[
        must("asset", Kind::Object(&ASSET)),
        may("extensionsUsed", Kind::Words),
        with("extensionsRequired", Kind::Words, "extensionsUsed"),
        may("accessors", Kind::Elements(&ACCESSOR)),
        may("animations", Kind::Elements(&ANIMATION)),
        may("buffers", Kind::Elements(&BUFFER)),
        may("bufferViews", Kind::Elements(&BUFFER_VIEW)),
        may("cameras", Kind::Elements(&CAMERA)),
        may("images", Kind::Elements(&IMAGE)),
        may("materials", Kind::Elements(&MATERIAL)),
        may("meshes", Kind::Elements(&MESH)),
        may("nodes", Kind::Elements(&NODE)),
        may("samplers", Kind::Elements(&SAMPLER)),
        may("scene", to("scenes")),
        may("scenes", Kind::Elements(&SCENE)),
        may("skins", Kind::Elements(&SKIN)),
        may("textures", Kind::Elements(&TEXTURE)),
    ],
);

static ASSET: Type = plain(
    "asset",
    &[
        must("version", Kind::Text),
        may("minVersion", Kind::Text),
        may("copyright", Kind::Text),
        may("generator", Kind::Text),
    ],
);

static ACCESSOR: Type = named(
    "accessor",
    &[
        may("bufferView", to("bufferViews")),
        with("byteOffset", SIZE, "bufferView"),
        must("componentType", Kind::Code(&[5120, 5121, 5122, 5123, 5125, 5126])),
        may("normalized", Kind::Bool),
        must("count", SOME),
        must("type", Kind::OneOf(&["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"])),
        may("min", Kind::Numbers(&[1, 2, 3, 4, 9, 16], ANY)),
        may("max", Kind::Numbers(&[1, 2, 3, 4, 9, 16], ANY)),
        may("sparse", Kind::Object(&SPARSE)),
    ],
);

static SPARSE: Type = plain(
    "sparse",
    &[
        must("count", SOME),
        must("indices", Kind::Object(&SPARSE_INDICES)),
        must("values", Kind::Object(&SPARSE_VALUES)),
    ],
);

static SPARSE_INDICES: Type = plain(
    "sparse.indices",
    &[
        must("bufferView", to("bufferViews")),
        may("byteOffset", SIZE),
        must("componentType", Kind::Code(&[5121, 5123, 5125])),
    ],
);

static SPARSE_VALUES: Type =
    plain("sparse.values", &[must("bufferView", to("bufferViews")), may("byteOffset", SIZE)]);

static ANIMATION: Type = named(
    "animation",
    &[must("channels", Kind::List(&ANIMATION_CHANNEL)), must("samplers", Kind::List(&ANIMATION_SAMPLER))],
);

static ANIMATION_CHANNEL: Type = plain(
    "animation.channel",
    &[must("sampler", Kind::Local), must("target", Kind::Object(&ANIMATION_TARGET))],
);

static ANIMATION_TARGET: Type = plain(
    "animation.channel.target",
    &[may("node", to("nodes")), must("path", Kind::OneOf(&["translation", "rotation", "scale", "weights"]))],
);

static ANIMATION_SAMPLER: Type = plain(
    "animation.sampler",
    &[
        must("input", to("accessors")),
        may("interpolation", Kind::OneOf(&["LINEAR", "STEP", "CUBICSPLINE"])),
        must("output", to("accessors")),
    ],
);

static BUFFER: Type = named("buffer", &[may("uri", Kind::Text), must("byteLength", SOME)]);

static BUFFER_VIEW: Type = named(
    "bufferView",
    &[
        must("buffer", to("buffers")),
        may("byteOffset", SIZE),
        must("byteLength", SOME),
        may("byteStride", Kind::Whole(4, 252, 4)),
        may("target", Kind::Code(&[34962, 34963])),
    ],
);

static CAMERA: Type = named(
    "camera",
    &[
        must("type", Kind::OneOf(&["perspective", "orthographic"])),
        may("perspective", Kind::Object(&PERSPECTIVE)),
        may("orthographic", Kind::Object(&ORTHOGRAPHIC)),
    ],
);

static PERSPECTIVE: Type = plain(
    "camera.perspective",
    &[
        may("aspectRatio", Kind::Number(POSITIVE)),
        must("yfov", Kind::Number(POSITIVE)),
        may("zfar", Kind::Number(POSITIVE)),
        must("znear", Kind::Number(POSITIVE)),
    ],
);

static ORTHOGRAPHIC: Type = plain(
    "camera.orthographic",
    &[
        must("xmag", Kind::Number(ANY)),
        must("ymag", Kind::Number(ANY)),
        must("zfar", Kind::Number(POSITIVE)),
        must("znear", Kind::Number(NOT_NEGATIVE)),
    ],
);

static IMAGE: Type = named(
    "image",
    &[may("uri", Kind::Text), may("mimeType", Kind::Text), with("bufferView", to("bufferViews"), "mimeType")],
);

static MATERIAL: Type = named(
    "material",
    &[
        may("pbrMetallicRoughness", Kind::Object(&METALLIC_ROUGHNESS)),
        may("normalTexture", Kind::Object(&NORMAL_TEXTURE)),
        may("occlusionTexture", Kind::Object(&OCCLUSION_TEXTURE)),
        may("emissiveTexture", Kind::Object(&TEXTURE_INFO)),
        may("emissiveFactor", Kind::Numbers(&[3], UNIT)),
        may("alphaMode", Kind::OneOf(&["OPAQUE", "MASK", "BLEND"])),
        may("alphaCutoff", Kind::Number(NOT_NEGATIVE)),
        may("doubleSided", Kind::Bool),
    ],
);

static METALLIC_ROUGHNESS: Type = plain(
    "pbrMetallicRoughness",
    &[
        may("baseColorFactor", Kind::Numbers(&[4], UNIT)),
        may("baseColorTexture", Kind::Object(&TEXTURE_INFO)),
        may("metallicFactor", Kind::Number(UNIT)),
        may("roughnessFactor", Kind::Number(UNIT)),
        may("metallicRoughnessTexture", Kind::Object(&TEXTURE_INFO)),
    ],
);

/// The name by which the extensions of all texture references are found.
pub(super) const TEXTURE_REFERENCE: &str = "textureInfo";

pub(super) static TEXTURE_INFO: Type =
    plain(TEXTURE_REFERENCE, &[must("index", to("textures")), may("texCoord", SIZE)]);

pub(super) static NORMAL_TEXTURE: Type = plain(
    TEXTURE_REFERENCE,
    &[must("index", to("textures")), may("texCoord", SIZE), may("scale", Kind::Number(ANY))],
);

static OCCLUSION_TEXTURE: Type = plain(
    TEXTURE_REFERENCE,
    &[must("index", to("textures")), may("texCoord", SIZE), may("strength", Kind::Number(UNIT))],
);

static MESH: Type =
    named("mesh", &[must("primitives", Kind::List(&PRIMITIVE)), may("weights", Kind::Numbers(&[], ANY))]);

static PRIMITIVE: Type = plain(
    "mesh.primitive",
    &[
        must("attributes", Kind::Attributes),
        may("indices", to("accessors")),
        may("material", to("materials")),
        may("mode", Kind::Code(&[0, 1, 2, 3, 4, 5, 6])),
        may("targets", Kind::Targets),
    ],
);

static NODE: Type = named(
    "node",
    &[
        may("camera", to("cameras")),
        may("children", Kind::Refs(Target::Root("nodes"))),
        with("skin", to("skins"), "mesh"),
        may("matrix", Kind::Numbers(&[16], ANY)),
        may("mesh", to("meshes")),
        may("rotation", Kind::Numbers(&[4], SIGNED_UNIT)),
        may("scale", Kind::Numbers(&[3], ANY)),
        may("translation", Kind::Numbers(&[3], ANY)),
        with("weights", Kind::Numbers(&[], ANY), "mesh"),
    ],
);

static SAMPLER: Type = named(
    "sampler",
    &[
        may("magFilter", Kind::Code(&[9728, 9729])),
        may("minFilter", Kind::Code(&[9728, 9729, 9984, 9985, 9986, 9987])),
        may("wrapS", Kind::Code(&[33071, 33648, 10497])),
        may("wrapT", Kind::Code(&[33071, 33648, 10497])),
    ],
);

static SCENE: Type = named("scene", &[may("nodes", Kind::Refs(Target::Root("nodes")))]);

static SKIN: Type = named(
    "skin",
    &[
        may("inverseBindMatrices", to("accessors")),
        may("skeleton", to("nodes")),
        must("joints", Kind::Refs(Target::Root("nodes"))),
    ],
);

static TEXTURE: Type = named("texture", &[may("sampler", to("samplers")), may("source", to("images"))]);
