//! What a race does: who draws when, what is timed, when it ends, and what it refuses.

mod common;

use std::cell::RefCell;
use std::error::Error;
use std::ops::Range;
use std::rc::Rc;
use std::sync::atomic::{AtomicU32, Ordering};

use common::{Ramp, VARIANCE, Wound, contender};
use etendue_core::Progress;
use etendue_measure::{
    Axis, Budget, Clocks, Contender, Costs, Curve, Drawn, Estimator, Known, MeasureError, Metric, Point,
    Reference, convergence, race,
};

fn exact(pixels: usize) -> Reference {
    Reference::exact([pixels as u32, 1], vec![[1.0; 3]; pixels])
}

fn spp(curve: &Curve) -> Vec<u64> {
    curve.points.iter().map(|p| p.spp).collect()
}

#[test]
fn contenders_draw_in_turn() {
    let clock = Wound::default();
    let log = Rc::new(RefCell::new(Vec::new()));
    let named = |name: char| {
        let log = log.clone();
        contender(&name.to_string(), 2, |k| Ramp {
            log: Some((name, log.clone())),
            ..Ramp::new(1, k, &clock)
        })
    };
    let budget = Budget { spp: 3, seconds: None };
    let clocks = Clocks { wall: &clock, cpu: Some(&clock) };
    let curves = race(&mut [named('a'), named('b')], Some(&exact(1)), &budget, clocks, &()).expect("curves");
    let warm: [(char, Range<u64>); 2] = [('a', 0..1), ('b', 0..1)];
    assert_eq!(log.borrow()[..2], warm, "each draws one sample that does not count");
    let turns: Vec<(char, Range<u64>)> =
        [0..1, 1..2, 2..3].into_iter().flat_map(|r| ['a', 'b', 'a', 'b'].map(|c| (c, r.clone()))).collect();
    assert_eq!(log.borrow()[2..], turns);
    assert_eq!(spp(&curves[1]), [1, 2, 3]);
    let costs = curves[1].points[2].costs[1];
    assert_eq!((costs.samples, costs.rays, costs.rejected), (3, 9, 0));
    assert!((costs.seconds - 3e-3).abs() < 1e-8 && (costs.cpu_seconds.expect("a clock") - 3e-3).abs() < 1e-8);
}

#[test]
fn time_ends_a_curve_before_it_is_overdrawn() {
    let clock = Wound::default();
    let clocks = Clocks { wall: &clock, cpu: None };
    let slow = |seconds| contender("x", 2, |k| Ramp { seconds, ..Ramp::new(1, k, &clock) });
    let budget = Budget { spp: 64, seconds: Some(9.5e-3) };
    let curves = race(&mut [slow(1e-3), slow(2e-3)], None, &budget, clocks, &()).expect("curves");
    assert_eq!((spp(&curves[0]), spp(&curves[1])), (vec![1, 2, 4, 8], vec![1, 2, 4]));
    let (a, b) = curves[0].last_common(&curves[1]).expect("both have 4");
    assert_eq!((a.spp, b.spp), (4, 4));
    assert!((b.cost_over(a, Axis::Seconds).expect("a ratio").value - 2.0).abs() < 1e-6);
    assert_eq!(a.cost(Axis::CpuSeconds), None, "there is no such clock");
}

#[test]
fn strata_begin_anew_at_every_point() {
    let clock = Wound::default();
    let log = Rc::new(RefCell::new(Vec::new()));
    let anew =
        contender("s", 1, |k| Ramp { anew: true, log: Some(('s', log.clone())), ..Ramp::new(2, k, &clock) });
    let clocks = Clocks { wall: &clock, cpu: None };
    let curve = convergence(anew, None, &Budget { spp: 4, seconds: None }, clocks).expect("a curve");
    assert_eq!(log.borrow()[1..], [('s', 0..1), ('s', 0..2), ('s', 0..4)]);
    let last = &curve.points[2];
    assert_eq!(last.costs[0].samples, 8, "a point costs what it alone costs");
    assert!((last.costs[0].seconds - 4e-3).abs() < 1e-8);
}

/// Says stop after some questions.
struct StopAfter(AtomicU32);

impl Progress for StopAfter {
    fn cancelled(&self) -> bool {
        let left = self.0.load(Ordering::Relaxed);
        self.0.store(left.saturating_sub(1), Ordering::Relaxed);
        left == 0
    }
}

#[test]
fn what_was_measured_before_a_stop_is_kept() {
    let clock = Wound::default();
    let clocks = Clocks { wall: &clock, cpu: None };
    let budget = Budget { spp: 1 << 20, seconds: None };
    // Two runs: two questions a point and one after it.
    let stop = StopAfter(AtomicU32::new(7));
    let mut one = [contender("x", 2, |k| Ramp::new(1, k, &clock))];
    let curves = race(&mut one, None, &budget, clocks, &stop).expect("curves");
    assert_eq!(spp(&curves[0]), [1, 2], "a point that not all runs reached is left out");
}

struct Broken;

impl Estimator for Broken {
    fn draw(&mut self, _: Range<u64>) -> Result<Drawn, Box<dyn Error + Send + Sync>> {
        Err("no light".into())
    }
    fn reset(&mut self) {}
    fn picture(&self) -> Vec<[f32; 3]> {
        Vec::new()
    }
}

#[test]
fn refusals_name_the_contender() {
    let clock = Wound::default();
    let clocks = Clocks { wall: &clock, cpu: None };
    let budget = Budget { spp: 4, seconds: None };
    let refused = |c: Contender<'_>, r: Option<&Reference>| match convergence(c, r, &budget, clocks) {
        Ok(_) => panic!("accepted"),
        Err(e) => e,
    };
    let none = Contender { name: "none".into(), runs: Vec::new() };
    assert!(matches!(refused(none, None), MeasureError::NoRuns(n) if n == "none"));
    let broken = Contender { name: "dark".into(), runs: vec![Box::new(Broken)] };
    assert_eq!(refused(broken, None).to_string(), "'dark' failed: no light");
    let small = contender("small", 1, |k| Ramp::new(3, k, &clock));
    let e = refused(small, Some(&exact(4)));
    assert!(matches!(e, MeasureError::Size { found: 3, expected: 4, .. }), "{e}");
    let nothing = contender("x", 1, |k| Ramp::new(1, k, &clock));
    let curve = convergence(nothing, None, &Budget { spp: 0, seconds: None }, clocks).expect("no samples");
    assert!(curve.points.is_empty() && curve.slope(Metric::Relative, Axis::Samples).is_none());
}

#[test]
fn one_run_has_an_error_and_no_interval() {
    let clock = Wound::default();
    let clocks = Clocks { wall: &clock, cpu: None };
    let curve = |runs, reference| {
        let x = contender("x", runs, |k| Ramp::new(16, k, &clock));
        convergence(x, reference, &Budget { spp: 8, seconds: None }, clocks).expect("a curve")
    };
    let reference = exact(16);
    let one = curve(1, Some(&reference));
    let p = one.points.last().expect("points");
    assert!(p.error(Metric::Relative).is_some_and(|m| m.value > 0.0 && m.interval.is_none()));
    assert_eq!((p.variance(Metric::Relative), p.bias_squared(Metric::Relative)), (None, None));
    let blind = curve(4, None);
    let p = blind.points.last().expect("points");
    assert_eq!((p.error(Metric::Absolute), p.bias_squared(Metric::Absolute)), (None, None));
    let variance = p.variance(Metric::Absolute).expect("of pairs");
    assert!(variance.holds(VARIANCE / 8.0), "{variance:?}");
    assert_eq!(p.corrected(Metric::Absolute), Some(variance), "all that is known");
    assert!(p.variance(Metric::Trimmed).is_some_and(|t| t.interval.is_some()));
    assert_eq!(curve(1, None).points[3].corrected(Metric::Absolute), None);
}

#[test]
fn what_it_takes_to_reach_an_error() {
    let clock = Wound::default();
    let clocks = Clocks { wall: &clock, cpu: None };
    let pixels = 256;
    let x = contender("x", 4, |k| Ramp::new(pixels, k, &clock));
    let reference = exact(pixels);
    let curve =
        convergence(x, Some(&reference), &Budget { spp: 64, seconds: None }, clocks).expect("a curve");
    let samples = |n: f64| n * pixels as f64;
    let at = |spp: f64| curve.to_error(Metric::Absolute, VARIANCE / spp, Axis::Samples).expect("reached");
    for (spp, known) in [(0.5, Known::AtMost), (24.0, Known::Measured), (256.0, Known::Extrapolated)] {
        let t = at(spp);
        assert_eq!(t.known, known);
        let want = samples(spp.max(1.0));
        assert!((t.cost.value / want - 1.0).abs() < 0.2, "{t:?}, not {want}");
    }
    assert_eq!(curve.to_error(Metric::Absolute, 0.0, Axis::Samples), None);
    assert_eq!(curve.to_error(Metric::Absolute, f64::NAN, Axis::Samples), None);
}

/// A picture with pixels that are no numbers is measured where it is one.
#[test]
fn what_is_no_number_is_left_out_of_all_runs() {
    struct Holes(u32);
    impl Estimator for Holes {
        fn draw(&mut self, _: Range<u64>) -> Result<Drawn, Box<dyn Error + Send + Sync>> {
            Ok(Drawn::default())
        }
        fn reset(&mut self) {}
        fn picture(&self) -> Vec<[f32; 3]> {
            let mut p = vec![[1.5; 3]; 4];
            p[self.0 as usize][1] = f32::NAN;
            p
        }
    }
    let clock = Wound::default();
    let clocks = Clocks { wall: &clock, cpu: None };
    let runs = (0..2).map(|k| Box::new(Holes(k)) as Box<dyn Estimator>).collect();
    let c = Contender { name: "holes".into(), runs };
    let curve = convergence(c, Some(&exact(4)), &Budget { spp: 1, seconds: None }, clocks).expect("a curve");
    let p = &curve.points[0];
    assert_eq!(p.not_finite, 2);
    assert!((p.error(Metric::Absolute).expect("two pixels").value - 0.25).abs() < 1e-12);
    assert_eq!(p.efficiency(Metric::Absolute, Axis::Seconds), None, "no time has passed");
    let nowhere = Reference::exact([4, 1], vec![[f32::NAN; 3]; 4]);
    let p = Point::new(1, vec![p.costs[0]; 2], &vec![vec![[1.5; 3]; 4]; 2], Some(&nowhere)).expect("a point");
    for metric in [Metric::Relative, Metric::Trimmed, Metric::Absolute] {
        let numbers = [p.error(metric), p.variance(metric), p.bias_squared(metric), p.corrected(metric)];
        assert_eq!(numbers, [None; 4], "there is no pixel to say anything by");
    }
}

/// The pixels that are trimmed of an error are not those that are trimmed of a variance.
#[test]
fn trimmed_parts_are_no_parts_of_the_trimmed_error() {
    let picture = |k: usize| -> Vec<[f32; 3]> {
        (0..1000).map(|p| [1.0 + common::uniform(k as u64, p, 0) as f32; 3]).collect()
    };
    let (three, five): (Vec<_>, Vec<_>) = ((0..3).map(picture).collect(), (0..5).map(picture).collect());
    let reference = exact(1000);
    let point = |pictures: &[Vec<[f32; 3]>], reference| {
        let costs = vec![Costs { samples: 1, ..Costs::default() }; pictures.len()];
        Point::new(1, costs, pictures, reference).expect("a point")
    };
    let p = point(&five, Some(&reference));
    assert!(p.error(Metric::Trimmed).is_some() && p.variance(Metric::Trimmed).is_some());
    assert_eq!(p.bias_squared(Metric::Trimmed), None);
    // Of five runs, the trimmed variance of three of them is not known.
    let (few, many) = (point(&three, None), point(&five, None));
    assert_eq!(many.efficiency_over(&few, Metric::Trimmed, Axis::Samples), None);
    assert!(many.efficiency_over(&many, Metric::Trimmed, Axis::Samples).is_some_and(|m| m.holds(1.0)));
}
