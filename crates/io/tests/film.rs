//! The film format: every bit comes back, every damage is noticed, parts add up exactly.

mod common;

use common::Folder;
use etendue_camera::{Film, FirstHit, Ids, Planes, TileRect};
use etendue_core::{Spectrum, UVec2, Vec3A, math};
use etendue_io::{
    Digest, FilmFile, FilmInfo, FilmMergeError, FilmReadError, IndexRanges, Limits, SamplesError, film_bytes,
    read_film, read_film_bytes, write_film,
};
use proptest::prelude::*;

const SIZE: UVec2 = UVec2::new(3, 2);

/// What a render would add: a function of pixel and index alone.
fn add(film: &mut Film, pixel: UVec2, index: u64) {
    let v = math::sin_cos(index as f32 * 7.3 + pixel.x as f32 * 1.7 + pixel.y as f32).0;
    let replicate = (index % u64::from(film.replicates())) as u32;
    film.add(pixel, replicate, Spectrum::rgb(v, 1e6 * v, if index == 5 { f32::NAN } else { 1e-9 }));
    film.add_alpha(pixel, v.abs());
    if !(index + u64::from(pixel.x)).is_multiple_of(3) {
        let ids = Ids { inst: u32::MAX, geom: index as u32, prim: pixel.x };
        let hit = FirstHit { albedo: Spectrum::gray(v.abs()), normal: Vec3A::Y, depth: 2.0 + v, ids };
        film.add_first_hit(pixel, index, &hit);
    }
}

fn info(samples: IndexRanges) -> FilmInfo {
    FilmInfo {
        scene: Digest { value: 7 << 100, opaque: false },
        settings: Digest { value: 9, opaque: false },
        words: [("seed", "1"), ("sampler", "sobol"), ("scene", "Küche.obj")]
            .map(|(k, v)| (k.to_owned(), v.to_owned()))
            .into(),
        samples,
    }
}

fn part(name: &str, planes: Planes, replicates: u32, indices: &[u64]) -> FilmFile {
    let mut film = Film::with_planes(SIZE, replicates, planes).unwrap();
    let mut samples = IndexRanges::new();
    for &index in indices {
        for pixel in (TileRect { lo: UVec2::ZERO, hi: SIZE }).iter() {
            add(&mut film, pixel, index);
        }
        samples.insert(index..index + 1);
    }
    FilmFile::new(name, info(samples), film).unwrap()
}

#[test]
fn every_plane_comes_back_bit_for_bit() {
    let folder = Folder::new("film");
    for bits in 0..32u8 {
        let on = |k: u8| bits >> k & 1 == 1;
        let planes = Planes { albedo: on(0), normal: on(1), depth: on(2), ids: on(3), alpha: on(4) };
        let film = part("a", planes, 1 + u32::from(bits % 3), &[0, 1, 2, 5, 9]);
        let path = folder.path().join("a.film");
        write_film(&path, &film).unwrap();
        let again = read_film(&path, &Limits::default()).unwrap();
        assert_eq!(again, film);
        assert_eq!(again.film().digest(), film.film().digest());
        assert_eq!(film_bytes(&again), std::fs::read(&path).unwrap());
        assert_eq!(again.name(), path.display().to_string());
    }
    assert_eq!(folder.names(), ["a.film"]);
    let opaque = Digest { value: 3, opaque: true };
    let (mut info, film) = part("a", Planes::default(), 1, &[]).into_parts();
    info.scene = opaque;
    assert!(info.is_opaque());
    let empty = FilmFile::new("a", info, film).unwrap();
    assert_eq!(read_film_bytes("a", &film_bytes(&empty)).unwrap(), empty);
}

#[test]
fn more_than_one_block_comes_back() {
    // 300 x 250 pixels are 75,000 entries of each vector.
    let mut film = Film::with_planes(UVec2::new(300, 250), 1, Planes::ALL).unwrap();
    for pixel in (TileRect { lo: UVec2::ZERO, hi: film.size() }).iter() {
        add(&mut film, pixel, u64::from(pixel.x % 5 == 0));
    }
    let pixel = UVec2::new(299, 249);
    let before = film.mean(pixel);
    let mut samples = IndexRanges::from(0..1);
    samples.insert(1..2);
    // One sample each, of either index: the counts are those of one index, the ids' of both.
    let refused = FilmFile::new("a", info(samples), film.clone());
    assert!(matches!(refused, Err(SamplesError::Count { expected: 2, found: 1, .. })), "{refused:?}");
    let mut whole = Film::with_planes(film.size(), 1, Planes::ALL).unwrap();
    for pixel in (TileRect { lo: UVec2::ZERO, hi: film.size() }).iter() {
        add(&mut whole, pixel, 0);
    }
    let file = FilmFile::new("a", info((0..1).into()), whole).unwrap();
    let again = read_film_bytes("a", &film_bytes(&file)).unwrap();
    assert_eq!(again, file);
    assert_ne!(before, Spectrum::BLACK);
}

#[test]
fn a_flipped_bit_is_noticed_wherever_it_is() {
    let bytes = film_bytes(&part("a", Planes::ALL, 2, &[0, 1, 2, 3]));
    for at in 0..bytes.len() {
        for flip in [1u8, 0x80, 0xff] {
            let mut bad = bytes.clone();
            bad[at] ^= flip;
            match read_film_bytes("bad.film", &bad) {
                Ok(_) => panic!("byte {at} ^ {flip:#x} went unnoticed"),
                Err(e) => assert!(e.to_string().starts_with("bad.film"), "{e}"),
            }
        }
    }
}

#[test]
fn a_cut_or_longer_file_is_refused() {
    let bytes = film_bytes(&part("a", Planes::ALL, 2, &[0, 1]));
    for n in 0..bytes.len() {
        assert!(read_film_bytes("a", &bytes[..n]).is_err(), "{n} bytes were enough");
    }
    let mut longer = bytes.clone();
    longer.push(0);
    assert!(matches!(read_film_bytes("a", &longer), Err(FilmReadError::Length { .. })));
    let folder = Folder::new("film-cut");
    let path = folder.write("a.film", &bytes);
    let small = Limits { file_bytes: 100, ..Limits::default() };
    assert!(matches!(read_film(&path, &small), Err(FilmReadError::File(_))));
    assert!(matches!(read_film(folder.path(), &Limits::default()), Err(FilmReadError::File(_))));
    assert!(matches!(read_film(&folder.path().join("b"), &Limits::default()), Err(FilmReadError::File(_))));
}

/// The bytes with another `INFO`, its checksum made right again.
fn with_info(bytes: &[u8], change: impl Fn(&mut [u8])) -> Vec<u8> {
    let mut out = bytes.to_vec();
    let length = u64::from_le_bytes(out[16..24].try_into().unwrap()) as usize;
    change(&mut out[28..28 + length]);
    let mut crc = crc32fast::Hasher::new();
    crc.update(&out[12..24]);
    crc.update(&out[28..28 + length]);
    let sum = crc.finalize().to_le_bytes();
    out[24..28].copy_from_slice(&sum);
    out
}

#[test]
fn a_header_that_claims_more_than_the_file_has_takes_no_memory() {
    let bytes = film_bytes(&part("a", Planes::default(), 1, &[0]));
    let lie = |width: u32, height: u32, replicates: u32| {
        with_info(&bytes, |info| {
            for (i, v) in [width, height, replicates].into_iter().enumerate() {
                info[34 + 4 * i..38 + 4 * i].copy_from_slice(&v.to_le_bytes());
            }
        })
    };
    assert!(read_film_bytes("a", &lie(3, 2, 1)).is_ok());
    for (w, h, r) in
        [(60_000, 60_000, 1), (u32::MAX, u32::MAX, u32::MAX), (3, 2, u32::MAX), (0, 2, 1), (4, 2, 1)]
    {
        let e = read_film_bytes("a", &lie(w, h, r)).unwrap_err();
        assert!(matches!(e, FilmReadError::Length { .. }), "{e}");
    }
    // Right length, other shape.
    assert!(read_film_bytes("a", &lie(2, 3, 1)).is_ok());
    // Indices that the sums do not have.
    let ranges = with_info(&bytes, |info| info[59] = 2);
    let e = read_film_bytes("a", &ranges).unwrap_err();
    assert!(matches!(e, FilmReadError::Samples { .. }), "{e}");
    for (at, v) in [(46, 99), (16, 2), (51, 9)] {
        let e = read_film_bytes("a", &with_info(&bytes, |info| info[at] = v)).unwrap_err();
        assert!(matches!(e, FilmReadError::Damaged { block: "INFO", .. }), "{at}: {e}");
    }
}

#[test]
fn a_film_of_a_broken_pass_is_refused() {
    let mut film = Film::with_planes(SIZE, 2, Planes::default()).unwrap();
    for pixel in (TileRect { lo: UVec2::ZERO, hi: SIZE }).iter() {
        add(&mut film, pixel, 0);
    }
    add(&mut film, UVec2::new(2, 1), 1);
    let e = FilmFile::new("a", info((0..1).into()), film).unwrap_err();
    assert!(matches!(e, SamplesError::Count { x: 2, y: 1, replicate: 1, found: 1, expected: 0, .. }), "{e}");
    let mut film = Film::with_planes(SIZE, 1, Planes::ALL).unwrap();
    for pixel in (TileRect { lo: UVec2::ZERO, hi: SIZE }).iter() {
        add(&mut film, pixel, 4);
    }
    let e = FilmFile::new("a", info((0..1).into()), film).unwrap_err();
    assert!(matches!(e, SamplesError::Ids { index: 4, .. }), "{e}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, rng_seed: proptest::test_runner::RngSeed::Fixed(9), failure_persistence: None, ..ProptestConfig::default() })]

    /// Whoever renders which samples, and in whatever order the parts come together: the bits of the whole.
    #[test]
    fn parts_make_the_whole(owner in prop::collection::vec(0usize..4, 1..40), order in any::<u64>(), replicates in 1u32..4) {
        let all: Vec<u64> = (0..owner.len() as u64).collect();
        let whole = part("whole", Planes::ALL, replicates, &all);
        let mut parts: Vec<FilmFile> = (0..4)
            .map(|k| {
                let mine: Vec<u64> = all.iter().copied().filter(|&i| owner[i as usize] == k).collect();
                let made = part(&format!("part {k}"), Planes::ALL, replicates, &mine);
                read_film_bytes(&format!("part {k}"), &film_bytes(&made)).unwrap()
            })
            .collect();
        parts.sort_by_key(|p| (order ^ p.name().len() as u64).rotate_left(p.info().samples.count() as u32));
        let merged = parts.split_off(1).iter().fold(parts.remove(0), |a, b| a.merge(b).unwrap());
        prop_assert_eq!(&merged, &whole);
        prop_assert_eq!(film_bytes(&merged), film_bytes(&whole));
    }
}

#[test]
fn what_does_not_belong_together_is_refused_by_name() {
    let a = || part("a.film", Planes::default(), 1, &[0, 1, 2]);
    let b = || part("b.film", Planes::default(), 1, &[3, 4]);
    let with = |change: &dyn Fn(&mut FilmInfo)| {
        let (mut info, film) = b().into_parts();
        change(&mut info);
        FilmFile::new("b.film", info, film).unwrap()
    };
    let refused = |other: &FilmFile| {
        let e = a().merge(other).unwrap_err();
        assert!(e.to_string().contains("a.film") && e.to_string().contains("b.film"), "{e}");
        e
    };
    assert!(a().merge(&b()).is_ok());

    let other = with(&|i| {
        i.settings.value = 10;
        i.words.insert("seed".into(), "2".into());
        i.words.insert("filter".into(), "box".into());
    });
    let e = refused(&other);
    assert!(matches!(e, FilmMergeError::Settings { .. }));
    assert!(e.to_string().contains("filter: none and box; seed: 1 and 2"), "{e}");
    let e = refused(&with(&|i| i.settings.value = 10));
    assert!(e.to_string().contains("without a name"), "{e}");
    let e = refused(&with(&|i| {
        i.scene.value = 1;
        i.words.insert("scene".into(), "Bad.obj".into());
    }));
    assert!(matches!(e, FilmMergeError::Scene { .. }));
    assert!(e.to_string().contains("scene: Küche.obj and Bad.obj"), "{e}");

    let e = refused(&part("b.film", Planes::default(), 1, &[7, 2, 8]));
    assert_eq!(e, FilmMergeError::Overlap { a: "a.film".into(), b: "b.film".into(), range: 2..3 });
    // The part that brought the samples is named, not the first.
    let both = part("first.film", Planes::default(), 1, &[9]).merge(&a()).unwrap();
    let e = both.merge(&part("b.film", Planes::default(), 1, &[1])).unwrap_err();
    assert_eq!(e, FilmMergeError::Overlap { a: "a.film".into(), b: "b.film".into(), range: 1..2 });

    assert!(matches!(refused(&part("b.film", Planes::ALL, 1, &[3])), FilmMergeError::Film { .. }));
    assert!(matches!(refused(&part("b.film", Planes::default(), 2, &[3])), FilmMergeError::Film { .. }));
    let film = Film::new(UVec2::new(2, 2), 1).unwrap();
    let small = FilmFile::new("b.film", info(IndexRanges::new()), film).unwrap();
    let e = refused(&small);
    assert!(e.to_string().contains("3x2 and 2x2"), "{e}");
}
