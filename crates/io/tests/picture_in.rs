//! Pictures read: what this crate writes, what others write, and what nobody should.
#![cfg(all(feature = "png", feature = "exr", feature = "hdr", feature = "obj"))]

mod common;

use std::io::Cursor;

use common::Folder;
use etendue_camera::{Film, Planes};
use etendue_core::{Spectrum, UVec2, math};
use etendue_io::{
    ExrInfo, ImageBudget, Limits, PictureError, ToneMap, decode_texture, read_picture, read_picture_bytes,
    write_exr, write_hdr, write_png,
};
use etendue_texture::{Encoding, Texture};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding as ExrEncoding, FlatSamples, Image, Layer,
    LayerAttributes, LineOrder, SpecificChannels, Vec2, WritableImage, f16,
};
use proptest::prelude::*;

fn film(width: u32, height: u32, planes: Planes) -> Film {
    let mut film = Film::with_planes(UVec2::new(width, height), 1, planes).unwrap();
    for y in 0..height {
        for x in 0..width {
            let v = math::sin_cos((x * 31 + y * 17) as f32).0.abs();
            film.add(UVec2::new(x, y), 0, Spectrum::rgb(v * 3.0, 0.25, if x > 3 { 1e-4 } else { 700.0 * v }));
        }
    }
    film
}

#[test]
fn exr_comes_back_bit_for_bit() {
    let folder = Folder::new("exr-in");
    let path = folder.path().join("a.exr");
    let film = film(37, 50, Planes::ALL);
    let info = ExrInfo { notes: vec![("seed".into(), "17".into())], ..ExrInfo::default() };
    write_exr(&path, &film, &info).unwrap();
    let picture = read_picture(&path, &Limits::default()).unwrap();
    assert_eq!((picture.width, picture.height), (37, 50));
    assert_eq!(picture.rgb, film.to_rgb());
    for layer in ["R", "albedo.G", "normal.Z", "depth.Z", "id.geom", "A"] {
        assert!(picture.layers.iter().any(|l| l == layer), "{layer}: {:?}", picture.layers);
    }
    let seed = picture.metadata.iter().find(|(k, _)| k == "etendue.note.seed").map(|(_, v)| v.as_str());
    assert_eq!(seed, Some("17"));
}

#[test]
fn hdr_comes_back_to_its_precision_whatever_the_width() {
    let folder = Folder::new("hdr-in");
    for width in [1, 7, 8, 9, 200, 1000] {
        let path = folder.path().join("a.hdr");
        let film = film(width, 3, Planes::default());
        write_hdr(&path, &film, &[("seed".into(), "1\nFORMAT=x".into())]).unwrap();
        let picture = read_picture(&path, &Limits::default()).unwrap();
        for (a, b) in picture.rgb.iter().zip(film.to_rgb()) {
            let largest = b.iter().fold(0.0f32, |m, v| m.max(*v));
            for (a, b) in a.iter().zip(b) {
                assert!((a - b).abs() <= largest / 256.0, "{a} {b}");
            }
        }
        // Another decoder sees the same.
        let other = image::open(&path).unwrap().into_rgb32f();
        let rgb: Vec<[f32; 3]> = other.pixels().map(|p| p.0).collect();
        assert_eq!(rgb, picture.rgb, "{width}");
    }
}

#[test]
fn png_comes_back_through_the_curve() {
    let folder = Folder::new("png-in");
    let path = folder.path().join("a.png");
    let film = film(20, 10, Planes::default());
    write_png(&path, &film, &ToneMap::default()).unwrap();
    let picture = read_picture(&path, &Limits::default()).unwrap();
    for (a, b) in picture.rgb.iter().zip(film.to_rgb()) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b.min(1.0)).abs() < 0.006, "{a} {b}");
        }
    }
    let again = film_of(&picture.rgb, 20, 10);
    write_png(&path, &again, &ToneMap::default()).unwrap();
    assert_eq!(read_picture(&path, &Limits::default()).unwrap(), picture);
}

fn film_of(rgb: &[[f32; 3]], width: u32, height: u32) -> Film {
    let mut film = Film::new(UVec2::new(width, height), 1).unwrap();
    for (i, c) in rgb.iter().enumerate() {
        film.add(UVec2::new(i as u32 % width, i as u32 / width), 0, Spectrum::from(*c));
    }
    film
}

fn encoded(image: image::DynamicImage, format: image::ImageFormat) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, format).unwrap();
    out.into_inner()
}

fn texture(bytes: &[u8], encoding: Encoding) -> Result<etendue_texture::ImageTexture, PictureError> {
    decode_texture(bytes, encoding, &mut ImageBudget::new(&Limits::default()))
}

#[test]
fn textures_keep_their_width_and_channels() {
    use image::DynamicImage as D;
    let png = image::ImageFormat::Png;
    for (image, channels, bytes) in [
        (D::new_luma8(9, 4), 1, 36),
        (D::new_luma_a8(9, 4), 2, 72),
        (D::new_rgb8(9, 4), 3, 108),
        (D::new_rgba8(9, 4), 4, 144),
        (D::new_luma16(9, 4), 1, 144),
        (D::new_rgba16(9, 4), 4, 576),
    ] {
        let file = encoded(image, png);
        let mut budget = ImageBudget::new(&Limits::default());
        let t = decode_texture(&file, Encoding::Srgb, &mut budget).unwrap();
        assert_eq!((t.width(), t.height(), t.channels()), (9, 4, channels));
        assert_eq!(budget.left(), Limits::default().all_image_bytes - bytes);
        assert!(t.bytes() as u64 >= bytes);
    }
    let jpeg = encoded(D::new_rgb8(9, 4), image::ImageFormat::Jpeg);
    assert_eq!(texture(&jpeg, Encoding::Srgb).unwrap().channels(), 3);
}

#[test]
fn sixteen_bits_follow_the_curve_and_alpha_does_not() {
    let pixel = image::Rgba([32768u16, 65535, 0, 32768]);
    let file = encoded(image::ImageBuffer::from_pixel(1, 1, pixel).into(), image::ImageFormat::Png);
    let half = 32768.0 / 65535.0;
    let t = texture(&file, Encoding::Srgb).unwrap().texel(0, 0);
    // ((0.50000763 + 0.055) / 1.055)^2.4.
    assert!((t.x - 0.214_047_6).abs() < 1e-6 && t.y == 1.0 && t.z == 0.0, "{t}");
    assert_eq!(t.w, half);
    assert_eq!(texture(&file, Encoding::Linear).unwrap().texel(0, 0).x, half);
}

/// Channels as another program would write them.
fn exr(
    compression: Compression,
    blocks: Blocks,
    list: Vec<(&str, FlatSamples)>,
    w: usize,
    h: usize,
) -> Vec<u8> {
    let channels = list.into_iter().map(|(n, s)| AnyChannel::new(n, s)).collect();
    let encoding = ExrEncoding { compression, blocks, line_order: LineOrder::Increasing };
    let mut attributes = LayerAttributes::named("other");
    attributes.layer_position = Vec2(-3, 12);
    let layer = Layer::new((w, h), attributes, encoding, AnyChannels::sort(channels));
    let mut out = Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut out).unwrap();
    out.into_inner()
}

#[test]
fn exr_of_others_is_read_in_every_lossless_way() {
    let (w, h) = (45, 70);
    let value = |i: usize| ((i * 7919) % 1000) as f32 / 8.0;
    let float: Vec<f32> = (0..w * h).map(value).collect();
    let half = || FlatSamples::F16(float.iter().map(|v| f16::from_f32(*v)).collect());
    let uint = || FlatSamples::U32(float.iter().map(|v| *v as u32).collect());
    for compression in
        [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ]
    {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(32, 16)), Blocks::Tiles(Vec2(100, 100))] {
            for prefix in ["", "RGB.", "a.b."] {
                let name = |c: &str| format!("{prefix}{c}");
                let (r, g, b) = (name("R"), name("G"), name("B"));
                let list = vec![
                    (r.as_str(), FlatSamples::F32(float.clone())),
                    (g.as_str(), half()),
                    (b.as_str(), uint()),
                    ("depth.Z", half()),
                ];
                let bytes = exr(compression, blocks, list, w, h);
                let picture = read_picture_bytes(&bytes, &Limits::default()).unwrap();
                for (c, v) in picture.rgb.iter().zip(&float) {
                    assert_eq!(*c, [*v, f16::from_f32(*v).to_f32(), v.floor()], "{compression} {blocks:?}");
                }
            }
        }
    }
    let gray = exr(Compression::ZIP16, Blocks::ScanLines, vec![("Y", half())], w, h);
    assert_eq!(read_picture_bytes(&gray, &Limits::default()).unwrap().rgb[1], [value(1); 3]);
    let none = exr(Compression::ZIP16, Blocks::ScanLines, vec![("Q", half()), ("R", half())], w, h);
    let e = read_picture_bytes(&none, &Limits::default()).unwrap_err();
    assert!(matches!(e, PictureError::NoColour { .. }) && e.to_string().contains("Q, R"), "{e}");
}

fn small_exr() -> Vec<u8> {
    let image = Image::from_channels(
        (20, 40),
        SpecificChannels::rgb(|p: Vec2<usize>| (p.x() as f32, p.y() as f32, 0.5f32)),
    );
    let mut out = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut out).unwrap();
    out.into_inner()
}

#[test]
fn cut_exr_is_refused() {
    let bytes = small_exr();
    for n in 0..bytes.len() {
        assert!(read_picture_bytes(&bytes[..n], &Limits::default()).is_err(), "{n} bytes were enough");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, rng_seed: proptest::test_runner::RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default() })]

    /// Damage gives a picture or an error, nothing else.
    #[test]
    fn damaged_pictures_do_no_harm(kind in 0usize..4, flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        thread_local!(static FILES: [Vec<u8>; 4] = [
            small_exr(),
            exr(Compression::PIZ, Blocks::Tiles(Vec2(16, 16)), vec![("Y", FlatSamples::F32(vec![0.5; 900]))], 30, 30),
            {
                let folder = Folder::new("damaged");
                write_hdr(&folder.path().join("a.hdr"), &film(20, 4, Planes::default()), &[]).unwrap();
                std::fs::read(folder.path().join("a.hdr")).unwrap()
            },
            encoded(image::DynamicImage::new_rgb8(20, 20), image::ImageFormat::Png),
        ]);
        let mut bytes = FILES.with(|f| f[kind].clone());
        for (at, flip) in flips {
            let at = at.index(bytes.len());
            bytes[at] ^= flip;
        }
        let small = Limits { image_bytes: 1 << 24, ..Limits::default() };
        let _ = read_picture_bytes(&bytes, &small);
        let _ = decode_texture(&bytes, Encoding::Srgb, &mut ImageBudget::new(&small));
    }
}

#[test]
fn limits_are_kept_before_anything_is_allocated() {
    let file = encoded(image::DynamicImage::new_rgb8(100, 50), image::ImageFormat::Png);
    let with = |change: &dyn Fn(&mut Limits)| {
        let mut limits = Limits::default();
        change(&mut limits);
        decode_texture(&file, Encoding::Srgb, &mut ImageBudget::new(&limits)).unwrap_err()
    };
    assert!(matches!(with(&|l| l.image_side = 99), PictureError::Side { width: 100, limit: 99, .. }));
    assert!(matches!(with(&|l| l.image_bytes = 14_999), PictureError::Bytes { bytes: 15_000, .. }));
    assert!(matches!(
        with(&|l| l.all_image_bytes = 14_999),
        PictureError::All { bytes: 15_000, left: 14_999 }
    ));
    let mut budget = ImageBudget::new(&Limits { all_image_bytes: 20_000, ..Limits::default() });
    assert!(decode_texture(&file, Encoding::Srgb, &mut budget).is_ok());
    assert_eq!(budget.left(), 5_000);
    assert!(decode_texture(&file, Encoding::Srgb, &mut budget).is_err());
    assert_eq!(budget.left(), 5_000);

    let big = encoded(image::DynamicImage::new_luma8(8192, 4096), image::ImageFormat::Png);
    let strict = Limits { image_ratio: 100, ..Limits::default() };
    let e = decode_texture(&big, Encoding::Srgb, &mut ImageBudget::new(&strict)).unwrap_err();
    assert!(matches!(e, PictureError::Ratio { .. }), "{e}");

    // A row of one colour: the largest honest ratio of HDR.
    let hdr = b"#?RADIANCE\n\n-Y 30000 +X 30000\n\x02\x02\x75\x30".to_vec();
    let e = read_picture_bytes(&hdr, &Limits { image_bytes: u64::MAX, ..Limits::default() }).unwrap_err();
    assert!(matches!(e, PictureError::Ratio { .. }), "{e}");
    for (bytes, says) in [
        (&b"RIFF\0\0\0\0WEBPVP8 "[..], "WebP"),
        (b"version https://git-lfs.github.com/spec/v1", "LFS"),
        (b"", "empty"),
        (b"nothing", "no known picture"),
    ] {
        let e = read_picture_bytes(bytes, &Limits::default()).unwrap_err();
        assert!(e.to_string().contains(says), "{e}");
    }
}

#[test]
fn hdr_by_hand() {
    let read = |text: &[u8]| read_picture_bytes(text, &Limits::default());
    // Old run-length encoding: a pixel, then twice the same, then counts to the base 256.
    let old =
        read(b"#?RGBE\nEXPOSURE=2\n\n-Y 1 +X 4\n\x80\x40\x20\x82\x01\x01\x01\x02\x80\x80\x80\x81").unwrap();
    assert_eq!(old.rgb, [[1.0, 0.5, 0.25], [1.0, 0.5, 0.25], [1.0, 0.5, 0.25], [0.5; 3]]);
    let upside_down = read(b"#?RADIANCE\n\n+Y 2 -X 1\n\x80\x80\x80\x81\x80\x80\x80\x82").unwrap();
    assert_eq!(upside_down.rgb, [[2.0; 3], [1.0; 3]]);
    for bad in [
        &b"#?RADIANCE\n\n-Y 1 +X 4\n\x01\x01\x01\x02"[..],
        b"#?RADIANCE\n\n-Y 1 +X 2\n\x80\x80\x80\x80\x01\x01\x01\x02",
        b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n\x80\x80\x80\x80",
        b"#?RADIANCE\n\n+X 1 -Y 1\n\x80\x80\x80\x80",
        b"#?RADIANCE\n\n-Y 1 +X 9\n\x02\x02\x00\x08",
        b"#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n\x80\x80\x80\x80",
        b"#?RADIANCE\n\n-Y 0 +X 1\n",
        b"#?RADIANCE\n",
    ] {
        assert!(read(bad).is_err(), "{}", String::from_utf8_lossy(bad));
    }
}
