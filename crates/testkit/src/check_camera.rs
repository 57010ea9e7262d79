use etendue_camera::Camera;
use etendue_core::{Needs, Origin, Vec2, vector};

use crate::budget::{Budget, EXTREMES, Judge, Outcome};

const RAYS: usize = 5_000;

/// Tests a camera against the contract of [`Camera`].
///
/// Rays are valid, unit, finite in weight and spread, for any film position (outside of the picture too), lens and
/// time; without [`Needs::LENS`] the lens and without [`Needs::MOTION`] the time changes nothing; neighbouring film
/// positions give neighbouring rays; and where the camera knows the way back ([`Camera::connect`]), a point on a ray
/// is connected to the film position that the ray came from.
///
/// # Errors
/// The first [`crate::Failure`].
pub fn check_camera(camera: &dyn Camera, budget: &Budget) -> Outcome {
    let mut judge = Judge::new(budget, 0);
    let mut random = budget.random(0xca3e);
    let size = camera.resolution();
    judge.require(size.x > 0 && size.y > 0, "resolution", || format!("{size}"))?;
    let extent = Vec2::new(size.x as f32, size.y as f32);
    let needs = camera.needs();
    let mut seen = 0;
    for i in 0..budget.samples(RAYS) {
        // A tenth of the positions lie outside of the picture, where a wide filter may ask.
        let margin = if i % 10 == 0 { 4.0 } else { 0.0 };
        let film = random.pair() * (extent + Vec2::splat(2.0 * margin)) - Vec2::splat(margin);
        let extreme = |k: usize| EXTREMES[(i / 7 + k) % EXTREMES.len()];
        let lens = if i % 7 == 0 { Vec2::new(extreme(0), extreme(1)) } else { random.pair() };
        let time = random.unit();
        let Some(s) = camera.ray(film, lens, time) else { continue };
        seen += 1;
        let ok = s.ray.is_valid()
            && (vector::length(s.ray.d) - 1.0).abs() < 1e-5
            && s.weight.is_finite()
            && s.spread.is_finite()
            && s.spread >= 0.0;
        judge.require(ok, "ray", || format!("{s:?} at film {film}, lens {lens}, time {time}"))?;
        judge.require(s.ray.time == time, "time", || format!("asked for {time}, the ray says {}", s.ray.time))?;
        if !needs.contains(Needs::LENS) {
            let other = camera.ray(film, random.pair(), time);
            judge.require(other == Some(s), "lens", || "it matters, but Needs::LENS is not declared".into())?;
        }
        if !needs.contains(Needs::MOTION) {
            let other = camera.ray(film, lens, random.unit()).map(|o| (o.ray.o, o.ray.d, o.weight));
            let same = other == Some((s.ray.o, s.ray.d, s.weight));
            judge.require(same, "time", || "it matters, but Needs::MOTION is not declared".into())?;
        }
        if let Some(next) = camera.ray(film + Vec2::splat(1e-2), lens, time) {
            let turned = vector::length(next.ray.d - s.ray.d);
            judge.require(turned < 0.1, "continuity", || format!("a hundredth of a pixel turns the ray by {turned}"))?;
        }
        if let Some(back) = camera.connect(&Origin::free(s.ray.at(3.0)), lens) {
            let off = (back.film - film).length();
            judge.require(off < 1e-2 && back.pdf > 0.0 && back.we.is_finite(), "connect", || {
                format!("film {film} came back as {} ({off} pixels off)", back.film)
            })?;
        }
    }
    judge.require(seen > 0, "ray", || "the camera is blind everywhere".into())?;
    judge.done()
}
