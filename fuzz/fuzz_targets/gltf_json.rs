#![no_main]
//! glTF as text.

use etendue_fuzz::check_gltf;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    check_gltf(bytes);
});
