use std::collections::BTreeMap;

use etendue_light::{LightId, LightPicker, LitPoint};

use crate::budget::{Budget, EXTREMES, Failure, Judge, Outcome, Random};
use crate::stats::chi2_test;

const SAMPLES: usize = 100_000;
/// Intervals of the stretched number.
const INTERVALS: usize = 16;

/// Tests a light picker against the contract of [`LightPicker`].
///
/// `ids` are all parts it may pick, `reaches` says whether a part sends light to a point. The probabilities add up
/// to 1 (or nothing is ever picked), `pmf` is that of the pick, picks fit the probabilities (χ²), the number handed
/// back is uniform within each part's share (χ² of parts × 16 intervals), and a part that sends light is never
/// impossible.
///
/// Power at effort 1, on 99 of 100 seeds: a probability wrong by a tenth for a part that is picked once in ten, or a
/// number that is not stretched.
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
        judge.require(pmf.iter().all(|p| (0.0..=1.0 + 1e-6).contains(p)), "probability", || {
            format!("{pmf:?}")
        })?;
        judge.require((total - 1.0).abs() < 1e-4 || total == 0.0, "total", || {
            format!("probabilities add up to {total}")
        })?;
        for (&id, &p) in ids.iter().zip(&pmf) {
            judge.require(p > 0.0 || !reaches(at, id), "impossible", || {
                format!("{id:?} sends light to {} but is never picked", at.p)
            })?;
        }
        if let Some(picks) = draw(picker, ids, at, &pmf, budget, &mut random, &mut judge)? {
            fit(&picks, &pmf, &mut judge)?;
        }
    }
    judge.done()
}

/// Picks by part and by interval of the stretched number; `None` where nothing can be picked.
fn draw(
    picker: &dyn LightPicker,
    ids: &[LightId],
    at: &LitPoint,
    pmf: &[f64],
    budget: &Budget,
    random: &mut Random,
    judge: &mut Judge,
) -> Result<Option<Vec<[u64; INTERVALS]>>, Failure> {
    let places: BTreeMap<LightId, usize> = ids.iter().enumerate().map(|(i, &id)| (id, i)).collect();
    let none = pmf.iter().all(|&p| p == 0.0);
    let mut picks = vec![[0u64; INTERVALS]; ids.len()];
    for i in 0..EXTREMES.len() + budget.samples(SAMPLES) {
        let extreme = EXTREMES.get(i).copied();
        let u = extreme.unwrap_or_else(|| random.unit());
        let Some(pick) = picker.pick(at, u) else {
            judge.require(none, "pick", || format!("nothing picked at u = {u}"))?;
            continue;
        };
        let place = places.get(&pick.id).copied();
        let p = place.and_then(|i| pmf.get(i)).copied().unwrap_or(f64::NAN);
        let Some(row) = place.and_then(|i| picks.get_mut(i)) else {
            return Err(Failure { test: "pick", what: format!("{:?} is not among the parts", pick.id) });
        };
        judge.require((0.0..1.0).contains(&pick.u), "remap", || format!("u = {} after picking", pick.u))?;
        judge.require((f64::from(pick.pmf) - p).abs() <= 1e-5 * p && p > 0.0, "pmf", || {
            format!("pick says {}, pmf says {p} for {:?}", pick.pmf, pick.id)
        })?;
        if extreme.is_none() {
            row[((pick.u * INTERVALS as f32) as usize).min(INTERVALS - 1)] += 1;
        }
    }
    Ok((!none).then_some(picks))
}

fn fit(picks: &[[u64; INTERVALS]], pmf: &[f64], judge: &mut Judge) -> Result<(), Failure> {
    let counts: Vec<u64> = picks.iter().map(|row| row.iter().sum()).collect();
    let n = counts.iter().sum::<u64>() as f64;
    let expected: Vec<f64> = pmf.iter().map(|p| p * n).collect();
    let chi2 = chi2_test(&counts, &expected);
    judge.p_value(chi2.p, "frequency", || {
        format!("χ² = {:.1} with {} degrees of freedom", chi2.statistic, chi2.dof)
    })?;
    let cells: Vec<u64> = picks.iter().flatten().copied().collect();
    let expected: Vec<f64> = pmf.iter().flat_map(|p| [p * n / INTERVALS as f64; INTERVALS]).collect();
    let chi2 = chi2_test(&cells, &expected);
    judge.p_value(chi2.p, "remap", || {
        format!(
            "the stretched numbers are not uniform within the parts: χ² = {:.1} with {} degrees of freedom",
            chi2.statistic, chi2.dof
        )
    })
}
