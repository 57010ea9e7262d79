#![no_main]
//! Valid documents whose values are damaged one by one: the bytes choose the document and the damage.

use etendue_fuzz::{check_gltf, damaged_document};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    check_gltf(&damaged_document(bytes));
});
