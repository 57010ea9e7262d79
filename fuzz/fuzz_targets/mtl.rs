#![no_main]
//! MTL text through an OBJ file that uses every material it names.

use etendue_fuzz::{Always, check, limits};
use etendue_scene::SceneBuilder;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut obj = String::from("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n");
    for line in String::from_utf8_lossy(bytes).lines().take(100) {
        if let Some(name) = line.trim().strip_prefix("newmtl ") {
            obj.push_str(&format!("usemtl {name}\nf 1/1 2/1 3/1\n"));
        }
    }
    obj.push_str("usemtl none\nf 1 2 3\n");
    let mut b = SceneBuilder::new();
    let result = etendue_io::obj::read("fuzzed.obj", obj.as_bytes(), &Always(bytes), &limits(), &mut b);
    check("fuzzed.obj", result, b);
});
