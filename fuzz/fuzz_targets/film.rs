#![no_main]
//! Films. Their checksums stop almost all damage, so a corpus of valid films is needed to come far.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match etendue_io::read_film_bytes("fuzzed.film", bytes) {
        // One film has one form.
        Ok(film) => assert_eq!(etendue_io::film_bytes(&film), bytes),
        Err(e) => assert!(e.to_string().contains("fuzzed.film"), "the error does not name the file: {e}"),
    }
});
