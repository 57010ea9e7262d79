//! Small valid glTF documents that between them use what the loader reads: what damage begins with.

use serde_json::{Value, json};

use super::mutate::{Dice, mutate};

/// Two by two pixels of RGBA.
const PNG: [u8; 84] = [
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 2, 8, 6, 0, 0, 0, 114,
    182, 13, 36, 0, 0, 0, 27, 73, 68, 65, 84, 120, 218, 99, 56, 161, 33, 247, 95, 110, 139, 77, 3, 131, 136,
    205, 157, 255, 191, 126, 253, 98, 0, 0, 70, 73, 8, 181, 205, 155, 29, 234, 0, 0, 0, 0, 73, 69, 78, 68,
    174, 66, 96, 130,
];

const SQUARE: [[f32; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
const UP: [[f32; 3]; 4] = [[0.0, 0.0, 1.0]; 4];
const UV: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];

/// JSON and the buffer that it speaks of.
#[derive(Clone)]
pub(crate) struct Document {
    json: Value,
    bin: Vec<u8>,
}

/// One of each.
pub(crate) fn all() -> Vec<Document> {
    [features(), stored(), posed(), placed(), textured()].map(Document::finished).into()
}

/// The example of the repository. Its balls keep a few of their triangles, so that thousands of damaged ones are read
/// in a minute.
fn features() -> Document {
    let text = include_str!("../../../../examples/data/features.gltf");
    let mut json: Value = serde_json::from_str(text).expect("JSON");
    json["accessors"][3]["count"] = json!(24);
    Document { json, bin: Vec::new() }
}

/// Every way to store vertices: sparse over bytes and over nothing, interleaved, quantised, strips and fans.
fn stored() -> Document {
    let mut d = Document::new(&["KHR_mesh_quantization"]);
    let base = d.floats(&SQUARE);
    // Two accessors look at it.
    d.json["bufferViews"][0]["byteStride"] = json!(12);
    let moved = d.view(&floats(&[[-2.0f32, -1.0, 0.0], [2.0, 1.0, 0.0]]), None);
    let places = d.view(&[0, 2], None);
    let sparse = json!({"count": 2, "indices": {"bufferView": places, "componentType": 5121},
        "values": {"bufferView": moved}});
    let mut over = d.json["accessors"][base].clone();
    (over["sparse"], over["min"], over["max"]) = (sparse.clone(), json!([-2, -1, 0]), json!([2, 1, 0]));
    let over = d.push("accessors", over);
    let nothing = d.push(
        "accessors",
        json!({"componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse, "min": [-2, -1, 0],
            "max": [2, 1, 0]}),
    );
    let mut bytes = Vec::new();
    for ((p, n), uv) in SQUARE.iter().zip(&UP).zip(&UV) {
        bytes.extend([floats(&[*p]), floats(&[*n]), floats(&[*uv])].concat());
    }
    let both = d.view(&bytes, Some(32));
    let part = |offset: usize, kind: &str, more: Value| {
        let mut a = json!({"bufferView": both, "byteOffset": offset, "componentType": 5126, "count": 4, "type": kind});
        a.as_object_mut().expect("object").extend(more.as_object().expect("object").clone());
        a
    };
    let p = d.push("accessors", part(0, "VEC3", json!({"min": [-1, -1, 0], "max": [1, 1, 0]})));
    let n = d.push("accessors", part(12, "VEC3", json!({})));
    let uv = d.push("accessors", part(24, "VEC2", json!({})));

    let shorts: Vec<u8> = [[-100i16, -100, 0, 0], [100, -100, 0, 0], [100, 100, 0, 0], [-100, 100, 0, 0]]
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let view = d.view(&shorts, Some(8));
    let few = d.push(
        "accessors",
        json!({"bufferView": view, "componentType": 5122, "normalized": true, "count": 4, "type": "VEC3",
            "min": [-100, -100, 0], "max": [100, 100, 0]}),
    );
    let view = d.view(&[0, 0, 127, 0].repeat(4), Some(4));
    let few_n = d.push(
        "accessors",
        json!({"bufferView": view, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3"}),
    );
    let view = d.view(&[255, 128, 0, 255].repeat(4), Some(4));
    let colors = d.push(
        "accessors",
        json!({"bufferView": view, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4"}),
    );
    let corners = d.indices();
    d.mesh(json!([
        {"attributes": {"POSITION": over, "COLOR_0": colors}, "indices": corners},
        {"attributes": {"POSITION": nothing}, "mode": 6},
        {"attributes": {"POSITION": p, "NORMAL": n, "TEXCOORD_0": uv}, "mode": 5},
        {"attributes": {"POSITION": few, "NORMAL": few_n}, "indices": corners},
        {"attributes": {"POSITION": base}, "mode": 0}
    ]));
    d
}

/// Morph targets, a skin, and an animation of both.
fn posed() -> Document {
    let mut d = Document::new(&[]);
    let (p, n, corners) = (d.floats(&SQUARE), d.floats(&UP), d.indices());
    let by = d.floats(&[[0.0f32, 0.0, 0.5]; 4]);
    let ids = d.view(&[0, 1, 0, 0].repeat(4), Some(4));
    let ids =
        d.push("accessors", json!({"bufferView": ids, "componentType": 5121, "count": 4, "type": "VEC4"}));
    let weights = d.floats(&[[0.75f32, 0.25, 0.0, 0.0]; 4]);
    let one = [1.0f32, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let bind = d.view(&floats(&[one, one]), None);
    let bind =
        d.push("accessors", json!({"bufferView": bind, "componentType": 5126, "count": 2, "type": "MAT4"}));
    let targets = json!([{"POSITION": by}, {"POSITION": by, "NORMAL": by}]);
    let mesh = d.push(
        "meshes",
        json!({"weights": [0.5, 0.25], "primitives": [{"indices": corners, "targets": targets,
            "attributes": {"POSITION": p, "NORMAL": n, "JOINTS_0": ids, "WEIGHTS_0": weights}}]}),
    );
    let tip = d.push("nodes", json!({"translation": [0, 1, 0]}));
    let joint = d.node(json!({"rotation": [0, 0, 0.6, 0.8], "children": [tip]}));
    d.push("skins", json!({"joints": [joint, tip], "inverseBindMatrices": bind, "skeleton": joint}));
    d.node(json!({"mesh": mesh, "skin": 0}));
    let plain = d.push(
        "meshes",
        json!({"primitives": [{"attributes": {"POSITION": p}, "targets": [{"POSITION": by}]}]}),
    );
    d.node(json!({"mesh": plain, "weights": [1.5]}));
    let times = d.floats(&[[0.0f32], [1.0]]);
    let moves = d.floats(&[[0.0f32, 1.0, 0.0], [0.0, 2.0, 0.0]]);
    d.push(
        "animations",
        json!({"samplers": [{"input": times, "output": moves, "interpolation": "LINEAR"}],
            "channels": [{"sampler": 0, "target": {"node": tip, "path": "translation"}}]}),
    );
    d
}

/// Nodes in nodes, copies, cameras, lights and a second scene.
fn placed() -> Document {
    let mut d = Document::new(&["EXT_mesh_gpu_instancing", "KHR_lights_punctual", "KHR_node_visibility"]);
    let (p, corners) = (d.floats(&SQUARE), d.indices());
    let mesh = d.push("meshes", json!({"primitives": [{"attributes": {"POSITION": p}, "indices": corners}]}));
    let by = d.floats(&[[0.0f32, 0.0, 0.5], [1.0, 2.0, 3.0]]);
    let turns = d.floats(&[[0.0f32, 0.0, 0.0, 1.0], [0.0, 0.6, 0.0, 0.8]]);
    let copies = json!({"attributes": {"TRANSLATION": by, "ROTATION": turns, "SCALE": by}});
    let lights = json!([
        {"type": "point", "intensity": 5.0, "color": [1, 0.5, 0.25], "range": 10.0},
        {"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}, "name": "lamp"},
        {"type": "directional", "intensity": 2.0}
    ]);
    d.json["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}});
    d.push(
        "cameras",
        json!({"type": "perspective",
        "perspective": {"yfov": 0.75, "aspectRatio": 1.5, "znear": 0.25, "zfar": 100.0}}),
    );
    d.push(
        "cameras",
        json!({"type": "orthographic",
        "orthographic": {"xmag": 2.0, "ymag": 1.5, "znear": 0.0, "zfar": 50.0}}),
    );
    let leaf = d.push("nodes", json!({"mesh": mesh, "scale": [1, 2, -1]}));
    let lamp = d.push("nodes", json!({"extensions": {"KHR_lights_punctual": {"light": 1}}, "camera": 1}));
    let hidden =
        d.push("nodes", json!({"mesh": mesh, "extensions": {"KHR_node_visibility": {"visible": false}}}));
    d.node(json!({"matrix": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 1, 2, 3, 1], "children": [leaf, lamp, hidden]}));
    d.node(json!({"mesh": mesh, "extensions": {"EXT_mesh_gpu_instancing": copies}}));
    d.node(
        json!({"camera": 0, "translation": [0, 0, 5], "extensions": {"KHR_lights_punctual": {"light": 0}}}),
    );
    d.node(
        json!({"mesh": mesh, "translation": [0, 0, -1], "extensions": {"KHR_lights_punctual": {"light": 2}}}),
    );
    let elsewhere = d.push("nodes", json!({"mesh": mesh}));
    d.push("scenes", json!({"nodes": [elsewhere]}));
    d
}

/// A texture in every slot, through every kind of sampler, transformed, and three kinds of variants.
fn textured() -> Document {
    let mut d = Document::new(&[
        "KHR_texture_transform",
        "KHR_materials_ior",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_materials_emissive_strength",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_clearcoat",
    ]);
    let view = d.view(&PNG, None);
    d.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    d.push("images", json!({"uri": format!("data:image/png;base64,{}", base64(&PNG))}));
    d.push("samplers", json!({"magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648}));
    d.push("samplers", json!({"minFilter": 9728}));
    d.push("textures", json!({"source": 0, "sampler": 0}));
    d.push("textures", json!({"source": 1, "sampler": 1}));
    d.push("textures", json!({"source": 0}));
    let turned = json!({"index": 1, "extensions": {"KHR_texture_transform":
        {"offset": [0.5, 0.25], "rotation": 0.5, "scale": [2, -1], "texCoord": 1}}});
    let (first, second) = (json!({"index": 0}), json!({"index": 2, "texCoord": 1}));
    d.push(
        "materials",
        json!({
        "pbrMetallicRoughness": {"baseColorTexture": first, "metallicRoughnessTexture": turned,
            "baseColorFactor": [0.5, 0.75, 1, 0.5], "metallicFactor": 0.5, "roughnessFactor": 0.25},
        "normalTexture": {"index": 2, "scale": 0.5}, "occlusionTexture": {"index": 0, "strength": 0.5},
        "emissiveTexture": second, "emissiveFactor": [1, 0.5, 0], "alphaMode": "MASK", "alphaCutoff": 0.25,
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 5.0}, "KHR_materials_ior": {"ior": 1.25},
            "KHR_materials_specular": {"specularFactor": 0.5, "specularTexture": first,
                "specularColorFactor": [1, 0.5, 2], "specularColorTexture": turned},
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": first}
        }}),
    );
    d.push("materials", json!({
        "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.0}, "doubleSided": true,
        "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 0.75, "transmissionTexture": second},
            "KHR_materials_volume": {"thicknessFactor": 1.0, "thicknessTexture": first, "attenuationDistance": 0.5,
                "attenuationColor": [0.25, 0.5, 1]}
        }}));
    d.push(
        "materials",
        json!({"pbrMetallicRoughness": {"baseColorTexture": turned}, "alphaMode": "BLEND",
        "extensions": {"KHR_materials_unlit": {}}}),
    );
    d.json["extensions"] =
        json!({"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}});
    let (p, n, uv, corners) = (d.floats(&SQUARE), d.floats(&UP), d.floats(&UV), d.indices());
    let tangents = d.floats(&[[1.0f32, 0.0, 0.0, -1.0]; 4]);
    let attributes = json!({"POSITION": p, "NORMAL": n, "TEXCOORD_0": uv, "TEXCOORD_1": uv});
    let mut given = attributes.clone();
    given["TANGENT"] = json!(tangents);
    let mappings = json!({"KHR_materials_variants": {"mappings": [{"material": 2, "variants": [1]}]}});
    d.mesh(json!([
        {"attributes": attributes, "indices": corners, "material": 0},
        {"attributes": given, "indices": corners, "material": 0, "extensions": mappings},
        {"attributes": attributes, "indices": corners, "material": 1},
        {"attributes": attributes, "indices": corners, "material": 2}
    ]));
    d
}

fn floats<const N: usize>(data: &[[f32; N]]) -> Vec<u8> {
    data.iter().flatten().flat_map(|v| v.to_le_bytes()).collect()
}

impl Document {
    fn new(extensions: &[&str]) -> Self {
        let mut json = json!({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]});
        if !extensions.is_empty() {
            json["extensionsUsed"] = json!(extensions);
        }
        if extensions.contains(&"KHR_mesh_quantization") {
            json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        }
        Self { json, bin: Vec::new() }
    }

    /// Appends to an array of the root; its index.
    fn push(&mut self, key: &str, value: Value) -> usize {
        let root = self.json.as_object_mut().expect("root");
        let all = root.entry(key).or_insert_with(|| json!([])).as_array_mut().expect("array");
        all.push(value);
        all.len() - 1
    }

    /// A node of the scene.
    fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().expect("nodes").push(json!(index));
        index
    }

    fn mesh(&mut self, primitives: Value) {
        let mesh = self.push("meshes", json!({"primitives": primitives}));
        self.node(json!({"mesh": mesh}));
    }

    fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        let offset = self.bin.len().next_multiple_of(4);
        self.bin.resize(offset, 0);
        self.bin.extend_from_slice(bytes);
        let mut view = json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()});
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.push("bufferViews", view)
    }

    fn floats<const N: usize>(&mut self, data: &[[f32; N]]) -> usize {
        let view = self.view(&floats(data), None);
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N).map(|c| data.iter().map(|v| v[c]).reduce(pick).expect("elements")).collect()
        };
        let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"][N];
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5126, "count": data.len(), "type": kind,
            "min": bound(f32::min), "max": bound(f32::max)}),
        )
    }

    /// Two triangles of four corners.
    fn indices(&mut self) -> usize {
        let view = self.view(&[0, 1, 2, 0, 2, 3], None);
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5121, "count": 6, "type": "SCALAR"}),
        )
    }

    /// Damages JSON and buffer as the bytes decide.
    pub(crate) fn damaged(&self, bytes: &[u8]) -> Self {
        let mut out = self.clone();
        let dice = &mut Dice::new(bytes);
        // Not a number, infinity, huge, and indices of nothing, in one document of four.
        const WORDS: [u32; 6] = [0x7fc0_0000, 0xff80_0000, 0x7f7f_ffff, 0x0000_0001, u32::MAX, 0x8000_0000];
        if dice.below(4) == Some(0) && !out.bin.is_empty() {
            for _ in 0..dice.below(8).unwrap_or(0) {
                let (Some(at), Some(word)) = (dice.below(out.bin.len() / 4), dice.below(WORDS.len())) else {
                    break;
                };
                out.bin[4 * at..][..4].copy_from_slice(&WORDS[word].to_le_bytes());
            }
        }
        mutate(&mut out.json, dice);
        out
    }

    /// Names the buffer.
    fn finished(mut self) -> Self {
        if !self.bin.is_empty() {
            self.json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        self
    }

    /// As `.gltf` with the buffer inside.
    pub(crate) fn gltf(&self) -> Vec<u8> {
        let mut d = self.clone();
        if let Some(buffer) = d.json.pointer_mut("/buffers/0").and_then(Value::as_object_mut)
            && !d.bin.is_empty()
        {
            let uri = format!("data:application/octet-stream;base64,{}", base64(&d.bin));
            buffer.entry("uri").or_insert(json!(uri));
        }
        serde_json::to_vec(&d.json).expect("JSON")
    }

    /// As `.glb`.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut d = self.clone();
        let mut text = serde_json::to_vec(&d.json).expect("JSON");
        text.resize(text.len().next_multiple_of(4), b' ');
        d.bin.resize(d.bin.len().next_multiple_of(4), 0);
        let mut chunks = vec![(*b"JSON", text)];
        if !d.bin.is_empty() {
            chunks.push((*b"BIN\0", d.bin));
        }
        let length = 12 + chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
        let mut out = b"glTF\x02\0\0\0".to_vec();
        out.extend((length as u32).to_le_bytes());
        for (tag, bytes) in chunks {
            out.extend((bytes.len() as u32).to_le_bytes());
            out.extend(tag);
            out.extend(bytes);
        }
        out
    }
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let n = chunk.iter().enumerate().fold(0u32, |n, (i, b)| n | u32::from(*b) << (16 - 8 * i));
        for i in 0..4 {
            let digit = DIGITS[(n >> (18 - 6 * i) & 63) as usize];
            out.push(if i <= chunk.len() { digit as char } else { '=' });
        }
    }
    out
}
