//! The framing of binary glTF (Khronos, "glTF 2.0 Specification", section 4).

use super::report::Issue;

/// A binary glTF file, taken apart.
#[derive(Debug)]
pub(crate) struct Glb<'a> {
    /// The document.
    pub json: &'a [u8],
    /// The first buffer, if it is inside.
    pub bin: Option<&'a [u8]>,
    /// What is odd but allowed.
    pub warnings: Vec<Issue>,
}

const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;
/// Odd chunks that are spoken of.
const WARNINGS: usize = 10;

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|b| u32::from_le_bytes(*b))
}

fn fault(code: &'static str, at: usize, message: String) -> Issue {
    Issue::error(code, format_args!("@{at}"), message)
}

/// Takes a binary glTF file apart.
///
/// # Errors
/// The first fault of the framing. Lengths are compared with the bytes that are there; nothing is allocated for them.
pub(crate) fn glb(bytes: &[u8]) -> Result<Glb<'_>, Issue> {
    let (Some(magic), Some(version), Some(length)) = (word(bytes, 0), word(bytes, 4), word(bytes, 8)) else {
        let message = format!("the file has {} bytes; the header alone has 12", bytes.len());
        return Err(fault("GLB_UNEXPECTED_END_OF_HEADER", bytes.len(), message));
    };
    if magic != u32::from_le_bytes(*b"glTF") {
        return Err(fault(
            "GLB_INVALID_MAGIC",
            0,
            "the file does not begin with 'glTF'; it is no GLB file".into(),
        ));
    }
    if version != 2 {
        let message =
            format!("version {version} of the container; only 2 is known, export the scene as glTF 2.0");
        return Err(fault("GLB_INVALID_VERSION", 4, message));
    }
    // The header and the header of one chunk.
    if length <= 12 {
        return Err(fault(
            "GLB_LENGTH_TOO_SMALL",
            8,
            format!("a length of {length} bytes leaves no room for a scene"),
        ));
    }
    let length = usize::try_from(length).unwrap_or(usize::MAX);
    let mut reader =
        Reader { bytes, length, at: 12, out: Glb { json: &[], bin: None, warnings: Vec::new() } };
    let mut seen = Seen::default();
    while reader.at < length.min(bytes.len()) {
        reader.chunk(&mut seen)?;
    }
    if bytes.len() < length {
        let message =
            format!("the header says {length} bytes but there are {}; the file is cut off", bytes.len());
        return Err(fault("GLB_LENGTH_MISMATCH", bytes.len(), message));
    }
    if bytes.len() > length {
        let message = format!("{} bytes after the end", bytes.len().saturating_sub(length));
        reader.out.warnings.push(Issue::warning("GLB_EXTRA_DATA", format_args!("@{length}"), message));
    }
    if !seen.json {
        return Err(fault("GLB_UNEXPECTED_FIRST_CHUNK", 12, "there is no chunk of JSON".into()));
    }
    Ok(reader.out)
}

#[derive(Default)]
struct Seen {
    chunks: usize,
    json: bool,
    bin: bool,
}

struct Reader<'a> {
    bytes: &'a [u8],
    length: usize,
    at: usize,
    out: Glb<'a>,
}

impl Reader<'_> {
    fn chunk(&mut self, seen: &mut Seen) -> Result<(), Issue> {
        let at = self.at;
        let (Some(size), Some(kind)) = (word(self.bytes, at), word(self.bytes, at.saturating_add(4))) else {
            let message = "the file ends in the header of a chunk; it is cut off".into();
            return Err(fault("GLB_UNEXPECTED_END_OF_CHUNK_HEADER", self.bytes.len(), message));
        };
        let size = usize::try_from(size).unwrap_or(usize::MAX);
        let begin = at.saturating_add(8);
        let end = begin.saturating_add(size);
        if !size.is_multiple_of(4) {
            let message = format!("a chunk of {size} bytes; lengths are multiples of 4");
            return Err(fault("GLB_CHUNK_LENGTH_UNALIGNED", at, message));
        }
        if end > self.length {
            let message = format!("a chunk of {size} bytes does not fit in the {} of the file", self.length);
            return Err(fault("GLB_CHUNK_TOO_BIG", at, message));
        }
        if seen.chunks == 0 && kind != JSON {
            return Err(fault("GLB_UNEXPECTED_FIRST_CHUNK", at, "the first chunk is not JSON".into()));
        }
        if size == 0 && kind == JSON {
            return Err(fault("GLB_EMPTY_CHUNK", at, "a chunk without bytes".into()));
        }
        let Some(body) = self.bytes.get(begin..end) else {
            let message = "the file ends in the data of a chunk; it is cut off".into();
            return Err(fault("GLB_UNEXPECTED_END_OF_CHUNK_DATA", self.bytes.len(), message));
        };
        match kind {
            JSON | BIN if (kind == JSON && seen.json) || (kind == BIN && seen.bin) => {
                return Err(fault("GLB_DUPLICATE_CHUNK", at, "a second chunk of the same kind".into()));
            }
            JSON => (self.out.json, seen.json) = (body, true),
            BIN if seen.chunks != 1 => {
                let message = "the chunk of binary data must be the second".into();
                return Err(fault("GLB_UNEXPECTED_BIN_CHUNK", at, message));
            }
            BIN => (self.out.bin, seen.bin) = (Some(body), true),
            _ if self.out.warnings.len() < WARNINGS => {
                let message = format!("a chunk of an unknown kind, {kind:#010x}");
                let warning = Issue::warning("GLB_UNKNOWN_CHUNK_TYPE", format_args!("@{at}"), message);
                self.out.warnings.push(warning);
            }
            _ => {}
        }
        seen.chunks = seen.chunks.saturating_add(1);
        self.at = end;
        Ok(())
    }
}
