use std::io::{self, Write};
use std::path::Path;

use super::layout::{
    ALBEDO, ALPHA, BLOCK, COUNTS, DEPTH, END, Entry, HITS, IDS, INFO, MAGIC, NORMAL, SUMS, VERSION, Vector,
    checksum, plane_bits,
};
use super::{Digest, FilmFile};
use crate::WriteError;
use crate::atomic::write_with;

/// Writes a `.film` file so that the target is either what it was or all of the film.
///
/// # Errors
/// [`WriteError`]; the target is then as it was.
pub fn write_film(path: &Path, film: &FilmFile) -> Result<(), WriteError> {
    write_with(path, |out| put(film, out))
}

/// The bytes of a `.film` file.
pub fn film_bytes(film: &FilmFile) -> Vec<u8> {
    let mut out = Vec::new();
    // A vector takes every byte.
    let _ = put(film, &mut out);
    out
}

fn put(file: &FilmFile, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(&MAGIC)?;
    out.write_all(&VERSION.to_le_bytes())?;
    block(out, INFO, &info(file))?;
    let v = file.film().view();
    vector(out, SUMS, v.sums)?;
    vector(out, COUNTS, v.counts)?;
    vector(out, ALBEDO, v.albedo)?;
    vector(out, NORMAL, v.normal)?;
    vector(out, DEPTH, v.depth)?;
    vector(out, HITS, v.hits)?;
    vector(out, ALPHA, v.alpha)?;
    vector(out, IDS, v.ids)?;
    block(out, END, &[])
}

fn vector<E: Entry>(out: &mut dyn Write, vector: Vector, entries: &[E]) -> io::Result<()> {
    let mut payload = Vec::new();
    for some in entries.chunks(BLOCK) {
        payload.clear();
        some.iter().for_each(|e| e.put(&mut payload));
        block(out, vector.tag, &payload)?;
    }
    Ok(())
}

fn block(out: &mut dyn Write, tag: &[u8; 4], payload: &[u8]) -> io::Result<()> {
    out.write_all(tag)?;
    out.write_all(&(payload.len() as u64).to_le_bytes())?;
    out.write_all(&checksum(tag, payload).to_le_bytes())?;
    out.write_all(payload)
}

fn info(file: &FilmFile) -> Vec<u8> {
    let (info, film) = (file.info(), file.film());
    let mut out = Vec::new();
    for Digest { value, opaque } in [info.scene, info.settings] {
        out.extend_from_slice(&value.to_le_bytes());
        out.push(u8::from(opaque));
    }
    for v in [film.size().x, film.size().y, film.replicates()] {
        out.extend_from_slice(&v.to_le_bytes());
    }
    out.push(plane_bits(film.planes()));
    let ranges = info.samples.as_slice();
    out.extend_from_slice(&(ranges.len() as u32).to_le_bytes());
    for r in ranges {
        r.start.put(&mut out);
        r.end.put(&mut out);
    }
    out.extend_from_slice(&(info.words.len() as u32).to_le_bytes());
    for (key, value) in &info.words {
        for text in [key, value] {
            out.extend_from_slice(&(text.len() as u32).to_le_bytes());
            out.extend_from_slice(text.as_bytes());
        }
    }
    out
}
