//! Documents made in code: JSON and one buffer.

use etendue::core::glam::{Vec2, Vec3};
use etendue::core::math;
use serde_json::{Value, json};

/// A glTF document in the making.
#[derive(Clone)]
pub(crate) struct Doc {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl Doc {
    pub(crate) fn new() -> Self {
        Self {
            json: json!({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}),
            bin: Vec::new(),
        }
    }

    /// Appends to an array of the root; its index.
    pub(crate) fn push(&mut self, key: &str, value: Value) -> usize {
        let root = self.json.as_object_mut().expect("root");
        let all = root.entry(key).or_insert_with(|| json!([])).as_array_mut().expect("array");
        all.push(value);
        all.len() - 1
    }

    /// A node of the scene.
    pub(crate) fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().expect("nodes").push(json!(index));
        index
    }

    pub(crate) fn uses(&mut self, extension: &str) {
        let known = self.json.get("extensionsUsed").and_then(Value::as_array);
        if !known.is_some_and(|all| all.contains(&json!(extension))) {
            self.push("extensionsUsed", json!(extension));
        }
    }

    /// A buffer view, aligned to four bytes.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.bin.len().is_multiple_of(4) {
            self.bin.push(0);
        }
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    pub(crate) fn floats<const N: usize>(&mut self, data: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = data.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let bound = |pick: fn(f32, f32) -> f32, start: f32| -> Vec<f32> {
            (0..N).map(|c| data.iter().map(|v| v[c]).fold(start, pick)).collect()
        };
        let (min, max) = (bound(f32::min, f32::INFINITY), bound(f32::max, f32::NEG_INFINITY));
        let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"][N];
        let accessor = json!({"bufferView": view, "componentType": 5126, "count": data.len(), "type": kind,
            "min": min, "max": max});
        self.push("accessors", accessor)
    }

    pub(crate) fn indices(&mut self, data: &[u16]) -> usize {
        let view = self.view(&data.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5123, "count": data.len(), "type": "SCALAR"}),
        )
    }

    /// An image of 8-bit pixels with one texture of it, read by the sampler given.
    pub(crate) fn texture(&mut self, width: u32, pixels: &[[u8; 4]], sampler: Value) -> usize {
        let view = self.view(&png(width, pixels));
        let image = self.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
        let sampler = self.push("samplers", sampler);
        self.push("textures", json!({"source": image, "sampler": sampler}))
    }

    /// A mesh with the attributes of `shape`.
    pub(crate) fn mesh(&mut self, shape: &Shape, material: Option<usize>) -> usize {
        let mut attributes = json!({"POSITION": self.floats(&shape.positions)});
        if !shape.normals.is_empty() {
            attributes["NORMAL"] = json!(self.floats(&shape.normals));
        }
        if !shape.uv.is_empty() {
            attributes["TEXCOORD_0"] = json!(self.floats(&shape.uv));
        }
        let mut primitive = json!({"attributes": attributes, "indices": self.indices(&shape.indices)});
        if let Some(m) = material {
            primitive["material"] = json!(m);
        }
        self.push("meshes", json!({"primitives": [primitive]}))
    }

    fn finished(&self) -> Value {
        let mut json = self.json.clone();
        if !self.bin.is_empty() {
            json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        json
    }

    /// As `.gltf` with the buffer inside.
    pub(crate) fn gltf(&self) -> Vec<u8> {
        let mut json = self.finished();
        if !self.bin.is_empty() {
            json["buffers"][0]["uri"] =
                json!(format!("data:application/octet-stream;base64,{}", base64(&self.bin)));
        }
        serde_json::to_vec_pretty(&json).expect("JSON")
    }

    /// As `.gltf` whose buffer is a file.
    pub(crate) fn gltf_with(&self, uri: &str) -> Vec<u8> {
        let mut json = self.finished();
        json["buffers"][0]["uri"] = json!(uri);
        serde_json::to_vec(&json).expect("JSON")
    }

    /// As `.glb`.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut text = serde_json::to_vec(&self.finished()).expect("JSON");
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bin.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let mut out = Vec::new();
        let word = |out: &mut Vec<u8>, v: u32| out.extend(v.to_le_bytes());
        out.extend(b"glTF");
        word(&mut out, 2);
        let chunks = if bin.is_empty() { 20 + text.len() } else { 28 + text.len() + bin.len() };
        word(&mut out, chunks as u32);
        word(&mut out, text.len() as u32);
        out.extend(b"JSON");
        out.extend(text);
        if !bin.is_empty() {
            word(&mut out, bin.len() as u32);
            out.extend(b"BIN\0");
            out.extend(bin);
        }
        out
    }
}

/// Vertices and triangles.
#[derive(Clone, Default)]
pub(crate) struct Shape {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) uv: Vec<[f32; 2]>,
    pub(crate) indices: Vec<u16>,
}

/// The square from −1 to 1 in x and y that faces +z; the image's top left corner is its top left corner.
pub(crate) fn quad() -> Shape {
    Shape {
        positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        uv: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

/// A ball of radius 1 with normals and texture coordinates.
pub(crate) fn ball(around: u16, down: u16) -> Shape {
    let mut s = Shape::default();
    for j in 0..=down {
        for i in 0..=around {
            let (u, v) = (f32::from(i) / f32::from(around), f32::from(j) / f32::from(down));
            let (phi, theta) = (u * std::f32::consts::TAU, v * std::f32::consts::PI);
            let ((st, ct), (sp, cp)) = (math::sin_cos(theta), math::sin_cos(phi));
            let p = Vec3::new(st * sp, ct, st * cp);
            s.positions.push(p.to_array());
            s.normals.push(p.normalize().to_array());
            s.uv.push(Vec2::new(u, v).to_array());
        }
    }
    let at = |i: u16, j: u16| j * (around + 1) + i;
    for j in 0..down {
        for i in 0..around {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            // The poles' triangles would be lines.
            if j > 0 {
                s.indices.extend([a, b, d]);
            }
            if j + 1 < down {
                s.indices.extend([b, c, d]);
            }
        }
    }
    s
}

pub(crate) fn png(width: u32, pixels: &[[u8; 4]]) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    let bytes: Vec<u8> = pixels.iter().flatten().copied().collect();
    let image = image::RgbaImage::from_raw(width, pixels.len() as u32 / width, bytes).expect("size");
    image.write_to(&mut out, image::ImageFormat::Png).expect("PNG");
    out.into_inner()
}

pub(crate) fn base64(bytes: &[u8]) -> String {
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
