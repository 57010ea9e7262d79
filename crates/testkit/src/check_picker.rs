use etendue_light::{LightId, LightPicker, LitPoint};

use crate::budget::{Budget, EXTREMES, Failure, Judge, Outcome};
use crate::stats::{chi2_test, ks_uniform};

const SAMPLES: usize = 100_000;

/// Tests a light picker against the contract of [`LightPicker`].
///
/// `ids` are all parts it may pick, `reaches` says whether a part sends light to a point. The probabilities add up
/// to 1 (or nothing is ever picked), `pmf` is that of the pick, picks fit the probabilities (χ²), the remapped number
/// is uniform (Kolmogorov–Smirnov), and a part that sends light is never impossible.
///
/// Power: a probability wrong by 5 % for a part that is picked once in ten is rejected.
///
/// # Errors
/// The first [`Failure`].
pub fn check_picker(
    picker: &dyn LightPicker,
    ids: &[LightId],
    points: &[LitPoint],
    reaches: &dyn Fn(&LitPoint, LightId) -> bool,
    budget: &Budget,
) -> Outcome {
    let mut judge = Judge::new(budget, 2 * points.len());
    let mut random = budget.random(0x91c4);
    for at in points {
        let pmf: Vec<f64> = ids.iter().map(|&id| f64::from(picker.pmf(at, id))).collect();
        let total: f64 = pmf.iter().sum();
        judge.require(pmf.iter().all(|p| (0.0..=1.0 + 1e-6).contains(p)), "probability", || format!("{pmf:?}"))?;
        judge.require((total - 1.0).abs() < 1e-4 || total == 0.0, "total", || format!("probabilities add up to {total}"))?;
        for (&id, &p) in ids.iter().zip(&pmf) {
            judge.require(p > 0.0 || !reaches(at, id), "impossible", || {
                format!("{id:?} sends light to {} but is never picked", at.p)
            })?;
        }
        let n = budget.samples(SAMPLES);
        let mut counts = vec![0u64; ids.len()];
        let mut remapped = Vec::new();
        let us = EXTREMES.into_iter().chain((0..n).map(|_| random.unit())).collect::<Vec<_>>();
        for u in us {
            let Some(pick) = picker.pick(at, u) else {
                judge.require(total == 0.0, "pick", || format!("nothing picked at u = {u}"))?;
                continue;
            };
            let place = ids.iter().position(|&id| id == pick.id);
            let Some(i) = place else {
                return Err(Failure { test: "pick", what: format!("{:?} is not among the parts", pick.id) });
            };
            counts[i] += 1;
            judge.require((0.0..1.0).contains(&pick.u), "remap", || format!("u = {} after picking", pick.u))?;
            judge.require((f64::from(pick.pmf) - pmf[i]).abs() <= 1e-5 * pmf[i], "pmf", || {
                format!("pick says {}, pmf says {} for {:?}", pick.pmf, pmf[i], pick.id)
            })?;
            if remapped.len() < 10_000 && !EXTREMES.contains(&u) {
                remapped.push(f64::from(pick.u));
            }
        }
        if total == 0.0 {
            continue;
        }
        let picks: u64 = counts.iter().sum();
        let expected: Vec<f64> = pmf.iter().map(|p| p * picks as f64).collect();
        let chi2 = chi2_test(&counts, &expected);
        judge.require(chi2.impossible == 0, "impossible", || format!("{} picks of probability 0", chi2.impossible))?;
        judge.p_value(chi2.p, "frequency", || format!("χ² = {:.1} with {} degrees of freedom", chi2.statistic, chi2.dof))?;
        judge.p_value(ks_uniform(&mut remapped), "remap", || "the remapped numbers are not uniform".into())?;
    }
    judge.done()
}
