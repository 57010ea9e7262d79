//! Moving instances: what the census, the report, the digest and the lights say of them.

mod common;

use common::{gray, square};
use etendue_core::{Motion, Needs, Ray, Segment, Spectrum, Transform, Vec2, Vec3A};
use etendue_geometry::Sphere;
use etendue_light::{LitPoint, Sides};
use etendue_scene::{Emission, Scene, SceneBuilder, SceneError};

fn travel(x: f32, y: f32) -> Motion {
    Motion::travel(Vec3A::new(x, y, 0.0)).expect("finite")
}

/// A ball of radius 1 at the origin that moves, and shines if asked.
fn ball(motion: Option<Motion>, shines: bool) -> SceneBuilder {
    let mut b = SceneBuilder::new();
    let m = gray(&mut b);
    let id = b.add_grouped(Sphere::new(Vec3A::ZERO, 1.0).expect("a ball"), m);
    if shines {
        b.emit(id, Emission::new(Spectrum::ONE));
    }
    let group = b.group(&[id]);
    match motion {
        None => b.instance(group, Transform::IDENTITY),
        Some(motion) => b.moving_instance(group, Transform::IDENTITY, motion),
    };
    b
}

fn built(b: SceneBuilder) -> Scene {
    b.build().expect("a scene")
}

#[test]
fn what_moves_is_counted_and_what_does_not_is_not() {
    let plain = built(ball(None, false));
    let still = built(ball(Some(Motion::turn(Vec3A::Y, 0.0, Vec3A::X).expect("finite")), false));
    assert!(!still.needs().contains(Needs::MOTION));
    assert_eq!(still.report(), plain.report());
    assert_eq!(still.fingerprint(), plain.fingerprint());
    assert!(!still.report().to_string().contains("moving"));

    let moving = built(ball(Some(travel(3.0, 0.0)), false));
    assert!(moving.needs().contains(Needs::MOTION | Needs::INSTANCES));
    assert_eq!((moving.report().instances, moving.report().moving), (1, 1));
    assert!(moving.report().to_string().contains("1 instances moving"), "{}", moving.report());
    // A group of nothing moves nothing.
    let mut b = SceneBuilder::new();
    let nothing = b.group(&[]);
    b.moving_instance(nothing, Transform::IDENTITY, travel(1.0, 0.0));
    let scene = built(b);
    assert_eq!((scene.needs().contains(Needs::MOTION), scene.report().moving), (false, 0));
}

#[test]
fn bounds_hold_the_whole_way() {
    let b = ball(Some(travel(3.0, 0.0)), false);
    let asked = b.bounds();
    let scene = built(b);
    for b in [asked, scene.bounds()] {
        assert!((b.lo - Vec3A::new(-1.0, -1.0, -1.0)).abs().max_element() < 1e-5, "{b:?}");
        assert!((b.hi - Vec3A::new(4.0, 1.0, 1.0)).abs().max_element() < 1e-5, "{b:?}");
    }
}

#[test]
fn digests_hold_the_motion() {
    let digest = |m| built(ball(Some(m), true)).fingerprint().value();
    assert_eq!(digest(travel(1.0, 0.0)), digest(travel(1.0, 0.0)));
    assert_ne!(digest(travel(1.0, 0.0)), digest(travel(2.0, 0.0)));
    let dark = |m| built(ball(m, false)).fingerprint().value();
    assert_ne!(dark(Some(travel(1.0, 0.0))), dark(Some(travel(2.0, 0.0))));
    assert_ne!(dark(Some(travel(1.0, 0.0))), dark(None));
}

#[test]
fn rays_meet_it_where_it_is() {
    let scene = built(ball(Some(travel(4.0, 0.0)), false));
    for time in [0.0, 0.25, 0.75] {
        let ray = |x: f32| Ray { time, ..Ray::new(Vec3A::new(x, 0.0, 5.0), Vec3A::NEG_Z) };
        let here = ray(4.0 * time);
        let hit = scene.intersect(&here, 0).expect("it is here");
        assert!((hit.t - 4.0).abs() < 1e-5);
        let s = scene.surface(&here, &hit, 0.0);
        assert_eq!(s.time, time);
        assert!((s.p - Vec3A::new(4.0 * time, 0.0, 1.0)).abs().max_element() < 1e-5);
        assert!(scene.intersect(&ray(4.0 * time + 1.1), 0).is_none());
        assert!(scene.intersect(&ray(4.0 * time - 1.1), 0).is_none());
    }
}

/// Light sampling, its density and what a ray finds agree at every time, through the scene.
#[test]
fn a_moving_lamp_is_one_light() {
    let scene =
        built(ball(Some(Motion::new(Vec3A::Z, 2.0, Vec3A::Y, Vec3A::X * 4.0).expect("finite")), true));
    assert!(scene.needs().contains(Needs::MOTION | Needs::AREA_LIGHTS));
    assert!(!scene.has_hidden_lights());
    let (mut drawn, mut found) = (0, 0);
    for i in 0..600u32 {
        let time = (i % 3) as f32 * 0.4;
        let p = Vec3A::new(2.0, -4.0, 1.0);
        let at = LitPoint { p, p_err: Vec3A::ZERO, ng: Vec3A::Y, ns: Vec3A::Y, sides: Sides::Same, time };
        let u = Vec2::new((i as f32 * 0.618_034).fract(), (i as f32 * 0.754_877).fract());
        let Some(draw) = scene.sample_light(&at, u) else { continue };
        drawn += 1;
        let ray = at.origin().ray(draw.sample.wi, time);
        let Some(hit) = scene.intersect(&ray, 0) else { continue };
        let s = scene.surface(&ray, &hit, 0.0);
        assert_eq!(scene.light_at(&s), Some(draw.id));
        let pdf = scene.light_pdf(&at, draw.id, draw.sample.wi, Some(&s));
        // Near the limb the cosine is not well known.
        let cos = s.ng.dot(draw.sample.wi).abs();
        assert!((pdf / draw.sample.pdf - 1.0).abs() < 1e-4 / cos, "{pdf} {:?}", draw.sample);
        assert_eq!(scene.emitted(draw.id, &s, -draw.sample.wi), Spectrum::ONE);
        let free = Segment { from: at.origin(), d: draw.sample.wi, to: draw.sample.end, time };
        found += u32::from(!scene.transmittance(&free, 0).is_black());
    }
    // By area more than half lies on the far side; of the near side nothing shadows itself.
    assert!(drawn > 200 && found + 1 >= drawn, "{found} of {drawn}");
}

#[test]
fn motions_that_lead_nowhere_are_refused() {
    let mut b = ball(Some(travel(3e38, 0.0)), false);
    let m = gray(&mut b);
    let far = b.add_grouped(square(0.0), m);
    let group = b.group(&[far]);
    b.moving_instance(group, Transform::translation(Vec3A::X * 1e38), travel(3e38, 0.0));
    let e = b.build().map(|_| ()).expect_err("out of range");
    assert!(matches!(e, SceneError::BadMotion { instance: 1 }), "{e}");
    assert!(e.to_string().contains("move it less"));

    let mut other = SceneBuilder::new();
    let group = ball(None, false).group(&[]);
    other.moving_instance(group, Transform::IDENTITY, travel(1.0, 0.0));
    let e = other.build().map(|_| ()).expect_err("of another builder");
    assert!(matches!(e, SceneError::UnknownId { what: "group", .. }), "{e}");
}
