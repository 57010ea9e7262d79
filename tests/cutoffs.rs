//! Ending paths: what cut-offs lose, that roulette and branching lose nothing, and what they cost.

mod support;

use etendue::integrator::Branching;
use etendue::prelude::*;
use etendue_testkit::stats::mean_test;
use support::{assert_mean, radiance};

const RHO: f64 = 0.7;

/// The inside of a ball that emits 1 and reflects ρ: after k scattering events a path carries ρᵏ and has found the sum so
/// far, so that every answer is a geometric series.
fn furnace() -> Scene {
    let mut b = SceneBuilder::new();
    let wall = b.material(Diffuse::new(Spectrum::gray(RHO as f32)));
    let id = b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), wall);
    b.emit(id, Emission::new(Spectrum::ONE).two_sided());
    b.build().unwrap()
}

fn inside(_: &Independent) -> Ray {
    Ray::new(Vec3A::new(0.1, 0.2, 0.3), Vec3A::NEG_Z)
}

/// The first `n` terms.
fn series(n: u32) -> f64 {
    (1.0 - RHO.powi(n as i32)) / (1.0 - RHO)
}

/// Emission is met by chance, so that a path has no other noise than its own end.
const CHANCE: PathTracer = PathTracer {
    max_depth: None,
    threshold: 0.0,
    direct: DirectLight::None,
    roulette: Roulette::Off,
    branching: Branching::NONE,
};

/// Either is short of 1/(1 − ρ) by what it cut, exactly, and says that it is biased.
#[test]
fn cut_offs_lose_the_rest_of_the_series_and_say_so() {
    let scene = furnace();
    for depth in [0, 1, 4, 12] {
        let cut = PathTracer { max_depth: Some(depth), ..CHANCE };
        assert_mean(&radiance(&scene, &cut, 1, 16, &inside), series(depth + 1), 1e-5, "depth");
        assert!(Integrator::<Independent>::bias(&cut)[0].contains(&format!("max_depth={depth}")));
    }
    // ρᵏ < threshold from k on.
    for (threshold, k) in [(0.5, 2), (0.1, 7), (0.01, 13)] {
        assert!(RHO.powi(k) < threshold && threshold < RHO.powi(k - 1));
        let cut = PathTracer { threshold: threshold as f32, ..CHANCE };
        assert_mean(&radiance(&scene, &cut, 1, 16, &inside), series(k as u32), 1e-5, "threshold");
        assert!(Integrator::<Independent>::bias(&cut)[0].contains("threshold"));
    }
}

/// With P = ρ the survivors carry 1 for ever and a path of n terms shows n: variance ρ/(1 − ρ)². In general
/// Var = Σ of what the coin at each event adds: with r = ρ²/P < 1, Var = (1 − P) ρ² / (P (1 − r) (1 − ρ)²).
#[test]
fn roulette_is_unbiased_and_its_variance_is_the_computed_one() {
    let scene = furnace();
    let truth = 1.0 / (1.0 - RHO);
    let n = 200_000;
    let variance = |p: f64| {
        let r = RHO * RHO / p;
        (1.0 - p) * RHO * RHO / (p * (1.0 - r) * (1.0 - RHO).powi(2))
    };
    let rules = [
        (Roulette::Fixed { p: 0.75, from: 1 }, 0.75),
        (Roulette::Fixed { p: 0.9, from: 1 }, f64::from(0.9f32)),
        (Roulette::Albedo { from: 1 }, RHO),
    ];
    for (rule, p) in rules {
        let xs = radiance(&scene, &PathTracer { roulette: rule, ..CHANCE }, 2, n, &inside);
        assert_mean(&xs, truth, 0.03, &format!("{rule:?}"));
        let squares: Vec<f64> = xs.iter().map(|x| (x - truth).powi(2)).collect();
        let test = mean_test(&squares, variance(p));
        assert!(!test.rejects(1e-4), "{rule:?}: variance {test:?}");
        // Mutants: survivors that carry nothing more, and a P that is off by a tenth.
        assert!(mean_test(&xs, 1.0 / (1.0 - RHO * p)).rejects(1e-6));
        assert!(mean_test(&squares, variance(0.9 * p)).rejects(1e-4), "{rule:?}");
    }
    let by_throughput = PathTracer { roulette: Roulette::Throughput { from: 1 }, ..CHANCE };
    assert_mean(&radiance(&scene, &by_throughput, 3, n, &inside), truth, 0.03, "throughput");
    let found = PathTracer { direct: DirectLight::MisPower, ..by_throughput };
    assert!(Integrator::<Independent>::bias(&found).is_empty());
}

/// P counts what is transmitted: through clear glass no path ends, though it reflects 4 %.
#[test]
fn the_albedo_of_glass_holds_what_it_lets_through() {
    let mut b = SceneBuilder::new();
    let glass = b.material(Glass::new(1.33));
    b.add(Sphere::new(Vec3A::ZERO, 1.0).unwrap(), glass);
    b.light(ConstantEnvironment::new(Spectrum::ONE));
    let scene = b.build().unwrap();
    let cx = Context::new(&scene);
    let path = PathTracer { roulette: Roulette::Albedo { from: 1 }, ..PathTracer::default() };
    for i in 0..1000 {
        let u = Independent::new(1, 1).start(i, 0);
        let at = u.get_2d(Dim::FILM) - Vec2::splat(0.5);
        let ray = Ray::new(Vec3A::new(at.x, at.y, 4.0), Vec3A::NEG_Z);
        let l = path.li_plain(&cx, &CameraSample { ray, weight: 1.0, spread: 0.0 }, u).l;
        assert!((l.r() - 1.0).abs() < 1e-5, "{l:?}");
    }
    assert!(cx.counts().scatter_rays > 1000 && cx.counts().roulette_ends == 0);
}

/// Branches share the weight: no bias, and as many more rays as said; the variance that is left is that before the branches
/// and a part of that behind them.
#[test]
fn branches_share_the_weight() {
    let scene = furnace();
    let truth = 1.0 / (1.0 - RHO);
    let rule = Roulette::Fixed { p: 0.75, from: 2 };
    let of = |factor, levels| {
        let branching = Branching { factor, levels };
        radiance(&scene, &PathTracer { roulette: rule, branching, ..CHANCE }, 4, 60_000, &inside)
    };
    let variance = |xs: &[f64]| xs.iter().map(|x| (x - truth).powi(2)).sum::<f64>() / xs.len() as f64;
    let one = of(1, 1);
    assert_eq!(one, of(4, 0), "no level, no branch: the same bits");
    for (factor, levels) in [(2, 1), (4, 1), (16, 1), (3, 2)] {
        let xs = of(factor, levels);
        assert_mean(&xs, truth, 0.03, &format!("{factor} ways at {levels} levels"));
        // In the furnace all variance is behind the branches, and they are independent.
        let ways = f64::from(factor.pow(levels));
        let ratio = variance(&one) / variance(&xs) / ways;
        assert!((ratio - 1.0).abs() < 0.15, "{factor}^{levels}: {ratio}");
    }
    let cx = Context::new(&scene);
    let branching = Branching { factor: 5, levels: 2 };
    let two = PathTracer { branching, max_depth: Some(2), ..CHANCE };
    let s = CameraSample { ray: inside(&Independent::new(1, 1)), weight: 1.0, spread: 0.0 };
    two.li_plain(&cx, &s, Independent::new(1, 1));
    assert_eq!(cx.counts().scatter_rays, 5 + 25);
    // A tree that would not end is not made.
    let huge = Branching { factor: 1000, levels: u32::MAX };
    let cx = Context::new(&scene);
    PathTracer { branching: huge, max_depth: Some(4), ..CHANCE }.li_plain(&cx, &s, Independent::new(1, 1));
    assert!(cx.counts().scatter_rays <= 4 * 65_536);
}
