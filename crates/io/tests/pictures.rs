//! Pictures written and read back.
#![cfg(all(feature = "png", feature = "exr"))]

mod common;

use common::Folder;
use etendue_camera::{Film, FirstHit, Ids, Planes};
use etendue_core::{Spectrum, UVec2, Vec3A};
use etendue_io::{
    Digest, ExrInfo, PngError, ToneMap, WriteError, png_bytes, write_exr, write_png, write_png_pixels,
};
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};

const SIZE: UVec2 = UVec2::new(5, 3);

/// Every pixel another colour, some beyond what a display shows.
fn film(planes: Planes) -> Film {
    let mut film = Film::with_planes(SIZE, 2, planes).unwrap();
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let pixel = UVec2::new(x, y);
            film.add(pixel, 0, Spectrum::rgb(x as f32 * 0.1, y as f32 * 0.3, 7.5e4));
            film.add(pixel, 1, Spectrum::rgb(x as f32 * 0.1, y as f32 * 0.3, 1e-5));
            film.add_alpha(pixel, x as f32 * 0.25);
            if x != 4 {
                let ids = Ids { inst: u32::MAX, geom: x, prim: y };
                let hit =
                    FirstHit { albedo: Spectrum::gray(0.5), normal: Vec3A::Y, depth: 2.0 + x as f32, ids };
                film.add_first_hit(pixel, 0, &hit);
            }
        }
    }
    film
}

#[test]
fn png_reads_back() {
    let folder = Folder::new("png");
    let path = folder.path().join("a.png");
    let film = film(Planes::default());
    for tone in [ToneMap::default(), ToneMap { exposure: -2.0, filmic: true }] {
        write_png(&path, &film, &tone).unwrap();
        let image = image::open(&path).unwrap().into_rgb8();
        assert_eq!(image.dimensions(), (SIZE.x, SIZE.y));
        for (x, y, pixel) in image.enumerate_pixels() {
            assert_eq!(pixel.0, tone.bytes(film.mean(UVec2::new(x, y))), "{x}, {y}");
        }
    }
    assert_eq!(folder.names(), ["a.png"]);
}

#[test]
fn pixels_become_a_png_as_they_are() {
    let folder = Folder::new("png-pixels");
    let path = folder.path().join("a.png");
    let pixels: Vec<[u8; 3]> = (0..15u8).map(|i| [i, 255 - i, 17 * i]).collect();
    write_png_pixels(&path, [5, 3], &pixels).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(bytes, png_bytes([5, 3], &pixels).unwrap());
    let image = image::load_from_memory(&bytes).unwrap();
    assert_eq!(image.color(), image::ColorType::Rgb8);
    let image = image.into_rgb8();
    assert_eq!(image.dimensions(), (5, 3));
    assert_eq!(image.pixels().map(|p| p.0).collect::<Vec<_>>(), pixels, "row by row from the top");
}

#[test]
fn pixels_that_do_not_fill_the_size_are_refused() {
    let folder = Folder::new("png-refused");
    let path = folder.path().join("a.png");
    let pixels = [[1, 2, 3]; 6];
    // 2¹⁶ · 2¹⁶ would be 0 in 32 bits.
    for size in [[2, 2], [3, 3], [0, 6], [u32::MAX, u32::MAX], [1 << 16, 1 << 16]] {
        assert_eq!(png_bytes(size, &pixels), Err(PngError::Pixels { size, given: 6 }));
        assert!(matches!(write_png_pixels(&path, size, &pixels), Err(WriteError::Encode { .. })));
    }
    assert!(matches!(png_bytes([0, 0], &[]), Err(PngError::Encode(_))));
    assert!(matches!(png_bytes([1 << 16, 1 << 16], &[]), Err(PngError::Pixels { .. })));
    let message = png_bytes([4, 2], &pixels).unwrap_err().to_string();
    assert_eq!(message, "6 pixels for a picture of 4x2");
    assert_eq!(folder.names(), [""; 0], "nothing is written");
}

fn channel(image: &exr::image::FlatImage, name: &str) -> Option<FlatSamples> {
    let channels = &image.layer_data[0].channel_data.list;
    channels.iter().find(|c| c.name.to_string() == name).map(|c| c.sample_data.clone())
}

fn floats(image: &exr::image::FlatImage, name: &str) -> Vec<f32> {
    match channel(image, name) {
        Some(FlatSamples::F32(v)) => v,
        other => panic!("{name}: {other:?}"),
    }
}

fn ints(image: &exr::image::FlatImage, name: &str) -> Vec<u32> {
    match channel(image, name) {
        Some(FlatSamples::U32(v)) => v,
        other => panic!("{name}: {other:?}"),
    }
}

fn read_exr(path: &std::path::Path) -> exr::image::FlatImage {
    read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_file(path)
        .unwrap()
}

#[test]
fn exr_reads_back_with_its_planes_and_notes() {
    let folder = Folder::new("exr");
    let path = folder.path().join("a.exr");
    let film = film(Planes::ALL);
    let info = ExrInfo {
        bias: vec!["max_depth=3".into(), "clamped".into()],
        notes: vec![
            ("seed".into(), "17".into()),
            ("sampler".into(), "sobol".into()),
            ("bias".into(), "none".into()),
        ],
        scene: Some(Digest { value: 0xabc, opaque: false }),
        settings: Some(Digest { value: 1, opaque: true }),
    };
    write_exr(&path, &film, &info).unwrap();
    let image = read_exr(&path);
    let pixels: Vec<UVec2> = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| UVec2::new(x, y))).collect();
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        let expected: Vec<f32> = pixels.iter().map(|&p| film.mean(p)[c]).collect();
        assert_eq!(floats(&image, name), expected, "the same bits, beyond 1 too");
    }
    assert_eq!(floats(&image, "A"), pixels.iter().map(|&p| film.alpha(p).unwrap()).collect::<Vec<_>>());
    assert_eq!(
        floats(&image, "albedo.G"),
        pixels.iter().map(|&p| film.albedo(p).unwrap().g()).collect::<Vec<_>>()
    );
    assert_eq!(
        floats(&image, "normal.Y"),
        pixels.iter().map(|&p| film.normal(p).unwrap().y).collect::<Vec<_>>()
    );
    let depth = floats(&image, "depth.Z");
    assert_eq!(depth, pixels.iter().map(|&p| film.depth(p).unwrap()).collect::<Vec<_>>());
    assert!(depth[4].is_infinite() && depth[3] == 5.0);
    // One beyond the id; 0 is nothing. No instance is u32::MAX and wraps to 0.
    assert_eq!(ints(&image, "id.geom")[..5], [1, 2, 3, 4, 0]);
    assert_eq!(ints(&image, "id.prim")[5..8], [2, 2, 2]);
    assert_eq!(ints(&image, "id.inst")[..2], [0, 0]);

    let layer = &image.layer_data[0];
    assert_eq!((layer.size.0, layer.size.1), (5, 3));
    let note = |name: &str| {
        let other = &layer.attributes.other;
        other.iter().find(|(k, _)| **k == *name).map(|(_, v)| match v {
            exr::prelude::AttributeValue::Text(t) => t.to_string(),
            other => format!("{other:?}"),
        })
    };
    assert_eq!(note("etendue.spp").as_deref(), Some("2"));
    assert_eq!(note("etendue.bias").as_deref(), Some("max_depth=3; clamped"));
    assert_eq!(note("etendue.scene").as_deref(), Some("00000000000000000000000000000abc"));
    assert!(note("etendue.settings").unwrap().contains("not all of it"));
    assert_eq!(note("etendue.note.seed").as_deref(), Some("17"));
    assert_eq!(note("etendue.note.sampler").as_deref(), Some("sobol"));
    assert_eq!(layer.attributes.software_name.as_ref().map(ToString::to_string).as_deref(), Some("etendue"));
}

#[test]
fn an_unbiased_picture_says_so_and_has_no_planes_it_was_not_given() {
    let folder = Folder::new("exr-plain");
    let path = folder.path().join("a.exr");
    write_exr(&path, &film(Planes::default()), &ExrInfo::default()).unwrap();
    let image = read_exr(&path);
    let names: Vec<String> =
        image.layer_data[0].channel_data.list.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "R"]);
    let other = &image.layer_data[0].attributes.other;
    assert!(
        other.iter().any(|(k, v)| *k == *"etendue.bias"
            && matches!(v, exr::prelude::AttributeValue::Text(t) if *t == *"none"))
    );
}

#[test]
fn an_empty_film_is_a_black_picture() {
    let folder = Folder::new("black");
    let film = Film::new(UVec2::new(2, 2), 1).unwrap();
    write_exr(&folder.path().join("a.exr"), &film, &ExrInfo::default()).unwrap();
    assert_eq!(floats(&read_exr(&folder.path().join("a.exr")), "R"), [0.0; 4]);
    write_png(&folder.path().join("a.png"), &film, &ToneMap::default()).unwrap();
    assert!(image::open(folder.path().join("a.png")).unwrap().into_rgb8().into_raw().iter().all(|&b| b == 0));
}

#[test]
fn the_same_film_gives_the_same_bytes() {
    let folder = Folder::new("bytes");
    let film = film(Planes::ALL);
    // Many notes, so that an order by chance would not be the same twice.
    let notes = (0..20).map(|i| (format!("note{i}"), i.to_string())).collect();
    let info = ExrInfo { notes, ..ExrInfo::default() };
    for name in ["a", "b"] {
        write_exr(&folder.path().join(format!("{name}.exr")), &film, &info).unwrap();
        write_png(&folder.path().join(format!("{name}.png")), &film, &ToneMap::default()).unwrap();
    }
    for end in ["exr", "png"] {
        let bytes = |n: &str| std::fs::read(folder.path().join(format!("{n}.{end}"))).unwrap();
        assert!(bytes("a") == bytes("b"), "{end}");
    }
}

#[test]
fn a_write_that_fails_leaves_what_was_there() {
    let folder = Folder::new("failing");
    let film = film(Planes::default());
    // A folder where the picture should go: the rename is refused.
    for name in ["a.png", "a.exr"] {
        folder.write(&format!("{name}/inner"), "kept");
    }
    let png = write_png(&folder.path().join("a.png"), &film, &ToneMap::default());
    let exr = write_exr(&folder.path().join("a.exr"), &film, &ExrInfo::default());
    for (result, name) in [(png, "a.png"), (exr, "a.exr")] {
        let e = result.expect_err("a folder is in the way");
        assert!(matches!(e, WriteError::Io { .. }) && e.to_string().contains(name), "{e}");
        assert_eq!(std::fs::read(folder.path().join(name).join("inner")).unwrap(), b"kept");
    }
    // A folder that is not there, and no name at all.
    for path in [folder.path().join("none/b.png"), "/".into(), "..".into(), "".into()] {
        assert!(write_png(&path, &film, &ToneMap::default()).is_err(), "{}", path.display());
    }
    assert_eq!(folder.names(), ["a.exr", "a.png"], "nothing half written is left");
}

/// The old picture survives where the folder cannot be written. Root may write anywhere, so the check is of what
/// the system allows.
#[cfg(unix)]
#[test]
fn a_read_only_folder_keeps_the_old_picture() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("read-only");
    let path = folder.write("a.png", "old");
    let set = |mode| std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(mode)).unwrap();
    set(0o555);
    let may_write = std::fs::File::create(folder.path().join("probe")).is_ok();
    let result = write_png(&path, &film(Planes::default()), &ToneMap::default());
    set(0o755);
    if may_write {
        assert!(result.is_ok());
    } else {
        assert!(result.is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
    }
}
