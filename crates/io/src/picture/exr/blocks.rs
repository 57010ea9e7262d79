use super::bad;
use super::header::{Cursor, Head, Part, Tiles};
use crate::PictureError;

/// One block of the largest level: where it lies in the picture and in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block<'a> {
    /// Pixels from the left and the top of the data window.
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) width: u32,
    pub(super) height: u32,
    /// Its number among the tiles, or 0 and the row of blocks.
    pub(super) tile: [u32; 2],
    pub(super) data: &'a [u8],
}

/// Rows in one block; `None` for a compression that is unknown.
fn rows_per_block(compression: u8) -> Option<u32> {
    match compression {
        0..=2 => Some(1),
        3 | 5 => Some(16),
        4 | 6..=8 => Some(32),
        9 => Some(256),
        _ => None,
    }
}

/// Number of blocks of a part, all levels together.
pub(super) fn count(part: &Part) -> Result<u64, PictureError> {
    let (width, height) = part.size();
    let (width, height) = (width.unsigned_abs(), height.unsigned_abs());
    let Some(t) = part.tiles else {
        let rows = rows_per_block(part.compression)
            .ok_or_else(|| bad("header", format!("compression {} is unknown", part.compression)))?;
        return Ok(height.div_ceil(u64::from(rows)));
    };
    let levels = |side: u64| {
        let log = side.checked_ilog2().unwrap_or(0);
        let up = t.round_up && !side.is_power_of_two();
        log.saturating_add(u32::from(up)).saturating_add(1)
    };
    let tiles_at = |side: u64, level: u32, tile: u32| {
        let down = side.checked_shr(level).unwrap_or(0);
        let exact = down.checked_shl(level).unwrap_or(0) == side;
        let side = if t.round_up && !exact { down.saturating_add(1) } else { down };
        side.max(1).div_ceil(u64::from(tile.max(1)))
    };
    let at = |x: u32, y: u32| tiles_at(width, x, t.width).saturating_mul(tiles_at(height, y, t.height));
    let sum = |counts: &mut dyn Iterator<Item = u64>| counts.fold(0, u64::saturating_add);
    Ok(match t.levels {
        0 => at(0, 0),
        1 => sum(&mut (0..levels(width.max(height))).map(|l| at(l, l))),
        _ => sum(&mut (0..levels(height))
            .flat_map(|y| (0..levels(width)).map(move |x| (x, y)))
            .map(|(x, y)| at(x, y))),
    })
}

/// The blocks of the largest level of part `wanted`: all of them, each once.
pub(super) fn find<'a>(bytes: &'a [u8], head: &Head, wanted: usize) -> Result<Vec<Block<'a>>, PictureError> {
    let mut table = head.end;
    let mut counted = None;
    for (i, part) in head.parts.iter().enumerate() {
        let n = count(part)?;
        if part.chunks.is_some_and(|c| c != n) && head.multipart {
            return Err(bad("header", "its number of blocks is not that of its size"));
        }
        // Eight bytes of table each, and a block is at least its frame.
        let needed = n.saturating_mul(8);
        let there = bytes.len().saturating_sub(table) as u64;
        if n.saturating_mul(16) > there {
            let reason = format!("{n} blocks are named, and {there} bytes are left for them");
            return Err(bad("tables of offsets", reason));
        }
        if i == wanted {
            counted = Some((table, n));
        }
        table = table.saturating_add(needed as usize);
    }
    let Some((at, n)) = counted else { return Err(bad("header", "the part is missing")) };
    let part = head.parts.get(wanted).ok_or_else(|| bad("header", "the part is missing"))?;
    let mut offsets = Cursor::new(bytes, at);
    let mut out = super::super::budget::room(n as usize)?;
    for i in 0..n {
        let place = || format!("block {i}");
        let offset = offsets.u64().ok_or_else(|| bad(place(), "its offset is cut off"))?;
        let start = usize::try_from(offset).unwrap_or(usize::MAX);
        if start < table || start >= bytes.len() {
            return Err(bad(place(), format!("its offset {offset} is outside of the file's blocks")));
        }
        let mut c = Cursor::new(bytes, start);
        let found = block(&mut c, part, head.multipart.then_some(wanted));
        out.extend(found.map_err(|reason| bad(place(), reason))?);
    }
    check_cover(part, &mut out)?;
    Ok(out)
}

/// One block; `None` if it belongs to a smaller level.
fn block<'a>(c: &mut Cursor<'a>, part: &Part, number: Option<usize>) -> Result<Option<Block<'a>>, String> {
    let cut = || "it is cut off".to_owned();
    if let Some(number) = number
        && c.i32().ok_or_else(cut)?.try_into() != Ok(number)
    {
        return Err("it belongs to another part".into());
    }
    let (width, height) = part.size();
    let (width, height) = (width.unsigned_abs(), height.unsigned_abs());
    let (tile, step) = match part.tiles {
        Some(Tiles { width, height, .. }) => {
            let mut next = || c.u32().ok_or_else(cut);
            let (tile, level) = ([next()?, next()?], [next()?, next()?]);
            if level != [0, 0] {
                return Ok(None);
            }
            (tile, [u64::from(width), u64::from(height)])
        }
        None => {
            let y = i64::from(c.i32().ok_or_else(cut)?);
            let top = part.window.map_or(0, |[_, top, ..]| i64::from(top));
            let rows = i64::from(rows_per_block(part.compression).unwrap_or(1));
            let from_top = y.saturating_sub(top);
            let (row, rest) = (from_top.checked_div(rows), from_top.checked_rem(rows));
            let (Some(row), Some(0)) = (row, rest) else { return Err(format!("no block begins in row {y}")) };
            let row = u32::try_from(row).map_err(|_| format!("row {y} is not in the picture"))?;
            ([0, row], [width, rows.unsigned_abs()])
        }
    };
    let [x, y] = [0, 1].map(|i| {
        let (tile, step) = (tile.get(i).copied().unwrap_or(0), step.get(i).copied().unwrap_or(0));
        u64::from(tile).saturating_mul(step)
    });
    if x >= width || y >= height {
        return Err(format!("it lies at ({x}, {y}), outside of the picture"));
    }
    let [step_x, step_y] = step;
    let length =
        usize::try_from(c.i32().ok_or_else(cut)?).map_err(|_| "its length is negative".to_owned())?;
    let data = c.take(length).ok_or_else(|| format!("its {length} bytes are more than the file has left"))?;
    Ok(Some(Block {
        x: x as u32,
        y: y as u32,
        width: step_x.min(width.saturating_sub(x)) as u32,
        height: step_y.min(height.saturating_sub(y)) as u32,
        tile,
        data,
    }))
}

/// Blocks lie on a grid, so all are there if none is there twice and their pixels add up.
fn check_cover(part: &Part, blocks: &mut [Block<'_>]) -> Result<(), PictureError> {
    blocks.sort_by_key(|b| (b.y, b.x));
    let twice = blocks.iter().zip(blocks.iter().skip(1)).any(|(a, b)| (a.x, a.y) == (b.x, b.y));
    let pixels = |b: &Block<'_>| u64::from(b.width).saturating_mul(u64::from(b.height));
    let covered = blocks.iter().map(pixels).fold(0, u64::saturating_add);
    let (width, height) = part.size();
    if twice || covered != width.unsigned_abs().saturating_mul(height.unsigned_abs()) {
        return Err(bad("blocks", "one is there twice or missing; the file was not finished"));
    }
    Ok(())
}
