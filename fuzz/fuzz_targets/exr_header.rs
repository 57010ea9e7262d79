#![no_main]
//! OpenEXR behind its first four bytes: attributes, parts, tables of offsets, blocks.

use etendue_fuzz::limits;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let all = [&[0x76, 0x2f, 0x31, 0x01], bytes].concat();
    if let Ok(picture) = etendue_io::read_picture_bytes(&all, &limits()) {
        assert_eq!(picture.rgb.len() as u64, u64::from(picture.width) * u64::from(picture.height));
    }
});
