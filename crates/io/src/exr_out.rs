use std::path::Path;

use etendue_camera::{Film, TileRect};
use etendue_core::UVec2;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec,
    Text, WritableImage,
};

use crate::{Digest, FilmInfo, WriteError, write_atomically};

/// What is said about a picture inside its file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExrInfo {
    /// Biased options that were in force; empty for an unbiased picture.
    pub bias: Vec<String>,
    /// The scene's fingerprint.
    pub scene: Option<Digest>,
    /// That of camera, integrator, sampler and filter.
    pub settings: Option<Digest>,
    /// Further (name, value) pairs, such as a seed.
    pub notes: Vec<(String, String)>,
}

impl ExrInfo {
    /// What a film file knows about its film.
    pub fn of(info: &FilmInfo, bias: Vec<String>) -> Self {
        let mut notes: Vec<(String, String)> =
            info.words.iter().map(|(k, v)| (k.clone(), v.clone())).collect();
        notes.push(("samples".into(), info.samples.to_string()));
        Self { bias, scene: Some(info.scene), settings: Some(info.settings), notes }
    }
}

/// Writes a film as OpenEXR in 32-bit floats: R, G, B, and every auxiliary plane it keeps (`albedo.R` …,
/// `normal.X` …, `depth.Z`, `id.inst` …, `A`), with the samples per pixel and any bias in the attributes.
///
/// # Errors
/// [`WriteError`]; the target is then as it was.
pub fn write_exr(path: &Path, film: &Film, info: &ExrInfo) -> Result<(), WriteError> {
    let size = film.size();
    let pixels = || TileRect { lo: UVec2::ZERO, hi: size }.iter();
    let mut channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = SmallVec::new();
    let mut float = |name: &str, f: &dyn Fn(UVec2) -> f32| {
        let samples = pixels().map(f).collect();
        channels.push(AnyChannel::new(name, FlatSamples::F32(samples)));
    };
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        float(name, &|p| film.mean(p)[c]);
    }
    let planes = film.planes();
    if planes.alpha {
        float("A", &|p| film.alpha(p).unwrap_or(0.0));
    }
    if planes.albedo {
        for (c, name) in ["albedo.R", "albedo.G", "albedo.B"].into_iter().enumerate() {
            float(name, &|p| film.albedo(p).map_or(0.0, |a| a[c]));
        }
    }
    if planes.normal {
        for (c, name) in ["normal.X", "normal.Y", "normal.Z"].into_iter().enumerate() {
            float(name, &|p| film.normal(p).map_or(0.0, |v| v[c]));
        }
    }
    if planes.depth {
        float("depth.Z", &|p| film.depth(p).unwrap_or(f32::INFINITY));
    }
    if planes.ids {
        let mut id = |name: &str, f: &dyn Fn(etendue_camera::Ids) -> u32| {
            // One beyond the id, so that 0 is nothing.
            let samples = pixels().map(|p| film.ids(p).map_or(0, |ids| f(ids).wrapping_add(1))).collect();
            channels.push(AnyChannel::new(name, FlatSamples::U32(samples)));
        };
        id("id.inst", &|i| i.inst);
        id("id.geom", &|i| i.geom);
        id("id.prim", &|i| i.prim);
    }

    let mut attributes = LayerAttributes::named("etendue");
    attributes.software_name = Text::new_or_none("etendue");
    let mut note = |name: &str, value: &str| {
        if let (Some(name), Some(value)) = (Text::new_or_none(name), Text::new_or_none(value)) {
            attributes.other.insert(name, AttributeValue::Text(value));
        }
    };
    let samples = film.total_samples() as f64 / (f64::from(size.x) * f64::from(size.y));
    note("etendue.spp", &format!("{samples}"));
    note("etendue.bias", &if info.bias.is_empty() { "none".into() } else { info.bias.join("; ") });
    for (name, digest) in [("etendue.scene", info.scene), ("etendue.settings", info.settings)] {
        if let Some(Digest { value, opaque }) = digest {
            note(
                name,
                &format!("{value:032x}{}", if opaque { " (not all of it describes itself)" } else { "" }),
            );
        }
    }
    for (name, value) in &info.notes {
        // A name of their own, so that no note can stand in for what the library says.
        note(&format!("etendue.note.{name}"), value);
    }
    let layer = Layer::new(
        (size.x as usize, size.y as usize),
        attributes,
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(channels),
    );
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|e| WriteError::Encode { path: path.into(), reason: e.to_string() })?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    write_atomically(path, &bytes)
}

/// Sorts the attributes of a one-part file's header by name. The encoder keeps them in a hash map and writes them in
/// another order each time; the same film must give the same bytes. The header's length stays, so no offset moves.
fn sort_attributes(file: &mut [u8]) {
    /// Magic number and version.
    const START: usize = 8;
    fn attribute(rest: &[u8]) -> Option<&[u8]> {
        let name = rest.iter().position(|&b| b == 0)?;
        let kind = rest.get(name.checked_add(1)?..)?.iter().position(|&b| b == 0)?;
        let size_at = name.checked_add(kind)?.checked_add(2)?;
        let value_at = size_at.checked_add(4)?;
        let size = u32::from_le_bytes(rest.get(size_at..value_at)?.try_into().ok()?);
        rest.get(..value_at.checked_add(size as usize)?)
    }
    let mut found = Vec::new();
    let mut rest = file.get(START..).unwrap_or(&[]);
    while rest.first().is_some_and(|&b| b != 0) {
        let Some(whole) = attribute(rest) else { return };
        found.push(whole.to_vec());
        rest = rest.get(whole.len()..).unwrap_or(&[]);
    }
    found.sort();
    let sorted = found.concat();
    if let Some(header) = file.get_mut(START..).and_then(|f| f.get_mut(..sorted.len())) {
        header.copy_from_slice(&sorted);
    }
}
