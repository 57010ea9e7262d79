#![no_main]
//! PLY in text and bytes.

use etendue_fuzz::{check, limits};
use etendue_scene::SceneBuilder;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut b = SceneBuilder::new();
    let result = etendue_io::ply::read("fuzzed.ply", bytes, &limits(), &mut b);
    check("fuzzed.ply", result, b);
});
