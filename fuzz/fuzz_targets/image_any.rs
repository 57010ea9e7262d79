#![no_main]
//! Any picture, as the texture of a material.

use etendue_fuzz::{check, limits};
use etendue_io::{ResolveError, Resolver};
use etendue_scene::SceneBuilder;
use libfuzzer_sys::fuzz_target;

struct Textured<'a>(&'a [u8]);

impl Resolver for Textured<'_> {
    fn read(&self, name: &str, _limit: u64) -> Result<Vec<u8>, ResolveError> {
        Ok(match name {
            "a.mtl" => b"newmtl a\nmap_Kd a.png\nmap_d a.png\n".to_vec(),
            _ => self.0.to_vec(),
        })
    }
}

fuzz_target!(|bytes: &[u8]| {
    let obj = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    let mut b = SceneBuilder::new();
    let result = etendue_io::obj::read("fuzzed.obj", obj, &Textured(bytes), &limits(), &mut b);
    check("fuzzed.obj", result, b);
});
