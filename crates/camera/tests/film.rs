//! The film: exact sums, honest errors, nothing refused in silence.

mod common;

use common::{SIZE, first_hit, pixels};
use etendue_camera::{Film, FilmError, FirstHit, Ids, LIMIT, MergeError, Planes, Tile, TileRect};
use etendue_core::{Spectrum, UVec2, Vec3A};
use etendue_sampling::{Dim, Independent, Sampler};
use etendue_testkit::stats::{binomial_test, mean_test};
use proptest::prelude::*;

/// One thing that can happen to a film.
#[derive(Clone, Debug)]
struct Event {
    pixel: UVec2,
    replicate: u32,
    index: u64,
    l: Spectrum,
}

fn events() -> impl Strategy<Value = Vec<Event>> {
    let radiance = prop_oneof![
        4 => (-1e3f32..1e12).boxed(),
        1 => prop::num::f32::ANY.boxed(),
        1 => Just(1e-20f32).boxed(),
    ];
    let event =
        (0..SIZE.x, 0..SIZE.y, 0u32..3, 0u64..50, radiance).prop_map(|(x, y, replicate, index, l)| Event {
            pixel: UVec2::new(x, y),
            replicate,
            index,
            l: Spectrum::rgb(l, 0.3 * l, 1e-7 * l),
        });
    prop::collection::vec(event, 0..60)
}

fn apply(film: &mut Film, e: &Event) {
    film.add(e.pixel, e.replicate, e.l);
    film.add_first_hit(e.pixel, e.index, &first_hit(e.index));
    film.add_alpha(e.pixel, 0.5);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, rng_seed: proptest::test_runner::RngSeed::Fixed(3), failure_persistence: None, ..ProptestConfig::default() })]

    /// Any order, any split into films, tiles or one film: the same bits.
    #[test]
    fn sums_do_not_know_their_order(events in events(), cut in 0usize..60, shuffle in any::<u64>()) {
        let new = || Film::with_planes(SIZE, 3, Planes::ALL).unwrap();
        let mut whole = new();
        events.iter().for_each(|e| apply(&mut whole, e));

        let mut order: Vec<usize> = (0..events.len()).collect();
        order.sort_by_key(|&i| etendue_sampling::mix(i as u64 ^ shuffle));
        let mut shuffled = new();
        order.iter().for_each(|&i| apply(&mut shuffled, &events[i]));
        // Which of two equal indices came first is nobody's business here: their ids are equal.
        prop_assert!(shuffled == whole);

        let cut = cut.min(events.len());
        let (mut a, mut b) = (new(), new());
        events[..cut].iter().for_each(|e| apply(&mut a, e));
        events[cut..].iter().for_each(|e| apply(&mut b, e));
        let mut ba = b.clone();
        ba.merge(&a).unwrap();
        a.merge(&b).unwrap();
        prop_assert!(a == whole && ba == whole);
        prop_assert_eq!(a.digest(), whole.digest());

        let mut tiled = new();
        for rect in TileRect::split(SIZE, 1 + shuffle as u32 % 4) {
            let mut tile = Tile::try_new(rect, 3, Planes::ALL).unwrap();
            for e in &events {
                // A tile takes what is its own and refuses the rest.
                tile.add(e.pixel, e.replicate, e.l);
                tile.add_first_hit(e.pixel, e.index, &first_hit(e.index));
                tile.add_alpha(e.pixel, 0.5);
            }
            tiled.absorb(&tile);
        }
        prop_assert!(tiled == whole);
    }
}

#[test]
fn a_cleared_film_is_a_new_one() {
    let new = Film::with_planes(SIZE, 2, Planes::ALL).unwrap();
    let mut film = new.clone();
    let hit = FirstHit {
        albedo: Spectrum::ONE,
        normal: Vec3A::Z,
        depth: 2.0,
        ids: Ids { inst: 1, geom: 2, prim: 3 },
    };
    film.add(UVec2::ONE, 1, Spectrum::ONE);
    film.add_alpha(UVec2::ONE, 1.0);
    film.add_first_hit(UVec2::ONE, 7, &hit);
    assert_ne!(film, new);
    film.clear();
    assert_eq!(film, new);
}

#[test]
fn films_that_do_not_fit_together_are_refused_and_left_alone() {
    let mut film = Film::with_planes(SIZE, 2, Planes::default()).unwrap();
    film.add(UVec2::ZERO, 0, Spectrum::ONE);
    let before = film.clone();
    let other = |size, replicates, planes| Film::with_planes(size, replicates, planes).unwrap();
    let bigger = UVec2::new(5, 3);
    let none = Planes::default();
    assert_eq!(film.merge(&other(bigger, 2, none)), Err(MergeError::Size(SIZE, bigger)));
    assert_eq!(film.merge(&other(SIZE, 3, none)), Err(MergeError::Replicates(2, 3)));
    assert_eq!(film.merge(&other(SIZE, 2, Planes::ALL)), Err(MergeError::Planes(none, Planes::ALL)));
    assert_eq!(film, before);
    assert!(film.merge(&before).is_ok());
    assert_eq!(film.samples(UVec2::ZERO), 2);
}

#[test]
fn films_of_nothing_or_of_too_much_are_refused() {
    for (size, replicates) in [(UVec2::new(0, 1), 1), (UVec2::new(1, 0), 1), (UVec2::ONE, 0)] {
        assert!(matches!(Film::new(size, replicates), Err(FilmError::Empty(..))));
    }
    for (size, replicates) in [(UVec2::MAX, 1), (UVec2::MAX, u32::MAX), (UVec2::splat(1 << 24), 4)] {
        let e = Film::with_planes(size, replicates, Planes::ALL).expect_err("terabytes");
        assert!(matches!(e, FilmError::TooLarge(..)) && e.to_string().contains("memory"), "{e}");
    }
}

#[test]
fn refused_samples_count_as_black() {
    let below = f32::from_bits(LIMIT.to_bits() - 1);
    let pixel = UVec2::new(1, 1);
    let bad = [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, LIMIT, -LIMIT, f32::MAX];
    for bad in bad {
        for channel in 0..3 {
            let mut film = Film::new(SIZE, 1).unwrap();
            assert!(film.add(pixel, 0, Spectrum::gray(1.0)));
            let mut l = [0.5; 3];
            l[channel] = bad;
            assert!(!film.add(pixel, 0, Spectrum::from(l)), "{bad} in channel {channel}");
            assert_eq!(
                (film.samples(pixel), film.mean(pixel)),
                (2, Spectrum::gray(0.5)),
                "adds 0 and still divides"
            );
        }
    }
    let mut film = Film::new(SIZE, 1).unwrap();
    assert!(film.add(pixel, 0, Spectrum::rgb(below, -below, 0.0)));
    assert_eq!(film.mean(pixel), Spectrum::rgb(below, -below, 0.0));
    // What lies beside the picture is refused and counted nowhere.
    for outside in [UVec2::new(4, 0), UVec2::new(0, 3), UVec2::MAX] {
        assert!(!film.add(outside, 0, Spectrum::ONE));
        film.add_first_hit(outside, 0, &first_hit(0));
        film.add_alpha(outside, 1.0);
        assert_eq!(
            (film.samples(outside), film.mean(outside), film.standard_error(outside)),
            (0, Spectrum::BLACK, None)
        );
    }
    assert_eq!(film.total_samples(), 1);
}

/// A tile touches its own pixels only, whatever it is asked.
#[test]
fn tiles_refuse_what_lies_beside_them() {
    let rect = TileRect { lo: UVec2::new(2, 1), hi: UVec2::new(4, 3) };
    let mut tile = Tile::try_new(rect, 1, Planes::ALL).unwrap();
    for beside in [(1, 1), (4, 1), (2, 0), (2, 3), (0, 2), (u32::MAX, 1), (2, u32::MAX)] {
        let beside = UVec2::from(beside);
        assert!(!tile.add(beside, 0, Spectrum::ONE), "{beside}");
        tile.add_first_hit(beside, 0, &first_hit(0));
        tile.add_alpha(beside, 1.0);
    }
    assert_eq!(tile, Tile::try_new(rect, 1, Planes::ALL).unwrap());
    assert!(tile.add(UVec2::new(3, 2), 0, Spectrum::ONE));
    let mut inverted =
        Tile::try_new(TileRect { lo: UVec2::new(4, 4), hi: UVec2::ZERO }, 1, Planes::ALL).unwrap();
    assert!(!inverted.add(UVec2::new(4, 4), 0, Spectrum::ONE));
    // A tile over the border fills what of it is inside.
    let mut film = Film::new(SIZE, 1).unwrap();
    let mut over =
        Tile::try_new(TileRect { lo: UVec2::new(3, 2), hi: UVec2::new(6, 5) }, 1, Planes::default()).unwrap();
    for p in over.rect().iter() {
        over.add(p, 0, Spectrum::ONE);
    }
    film.absorb(&over);
    assert_eq!((film.total_samples(), film.mean(UVec2::new(3, 2))), (1, Spectrum::ONE));
}

#[test]
fn tiles_cover_every_pixel_once() {
    for size in [UVec2::new(1, 1), UVec2::new(37, 16), UVec2::new(16, 40)] {
        for side in [0, 1, 7, 16, 64, u32::MAX] {
            let mut seen = vec![0; (size.x * size.y) as usize];
            for rect in TileRect::split(size, side) {
                assert_eq!(rect.iter().count(), rect.pixels());
                rect.iter().for_each(|p| seen[(p.y * size.x + p.x) as usize] += 1);
            }
            assert!(seen.iter().all(|&n| n == 1), "{size}, {side}");
        }
    }
}

/// 2²² samples just below the limit fit; the film of one sample is doubled 22 times.
#[test]
fn the_largest_sum_is_exact() {
    let below = f32::from_bits(LIMIT.to_bits() - 1);
    let mut film = Film::new(UVec2::ONE, 1).unwrap();
    film.add(UVec2::ZERO, 0, Spectrum::rgb(below, -below, 1.0));
    for _ in 0..22 {
        let copy = film.clone();
        film.merge(&copy).unwrap();
    }
    assert_eq!(film.samples(UVec2::ZERO), 1 << 22);
    assert_eq!(film.mean(UVec2::ZERO), Spectrum::rgb(below, -below, 1.0));
    // Beyond the promise it is wrong, but it does not fail.
    for _ in 0..3 {
        let copy = film.clone();
        film.merge(&copy).unwrap();
    }
    assert_eq!(film.samples(UVec2::ZERO), 1 << 25);
}

#[test]
fn tiny_samples_beside_huge_ones_are_not_lost() {
    let mut film = Film::new(UVec2::ONE, 1).unwrap();
    let tiny = 2f32.powi(-41);
    film.add(UVec2::ZERO, 0, Spectrum::gray(1e11));
    for _ in 0..1000 {
        film.add(UVec2::ZERO, 0, Spectrum::gray(tiny));
    }
    film.add(UVec2::ZERO, 0, Spectrum::gray(-1e11));
    let mean = film.replicate_mean(UVec2::ZERO, 0).unwrap()[0];
    assert_eq!(mean, f64::from(tiny) * 1000.0 / 1002.0);
}

#[test]
fn replicates_are_kept_apart() {
    let mut film = Film::new(SIZE, 4).unwrap();
    let pixel = UVec2::new(2, 1);
    assert_eq!((film.replicate_mean(pixel, 0), film.standard_error(pixel)), (None, None));
    for i in 0..8u32 {
        film.add(pixel, i, Spectrum::gray(i as f32));
    }
    for r in 0..4 {
        assert_eq!(film.replicate_mean(pixel, r), Some([2.0 + f64::from(r); 3]), "samples r and r + 4");
    }
    assert_eq!((film.replicate_mean(pixel, 4), film.replicate_mean(SIZE, 0)), (None, None));
    assert_eq!(film.mean(pixel), Spectrum::gray(3.5));
    // The scatter of 2, 3, 4, 5 over the root of 4: √(5/3) / 2.
    let expected = (5.0f64 / 3.0).sqrt() / 2.0;
    assert!((film.standard_error(pixel).unwrap()[1] - expected).abs() < 1e-12);
    let mut single = Film::new(SIZE, 1).unwrap();
    single.add(pixel, 0, Spectrum::ONE);
    assert_eq!(single.standard_error(pixel), None, "one replicate knows no error");
}

/// Films of numbers with a known spread: the square of the standard error is that of the mean on average, and the
/// truth lies within the 95 % interval of Student's t in 95 % of the pixels.
#[test]
fn standard_errors_are_true() {
    const REPLICATES: u32 = 8;
    const PER_REPLICATE: u32 = 4;
    // 97.5 % point of Student's t with 7 degrees of freedom.
    const T: f64 = 2.364_624_252;
    let size = UVec2::splat(128);
    let n = REPLICATES * PER_REPLICATE;
    let mut film = Film::new(size, REPLICATES).unwrap();
    let sampler = Independent::new(21, n);
    for (stream, pixel) in pixels(size).enumerate() {
        for i in 0..n {
            let u = sampler.start(stream as u64, u64::from(i));
            // Uniform, and a sum of four that is nearly normal, of variances 1/12 and 1/3.
            let four: f32 = (0..4).map(|d| u.get_1d(Dim::bounce(d, etendue_sampling::Slot::Lobe))).sum();
            film.add(pixel, i, Spectrum::rgb(u.get_1d(Dim::TIME), four, 0.25));
        }
    }
    let errors: Vec<[f64; 3]> = pixels(size).map(|p| film.standard_error(p).unwrap()).collect();
    for (c, variance) in [(0, 1.0 / 12.0), (1, 1.0 / 3.0)] {
        let squares: Vec<f64> = errors.iter().map(|e| e[c] * e[c]).collect();
        let truth = variance / f64::from(n);
        let test = mean_test(&squares, truth);
        assert!(!test.rejects(1e-6), "channel {c}: {test:?}");
        // Dividing by R instead of R − 1 would be 1/8 off; a 2.5 % bias is five standard errors.
        assert!(5.0 * test.standard_error < 0.025 * truth, "channel {c}: {test:?}");
        let mutant: Vec<f64> = squares.iter().map(|s| s * 7.0 / 8.0).collect();
        assert!(mean_test(&mutant, truth).rejects(1e-6));
    }
    let mean = 2.0;
    let covered = pixels(size)
        .zip(&errors)
        .filter(|(p, e)| (f64::from(film.mean(*p).g()) - mean).abs() <= T * e[1])
        .count();
    let test = binomial_test(covered as u64, u64::from(size.x * size.y), 0.95);
    assert!(!test.rejects(1e-6), "{test:?}");
    // With the normal's 1.96 only about 91 % would be covered.
    let short = pixels(size)
        .zip(&errors)
        .filter(|(p, e)| (f64::from(film.mean(*p).g()) - mean).abs() <= 1.96 * e[1])
        .count();
    assert!(binomial_test(short as u64, u64::from(size.x * size.y), 0.95).rejects(1e-6));
    assert!(errors.iter().all(|e| e[2] == 0.0), "a constant has no error");
}

#[test]
fn planes_hold_means_and_the_first_ids() {
    let pixel = UVec2::new(3, 2);
    let mut film = Film::with_planes(SIZE, 1, Planes::ALL).unwrap();
    assert_eq!(
        (film.depth(pixel), film.ids(pixel), film.alpha(pixel)),
        (Some(f32::INFINITY), None, Some(0.0))
    );
    for index in [5, 2, 9] {
        film.add(pixel, 0, Spectrum::ONE);
        film.add_first_hit(pixel, index, &first_hit(index));
        film.add_alpha(pixel, 1.0);
    }
    film.add(pixel, 0, Spectrum::ONE);
    film.add_alpha(pixel, 0.0);
    assert_eq!(film.alpha(pixel), Some(0.75));
    assert_eq!(film.ids(pixel).unwrap().geom, 2, "of the lowest index, not of the first to come");
    // Depth over the samples that hit; albedo and normal over all of them.
    assert_eq!(film.depth(pixel), Some(1.5 + 16.0 / 3.0));
    assert_eq!(film.albedo(pixel).unwrap().b(), 4.0);
    assert!((film.normal(pixel).unwrap() - Vec3A::new(0.0, 0.45, 0.6)).length() < 1e-6);
    assert_eq!(film.depth(UVec2::ZERO), Some(f32::INFINITY));

    let mut plain = Film::new(SIZE, 1).unwrap();
    plain.add(pixel, 0, Spectrum::ONE);
    plain.add_first_hit(pixel, 0, &first_hit(0));
    assert_eq!((plain.albedo(pixel), plain.normal(pixel), plain.depth(pixel)), (None, None, None));
    assert_eq!((plain.alpha(pixel), plain.ids(pixel)), (None, None));
    assert!(plain.bytes() < film.bytes());
    // Each plane alone, and depth without alpha.
    let depth_only = Planes { depth: true, ..Planes::default() };
    let film = Film::with_planes(SIZE, 1, depth_only).unwrap();
    assert_eq!((film.depth(pixel), film.alpha(pixel)), (Some(f32::INFINITY), None));
}
