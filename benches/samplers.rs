//! What one random number costs: `cargo bench --bench samplers`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{
    BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime,
};
use etendue::prelude::*;

const SPP: u32 = 64;

/// Pixels and samples as a render visits them.
fn points() -> impl Iterator<Item = (u64, u64)> {
    (0..16u64).flat_map(|stream| (0..u64::from(SPP)).map(move |index| (stream, index)))
}

fn kind<S: Sampler>(group: &mut BenchmarkGroup<'_, WallTime>, name: &str, sampler: S) {
    group.throughput(Throughput::Elements(points().count() as u64));
    group.bench_function(format!("{name}/film pair"), |b| {
        b.iter(|| {
            for (stream, index) in points() {
                black_box(sampler.start(stream, index).get_2d(Dim::FILM));
            }
        });
    });
    // The first vertex belongs to the joint point set, the fourth has dimensions of its own.
    for depth in [0, 3] {
        group.bench_function(format!("{name}/bounce {depth}"), |b| {
            b.iter(|| {
                for (stream, index) in points() {
                    black_box(sampler.start(stream, index).bounce(depth));
                }
            });
        });
    }
}

fn samplers(c: &mut Criterion) {
    let mut group = c.benchmark_group("samplers");
    kind(&mut group, "independent", Independent::new(1, SPP));
    kind(&mut group, "stratified", Stratified::new(1, SPP));
    kind(&mut group, "sobol", Sobol::new(1, SPP));
    kind(&mut group, "sobol, 8 replicates", Sobol::new(1, SPP).with_replicates(8));
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    targets = samplers
}
criterion_main!(benches);
