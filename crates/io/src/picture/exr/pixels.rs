use std::panic::{AssertUnwindSafe, catch_unwind};

use exr::block::UncompressedBlock;
use exr::block::chunk::{
    Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock, TileCoordinates,
};
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::prelude::f16;

use super::super::budget::{ImageBudget, filled, probe};
use super::super::decode::{Decoded, Numbers};
use super::bad;
use super::blocks::{self, Block};
use super::header::{self, Head, Kind, Part};
use crate::PictureError;

/// Where the colour of a picture is.
struct Colour {
    part: usize,
    /// The channel's number of red, green and blue; three times the same for gray.
    channels: [usize; 3],
}

pub(in crate::picture) fn read(bytes: &[u8], budget: &ImageBudget) -> Result<Decoded, PictureError> {
    let head = header::parse(bytes)?;
    let layers = layers(&head);
    for part in &head.parts {
        let (width, height) = part.size();
        // Three floats a pixel are kept; the blocks bring all channels.
        budget.check(width, height, part.pixel_bytes().max(12), bytes.len() as u64)?;
    }
    let colour = colour(&head).ok_or_else(|| PictureError::NoColour { channels: listed(&layers) })?;
    let part = head.parts.get(colour.part).ok_or_else(|| bad("header", "the part is missing"))?;
    if let Some(c) = part.channels.iter().find(|c| c.subsampled) {
        return Err(bad(
            format!("channel '{}'", c.name),
            "subsampled channels are not read; write it in full",
        ));
    }
    let found = blocks::find(bytes, &head, colour.part)?;
    let meta = exr::block::read(std::io::Cursor::new(bytes), false)
        .map_err(|e| bad("header", e.to_string()))?
        .into_meta_data();

    let (width, height) = part.size();
    let pixels = width.unsigned_abs().saturating_mul(height.unsigned_abs());
    let mut rgb = filled(0.0f32, pixels.saturating_mul(3) as usize)?;
    for block in found {
        let place = || format!("block at ({}, {})", block.x, block.y);
        let area = u64::from(block.width).saturating_mul(u64::from(block.height));
        let decoded = area.saturating_mul(part.pixel_bytes());
        budget.ratio(decoded, block.data.len() as u64)?;
        // Compressed, decompressed, and what the method needs beside them.
        probe(decoded.saturating_mul(4))?;
        let data = decompress(&block, colour.part, part, &meta).map_err(|reason| bad(place(), reason))?;
        if data.len() as u64 != decoded {
            return Err(bad(place(), "its pixels are too few or too many"));
        }
        place_block(&block, &data, part, &colour, width.unsigned_abs(), &mut rgb);
    }
    let mut metadata = vec![("format".to_owned(), "OpenEXR".to_owned())];
    metadata.extend(part.metadata.iter().cloned());
    Ok(Decoded {
        width: width as u32,
        height: height as u32,
        channels: 3,
        numbers: Numbers::Floats(rgb),
        layers,
        metadata,
    })
}

/// Every channel, with its part's name where there are several.
fn layers(head: &Head) -> Vec<String> {
    let names = |p: &Part| {
        let prefix = if head.parts.len() > 1 { format!("{}:", p.name) } else { String::new() };
        p.channels.iter().map(|c| format!("{prefix}{}", c.name)).collect::<Vec<_>>()
    };
    head.parts.iter().flat_map(names).collect()
}

fn listed(layers: &[String]) -> String {
    let mut out = layers.iter().take(16).cloned().collect::<Vec<_>>().join(", ");
    if layers.len() > 16 {
        out.push_str(" …");
    }
    out
}

/// The colour without a prefix before one with, the first part before the second, colour before gray; a channel that
/// stands alone is gray whatever its name.
fn colour(head: &Head) -> Option<Colour> {
    let in_part = |number: usize, part: &Part| {
        let place = |name: String| part.channels.iter().position(|c| c.name.eq_ignore_ascii_case(&name));
        let rgb = |prefix: &str| {
            let [r, g, b] = ["R", "G", "B"].map(|c| place(format!("{prefix}{c}")));
            Some(Colour { part: number, channels: [r?, g?, b?] })
        };
        let gray = |y: usize| Colour { part: number, channels: [y; 3] };
        let prefixes =
            || part.channels.iter().filter_map(|c| c.name.rsplit_once('.')).map(|(p, _)| format!("{p}."));
        rgb("")
            .or_else(|| prefixes().find_map(|p| rgb(&p)))
            .or_else(|| place("Y".into()).map(gray))
            .or_else(|| prefixes().find_map(|p| place(format!("{p}Y"))).map(gray))
            .or_else(|| (part.channels.len() == 1).then(|| gray(0)))
    };
    head.parts.iter().enumerate().find_map(|(i, p)| in_part(i, p))
}

fn decompress(block: &Block<'_>, number: usize, part: &Part, meta: &MetaData) -> Result<Vec<u8>, String> {
    let mut compressed_pixels_le = Vec::new();
    compressed_pixels_le.try_reserve_exact(block.data.len()).map_err(|_| "out of memory".to_owned())?;
    compressed_pixels_le.extend_from_slice(block.data);
    let [x, y] = block.tile;
    let compressed_block = if part.tiles.is_some() {
        let coordinates =
            TileCoordinates { tile_index: Vec2(x as usize, y as usize), level_index: Vec2(0, 0) };
        CompressedBlock::Tile(CompressedTileBlock { coordinates, compressed_pixels_le })
    } else {
        let top = part.window.map_or(0, |[_, top, ..]| top);
        let y_coordinate = top.saturating_add_unsigned(block.y);
        CompressedBlock::ScanLine(CompressedScanLineBlock { y_coordinate, compressed_pixels_le })
    };
    let chunk = Chunk { layer_index: number, compressed_block };
    // Its decompressors still have asserts and indices that damaged data can reach.
    match catch_unwind(AssertUnwindSafe(|| UncompressedBlock::decompress_chunk(chunk, meta, false))) {
        Ok(Ok(done)) => Ok(done.data),
        Ok(Err(e)) => Err(e.to_string()),
        Err(_) => Err("its data are damaged beyond what the decoder can tell".into()),
    }
}

/// Copies the colour of a block: row by row, in each all numbers of one channel after those of the other.
fn place_block(block: &Block<'_>, data: &[u8], part: &Part, colour: &Colour, width: u64, rgb: &mut [f32]) {
    let row_bytes = u64::from(block.width).saturating_mul(part.pixel_bytes()) as usize;
    for (y, row) in (u64::from(block.y)..).zip(data.chunks_exact(row_bytes.max(1))) {
        let start = y.saturating_mul(width).saturating_add(u64::from(block.x)).saturating_mul(3);
        let mut rest = row;
        for (number, channel) in part.channels.iter().enumerate() {
            let bytes = u64::from(block.width).saturating_mul(channel.kind.bytes()) as usize;
            let Some((line, after)) = rest.split_at_checked(bytes) else { return };
            rest = after;
            for (c, _) in (0u64..).zip(colour.channels).filter(|(_, wanted)| *wanted == number) {
                let to = rgb.get_mut(start.saturating_add(c) as usize..).unwrap_or_default();
                copy(line, channel.kind, to.iter_mut().step_by(3));
            }
        }
    }
}

fn copy<'a>(line: &[u8], kind: Kind, to: impl Iterator<Item = &'a mut f32>) {
    let number = |b: &[u8]| match (kind, b) {
        (Kind::Half, &[a, b]) => f16::from_ne_bytes([a, b]).to_f32(),
        (Kind::Float, &[a, b, c, d]) => f32::from_ne_bytes([a, b, c, d]),
        (Kind::Uint, &[a, b, c, d]) => u32::from_ne_bytes([a, b, c, d]) as f32,
        _ => 0.0,
    };
    for (to, from) in to.zip(line.chunks_exact(kind.bytes() as usize)) {
        *to = number(from);
    }
}
