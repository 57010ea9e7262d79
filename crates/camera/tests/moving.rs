//! Shutters and moving cameras.

use std::sync::Arc;

use etendue_camera::{Camera, Orthographic, Panorama, PanoramaMap, Perspective, Shutter, ShutterError};
use etendue_core::{Fingerprint, Motion, Needs, Transform, UVec2, Vec2, Vec3A, vector};
use etendue_testkit::{Budget, check_camera};

const SIZE: UVec2 = UVec2::new(32, 24);

fn view() -> Perspective {
    Perspective::look_at(Vec3A::new(1.0, 2.0, 5.0), Vec3A::ZERO, Vec3A::Y, 40.0, SIZE).expect("a view")
}

fn motion() -> Motion {
    Motion::new(Vec3A::new(0.2, 1.0, 0.1), 2.0, Vec3A::X, Vec3A::new(0.5, -0.2, 3.0)).expect("finite")
}

/// Every camera, held and moving, open and frozen, in a box or not.
fn all() -> Vec<Box<dyn Camera>> {
    let ortho = Orthographic::look_at(Vec3A::Z, Vec3A::ZERO, Vec3A::Y, 2.0, SIZE).expect("a view");
    let around =
        Panorama::new(Transform::translation(Vec3A::Y), PanoramaMap::EqualArea, SIZE).expect("a place");
    let lens = view().with_lens(0.2, 4.0).expect("a lens");
    let inner: Vec<Arc<dyn Camera>> =
        vec![Arc::new(view()), Arc::new(lens), Arc::new(ortho), Arc::new(around)];
    let mut all: Vec<Box<dyn Camera>> = Vec::new();
    for camera in inner {
        for (open, close) in [(0.0, 1.0), (0.25, 0.75), (0.6, 1.0), (0.3, 0.3), (1.0, 1.0)] {
            let held = Shutter::new(camera.clone(), open, close).expect("times");
            all.push(Box::new(held.clone()));
            let moving = held.with_motion(motion());
            all.push(Box::new(Shutter::new(moving.clone(), 0.5, 1.0).expect("times")));
            all.push(Box::new(Shutter::frozen(moving.clone(), 0.1).expect("a time")));
            all.push(Box::new(moving));
        }
    }
    all
}

#[test]
fn every_shutter_keeps_the_contract() {
    for (i, camera) in all().into_iter().enumerate() {
        let budget = Budget::default().seed(i as u64).effort(0.3);
        check_camera(&camera, &budget).unwrap_or_else(|e| panic!("camera {i}: {e}"));
        check_camera(&&*camera, &budget).unwrap_or_else(|e| panic!("camera {i} by reference: {e}"));
    }
}

#[derive(Clone, Copy, Debug)]
enum Wrong {
    /// The time asked for instead of the one in the exposure.
    Time,
    /// It moves and does not say so.
    Needs,
    /// Half of what it says.
    Exposure,
}

struct Mutant(Shutter<Perspective>, Wrong);

impl Camera for Mutant {
    fn resolution(&self) -> UVec2 {
        self.0.resolution()
    }
    fn ray(&self, film: Vec2, lens: Vec2, time: f32) -> Option<etendue_camera::CameraSample> {
        let mut s = self.0.ray(film, lens, time)?;
        match self.1 {
            Wrong::Time => s.ray.time = time,
            Wrong::Exposure => s.ray.time = 0.25 + 0.25 * time,
            Wrong::Needs => {}
        }
        Some(s)
    }
    fn needs(&self) -> Needs {
        if matches!(self.1, Wrong::Needs) { Needs::empty() } else { self.0.needs() }
    }
    fn exposure(&self) -> [f32; 2] {
        self.0.exposure()
    }
}

#[test]
fn wrong_shutters_are_rejected() {
    for (wrong, test) in [(Wrong::Time, "time"), (Wrong::Exposure, "time"), (Wrong::Needs, "motion")] {
        let right = Shutter::new(view(), 0.25, 0.75).expect("times").with_motion(motion());
        let failure = check_camera(&Mutant(right, wrong), &Budget::default().effort(0.1)).expect_err("wrong");
        assert_eq!(failure.test, test, "{wrong:?}: {failure}");
    }
}

#[test]
fn rays_are_displaced_at_their_own_time() {
    let shutter = Shutter::new(view(), 0.25, 0.75).expect("times").with_motion(motion());
    assert_eq!(shutter.exposure(), [0.25, 0.75]);
    for i in 0..100u32 {
        let film = Vec2::new((i % 32) as f32 + 0.3, (i % 24) as f32 + 0.6);
        let u = i as f32 / 100.0;
        let s = shutter.ray(film, Vec2::ZERO, u).expect("sees everywhere");
        let still = view().ray(film, Vec2::ZERO, 0.0).expect("sees everywhere");
        let time = 0.25 + 0.5 * u;
        let placed = motion().at(time);
        assert_eq!(s.ray.time, time);
        assert_eq!(s.ray.o, placed.point(still.ray.o));
        assert_eq!(s.ray.d, vector::normalize(placed.vector(still.ray.d)));
        assert_eq!((s.weight, s.spread), (still.weight, still.spread));
        // A point carried along by the same motion stays on the same ray of the film.
        let p = placed.point(still.ray.at(3.0));
        assert!(vector::length(s.ray.at(3.0) - p) < 1e-5);
        // Frozen at that time it is the same ray.
        let frozen = Shutter::frozen(view(), time).expect("a time").with_motion(motion());
        assert_eq!(frozen.ray(film, Vec2::ZERO, 0.9), Some(s));
    }
    // Open all the time and held, it changes no bit.
    let held = Shutter::new(view(), 0.0, 1.0)
        .expect("times")
        .with_motion(Motion::travel(Vec3A::ZERO).expect("finite"));
    assert!(held.motion().is_none());
    let film = Vec2::new(3.1, 4.2);
    assert_eq!(held.ray(film, Vec2::ZERO, 0.7), view().ray(film, Vec2::ZERO, 0.7));
}

#[test]
fn time_is_drawn_only_for_what_moves() {
    let needs = |open, close, moves: bool| {
        let shutter = Shutter::new(view(), open, close).expect("times");
        let shutter = if moves { shutter.with_motion(motion()) } else { shutter };
        shutter.needs().contains(Needs::MOTION)
    };
    assert!(needs(0.0, 1.0, true) && needs(0.2, 0.3, true));
    assert!(!needs(0.0, 1.0, false) && !needs(0.5, 0.5, true) && !needs(0.5, 0.5, false));
    let frozen = Shutter::frozen(Shutter::new(view(), 0.0, 0.5).expect("times").with_motion(motion()), 0.5);
    let frozen = frozen.expect("a time");
    assert!(!frozen.needs().contains(Needs::MOTION));
    assert_eq!(frozen.exposure(), [0.25, 0.25]);
    assert_eq!(frozen.ray(Vec2::ZERO, Vec2::ZERO, 0.9).expect("sees everywhere").ray.time, 0.25);
}

#[test]
fn bad_times_are_refused_with_their_reason() {
    let of = |open, close| Shutter::new(view(), open, close).map(|_| ());
    for (open, close) in [(-0.1, 0.5), (0.0, 1.1), (f32::NAN, 1.0), (0.0, f32::NAN), (0.0, f32::INFINITY)] {
        assert!(matches!(of(open, close), Err(ShutterError::Outside { .. })), "{open} {close}");
    }
    assert_eq!(of(0.5, 0.25), Err(ShutterError::Backwards { open: 0.5, close: 0.25 }));
    assert!(of(0.5, 0.25).unwrap_err().to_string().contains("0.25"));
    assert!(matches!(Shutter::frozen(view(), 2.0), Err(ShutterError::Outside { .. })));
}

#[test]
fn digests_hold_times_and_motion() {
    let digest = |camera: &dyn Camera| {
        let mut f = Fingerprint::default();
        camera.fingerprint(&mut f);
        assert!(!f.is_opaque());
        f.value()
    };
    let shutter = |open, close| Shutter::new(view(), open, close).expect("times");
    let all = [
        digest(&view()),
        digest(&shutter(0.0, 1.0)),
        digest(&shutter(0.0, 0.5)),
        digest(&shutter(0.0, 1.0).with_motion(motion())),
        digest(&shutter(0.0, 1.0).with_motion(Motion::travel(Vec3A::X).expect("finite"))),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(all[..i].iter().all(|b| a != b), "{i}");
    }
    assert_eq!(digest(&Box::new(view())), all[0]);
}
