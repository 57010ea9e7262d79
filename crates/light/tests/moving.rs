//! Moving lamps: the irradiance at given times, what their bounds hold, and what is wrong with almost moving ones.

mod support;

use std::sync::Arc;

use etendue_core::{Fingerprint, Motion, Needs, Ray, Spectrum, Transform, Vec2, Vec3A, vector};
use etendue_geometry::{Parallelogram, Shape, Surface, presets};
use etendue_light::{
    ConstantEnvironment, Light, LightBounds, LightSample, LitPoint, MeshLight, MovingLight,
    ParallelogramLight, PointLight, ShapeLight, Unpicked,
};
use etendue_testkit::{Budget, check_light, lit_point};
use etendue_texture::Tex;
use support::{Rng, irradiance, polygon_irradiance, receiver};

const ONE: Tex = Tex::Constant(Spectrum::ONE);

/// A unit square at height 2 that faces down.
fn square() -> Parallelogram {
    Parallelogram::new(Vec3A::new(-0.5, 2.0, -0.5), Vec3A::X, Vec3A::Z).expect("a square")
}

/// Half a turn about the vertical through a corner, and a metre along x and down, so that it never dips below the floor.
fn motion() -> Motion {
    Motion::new(Vec3A::new(0.1, 1.0, 0.05), 3.0, Vec3A::new(0.5, 2.0, 0.5), Vec3A::new(1.0, -0.6, 0.2))
        .expect("finite")
}

fn corners(square: &Parallelogram, placed: &Transform) -> [Vec3A; 4] {
    let [a, b, c] = [square.origin(), square.edge_u(), square.edge_v()];
    [a, a + b, a + b + c, a + c].map(|p| placed.point(p))
}

/// Lambert's formula for the square where it is at each time; three ways of sampling it.
#[test]
fn irradiance_is_that_of_the_moment() {
    let s = square();
    let mesh = Arc::new(presets::quad(s.origin(), s.edge_u(), s.edge_v()));
    let lamps: [(&str, Arc<dyn Light>, u32); 3] = [
        ("mesh", Arc::new(MeshLight::new(mesh, None, ONE, false)), 200_000),
        ("rectangle", Arc::new(ParallelogramLight::new(s, ONE)), 200_000),
        ("by area", Arc::new(ShapeLight::new(Arc::new(s), None, ONE, false)), 600_000),
    ];
    let p = Vec3A::new(0.2, 0.0, 0.1);
    let at_zero = polygon_irradiance(&corners(&s, &Transform::IDENTITY), p, Vec3A::Y);
    for (k, time) in [0.0, 0.2, 0.5, 0.9].into_iter().enumerate() {
        let e = polygon_irradiance(&corners(&s, &motion().at(time)), p, Vec3A::Y);
        // Mutants: the lamp at time 0 and at squared time. `Mean::check` sees half a per cent.
        assert!(time == 0.0 || (e / at_zero - 1.0).abs() > 0.02, "{e} {at_zero}");
        let squared = polygon_irradiance(&corners(&s, &motion().at(time * time)), p, Vec3A::Y);
        assert!(time == 0.0 || (e / squared - 1.0).abs() > 0.01, "{e} {squared}");
        for (i, (name, lamp, n)) in lamps.iter().enumerate() {
            let lamp = MovingLight::new(lamp.clone(), motion());
            let at = LitPoint { time, ..receiver(p, Vec3A::Y) };
            irradiance(&lamp, &at, *n, (10 * k + i) as u64).check(e, &format!("{name} at {time}"));
        }
    }
}

#[test]
fn a_moving_point_is_exact() {
    let lamp = PointLight::new(Vec3A::Y * 2.0, Spectrum::gray(8.0));
    let lamp = MovingLight::new(Arc::new(lamp), Motion::travel(Vec3A::Y * 4.0).expect("finite"));
    assert!(lamp.is_delta() && lamp.needs().contains(Needs::MOTION));
    for (time, li) in [(0.0, 2.0), (0.5, 0.5)] {
        let at = LitPoint { time, ..receiver(Vec3A::ZERO, Vec3A::Y) };
        let s = lamp.sample(&at, 0, Vec2::ZERO).expect("above the floor");
        assert_eq!((s.wi, s.li, s.pdf), (Vec3A::Y, Spectrum::gray(li), 1.0));
        assert_eq!(s.end.expect("a place").p, Vec3A::Y * (2.0 + 4.0 * time));
    }
    let still = MovingLight::new(
        Arc::new(ConstantEnvironment::new(Spectrum::ONE)),
        Motion::travel(Vec3A::ZERO).unwrap(),
    );
    assert!(still.is_infinite() && !still.needs().contains(Needs::MOTION));
}

/// The box holds the lamp at all times, and the cone its normals, not only those of the ends.
#[test]
fn bounds_hold_the_whole_motion() {
    let mut rng = Rng(3);
    let (mut narrow, mut outside_start) = (0, 0);
    for _ in 0..300 {
        let s = Parallelogram::new(rng.point(), rng.point(), rng.point()).expect("an area");
        let mesh = Arc::new(presets::quad(s.origin(), s.edge_u(), s.edge_v()));
        let lamp = Arc::new(MeshLight::new(mesh, None, ONE, false));
        let motion =
            Motion::new(rng.point(), 4.0 * rng.next() - 2.0, rng.point(), rng.point()).expect("finite");
        let still = lamp.bounds(0).expect("a place");
        let b = MovingLight::new(lamp, motion).bounds(0).expect("a place");
        assert_eq!(b.power, still.power);
        narrow += u32::from(b.cos_normals > -1.0);
        for k in 0..=100 {
            let placed = motion.at(k as f32 / 100.0);
            let n = placed.normal(s.normal());
            assert!(n.dot(b.axis) >= b.cos_normals - 1e-6, "{n} {b:?}");
            for c in corners(&s, &placed).into_iter().take(3) {
                assert!(b.bounds.contains(c), "{c} {b:?}");
            }
            outside_start += u32::from(n.dot(still.axis) < still.cos_normals - 1e-3);
        }
    }
    assert!(narrow > 250 && outside_start > 20_000, "{narrow} {outside_start}");
}

#[test]
fn digests_tell_motions_and_lamps_apart() {
    let digest = |watts: f32, travel: f32| {
        let lamp = Arc::new(PointLight::new(Vec3A::ZERO, Spectrum::gray(watts)));
        let mut f = Fingerprint::default();
        MovingLight::new(lamp, Motion::travel(Vec3A::X * travel).expect("finite")).fingerprint(&mut f);
        f.value()
    };
    assert_eq!(digest(1.0, 1.0), digest(1.0, 1.0));
    assert_ne!(digest(1.0, 1.0), digest(1.0, 2.0));
    assert_ne!(digest(1.0, 1.0), digest(2.0, 1.0));
}

/// Behind holes it is left to rays, and still moves.
#[test]
fn an_unpicked_lamp_moves_too() {
    let s = square();
    let lamp = MovingLight::new(Arc::new(ParallelogramLight::new(s, ONE)), motion());
    let lamp = Unpicked(Arc::new(lamp));
    assert!(lamp.needs().contains(Needs::MOTION) && !lamp.needs().contains(Needs::AREA_LIGHTS));
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Wrong {
    Nothing,
    /// The end of the shadow ray stays where the lamp was.
    End,
    /// The lamp of time 0 whatever the time.
    TimeZero,
    /// Faster at the end than at the start.
    Squared,
    /// The point that was hit is not taken back.
    Seen,
    /// Directions are not turned.
    Direction,
    /// The end's error knows nothing of the way to the moving geometry and back.
    EndError,
    /// Bounds at time 0.
    Bounds,
}

struct Mutant {
    right: MovingLight,
    wrong: Wrong,
}

impl Mutant {
    fn asked(&self, at: &LitPoint) -> LitPoint {
        let time = match self.wrong {
            Wrong::TimeZero => 0.0,
            Wrong::Squared => at.time * at.time,
            _ => at.time,
        };
        LitPoint { time, ..*at }
    }
}

impl Light for Mutant {
    fn sample(&self, at: &LitPoint, part: u32, u: Vec2) -> Option<LightSample> {
        let mut s = self.right.sample(&self.asked(at), part, u)?;
        let back = self.right.motion().at(at.time).inverse();
        match self.wrong {
            Wrong::End => s.end = s.end.map(|e| e.transformed(&back)),
            Wrong::Direction => s.wi = vector::normalize(back.vector(s.wi)),
            Wrong::EndError => s.end.iter_mut().for_each(|e| e.p_err = Vec3A::ZERO),
            _ => {}
        }
        Some(s)
    }

    fn pdf(&self, at: &LitPoint, part: u32, wi: Vec3A, seen: Option<&Surface>) -> f32 {
        let asked = self.asked(at);
        if self.wrong == Wrong::Seen {
            let forth = self.right.motion().at(at.time);
            let seen = seen.map(|s| s.clone().transformed(&forth));
            return self.right.pdf(&asked, part, wi, seen.as_ref());
        }
        self.right.pdf(&asked, part, wi, seen)
    }

    fn power(&self, part: u32, r: f32) -> Spectrum {
        self.right.power(part, r)
    }

    fn bounds(&self, part: u32) -> Option<LightBounds> {
        if self.wrong == Wrong::Bounds { self.right.light().bounds(part) } else { self.right.bounds(part) }
    }

    fn emitted(&self, part: u32, at: &Surface, wo: Vec3A) -> Spectrum {
        self.right.emitted(part, at, wo)
    }
}

/// What `check_light` finds of a lamp whose geometry is modelled `away` from its own origin.
fn verdict(wrong: Wrong, away: f32) -> Option<&'static str> {
    let s = square();
    let s = Parallelogram::new(s.origin() + Vec3A::splat(away), s.edge_u(), s.edge_v()).expect("a square");
    let turn = Transform::rotation(Vec3A::new(0.2, 1.0, 0.1), 0.7);
    let home = Vec3A::new(0.3, 0.1, 0.2) - turn.point(Vec3A::splat(away));
    let start = Transform::translation(home).after(&turn).expect("regular");
    let seen = |ray: &Ray| {
        let placed = motion().placement(&start, ray.time);
        let (object, _) = placed.ray_to_object(ray);
        let hit = s.intersect(&object)?;
        let mut surface = s.surface(&object, &hit).transformed(&placed);
        surface.time = ray.time;
        Some(surface)
    };
    let points = [0.3, 0.8].map(|time| LitPoint { time, ..lit_point(Vec3A::new(0.4, -0.3, 0.2), Vec3A::Y) });
    let light = Arc::new(ShapeLight::new(Arc::new(s), Some(start), ONE, false));
    let right = MovingLight::of_instance(light, &start, motion());
    let budget = Budget::default().effort(0.2);
    check_light(&Mutant { right, wrong }, 0, &points, &seen, &budget).err().map(|f| {
        println!("{wrong:?}: {f}");
        f.test
    })
}

#[test]
fn almost_moving_lamps_are_rejected() {
    assert_eq!(verdict(Wrong::Nothing, 0.0), None);
    assert_eq!(verdict(Wrong::End, 0.0), Some("end"));
    assert_eq!(verdict(Wrong::TimeZero, 0.0), Some("agreement"));
    assert_eq!(verdict(Wrong::Squared, 0.0), Some("agreement"));
    assert_eq!(verdict(Wrong::Seen, 0.0), Some("agreement"));
    assert_eq!(verdict(Wrong::Direction, 0.0), Some("end"));
    assert_eq!(verdict(Wrong::Bounds, 0.0), Some("bounds"));
    assert_eq!(verdict(Wrong::Nothing, 300.0), None);
    assert_eq!(verdict(Wrong::EndError, 300.0), Some("own shadow"));
}
