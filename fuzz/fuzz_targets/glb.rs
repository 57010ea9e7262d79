#![no_main]
//! The binary container: its magic and version are always right, so that the chunks are reached.

use etendue_fuzz::check_gltf;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let all = [b"glTF\x02\0\0\0", bytes].concat();
    check_gltf(&all);
    // Once more with the length that is true, which a fuzzer does not keep right by itself.
    if let Some(rest) = bytes.get(4..) {
        let length = (all.len() as u32).to_le_bytes();
        check_gltf(&[&all[..8], &length, rest].concat());
    }
});
