//! What stands where in a film file, shared by reader and writer.

use etendue_camera::{Ids, Planes};

pub(super) const MAGIC: [u8; 8] = *b"\x89ETFILM\n";
pub(super) const VERSION: u32 = 1;
/// Most entries of a vector in one block.
pub(super) const BLOCK: usize = 1 << 16;
/// Magic number and version.
pub(super) const START: u64 = 12;
/// Tag, length and checksum of a block.
pub(super) const FRAME: u64 = 16;
/// Longest `INFO`, bytes.
pub(super) const INFO_BYTES: u64 = 1 << 24;

pub(super) const INFO: &[u8; 4] = b"INFO";
pub(super) const END: &[u8; 4] = b"END ";

/// One vector of the film.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vector {
    pub(super) name: &'static str,
    pub(super) tag: &'static [u8; 4],
}

const fn vector(name: &'static str, tag: &'static [u8; 4]) -> Vector {
    Vector { name, tag }
}

pub(super) const SUMS: Vector = vector("sums", b"SUMS");
pub(super) const COUNTS: Vector = vector("counts", b"CNTS");
pub(super) const ALBEDO: Vector = vector("albedo", b"ALBD");
pub(super) const NORMAL: Vector = vector("normal", b"NRML");
pub(super) const DEPTH: Vector = vector("depth", b"DPTH");
pub(super) const HITS: Vector = vector("hits", b"HITS");
pub(super) const ALPHA: Vector = vector("alpha", b"ALPH");
pub(super) const IDS: Vector = vector("ids", b"IDS ");

/// The checksum of a block.
pub(super) fn checksum(tag: &[u8; 4], payload: &[u8]) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    crc.update(tag);
    crc.update(&(payload.len() as u64).to_le_bytes());
    crc.update(payload);
    crc.finalize()
}

/// Bytes of a whole file; `None` where that is beyond 64 bits.
pub(super) fn file_bytes(info: u64, pixels: u64, cells: u64, planes: Planes) -> Option<u64> {
    let n = |kept: bool| if kept { pixels } else { 0 };
    let vectors = [
        (cells, <[i128; 3]>::BYTES),
        (cells, u64::BYTES),
        (n(planes.albedo), <[i128; 3]>::BYTES),
        (n(planes.normal), <[i128; 3]>::BYTES),
        (n(planes.depth), i128::BYTES),
        (n(planes.depth), u64::BYTES),
        (n(planes.alpha), i128::BYTES),
        (n(planes.ids), <Option<(u64, Ids)>>::BYTES),
    ];
    let mut total = START.checked_add(FRAME)?.checked_add(info)?.checked_add(FRAME)?;
    for (entries, size) in vectors {
        let frames = entries.div_ceil(BLOCK as u64).checked_mul(FRAME)?;
        total = total.checked_add(entries.checked_mul(size as u64)?)?.checked_add(frames)?;
    }
    Some(total)
}

/// Which planes are kept, as bits.
pub(super) fn plane_bits(p: Planes) -> u8 {
    [p.albedo, p.normal, p.depth, p.ids, p.alpha]
        .into_iter()
        .rev()
        .fold(0, |bits, kept| (bits << 1) | u8::from(kept))
}

/// The planes of some bits; `None` for bits that mean nothing.
pub(super) fn planes_of(bits: u8) -> Option<Planes> {
    let kept = |i: u8| (bits >> i) & 1 == 1;
    (bits < 1 << 5).then(|| Planes {
        albedo: kept(0),
        normal: kept(1),
        depth: kept(2),
        ids: kept(3),
        alpha: kept(4),
    })
}

/// One entry of a vector.
pub(super) trait Entry: Sized {
    /// Bytes in the file.
    const BYTES: usize;
    fn put(&self, out: &mut Vec<u8>);
    /// Back from exactly [`Entry::BYTES`] bytes; `None` where they cannot have been written.
    fn get(bytes: &[u8]) -> Option<Self>;
}

impl Entry for u64 {
    const BYTES: usize = 8;
    fn put(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.to_le_bytes());
    }
    fn get(bytes: &[u8]) -> Option<Self> {
        Some(Self::from_le_bytes(bytes.try_into().ok()?))
    }
}

impl Entry for i128 {
    const BYTES: usize = 16;
    fn put(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.to_le_bytes());
    }
    fn get(bytes: &[u8]) -> Option<Self> {
        Some(Self::from_le_bytes(bytes.try_into().ok()?))
    }
}

impl Entry for [i128; 3] {
    const BYTES: usize = 48;
    fn put(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|v| v.put(out));
    }
    fn get(bytes: &[u8]) -> Option<Self> {
        let mut each = bytes.chunks_exact(16).map(i128::get);
        let mut next = || each.next().flatten();
        Some([next()?, next()?, next()?])
    }
}

impl Entry for Option<(u64, Ids)> {
    /// Whether anything was seen, sample index, instance, geometry, triangle.
    const BYTES: usize = 21;
    fn put(&self, out: &mut Vec<u8>) {
        let (index, ids) = self.unwrap_or((0, Ids { inst: 0, geom: 0, prim: 0 }));
        out.push(u8::from(self.is_some()));
        out.extend_from_slice(&index.to_le_bytes());
        for id in [ids.inst, ids.geom, ids.prim] {
            out.extend_from_slice(&id.to_le_bytes());
        }
    }
    fn get(bytes: &[u8]) -> Option<Self> {
        let (flag, rest) = bytes.split_first()?;
        match flag {
            0 => rest.iter().all(|&b| b == 0).then_some(None),
            1 => {
                let (index, ids) = rest.split_at_checked(8)?;
                let mut each = ids.chunks_exact(4).map(|b| Some(u32::from_le_bytes(b.try_into().ok()?)));
                let mut next = || each.next().flatten();
                Some(Some((u64::get(index)?, Ids { inst: next()?, geom: next()?, prim: next()? })))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_of_planes_come_back() {
        for bits in 0..32 {
            assert_eq!(plane_bits(planes_of(bits).unwrap()), bits);
        }
        assert_eq!(planes_of(32), None);
        assert_eq!(planes_of(plane_bits(Planes::ALL)), Some(Planes::ALL));
        assert!(planes_of(1).unwrap().albedo);
    }

    #[test]
    fn entries_come_back() {
        fn same<E: Entry + PartialEq + std::fmt::Debug>(e: E) {
            let mut out = Vec::new();
            e.put(&mut out);
            assert_eq!(out.len(), E::BYTES);
            assert_eq!(E::get(&out), Some(e));
        }
        same(u64::MAX - 1);
        same(i128::MIN + 5);
        same([1i128, -2, i128::MAX]);
        same(None::<(u64, Ids)>);
        same(Some((7u64, Ids { inst: u32::MAX, geom: 1, prim: 2 })));
    }
}
