use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use etendue_camera::{Film, FilmParts, Planes};
use etendue_core::UVec2;

use super::layout::{
    ALBEDO, ALPHA, BLOCK, COUNTS, DEPTH, END, Entry, FRAME, HITS, IDS, INFO, INFO_BYTES, MAGIC, NORMAL,
    START, SUMS, VERSION, Vector, checksum, file_bytes, planes_of,
};
use super::{Digest, FilmFile, FilmInfo, FilmReadError, IndexRanges};
use crate::Limits;
use crate::resolver::open_file;

/// Reads a `.film` file.
///
/// # Errors
/// [`FilmReadError`]: any damage is noticed, and no more memory is asked for than the file has bytes to fill.
pub fn read_film(path: &Path, limits: &Limits) -> Result<FilmFile, FilmReadError> {
    let name = path.display().to_string();
    let (file, bytes) = open_file(path, &name, limits.file_bytes)?;
    read(&name, std::io::BufReader::new(file), bytes)
}

/// Reads a film that is in memory; `name` stands for it in messages.
///
/// # Errors
/// As [`read_film`].
pub fn read_film_bytes(name: &str, bytes: &[u8]) -> Result<FilmFile, FilmReadError> {
    read(name, bytes, bytes.len() as u64)
}

/// A file on its way through the reader.
struct Source<'a, R> {
    name: &'a str,
    input: R,
    /// Bytes in all.
    length: u64,
    /// Bytes read.
    at: u64,
    /// Where the block being read begins, for messages.
    block_at: u64,
}

/// What `INFO` says.
struct Head {
    info: FilmInfo,
    size: UVec2,
    replicates: u32,
    planes: Planes,
}

fn read<R: Read>(name: &str, input: R, length: u64) -> Result<FilmFile, FilmReadError> {
    let mut source = Source { name, input, length, at: 0, block_at: 0 };
    let file = || name.to_owned();
    let mut start = [0; START as usize];
    if length < START {
        return Err(FilmReadError::Magic { file: file() });
    }
    source.fill(&mut start)?;
    let (magic, version) = start.split_at(MAGIC.len());
    if magic != MAGIC {
        return Err(FilmReadError::Magic { file: file() });
    }
    let found = version.iter().rev().fold(0u32, |v, &b| (v << 8) | u32::from(b));
    if found != VERSION {
        return Err(FilmReadError::Version { file: file(), found, known: VERSION });
    }

    let payload = source.block("INFO", INFO, None)?;
    let info_bytes = payload.len() as u64;
    let head = Fields(&payload).head().ok_or_else(|| source.damaged("INFO", "its fields make no sense"))?;
    let pixels = u64::from(head.size.x).saturating_mul(u64::from(head.size.y));
    let cells = pixels.saturating_mul(u64::from(head.replicates));
    let expected = file_bytes(info_bytes, pixels, cells, head.planes).unwrap_or(u64::MAX);
    if expected != length {
        return Err(FilmReadError::Length { file: file(), found: length, expected });
    }
    // As many bytes are there as these need, so they fit a usize where memory does.
    let n = |kept: bool| if kept { pixels as usize } else { 0 };
    let (cells, planes) = (cells as usize, head.planes);
    let parts = FilmParts {
        sums: source.vector(SUMS, cells)?,
        counts: source.vector(COUNTS, cells)?,
        albedo: source.vector(ALBEDO, n(planes.albedo))?,
        normal: source.vector(NORMAL, n(planes.normal))?,
        depth: source.vector(DEPTH, n(planes.depth))?,
        hits: source.vector(HITS, n(planes.depth))?,
        alpha: source.vector(ALPHA, n(planes.alpha))?,
        ids: source.vector(IDS, n(planes.ids))?,
    };
    source.block("END", END, Some(0))?;
    let film = Film::from_parts(head.size, head.replicates, planes, parts)
        .map_err(|source| FilmReadError::Film { file: file(), source })?;
    FilmFile::new(name, head.info, film).map_err(|source| FilmReadError::Samples { file: file(), source })
}

impl<R: Read> Source<'_, R> {
    fn damaged(&self, block: &'static str, what: &'static str) -> FilmReadError {
        FilmReadError::Damaged { file: self.name.into(), at: self.block_at, block, what }
    }

    fn fill(&mut self, buffer: &mut [u8]) -> Result<(), FilmReadError> {
        let failed = |source| FilmReadError::Io { file: self.name.into(), at: self.at, source };
        self.input.read_exact(buffer).map_err(failed)?;
        self.at = self.at.saturating_add(buffer.len() as u64);
        Ok(())
    }

    /// The payload of the next block, which must have this tag, and this length where it is known.
    fn block(
        &mut self,
        name: &'static str,
        tag: &[u8; 4],
        expected: Option<u64>,
    ) -> Result<Vec<u8>, FilmReadError> {
        self.block_at = self.at;
        if self.length.saturating_sub(self.at) < FRAME {
            return Err(self.damaged(name, "the file ends before it"));
        }
        let mut frame = [0; FRAME as usize];
        self.fill(&mut frame)?;
        let (found_tag, rest) = frame.split_at(4);
        let (length, sum) = rest.split_at(8);
        let length = u64::get(length).unwrap_or(u64::MAX);
        if found_tag != tag {
            return Err(self.damaged(name, "another block stands in its place"));
        }
        if expected.is_some_and(|e| e != length) {
            return Err(self.damaged(name, "its length is wrong"));
        }
        if length > self.length.saturating_sub(self.at) {
            return Err(self.damaged(name, "it is longer than the file"));
        }
        if expected.is_none() && length > INFO_BYTES {
            return Err(self.damaged(name, "it is longer than 16 MiB"));
        }
        let mut payload = Vec::new();
        if payload.try_reserve_exact(length as usize).is_err() {
            return Err(FilmReadError::Memory { file: self.name.into(), bytes: length });
        }
        payload.resize(length as usize, 0);
        self.fill(&mut payload)?;
        if sum != checksum(tag, &payload).to_le_bytes() {
            return Err(self.damaged(name, "its checksum is wrong"));
        }
        Ok(payload)
    }

    fn vector<E: Entry>(&mut self, vector: Vector, entries: usize) -> Result<Vec<E>, FilmReadError> {
        let mut out: Vec<E> = Vec::new();
        if out.try_reserve_exact(entries).is_err() {
            let bytes = (entries as u64).saturating_mul(size_of::<E>() as u64);
            return Err(FilmReadError::Memory { file: self.name.into(), bytes });
        }
        while out.len() < entries {
            let n = entries.saturating_sub(out.len()).min(BLOCK);
            let length = (n as u64).saturating_mul(E::BYTES as u64);
            let payload = self.block(vector.name, vector.tag, Some(length))?;
            for bytes in payload.chunks_exact(E::BYTES) {
                out.push(E::get(bytes).ok_or_else(|| self.damaged(vector.name, "an entry makes no sense"))?);
            }
        }
        Ok(out)
    }
}

/// The bytes of `INFO` that are still to be read.
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(taken)
    }

    fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    fn u64(&mut self) -> Option<u64> {
        u64::get(self.take(8)?)
    }

    fn byte(&mut self) -> Option<u8> {
        self.take(1)?.first().copied()
    }

    fn digest(&mut self) -> Option<Digest> {
        let value = u128::from_le_bytes(self.take(16)?.try_into().ok()?);
        let opaque = match self.byte()? {
            0 => false,
            1 => true,
            _ => return None,
        };
        Some(Digest { value, opaque })
    }

    fn text(&mut self) -> Option<String> {
        let n = self.u32()? as usize;
        Some(std::str::from_utf8(self.take(n)?).ok()?.to_owned())
    }

    fn head(mut self) -> Option<Head> {
        let (scene, settings) = (self.digest()?, self.digest()?);
        let size = UVec2::new(self.u32()?, self.u32()?);
        let replicates = self.u32()?;
        let planes = planes_of(self.byte()?)?;
        let mut samples = IndexRanges::new();
        let mut before: Option<u64> = None;
        for _ in 0..self.u32()? {
            let (start, end) = (self.u64()?, self.u64()?);
            if start >= end || before.is_some_and(|b| start <= b) {
                return None;
            }
            before = Some(end);
            samples.push_last(start..end);
        }
        let mut words = BTreeMap::new();
        for _ in 0..self.u32()? {
            let (key, value) = (self.text()?, self.text()?);
            if words.last_key_value().is_some_and(|(last, _)| *last >= key) {
                return None;
            }
            words.insert(key, value);
        }
        self.0.is_empty().then_some(Head {
            info: FilmInfo { scene, settings, words, samples },
            size,
            replicates,
            planes,
        })
    }
}
