//! What crosses the picture is in a pixel for as long as it covers it: closed forms of motion blur.

use std::f64::consts::TAU;

use etendue::camera::Shutter;
use etendue::core::Motion;
use etendue::prelude::*;
use etendue_testkit::stats::{binomial_test, sidak};

/// Level of each picture's test.
const ALPHA: f64 = 1e-6;
const WIDTH: u32 = 16;

/// A row or square of pixels of size 1 × 1 from the origin to the right and downward, seen along −z.
fn flat(height: u32) -> Orthographic {
    let (w, h) = (WIDTH as f32, height as f32);
    let to_world = Transform::translation(Vec3A::new(0.5 * w, -0.5 * h, 10.0));
    Orthographic::new(to_world, 0.5 * h, UVec2::new(WIDTH, height)).unwrap()
}

/// Every pixel of the picture of something that shines with radiance 1 and moves: the fraction of time and area that it
/// covers is `covered(pixel)`; `mutants` are other fractions, which the picture must contradict.
fn is_covered(
    shape: impl Into<Geometry>,
    motion: Motion,
    camera: &dyn Camera,
    covered: &dyn Fn(UVec2) -> f64,
    mutants: &[&dyn Fn(UVec2) -> f64],
) {
    let mut b = SceneBuilder::new();
    let black = b.material(etendue::material::Absorber);
    let id = b.add_grouped(shape, black);
    b.emit(id, Emission::new(Spectrum::ONE).two_sided());
    let group = b.group(&[id]);
    b.moving_instance(group, Transform::IDENTITY, motion);
    let scene = b.build().unwrap();
    const N: u32 = 8192;
    let size = camera.resolution();
    let options = RenderOptions { filter: Filter::Box { radius: 0.5 }, ..RenderOptions::default() };
    let tracer = PathTracer::default();
    let mut film = Film::new(size, 1).unwrap();
    render(&scene, camera, &tracer, Independent::new(3, N), &mut film, &options).unwrap();
    let pixels = || (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
    let level = sidak(ALPHA, pixels().count());
    let test = |p: UVec2, truth: f64| {
        let hits = (f64::from(film.mean(p).mean()) * f64::from(N)).round() as u64;
        binomial_test(hits, u64::from(N), truth.clamp(0.0, 1.0))
    };
    for p in pixels() {
        let t = test(p, covered(p));
        assert!(!t.rejects(level), "{p}: {t:?}");
    }
    for (i, mutant) in mutants.iter().enumerate() {
        assert!(pixels().any(|p| test(p, mutant(p)).rejects(level)), "mutant {i} goes unnoticed");
    }
    // Sobol's points come much closer.
    let mut film = Film::new(size, 1).unwrap();
    render(&scene, camera, &tracer, Sobol::new(4, N), &mut film, &options).unwrap();
    let worst = pixels().map(|p| (f64::from(film.mean(p).mean()) - covered(p)).abs()).fold(0.0, f64::max);
    assert!(worst < 0.01, "{worst}");
}

/// A mean over a fine grid of [0, 1].
fn mean_over(n: u32, f: impl Fn(f64) -> f64) -> f64 {
    (0..n).map(|i| f((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n)
}

/// A square of 2.5 pixels that crosses nine pixels: how much of the pixel from `x` on it covers, over time.
fn square_covers(x: f64, when: fn(f64) -> f64) -> f64 {
    mean_over(20_000, |t| {
        let left = 2.25 + 9.0 * when(t);
        ((left + 2.5).min(x + 1.0) - left.max(x)).max(0.0)
    })
}

#[test]
fn a_square_that_crosses_pixels_is_there_as_long_as_it_is() {
    let square = Parallelogram::new(Vec3A::new(2.25, -3.0, 0.0), Vec3A::X * 2.5, Vec3A::Y * 6.0).unwrap();
    let motion = Motion::travel(Vec3A::X * 9.0).unwrap();
    is_covered(
        square,
        motion,
        &flat(1),
        &|p| square_covers(f64::from(p.x), |t| t),
        &[&|p| square_covers(f64::from(p.x), |_| 0.5), &|p| square_covers(f64::from(p.x), |t| t * t), &|p| {
            square_covers(f64::from(p.x), |_| 0.0)
        }],
    );
    // Half of the interval, from a quarter on, is the same square slower and later.
    is_covered(
        square,
        motion,
        &Shutter::new(flat(1), 0.25, 0.75).unwrap(),
        &|p| square_covers(f64::from(p.x), |t| 0.25 + 0.5 * t),
        &[&|p| square_covers(f64::from(p.x), |t| t), &|p| square_covers(f64::from(p.x), |t| 0.5 * t)],
    );
}

/// A ball of radius 1.5 crosses: a point is covered while the ball's chord passes over it.
#[test]
fn a_ball_that_crosses_pixels_is_there_as_long_as_it_is() {
    let (r, speed) = (1.5f64, 10.0f64);
    let covered = |p: UVec2, speed: f64, late: f64| {
        mean_over(200, |v| {
            let y = f64::from(p.y) + v - 2.0;
            let half = (r * r - y * y).max(0.0).sqrt();
            mean_over(200, |u| {
                let x = f64::from(p.x) + u - 3.0;
                let (from, to) = ((x - half) / speed - late, (x + half) / speed - late);
                (to.min(1.0) - from.max(0.0)).max(0.0)
            })
        })
    };
    is_covered(
        Sphere::new(Vec3A::new(3.0, -2.0, 0.0), r as f32).unwrap(),
        Motion::travel(Vec3A::X * speed as f32).unwrap(),
        &flat(4),
        &|p| covered(p, speed, 0.0),
        &[&|p| covered(p, 1.15 * speed, 0.0), &|p| covered(p, speed, 0.04)],
    );
}

/// A blade of 1 × 7 turns three times about its end: a point is covered for as much of a turn as the blade fills of its
/// circle.
#[test]
fn a_blade_that_turns_several_times_is_everywhere_it_sweeps() {
    let (half, long) = (0.5f64, 7.0f64);
    let filled = |p: UVec2, turns: f64| {
        mean_over(40, |v| {
            mean_over(40, |u| {
                let (x, y) = (f64::from(p.x) + u - 8.0, 8.0 - f64::from(p.y) - v);
                let r = x.hypot(y);
                // The angles, seen from the blade, at which the point lies in it.
                let side = if r > half { (half / r).asin() } else { TAU / 4.0 };
                let tip = if r > long { (long / r).acos() } else { 0.0 };
                // Whole turns, and the last part of one: where it overlaps with one of the two ranges of angles.
                let (whole, open) = (turns.floor(), turns.fract() * TAU);
                let at = y.atan2(x);
                let over = |from: f64, to: f64| (to.min(open) - from.max(0.0)).max(0.0);
                let rest = [-TAU, 0.0, TAU].map(|k| {
                    let at = at + k;
                    over(at - side, at - tip) + over(at + tip, at + side)
                });
                (whole * 2.0 * (side - tip).max(0.0) + rest.iter().sum::<f64>()) / (turns * TAU)
            })
        })
    };
    let blade = || {
        Parallelogram::new(Vec3A::new(8.0, -8.5, 0.0), Vec3A::X * long as f32, Vec3A::Y * 2.0 * half as f32)
            .unwrap()
    };
    let center = Vec3A::new(8.0, -8.0, 0.0);
    let turning = |turns: f64| Motion::turn(Vec3A::Z, (turns * TAU) as f32, center).unwrap();
    let half_a_turn_more = |p: UVec2| filled(p, 3.5);
    is_covered(blade(), turning(3.0), &flat(16), &|p| filled(p, 3.0), &[&half_a_turn_more]);
    is_covered(blade(), turning(2.25), &flat(16), &|p| filled(p, 2.25), &[&|p| filled(p, 2.0)]);
    is_covered(blade(), turning(-3.0), &flat(16), &|p| filled(p, 3.0), &[&half_a_turn_more]);
}
