#![no_main]
//! Photometry: a lamp that shines as much as its table says, or an error.

use etendue_core::{Spectrum, Transform};
use etendue_fuzz::limits;
use etendue_scene::SceneBuilder;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match etendue_io::ies::read("fuzzed.ies", bytes, &limits()) {
        Ok(lamp) => {
            assert!(lamp.lumens() >= 0.0 && lamp.lumens().is_finite());
            let mut b = SceneBuilder::new();
            b.light(lamp.light(&Transform::IDENTITY, Spectrum::ONE));
            b.build().expect("a scene of one lamp");
        }
        Err(e) => assert!(e.to_string().contains("fuzzed.ies"), "{e}"),
    }
});
