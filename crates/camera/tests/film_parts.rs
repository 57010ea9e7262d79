//! Films taken apart, put together again, and told apart.

mod common;

use common::{SIZE, first_hit, pixels};
use etendue_camera::{Film, FilmError, FilmParts, FirstHit, MergeError, Planes};
use etendue_core::{Spectrum, UVec2, Vec3A};

#[test]
fn the_digest_sees_everything() {
    let base = || {
        let mut film = Film::with_planes(SIZE, 2, Planes::ALL).unwrap();
        film.add(UVec2::ONE, 0, Spectrum::gray(0.5));
        film.add_first_hit(UVec2::ONE, 4, &first_hit(4));
        film
    };
    assert_eq!(base().digest(), base().digest());
    let changes: [&dyn Fn(&mut Film); 7] = [
        &|f| f.add_alpha(UVec2::ZERO, 1.0),
        &|f| assert!(f.add(UVec2::ONE, 0, Spectrum::BLACK)),
        &|f| assert!(f.add(UVec2::ONE, 1, Spectrum::BLACK)),
        &|f| assert!(f.add(UVec2::ZERO, 0, Spectrum::gray(1e-19))),
        &|f| {
            f.add_first_hit(
                UVec2::ONE,
                3,
                &FirstHit { depth: 0.0, albedo: Spectrum::BLACK, normal: Vec3A::ZERO, ..first_hit(4) },
            )
        },
        &|f| {
            f.add_first_hit(
                UVec2::ZERO,
                4,
                &FirstHit { depth: 0.0, albedo: Spectrum::BLACK, normal: Vec3A::ZERO, ..first_hit(4) },
            )
        },
        &|f| {
            f.add_first_hit(
                UVec2::ONE,
                9,
                &FirstHit { depth: 0.0, albedo: Spectrum::BLACK, normal: Vec3A::ZERO, ..first_hit(4) },
            )
        },
    ];
    let mut digests = vec![base().digest()];
    for change in changes {
        let mut film = base();
        change(&mut film);
        digests.push(film.digest());
    }
    let count = digests.len();
    digests.sort_unstable();
    digests.dedup();
    assert_eq!(digests.len(), count);
}

fn parts(film: &Film) -> FilmParts {
    let v = film.view();
    FilmParts {
        sums: v.sums.to_vec(),
        counts: v.counts.to_vec(),
        albedo: v.albedo.to_vec(),
        normal: v.normal.to_vec(),
        depth: v.depth.to_vec(),
        hits: v.hits.to_vec(),
        alpha: v.alpha.to_vec(),
        ids: v.ids.to_vec(),
    }
}

#[test]
fn a_film_taken_apart_and_put_together_is_the_same() {
    for planes in [Planes::default(), Planes::ALL, Planes { depth: true, ..Planes::default() }] {
        let mut film = Film::with_planes(SIZE, 3, planes).unwrap();
        for (i, pixel) in pixels(SIZE).enumerate() {
            film.add(pixel, i as u32, Spectrum::rgb(-0.3, i as f32, 1e-9));
            film.add_first_hit(pixel, i as u64, &first_hit(i as u64));
            film.add_alpha(pixel, 0.25);
        }
        let again = Film::from_parts(SIZE, 3, planes, parts(&film)).unwrap();
        assert_eq!(again, film);
        assert_eq!(again.digest(), film.digest());
    }
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let film = Film::with_planes(SIZE, 2, Planes::ALL).unwrap();
    let make = |change: &dyn Fn(&mut FilmParts)| {
        let mut p = parts(&film);
        change(&mut p);
        Film::from_parts(SIZE, 2, Planes::ALL, p)
    };
    assert!(make(&|_| ()).is_ok());
    let length = |r: Result<Film, FilmError>| match r {
        Err(FilmError::Length { part, .. }) => part,
        other => panic!("{other:?}"),
    };
    assert_eq!(length(make(&|p| p.sums.truncate(3))), "sums");
    assert_eq!(length(make(&|p| p.counts.push(0))), "counts");
    assert_eq!(length(make(&|p| p.albedo.clear())), "albedo");
    assert_eq!(length(make(&|p| p.normal.clear())), "normal");
    assert_eq!(length(make(&|p| p.depth.clear())), "depth");
    assert_eq!(length(make(&|p| p.hits.clear())), "hits");
    assert_eq!(length(make(&|p| p.alpha.clear())), "alpha");
    assert_eq!(length(make(&|p| p.ids.clear())), "ids");
    assert_eq!(make(&|p| p.counts.fill(u64::MAX / 2)), Err(FilmError::Samples));
    assert_eq!(make(&|p| p.hits.fill(u64::MAX / 2)), Err(FilmError::Samples));
    assert_eq!(
        Film::from_parts(UVec2::new(0, 3), 2, Planes::ALL, parts(&film)),
        Err(FilmError::Empty(0, 3, 2))
    );
    // Two films that are sound each, but not together.
    let mut many = make(&|p| p.counts[0] = u64::MAX - 3).unwrap();
    let other = many.clone();
    assert_eq!(many.merge(&other), Err(MergeError::Samples));
    assert_eq!(many, other);
}
