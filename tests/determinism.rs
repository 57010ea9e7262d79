//! The film is a function of its inputs: not of threads, tiles, order of work or division of the samples.

mod support;

use etendue::prelude::*;
use support::{cornell, film_of};

fn options() -> RenderOptions<'static> {
    RenderOptions::default()
}

#[test]
fn threads_and_tiles_do_not_matter() {
    let (scene, camera) = cornell(40);
    let sampler = Sobol::new(5, 8);
    let expected = film_of(&scene, &camera, sampler, &options());
    for threads in [1, 2, 3, 7] {
        for tile in [8, 13, 16, 64] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let film =
                pool.install(|| film_of(&scene, &camera, sampler, &RenderOptions { tile, ..options() }));
            assert_eq!(film.digest(), expected.digest(), "{threads} threads, tiles of {tile}");
            assert!(film == expected);
        }
    }
}

#[test]
fn ranges_merge_to_the_whole() {
    let (scene, camera) = cornell(24);
    let sampler = Sobol::new(5, 16).with_replicates(4);
    let whole = film_of(&scene, &camera, sampler, &options());
    let mut merged = Film::new(camera.resolution(), 4).unwrap();
    // In any order, of any length.
    for samples in [9..16, 0..1, 4..9, 1..4] {
        let part = film_of(&scene, &camera, sampler, &RenderOptions { samples: Some(samples), ..options() });
        merged.merge(&part).unwrap();
    }
    assert!(merged == whole);
}

#[test]
fn one_sample_replayed_alone_is_its_contribution() {
    let (scene, camera) = cornell(16);
    let sampler = Sobol::new(9, 4);
    let path = PathTracer::default();
    for (pixel, index) in [(UVec2::new(3, 4), 0), (UVec2::new(8, 8), 3), (UVec2::new(12, 11), 2)] {
        let samples = Some(index..index + 1);
        let film = film_of(&scene, &camera, sampler, &RenderOptions { samples, ..options() });
        let alone = replay(&scene, &camera, &path, sampler, &options(), pixel, index, &mut ());
        assert_eq!(alone.contribution, film.mean(pixel), "{pixel}, {index}");
    }
}

/// A stopped render is valid, and going on gives the bits of one that was never stopped.
#[test]
fn a_cancelled_film_holds_whole_samples() {
    struct After(std::sync::atomic::AtomicU64, u64);
    impl Progress for After {
        fn update(&self, done: u64, _total: u64) {
            self.0.store(done, std::sync::atomic::Ordering::Relaxed);
        }
        fn cancelled(&self) -> bool {
            self.0.load(std::sync::atomic::Ordering::Relaxed) >= self.1
        }
    }
    let (scene, camera) = cornell(32);
    let sampler = Sobol::new(5, 16);
    let total = 32 * 32 * 16;
    for stop_at in [0, 1, total / 2, total - 1, total] {
        let progress = After(Default::default(), stop_at);
        let mut film = Film::new(camera.resolution(), 1).unwrap();
        let o = RenderOptions { progress: &progress, ..options() };
        let report = render(&scene, &camera, &PathTracer::default(), sampler, &mut film, &o).unwrap();
        assert_eq!(report.samples, film.total_samples());
        assert_eq!(report.ended == etendue::integrator::Ended::Complete, film.total_samples() == total);
        for p in [UVec2::ZERO, UVec2::new(16, 20)] {
            let n = film.samples(p);
            let same = film_of(&scene, &camera, sampler, &RenderOptions { samples: Some(0..n), ..options() });
            assert_eq!(film.mean(p), same.mean(p), "stopped at {stop_at}, pixel {p} with {n} samples");
        }
    }
}

#[test]
fn auxiliary_planes_do_not_change_the_picture() {
    let (scene, camera) = cornell(16);
    let sampler = Stratified::new(2, 4);
    let plain = film_of(&scene, &camera, sampler, &options());
    let mut film = Film::with_planes(camera.resolution(), 1, Planes::ALL).unwrap();
    render(&scene, &camera, &PathTracer::default(), sampler, &mut film, &options()).unwrap();
    assert_eq!(film.to_rgb(), plain.to_rgb());
    let middle = UVec2::splat(8);
    assert!(film.depth(middle).unwrap() > 1.0 && film.ids(middle).is_some());
    assert_eq!(film.alpha(middle), Some(1.0));
    assert_eq!(plain.depth(middle), None, "what is not asked for is not there");
}

/// Time runs by itself: one second per look.
#[derive(Default)]
struct Ticking(std::sync::atomic::AtomicU64);

impl etendue::core::Clock for Ticking {
    fn seconds(&self) -> f64 {
        self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed) as f64
    }
}

#[test]
fn a_time_budget_ends_at_a_whole_pass() {
    let (scene, camera) = cornell(16);
    let sampler = Sobol::new(5, 1024);
    let clock = Ticking::default();
    let mut film = Film::new(camera.resolution(), 1).unwrap();
    let o = RenderOptions { clock: Some(&clock), seconds: Some(3.5), ..options() };
    let report = render(&scene, &camera, &PathTracer::default(), sampler, &mut film, &o).unwrap();
    // Passes of 1, 2, 4 and 4 samples end at 1, 2, 3 and 4 seconds.
    assert_eq!((report.complete.clone(), report.ended), (0..11, etendue::integrator::Ended::Time));
    let same =
        film_of(&scene, &camera, sampler, &RenderOptions { samples: Some(report.complete), ..options() });
    assert!(film == same);
    let o = RenderOptions { seconds: Some(1.0), ..options() };
    let error = render(&scene, &camera, &PathTracer::default(), sampler, &mut film, &o).unwrap_err();
    assert!(error.to_string().contains("clock"), "{error}");
}
