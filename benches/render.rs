//! Whole pictures on the current rayon pool: `cargo bench --bench render`.

use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use etendue::geometry::presets as meshes;
use etendue::prelude::*;
use etendue::scene::presets::{Preset, cornell_box, empty_cornell_box};

const SIZE: UVec2 = UVec2::new(64, 64);
const SPP: u32 = 4;

/// The empty box with `n` small lamps in its air instead of nothing; all lamps together shine alike.
fn many_lights(n: u32) -> Preset {
    let mut p = empty_cornell_box();
    let b = &mut p.builder;
    let m = b.material(Diffuse::new(Spectrum::gray(0.5)));
    let sampler = Independent::new(7, n);
    for i in 0..n {
        let u = sampler.start(0, u64::from(i));
        let (xy, z) = (u.get_2d(Dim::FILM), u.get_1d(Dim::TIME));
        let at = Vec3A::new(0.8 * xy.x - 0.4, 0.1 + 0.8 * xy.y, 0.8 * z - 0.4);
        let lamp = b.add(meshes::cuboid(at, at + Vec3A::splat(0.01)), m);
        b.emit(lamp, Emission::new(Spectrum::gray(1000.0 / n as f32)));
    }
    p
}

fn renders(c: &mut Criterion) {
    let mut group = c.benchmark_group("render 64x64, 4 spp");
    group.throughput(Throughput::Elements(u64::from(SIZE.x * SIZE.y * SPP)));
    let nothing = Preset { builder: SceneBuilder::new(), ..cornell_box() };
    let presets = [
        ("cornell box", cornell_box()),
        ("empty scene", nothing),
        ("one light", empty_cornell_box()),
        ("10 lamps more", many_lights(10)),
        ("1000 lamps more", many_lights(1000)),
    ];
    for (name, p) in presets {
        let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, SIZE);
        let (Ok(scene), Ok(camera), Ok(empty)) = (p.builder.build(), camera, Film::new(SIZE, 1)) else {
            eprintln!("{name} could not be built");
            continue;
        };
        group.bench_function(name, |b| {
            b.iter(|| {
                let mut film = empty.clone();
                let options = RenderOptions::default();
                render(&scene, &camera, &PathTracer::default(), Sobol::new(1, SPP), &mut film, &options)
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
    targets = renders
}
criterion_main!(benches);
