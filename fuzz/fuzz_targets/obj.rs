#![no_main]
//! OBJ text, with the same bytes as its material file.

use etendue_fuzz::{Always, check, limits};
use etendue_scene::SceneBuilder;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut b = SceneBuilder::new();
    let result = etendue_io::obj::read("fuzzed.obj", bytes, &Always(bytes), &limits(), &mut b);
    check("fuzzed.obj", result, b);
});
