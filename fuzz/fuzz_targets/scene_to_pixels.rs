#![no_main]
//! From a damaged document to a picture: what loads must not only build but be traced, with finite light in every pixel.

use etendue_camera::{Camera, Film};
use etendue_core::UVec2;
use etendue_fuzz::{damaged_document, limits};
use etendue_integrator::{PathTracer, RenderOptions, render};
use etendue_io::{Limits, LoadOptions, NoFiles, fallback};
use etendue_sampling::Sobol;
use etendue_scene::SceneBuilder;
use libfuzzer_sys::fuzz_target;

/// More than this is left to the readers' own targets: a picture must take milliseconds.
const TRIANGLES: u64 = 4096;
const SIZE: UVec2 = UVec2::splat(8);

fuzz_target!(|bytes: &[u8]| {
    let file = damaged_document(bytes);
    let limits = Limits { vertices: 1 << 17, instances: 1 << 8, ..limits() };
    let options = LoadOptions { limits, lenient: bytes.len() % 2 == 0, ..LoadOptions::default() };
    let mut b = SceneBuilder::new();
    let Ok(loaded) = etendue_io::gltf::read("fuzzed.gltf", &file, &NoFiles, &options, &mut b) else { return };
    if loaded.report.triangles > TRIANGLES {
        return;
    }
    if b.has_no_light() {
        fallback::light(&mut b);
    }
    // A camera of the file may be out of range, and the bounds may be too large for one that sees everything.
    let own = loaded.cameras.first().and_then(|c| c.at_size(SIZE).ok());
    let camera = match own {
        Some(camera) => camera,
        None => match fallback::camera(&b.bounds(), SIZE) {
            Ok(camera) => Box::new(camera) as Box<dyn Camera>,
            Err(_) => return,
        },
    };
    let scene = b.build().expect("what loads builds");
    let mut film = Film::new(SIZE, 1).expect("a small film");
    let done = render(&scene, &*camera, &PathTracer::default(), Sobol::new(1, 1), &mut film, &RenderOptions::default());
    assert_eq!(done.expect("a render").samples, 64);
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let light = film.mean(UVec2::new(x, y));
            assert!(light.to_array().iter().all(|c| c.is_finite() && *c >= 0.0), "{light:?} at ({x}, {y})");
        }
    }
});
