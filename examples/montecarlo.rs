//! Monte Carlo integration in one dimension: ∫ 4x³ over [0, 1], which is 1.
//!
//! `cargo run --release --example montecarlo` prints what four densities leave of the variance, with the exact values
//! beside, and writes `montecarlo.html`: running estimates of two estimators, and the mean and the variance of 600 of
//! them against the number of samples, independent and stratified (the textbook's Fig. 14.1).
//! Options: `--size N` (estimators), `--spp N` (samples of each), `--out FOLDER`.
//!
//! A density of one's own needs two functions: the inverse of its distribution function, and itself.

use std::error::Error;
use std::path::PathBuf;

use etendue::measure::report::{
    Axis, Cell, Item, Line, Page, Plot, Point, Row, Section, Series, Table, number,
};
use etendue::prelude::*;
use etendue::sampling::estimate::{EstimateError, Estimation, Integral};
use etendue::sampling::stats::Moments;

struct Options {
    size: u32,
    spp: u32,
    out: PathBuf,
}

fn options() -> Result<Options, Box<dyn Error>> {
    let mut o = Options { size: 600, spp: 1024, out: ".".into() };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let value = args.next().ok_or(format!("{arg} needs a value"))?;
        match arg.as_str() {
            "--size" => o.size = value.parse::<u32>()?.max(2),
            "--spp" => o.spp = value.parse::<u32>()?.max(2),
            "--out" => o.out = value.into(),
            _ => return Err(format!("unknown option {arg}").into()),
        }
    }
    Ok(o)
}

fn f(x: f64) -> f64 {
    4.0 * x.powi(3)
}

/// Replicates, from whose scatter the error bars come.
const REPLICATES: u32 = 16;

fn main() -> Result<(), Box<dyn Error>> {
    let o = options()?;
    // The densities get all the samples that the estimators have together.
    let samples = u64::from(o.size) * u64::from(o.spp);
    let samples = samples.next_multiple_of(REPLICATES.into()).max(2 * u64::from(REPLICATES));
    let independent = densities(Independent::new(1, o.spp).with_replicates(REPLICATES), samples)?;
    let sobol = densities(
        Sobol::new(1, u32::try_from(samples).unwrap_or(u32::MAX)).with_replicates(REPLICATES),
        samples,
    )?;
    println!("∫ 4x³ from 0 to 1, {samples} samples, intervals of 95 %");
    println!("density   variance of a sample   exact    independent              Sobol");
    for (a, b) in independent.iter().zip(&sobol) {
        let [random, stratified] = [a, b].map(|d| with_interval(&d.result));
        println!("{:<9} {:<22.5} {:<8.5} {random:<24} {stratified}", a.name, a.result.variance, a.exact);
    }

    let page = Page {
        title: "Monte Carlo integration".into(),
        lead: vec![
            "∫ 4x³ over [0, 1] is 1. Its estimate is the mean of 4x³ / p(x) over points x of density p."
                .into(),
        ],
        sections: vec![
            Section::new("Samples of density 1", [Item::Plots(growing(&o)?)]),
            Section::new("Other densities", [Item::Table(table(&independent, &sobol, samples))]),
        ],
        command: format!("montecarlo --size {} --spp {}", o.size, o.spp),
        ..Page::default()
    };
    let to = o.out.join("montecarlo.html");
    std::fs::write(&to, page.html())?;
    println!("wrote {}", to.display());
    Ok(())
}

/// What a density makes of the integral, and the variance ∫ f²/p − 1 of its samples.
struct Density {
    name: &'static str,
    exact: f64,
    result: Estimation,
}

fn densities<S: Sampler>(s: S, n: u64) -> Result<[Density; 4], EstimateError> {
    let one = Integral::new(|u: f64| u, |_| 1.0, f).run(s, 0, n)?;
    let linear = Integral::new(f64::sqrt, |x| 2.0 * x, f).run(s, 0, n)?;
    let square = Integral::new(f64::cbrt, |x| 3.0 * x * x, f).run(s, 0, n)?;
    let alike = Integral::new(|u: f64| u.sqrt().sqrt(), f, f).run(s, 0, n)?;
    Ok([
        Density { name: "p = 1", exact: 9.0 / 7.0, result: one },
        Density { name: "p = 2x", exact: 1.0 / 3.0, result: linear },
        Density { name: "p = 3x²", exact: 1.0 / 15.0, result: square },
        Density { name: "p = 4x³", exact: 0.0, result: alike },
    ])
}

fn with_interval(e: &Estimation) -> String {
    format!("{:.6} ± {}", e.mean(), number(e.half_width(0.95)))
}

fn table(independent: &[Density], sobol: &[Density], samples: u64) -> Table {
    let row = |(a, b): (&Density, &Density)| {
        Row::new([
            Cell::text(a.name),
            Cell::number(number(a.result.variance)),
            Cell::number(number(a.exact)),
            Cell::number(with_interval(&a.result)),
            Cell::number(with_interval(&b.result)),
        ])
    };
    Table {
        caption: format!("{samples} samples"),
        head: ["Density", "Variance of a sample", "Exact", "Independent", "Sobol"].map(Into::into).into(),
        rows: independent.iter().zip(sobol).map(row).collect(),
        notes: vec![format!("Intervals of 95 %, from the scatter of {REPLICATES} replicates.")],
    }
}

/// Fig. 14.1: two estimates as they grow, and the mean and variance of many.
fn growing(o: &Options) -> Result<Vec<Plot>, EstimateError> {
    let counts = counts(o.spp);
    let random = estimates(o, &counts, |_| Independent::new(1, 1))?;
    let stratified = estimates(o, &counts, |n| Stratified::new(1, n))?;
    let integral = Integral::new(|u: f64| u, |_| 1.0, f);
    let single = |stream: u32| -> Result<Series, EstimateError> {
        let steps = integral.running(Independent::new(1, 1), stream.into()).take(o.spp as usize);
        let means: Vec<f64> = steps.map(|m| m.map(|m| m.mean())).collect::<Result<_, _>>()?;
        let points = counts.iter().map(|&n| Point::new(n.into(), means[n as usize - 1])).collect();
        Ok(Series { name: format!("estimator {}", stream + 1), points, ..Series::default() })
    };
    let series = |name: &str, of: &dyn Fn(u32, &Moments) -> Point, from: &[Moments]| Series {
        name: name.into(),
        points: counts.iter().zip(from).map(|(&n, m)| of(n, m)).collect(),
        ..Series::default()
    };
    // Straight on these axes.
    let ends = [1, o.spp];
    let theory = |name: &str, law: &dyn Fn(f64) -> f64, look| Series {
        name: name.into(),
        points: ends.map(|n| Point::new(n.into(), law(n.into()))).into(),
        line: Line::Dashed,
        look: Some(look),
    };
    // Estimators are independent of each other, whatever their points are.
    let mean = |n: u32, m: &Moments| {
        let half = 1.96 * m.standard_error();
        Point { low: Some(m.mean() - half), high: Some(m.mean() + half), ..Point::new(n.into(), m.mean()) }
    };
    let variance = |n: u32, m: &Moments| Point::new(n.into(), m.variance());
    Ok(vec![
        Plot {
            title: "Two estimators as they grow".into(),
            x: Axis::log("samples"),
            y: Axis::linear("estimate"),
            series: vec![single(0)?, single(1)?],
            ..Plot::default()
        },
        Plot {
            title: format!("Mean of {} estimators", o.size),
            x: Axis::log("samples of each"),
            y: Axis::linear("mean, with its interval of 95 %"),
            series: vec![series("independent", &mean, &random), theory("integral", &|_| 1.0, 2)],
            ..Plot::default()
        },
        Plot {
            title: format!("Variance of {} estimators", o.size),
            x: Axis::log("samples of each"),
            y: Axis::log("variance"),
            series: vec![
                series("independent", &variance, &random),
                series("stratified", &variance, &stratified),
                theory("9/7 N⁻¹", &|n| 9.0 / 7.0 / n, 0),
                theory("12/5 N⁻³", &|n| 2.4 / n.powi(3), 1),
            ],
            ..Plot::default()
        },
    ])
}

/// Numbers of samples, about eight to an octave.
fn counts(most: u32) -> Vec<u32> {
    let mut counts = vec![1];
    while let Some(&n) = counts.last().filter(|&&n| n < most) {
        counts.push((n + n.div_ceil(12)).min(most));
    }
    counts
}

/// Moments over all estimators of their value after each count of samples; `sampler` makes the point set of a count.
fn estimates<S: Sampler>(
    o: &Options,
    counts: &[u32],
    sampler: impl Fn(u32) -> S,
) -> Result<Vec<Moments>, EstimateError> {
    let integral = Integral::new(|u: f64| u, |_| 1.0, f);
    let mean = |n: u32, stream: u32| {
        let sum: Result<f64, _> = (0..n.into()).map(|i| integral.sample(sampler(n), stream.into(), i)).sum();
        sum.map(|sum| sum / f64::from(n))
    };
    counts.iter().map(|&n| (0..o.size).map(|stream| mean(n, stream)).collect()).collect()
}
