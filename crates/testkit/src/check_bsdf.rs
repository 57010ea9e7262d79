use etendue_bsdf::{Bsdf, BsdfSample, Lobes, Mode};
use etendue_core::{Spectrum, Vec2, Vec3A};

use crate::budget::{Budget, EXTREMES, Failure, Judge, Outcome, Random};
use crate::sphere_grid::SphereGrid;
use crate::stats::binomial_test;

/// Cosines of the outgoing directions tested, on both sides of the surface.
const COSINES: [f32; 5] = [0.98, 0.75, 0.4, 0.12, 0.02];
/// The two grids: one sees broad defects, the other local ones.
const GRIDS: [SphereGrid; 2] = [SphereGrid { rows: 20, cols: 20 }, SphereGrid { rows: 80, cols: 80 }];
const SAMPLES: usize = 40_000;
const PAIRS: usize = 2_000;

/// Tests a BSDF against the contract of [`Bsdf`].
///
/// For outgoing directions from the normal to grazing, on both sides and in both modes: samples are finite, unit and
/// within their lobes; `weight` is `eval / pdf` and `pdf` is that of the sample; the density integrates to the
/// sampled mass and fits the directions drawn (χ² on two grids); the mean weight is the integral of `eval`; no
/// energy is made (mean weight at most 1 in importance mode); swapping the directions swaps the modes (Veach 1997,
/// Eq. 5.14), and leaves reflection alone where [`Lobes::RECIPROCAL`] is declared; the fused and split calls agree
/// with the plain ones; extreme random numbers and grazing directions stay finite.
///
/// Power: a density wrong by 1 % over a hemisphere, or a mean weight wrong by 1 %, is rejected.
///
/// # Errors
/// The first [`Failure`].
pub fn check_bsdf(bsdf: &dyn Bsdf, budget: &Budget) -> Outcome {
    let directions = COSINES.len() * 2;
    let mut judge = Judge::new(budget, directions * 2 * (GRIDS.len() + 2));
    let mut random = budget.random(0xb5df);
    extremes(bsdf, &mut judge)?;
    exchange(bsdf, budget, &mut random, &mut judge)?;
    for (i, cos) in COSINES.iter().flat_map(|&c| [c, -c]).enumerate() {
        let phi = std::f64::consts::TAU * f64::from(random.unit());
        let sin = f64::from(1.0 - cos * cos).sqrt();
        let wo = Vec3A::new((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, cos);
        for mode in [Mode::Radiance, Mode::Importance] {
            density(bsdf, wo, mode, budget, &mut random, &mut judge)
                .map_err(|f| Failure { what: format!("{}; wo = {wo} (direction {i}), {mode:?}", f.what), ..f })?;
        }
    }
    judge.done()
}

fn close(a: f32, b: f32, relative: f32) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs())
}

fn close_spectra(a: Spectrum, b: Spectrum, relative: f32) -> bool {
    // Against the largest channel: a black channel of a coloured product is only rounding.
    let scale = a.max_channel().max(b.max_channel());
    (0..3).all(|c| (a[c] - b[c]).abs() <= relative * scale)
}

/// What must hold for any sample, whatever the input.
fn sound(bsdf: &dyn Bsdf, wo: Vec3A, s: &BsdfSample, judge: &mut Judge) -> Result<(), Failure> {
    let finite = s.wi.is_finite() && s.weight.is_finite() && s.pdf.is_finite() && s.eta.is_finite();
    judge.require(finite, "finite", || format!("{s:?} for wo = {wo}"))?;
    judge.require((s.wi.length() - 1.0).abs() < 1e-4, "unit", || format!("|wi| = {} for wo = {wo}", s.wi.length()))?;
    let positive = s.weight.to_array().iter().all(|&w| w >= 0.0) && s.pdf > 0.0 && s.eta > 0.0;
    judge.require(positive, "sign", || format!("{s:?} for wo = {wo}"))?;
    let known = bsdf.lobes().contains(s.lobe & !Lobes::RECIPROCAL);
    judge.require(known, "lobes", || format!("sampled {:?}, declared {:?}", s.lobe, bsdf.lobes()))?;
    let crossed = wo.z * s.wi.z < 0.0;
    let side = s.lobe.contains(Lobes::TRANSMISSION) == crossed || s.wi.z == 0.0 || wo.z == 0.0;
    judge.require(side, "side", || format!("{:?} from wo = {wo} to wi = {}", s.lobe, s.wi))
}

/// Extreme random numbers and grazing directions.
fn extremes(bsdf: &dyn Bsdf, judge: &mut Judge) -> Result<(), Failure> {
    for cos in [1.0f32, 0.5, 1e-3, 1e-7, 0.0, -1e-7, -1e-3, -0.5, -1.0] {
        let wo = Vec3A::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        for mode in [Mode::Radiance, Mode::Importance] {
            for u_lobe in EXTREMES {
                for u in EXTREMES.iter().flat_map(|&x| EXTREMES.map(|y| Vec2::new(x, y))) {
                    if let Some(s) = bsdf.sample(wo, u_lobe, u, mode) {
                        sound(bsdf, wo, &s, judge)?;
                        let (e, p) = (bsdf.eval(wo, s.wi, mode), bsdf.pdf(wo, s.wi, mode));
                        judge.require(e.is_finite() && p.is_finite() && p >= 0.0, "finite", || {
                            format!("eval {e:?}, pdf {p} for wo = {wo}, wi = {}", s.wi)
                        })?;
                    }
                }
            }
            let a = bsdf.albedo(wo);
            let ok = a.is_finite() && a.to_array().iter().all(|&c| (0.0..=1.5).contains(&c));
            judge.require(ok, "albedo", || format!("{a:?} for wo = {wo}"))?;
        }
    }
    Ok(())
}

/// Exchanging the directions, and the calls that must say the same.
fn exchange(bsdf: &dyn Bsdf, budget: &Budget, random: &mut Random, judge: &mut Judge) -> Result<(), Failure> {
    for _ in 0..budget.samples(PAIRS) {
        let wo = random.direction();
        let (u_lobe, u) = (random.unit(), random.pair());
        // Half the pairs where the BSDF is large, half anywhere.
        let wi = match bsdf.sample(wo, u_lobe, u, Mode::Radiance) {
            Some(s) if u_lobe < 0.5 => s.wi,
            _ => random.direction(),
        };
        // At grazing angles the quotient by the cosine is all rounding.
        if wo.z.abs() > 1e-2 && wi.z.abs() > 1e-2 {
            let there = bsdf.eval(wo, wi, Mode::Importance) / wi.z.abs();
            let back = bsdf.eval(wi, wo, Mode::Radiance) / wo.z.abs();
            judge.require(close_spectra(there, back, 2e-3), "adjoint", || {
                format!("f*({wo}, {wi}) = {there:?} in importance mode, f(wi, wo) = {back:?} in radiance mode")
            })?;
            if bsdf.lobes().contains(Lobes::RECIPROCAL) && wo.z * wi.z > 0.0 {
                let there = bsdf.eval(wo, wi, Mode::Radiance) / wi.z.abs();
                judge.require(close_spectra(there, back, 2e-3), "reciprocity", || {
                    format!("f({wo}, {wi}) = {there:?}, exchanged {back:?}")
                })?;
            }
        }
        for mode in [Mode::Radiance, Mode::Importance] {
            let (e, p) = (bsdf.eval(wo, wi, mode), bsdf.pdf(wo, wi, mode));
            let (fe, fp) = bsdf.eval_pdf(wo, wi, mode);
            let s = bsdf.scatter(wo, Some(wi), u_lobe, u, mode);
            let same = close_spectra(e, fe, 1e-5)
                && close(p, fp, 1e-5)
                && close_spectra(e, s.eval, 1e-5)
                && close(p, s.pdf, 1e-5)
                && s.sample == bsdf.sample(wo, u_lobe, u, mode);
            judge.require(same, "fused", || format!("eval_pdf or scatter differ from eval, pdf, sample at {wo}, {wi}"))?;
            let classes = bsdf.eval_classes(wo, wi, mode).into_iter().fold(Spectrum::BLACK, |a, b| a + b);
            judge.require(close_spectra(classes, e, 1e-5), "classes", || {
                format!("classes add up to {classes:?}, eval is {e:?} at {wo}, {wi}")
            })?;
        }
    }
    Ok(())
}

/// Density, mass, mean weight and energy for one outgoing direction.
fn density(
    bsdf: &dyn Bsdf,
    wo: Vec3A,
    mode: Mode,
    budget: &Budget,
    random: &mut Random,
    judge: &mut Judge,
) -> Result<(), Failure> {
    let n = budget.samples(SAMPLES);
    let mut observed = GRIDS.map(|g| vec![0u64; g.cells()]);
    let (mut spread, mut weights) = (0u64, etendue_sampling::Moments::default());
    let mut spread_weights = etendue_sampling::Moments::default();
    for _ in 0..n {
        let Some(s) = bsdf.sample(wo, random.unit(), random.pair(), mode) else {
            weights.add(0.0);
            spread_weights.add(0.0);
            continue;
        };
        sound(bsdf, wo, &s, judge)?;
        weights.add(f64::from(s.weight.max_channel()));
        let (e, p) = (bsdf.eval(wo, s.wi, mode), bsdf.pdf(wo, s.wi, mode));
        if s.lobe.contains(Lobes::DELTA) {
            spread_weights.add(0.0);
            continue;
        }
        judge.require(close(p, s.pdf, 2e-3), "pdf", || format!("sample says {}, pdf() says {p} at wi = {}", s.pdf, s.wi))?;
        judge.require(close_spectra(s.weight * s.pdf, e, 4e-3), "weight", || {
            format!("weight · pdf = {:?}, eval = {e:?} at wi = {}", s.weight * s.pdf, s.wi)
        })?;
        spread += 1;
        spread_weights.add(f64::from(s.weight.mean()));
        for (grid, cells) in GRIDS.iter().zip(&mut observed) {
            cells[grid.cell(s.wi)] += 1;
        }
    }
    let pdf = |wi: Vec3A| f64::from(bsdf.pdf(wo, wi, mode));
    for (grid, cells) in GRIDS.iter().zip(&observed) {
        let (chi2, mass) = grid.test(cells, n as u64, &pdf);
        judge.require(mass <= 1.002, "mass", || format!("the density integrates to {mass}"))?;
        // A few samples may be rounded across the border of the support.
        judge.require(chi2.impossible as f64 <= 1e-4 * n as f64 + 1.0, "support", || {
            format!("{} of {n} samples fell where the density is 0", chi2.impossible)
        })?;
        judge.p_value(chi2.p, "density", || {
            format!("directions do not fit the density: χ² = {:.1} with {} degrees of freedom", chi2.statistic, chi2.dof)
        })?;
        if grid.rows == GRIDS[0].rows {
            let test = binomial_test(spread, n as u64, mass.min(1.0));
            // Quadrature knows the mass to 1e-3; what is beyond must be chance.
            let p = if (test.estimate - mass).abs() < 1.5e-3 { 1.0 } else { test.p };
            judge.p_value(p, "mass", || format!("{} of the samples are spread, the density's mass is {mass}", test.estimate))?;
            let eval = |wi: Vec3A| f64::from(bsdf.eval(wo, wi, mode).mean());
            let integral: f64 = grid.integrate(cells, &eval).iter().sum();
            let (mean, se) = (spread_weights.mean(), spread_weights.standard_error());
            let off = ((mean - integral).abs() - 2e-3 * integral.max(mean)).max(0.0);
            let p = if off == 0.0 { 1.0 } else { crate::stats::p_of_z(off / se.max(1e-9)) };
            judge.p_value(p, "mean weight", || format!("samples say {mean}, the integral of eval is {integral}"))?;
        }
    }
    if mode == Mode::Importance {
        let (mean, se) = (weights.mean(), weights.standard_error());
        judge.require(mean - 6.0 * se <= 1.0 + 1e-4, "energy", || format!("the mean weight is {mean} ± {se}"))?;
    }
    Ok(())
}
