//! glTF, part by part: one small document each, with what it must become.

mod accessors;
mod doc;
mod features;
mod graph;
mod lights;
mod materials;

use doc::Doc;
use etendue::io::gltf::GltfError;
use etendue::io::{LoadOptions, Loaded, NoFiles, gltf};
use etendue::prelude::*;

/// A document as a scene, with whatever was said of it.
struct Read {
    scene: Scene,
    loaded: Loaded,
}

fn try_read(doc: &Doc, options: &LoadOptions<'_>) -> Result<Read, GltfError> {
    let mut b = SceneBuilder::new();
    let loaded = gltf::read("test.gltf", &doc.gltf(), &NoFiles, options, &mut b)?;
    Ok(Read { scene: b.build().expect("a scene"), loaded })
}

#[track_caller]
fn read(doc: &Doc) -> Read {
    let read = try_read(doc, &LoadOptions::default()).expect("a valid document");
    assert_eq!(read.loaded.report.warnings, Vec::<String>::new());
    read
}

impl Read {
    /// The surface that a ray from `o` along `d` meets.
    fn see(&self, o: Vec3A, d: Vec3A) -> Option<Surface> {
        let ray = Ray::new(o, etendue::core::vector::normalize(d));
        let hit = self.scene.intersect(&ray, 0)?;
        Some(self.scene.surface(&ray, &hit, 0.0))
    }

    /// The surface at (x, y), seen from +z.
    #[track_caller]
    fn at(&self, x: f32, y: f32) -> Surface {
        self.see(Vec3A::new(x, y, 10.0), Vec3A::NEG_Z).expect("something is there")
    }

    /// Albedo of the surface at (x, y), seen from straight above it.
    #[track_caller]
    fn albedo(&self, x: f32, y: f32) -> Spectrum {
        let s = self.at(x, y);
        self.scene.material(&s).expect("material").bsdf(&s).albedo(Vec3A::Z)
    }
}

#[track_caller]
fn close(a: Spectrum, b: [f32; 3], tolerance: f32) {
    for (a, b) in a.to_array().into_iter().zip(b) {
        assert!((a - b).abs() <= tolerance, "{a} against {b}");
    }
}
