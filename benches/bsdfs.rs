//! What one BSDF call costs, by model: `cargo bench --bench bsdfs`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use etendue::bsdf::{Conductor, Lambert, Meaning, Mirror, Principled, RoughDielectric, SmoothDielectric};
use etendue::prelude::*;
use etendue::sampling::warp;

const CALLS: usize = 1024;

struct Call {
    wo: Vec3A,
    wi: Vec3A,
    u: Vec2,
    u_lobe: f32,
}

/// Directions all over the upper hemisphere, and below it for what transmits.
fn calls() -> Vec<Call> {
    let sampler = Independent::new(1, 1);
    (0..CALLS as u64)
        .map(|i| {
            let u = sampler.start(0, i);
            Call {
                wo: warp::hemisphere(u.get_2d(Dim::FILM)),
                wi: warp::sphere(u.get_2d(Dim::LENS)),
                u: u.get_2d(Dim::bounce(0, Slot::Bsdf)),
                u_lobe: u.get_1d(Dim::bounce(0, Slot::Lobe)),
            }
        })
        .collect()
}

fn bsdfs(c: &mut Criterion) {
    let calls = calls();
    let color = Spectrum::rgb(0.8, 0.5, 0.2);
    let plastic = Principled::new(color, 0.0, 0.4);
    let metal = Principled::new(color, 1.0, 0.4);
    let gltf = Meaning::GltfB;
    let models: [(&str, BsdfAt<'_>); 11] = [
        ("lambert", BsdfAt::Lambert(Lambert::new(Spectrum::gray(0.7)))),
        ("mirror", BsdfAt::Mirror(Mirror::new(Spectrum::gray(0.7)))),
        ("gold 0.3", BsdfAt::Conductor(Conductor::gold(0.3))),
        ("smooth gold", BsdfAt::Conductor(Conductor::gold(0.0))),
        ("smooth dielectric", BsdfAt::SmoothDielectric(SmoothDielectric::new(1.5))),
        ("rough dielectric 0.3", BsdfAt::RoughDielectric(RoughDielectric::new(0.3, 1.5))),
        ("principled plastic", BsdfAt::Principled(plastic)),
        ("principled metal", BsdfAt::Principled(metal)),
        ("principled half glass", BsdfAt::Principled(Principled { transmission: 0.5, ..plastic })),
        ("gltf plastic", BsdfAt::Principled(Principled { meaning: gltf, ..plastic })),
        ("gltf metal", BsdfAt::Principled(Principled { meaning: gltf, ..metal })),
    ];
    let mut group = c.benchmark_group("bsdfs");
    group.throughput(Throughput::Elements(CALLS as u64));
    for (name, bsdf) in &models {
        group.bench_function(format!("{name}/sample"), |b| {
            b.iter(|| {
                for c in &calls {
                    black_box(bsdf.sample(c.wo, c.u_lobe, c.u, Mode::Radiance));
                }
            });
        });
        group.bench_function(format!("{name}/eval_pdf"), |b| {
            b.iter(|| {
                for c in &calls {
                    black_box(bsdf.eval_pdf(c.wo, c.wi, Mode::Radiance));
                }
            });
        });
        group.bench_function(format!("{name}/scatter"), |b| {
            b.iter(|| {
                for c in &calls {
                    black_box(bsdf.scatter(c.wo, Some(c.wi), c.u_lobe, c.u, Mode::Radiance));
                }
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    targets = bsdfs
}
criterion_main!(benches);
