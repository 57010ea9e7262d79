use super::bad;
use crate::PictureError;

/// More parts or channels than this are taken for damage: some steps go through all of them for each of them.
const MOST_PARTS: usize = 1024;
const MOST_CHANNELS: usize = 1024;
/// Longest attribute that is told as metadata, bytes.
const TOLD: usize = 4096;

/// How a channel's numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Uint,
    Half,
    Float,
}

impl Kind {
    pub(super) fn bytes(self) -> u64 {
        if self == Self::Half { 2 } else { 4 }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Channel {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) subsampled: bool,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Tiles {
    pub(super) width: u32,
    pub(super) height: u32,
    /// 0 one level, 1 mip map, 2 rip map.
    pub(super) levels: u8,
    pub(super) round_up: bool,
}

/// One picture of a file.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    pub(super) name: String,
    pub(super) kind: String,
    /// Left, top, right, bottom; inclusive.
    pub(super) window: Option<[i32; 4]>,
    pub(super) channels: Vec<Channel>,
    pub(super) compression: u8,
    pub(super) tiles: Option<Tiles>,
    pub(super) chunks: Option<u64>,
    pub(super) metadata: Vec<(String, String)>,
}

impl Part {
    /// Width and height of the data window.
    pub(super) fn size(&self) -> (i64, i64) {
        let [l, t, r, b] = self.window.unwrap_or([0, 0, -1, -1]).map(i64::from);
        (r.saturating_sub(l).saturating_add(1), b.saturating_sub(t).saturating_add(1))
    }

    pub(super) fn pixel_bytes(&self) -> u64 {
        self.channels.iter().map(|c| c.kind.bytes()).fold(0, u64::saturating_add)
    }
}

/// Everything before the tables of offsets.
#[derive(Debug)]
pub(super) struct Head {
    pub(super) parts: Vec<Part>,
    pub(super) multipart: bool,
    /// Where the tables of offsets begin.
    pub(super) end: usize,
}

pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    pub(super) at: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    pub(super) fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let end = self.at.checked_add(n)?;
        let taken = self.bytes.get(self.at..end)?;
        self.at = end;
        Some(taken)
    }

    pub(super) fn i32(&mut self) -> Option<i32> {
        Some(i32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    fn byte(&mut self) -> Option<u8> {
        self.take(1)?.first().copied()
    }

    /// A name that ends with a zero; names are at most 255 bytes long.
    fn name(&mut self) -> Option<String> {
        let rest = self.bytes.get(self.at..)?;
        let end = rest.iter().take(256).position(|&b| b == 0)?;
        self.at = self.at.checked_add(end)?.checked_add(1)?;
        Some(String::from_utf8_lossy(rest.get(..end)?).into_owned())
    }
}

pub(super) fn parse(bytes: &[u8]) -> Result<Head, PictureError> {
    let mut c = Cursor::new(bytes, 4);
    let Some(version) = c.u32() else { return Err(bad("header", "the file ends in it")) };
    if version & 0xff > 2 {
        return Err(bad("header", format!("version {} is not read, at most 2", version & 0xff)));
    }
    if version & 0x800 != 0 {
        return Err(bad("header", "deep pictures are not read; flatten it"));
    }
    let (tiled, multipart) = (version & 0x200 != 0, version & 0x1000 != 0);
    let mut parts = Vec::new();
    loop {
        let part = part(&mut c).map_err(|(place, reason)| bad(format!("header, {place}"), reason))?;
        match part {
            None if multipart && !parts.is_empty() => break,
            None => return Err(bad("header", "it is empty")),
            Some(mut p) => {
                // Old files of one part say by a flag alone whether they are tiled.
                if !multipart && !tiled {
                    p.tiles = None;
                }
                if multipart && p.kind != "tiledimage" {
                    p.tiles = None;
                }
                if (tiled || p.kind == "tiledimage") && p.tiles.is_none() {
                    return Err(bad("header", "it is tiled, but says not how"));
                }
                parts.push(p);
            }
        }
        if !multipart {
            break;
        }
        if parts.len() > MOST_PARTS {
            return Err(bad("header", format!("more than {MOST_PARTS} parts")));
        }
    }
    Ok(Head { parts, multipart, end: c.at })
}

type Problem = (String, String);

/// One header; `None` for the zero that ends a list of headers.
fn part(c: &mut Cursor<'_>) -> Result<Option<Part>, Problem> {
    let mut part = Part::default();
    let mut any = false;
    loop {
        let cut = || ("attributes".to_owned(), "the file ends in them".to_owned());
        let name = c.name().ok_or_else(cut)?;
        if name.is_empty() {
            break;
        }
        any = true;
        let here = |reason: &str| (format!("attribute '{name}'"), reason.to_owned());
        let kind = c.name().ok_or_else(|| here("its type is cut off or too long"))?;
        let size = c.i32().ok_or_else(|| here("the file ends in it"))?;
        let size = usize::try_from(size).map_err(|_| here("its size is negative"))?;
        let value = c.take(size).ok_or_else(|| here("it is longer than the file"))?;
        part.attribute(&name, &kind, value).map_err(|reason| here(&reason))?;
    }
    if !any {
        return Ok(None);
    }
    for (missing, name) in [(part.window.is_none(), "dataWindow"), (part.channels.is_empty(), "channels")] {
        if missing {
            return Err((format!("attribute '{name}'"), "it is missing or empty".into()));
        }
    }
    Ok(Some(part))
}

impl Part {
    fn attribute(&mut self, name: &str, kind: &str, value: &[u8]) -> Result<(), String> {
        let mut c = Cursor::new(value, 0);
        let short = || "it is too short".to_owned();
        match (name, kind) {
            ("dataWindow", "box2i") => {
                let mut next = || c.i32().ok_or_else(short);
                self.window = Some([next()?, next()?, next()?, next()?]);
            }
            ("channels", "chlist") => self.channels = channels(&mut c)?,
            ("compression", _) => self.compression = c.byte().ok_or_else(short)?,
            ("tiles", "tiledesc") => {
                let (width, height) = (c.u32().ok_or_else(short)?, c.u32().ok_or_else(short)?);
                let mode = c.byte().ok_or_else(short)?;
                let (levels, round_up) = (mode & 0xf, mode >> 4 == 1);
                if levels > 2 || width == 0 || height == 0 {
                    return Err(format!("tiles of {width} x {height} in mode {mode} are unknown"));
                }
                self.tiles = Some(Tiles { width, height, levels, round_up });
            }
            ("chunkCount", "int") => {
                let n = c.i32().ok_or_else(short)?;
                self.chunks = Some(u64::try_from(n).map_err(|_| "it is negative".to_owned())?);
            }
            ("name", "string") => self.name = text(value),
            ("type", "string") => self.kind = text(value),
            (_, "string") if value.len() <= TOLD => self.metadata.push((name.into(), text(value))),
            (_, "int") => self.metadata.push((name.into(), c.i32().ok_or_else(short)?.to_string())),
            (_, "float") => {
                let v = f32::from_bits(c.u32().ok_or_else(short)?);
                self.metadata.push((name.into(), v.to_string()));
            }
            _ => {}
        }
        Ok(())
    }
}

fn text(value: &[u8]) -> String {
    String::from_utf8_lossy(value).into_owned()
}

fn channels(c: &mut Cursor<'_>) -> Result<Vec<Channel>, String> {
    let mut out = Vec::new();
    loop {
        let cut = || "a channel is cut off or its name too long".to_owned();
        let name = c.name().ok_or_else(cut)?;
        if name.is_empty() {
            return Ok(out);
        }
        if out.len() >= MOST_CHANNELS {
            return Err(format!("more than {MOST_CHANNELS} channels"));
        }
        let kind = match c.i32().ok_or_else(cut)? {
            0 => Kind::Uint,
            1 => Kind::Half,
            2 => Kind::Float,
            other => return Err(format!("channel '{name}' is of unknown type {other}")),
        };
        c.take(4).ok_or_else(cut)?;
        let (x, y) = (c.i32().ok_or_else(cut)?, c.i32().ok_or_else(cut)?);
        out.push(Channel { name, kind, subsampled: (x, y) != (1, 1) });
    }
}
