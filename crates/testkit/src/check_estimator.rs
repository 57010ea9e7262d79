use etendue_camera::{Camera, CameraSample};
use etendue_core::{Spectrum, Vec2};
use etendue_integrator::{Context, Contribution, Integrator, Recorder, Sample, stream_of};
use etendue_sampling::{Dim, Sampler};
use etendue_scene::Scene;

use crate::budget::{Budget, Failure, Judge};
use crate::stats::{MeanTest, mean_test, welch_test};

/// What an estimator should give.
pub enum Truth<'a> {
    /// A known mean.
    Known(f64),
    /// The mean of another estimator: an independent estimate per seed.
    Same(&'a dyn Fn(u64) -> f64),
}

/// Tests that an estimator is unbiased. `estimate` gives one independent estimate per seed; the mean of a whole
/// QMC point set is one estimate.
///
/// `replicates` estimates are drawn (and as many of the other, if there is one); means are compared by a t-test.
/// Returns the test as well, so that a caller can state its power: on 99 of 100 seeds a bias of 7.5 standard errors is
/// rejected, of 9 where there are only 24 replicates (Student's t has longer tails).
///
/// # Errors
/// [`Failure`] where the mean is off, or where one estimate carries so much that the test cannot be trusted.
pub fn check_estimator(
    estimate: &dyn Fn(u64) -> f64,
    truth: &Truth<'_>,
    replicates: usize,
    budget: &Budget,
) -> Result<MeanTest, Failure> {
    let mut judge = Judge::new(budget, 1);
    let seeds = |salt: u64| {
        let base = budget.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ salt;
        (0..replicates as u64).map(move |i| base.wrapping_add(i.wrapping_mul(0xd134_2543_de82_ef95)))
    };
    let own: Vec<f64> = seeds(1).map(estimate).collect();
    judge.require(own.iter().all(|x| x.is_finite()), "finite", || "an estimate is not a number".into())?;
    let test = match truth {
        Truth::Known(t) => mean_test(&own, *t),
        Truth::Same(other) => welch_test(&own, &seeds(2).map(other).collect::<Vec<_>>()),
    };
    judge.require(!test.untrustworthy, "variance", || {
        format!("one estimate carries too much of the sum; {test:?}")
    })?;
    judge.p_value(test.p, "mean", || {
        format!("{} ± {} instead of {}", test.estimate, test.standard_error, test.truth)
    })?;
    Ok(test)
}

/// What the mean radiance over a picture should be, mean of the channels.
pub enum Radiance<'a, S: Sampler> {
    /// A known value, the same in every pixel.
    Known(f64),
    /// What another integrator finds in the same scene.
    Same(&'a dyn Integrator<S>),
}

/// Tests an integrator against the contract of [`Integrator`] in one scene.
///
/// `li`, `li_plain` and `li_batch` give the same bits; what the recorder hears adds up to the radiance; samples are
/// finite; `alpha` is a fraction; and the mean over the picture is the known one, or another integrator's, over
/// `replicates` independent seeds of `spp` samples a pixel.
///
/// # Errors
/// The first [`Failure`]; see [`check_estimator`] for the power.
pub fn check_integrator<S: Sampler>(
    integrator: &dyn Integrator<S>,
    make: &dyn Fn(u64) -> S,
    scene: &Scene,
    camera: &dyn Camera,
    truth: &Radiance<'_, S>,
    replicates: usize,
    budget: &Budget,
) -> Result<MeanTest, Failure> {
    let mut judge = Judge::new(budget, 0);
    let paths = paths(camera, make(budget.seed), 2);
    let cx = Context::new(scene);
    let mut batch = vec![Sample::default(); paths.len()];
    integrator.li_batch(&cx, &paths, &mut batch);
    let (mut silent, mut incomplete) = (true, None::<String>);
    for ((s, u), batched) in paths.iter().zip(&batch) {
        let mut sum = Sum(Spectrum::BLACK);
        let told = integrator.li(&cx, s, *u, &mut sum);
        let plain = integrator.li_plain(&cx, s, *u);
        judge.require(told == plain && plain == *batched, "same bits", || {
            format!("li {told:?}, li_plain {plain:?}, li_batch {batched:?} for {s:?}")
        })?;
        judge.require(plain.l.is_finite(), "finite", || format!("{plain:?} for {s:?}"))?;
        judge.require((0.0..=1.0).contains(&plain.alpha), "alpha", || format!("{}", plain.alpha))?;
        let off = (sum.0 - plain.l).map(f32::abs).max_channel();
        if off > 1e-4 * plain.l.map(f32::abs).max_channel() && incomplete.is_none() {
            incomplete = Some(format!("heard {:?}, the sample is {:?}", sum.0, plain.l));
        }
        silent &= sum.0.is_black();
    }
    // An integrator that records nothing at all is allowed; one that records must record all.
    judge.require(silent || incomplete.is_none(), "recorder", || incomplete.unwrap_or_default())?;
    let mean = |integrator: &dyn Integrator<S>, seed: u64| {
        let s = make(seed);
        let paths = self::paths(camera, s, u64::from(s.spp()));
        let mut out = vec![Sample::default(); paths.len()];
        integrator.li_batch(&cx, &paths, &mut out);
        out.iter().zip(&paths).map(|(o, (s, _))| f64::from(o.l.mean() * s.weight)).sum::<f64>()
            / paths.len() as f64
    };
    let own = |seed| mean(integrator, seed);
    match truth {
        Radiance::Known(t) => check_estimator(&own, &Truth::Known(*t), replicates, budget),
        Radiance::Same(other) => {
            let other = |seed| mean(*other, seed);
            check_estimator(&own, &Truth::Same(&other), replicates, budget)
        }
    }
}

/// Adds up what a recorder hears.
struct Sum(Spectrum);

impl Recorder for Sum {
    fn contribution(&mut self, c: &Contribution) {
        self.0 += c.value;
    }
}

/// The first `spp` samples of every pixel, box-filtered.
fn paths<S: Sampler>(camera: &dyn Camera, sampler: S, spp: u64) -> Vec<(CameraSample, S)> {
    let size = camera.resolution();
    let mut out = Vec::new();
    for y in 0..size.y {
        for x in 0..size.x {
            for index in 0..spp {
                let u = sampler.start(stream_of(etendue_core::UVec2::new(x, y)), index);
                let film = Vec2::new(x as f32, y as f32) + u.get_2d(Dim::FILM);
                if let Some(s) = camera.ray(film, u.get_2d(Dim::LENS), u.get_1d(Dim::TIME)) {
                    out.push((s, u));
                }
            }
        }
    }
    out
}
