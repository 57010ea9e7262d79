use std::error::Error;

use etendue_core::{Clock, Progress};

use crate::{Contender, Costs, Curve, Point, Reference};

/// How far a measurement goes: to the first limit reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Most samples per pixel of a run.
    pub spp: u64,
    /// A contender goes on to the next point as long as that would not take one of its runs longer than this, seconds
    /// by the wall.
    pub seconds: Option<f64>,
}

/// The clocks that a measurement reads; the library has none of its own.
#[derive(Clone, Copy)]
pub struct Clocks<'a> {
    /// Seconds by the wall.
    pub wall: &'a dyn Clock,
    /// Seconds of all threads of the process together, which a busy machine disturbs less.
    pub cpu: Option<&'a dyn Clock>,
}

/// Why there is no measurement.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeasureError {
    /// A contender failed.
    #[error("'{name}' failed: {source}")]
    Contender {
        /// Its name.
        name: String,
        /// Why.
        source: Box<dyn Error + Send + Sync>,
    },
    /// A contender without runs.
    #[error("'{0}' has no runs")]
    NoRuns(String),
    /// Not the reference's size.
    #[error("'{name}' has {found} pixels and the reference {expected}; make both in one size")]
    Size {
        /// Of the contender.
        name: String,
        /// Its pixels.
        found: usize,
        /// The reference's.
        expected: usize,
    },
}

/// Error against cost of one estimator. See [`race`].
///
/// # Errors
/// As [`race`].
pub fn convergence(
    render: Contender<'_>,
    reference: Option<&Reference>,
    budget: &Budget,
    clocks: Clocks<'_>,
) -> Result<Curve, MeasureError> {
    let name = render.name.clone();
    let curves = race(&mut [render], reference, budget, clocks, &())?;
    Ok(curves.into_iter().next().unwrap_or(Curve { name, points: Vec::new() }))
}

/// Error against cost of several estimators of one picture, measured side by side.
///
/// The numbers of samples are 1, 2, 4 … up to the budget. Up to each of them the contenders draw in turn, run by run:
/// A B A B …; so they share whatever else the machine does. Only drawing is timed. Every contender draws one sample
/// before the clocks start. A contender that would exceed its time, or that is stopped, has a shorter curve; a point
/// that not all runs reached is left out. Without a reference only variance is known.
///
/// # Errors
/// A contender without runs, one whose picture has not the size of the reference, or one that failed.
pub fn race(
    contenders: &mut [Contender<'_>],
    reference: Option<&Reference>,
    budget: &Budget,
    clocks: Clocks<'_>,
    progress: &dyn Progress,
) -> Result<Vec<Curve>, MeasureError> {
    let mut lanes = Vec::new();
    for c in contenders.iter_mut() {
        lanes.push(Lane::warm(c, reference)?);
    }
    let runs = lanes.iter().map(|l| l.costs.len()).max().unwrap_or(0);
    let (mut from, mut spp) = (0, 1.min(budget.spp));
    while from < spp {
        lanes.iter_mut().for_each(|l| l.running &= l.affords(spp, budget));
        for run in 0..runs {
            for (lane, contender) in lanes.iter_mut().zip(contenders.iter_mut()) {
                if lane.running && !progress.cancelled() {
                    lane.draw(contender, run, from..spp, clocks)?;
                }
            }
        }
        if progress.cancelled() {
            break;
        }
        for (lane, contender) in lanes.iter_mut().zip(contenders.iter()) {
            lane.look(contender, spp, reference)?;
        }
        if !lanes.iter().any(|l| l.running) {
            break;
        }
        (from, spp) = (spp, spp.saturating_mul(2).min(budget.spp));
        progress.update(from, budget.spp);
    }
    Ok(lanes.into_iter().map(|l| l.curve).collect())
}

/// A contender on its way.
struct Lane {
    curve: Curve,
    costs: Vec<Costs>,
    running: bool,
}

impl Lane {
    /// Draws one sample that does not count, so that no contender pays for cold caches, and looks at the size.
    fn warm(contender: &mut Contender<'_>, reference: Option<&Reference>) -> Result<Self, MeasureError> {
        let name = contender.name.clone();
        let runs = contender.runs.len();
        let first = contender.runs.first_mut().ok_or_else(|| MeasureError::NoRuns(name.clone()))?;
        first.draw(0..1).map_err(|source| MeasureError::Contender { name: name.clone(), source })?;
        let found = first.picture().len();
        first.reset();
        if let Some(expected) = reference.map(|r| r.rgb.len()).filter(|n| *n != found) {
            return Err(MeasureError::Size { name, found, expected });
        }
        let curve = Curve { name, points: Vec::new() };
        Ok(Self { curve, costs: vec![Costs::default(); runs], running: true })
    }

    /// Whether the next point stays within the time, if time grows with the samples.
    fn affords(&self, spp: u64, budget: &Budget) -> bool {
        let (Some(limit), Some(last)) = (budget.seconds, self.curve.points.last()) else { return true };
        let longest = self.costs.iter().map(|c| c.seconds).fold(0.0, f64::max);
        longest * (spp as f64 / last.spp as f64) <= limit
    }

    fn draw(
        &mut self,
        contender: &mut Contender<'_>,
        run: usize,
        mut indices: std::ops::Range<u64>,
        clocks: Clocks<'_>,
    ) -> Result<(), MeasureError> {
        let (Some(estimator), Some(costs)) = (contender.runs.get_mut(run), self.costs.get_mut(run)) else {
            return Ok(());
        };
        if estimator.starts_anew() {
            estimator.reset();
            indices.start = 0;
            *costs = Costs::default();
        }
        let cpu = || clocks.cpu.map(Clock::seconds);
        let (cpu_before, before) = (cpu(), clocks.wall.seconds());
        let drawn = estimator.draw(indices);
        let (after, cpu_after) = (clocks.wall.seconds(), cpu());
        let drawn =
            drawn.map_err(|source| MeasureError::Contender { name: contender.name.clone(), source })?;
        costs.seconds += after - before;
        let spent = cpu_before.zip(cpu_after).map(|(a, b)| b - a);
        costs.cpu_seconds = spent.map(|s| costs.cpu_seconds.unwrap_or(0.0) + s);
        costs.samples += drawn.samples;
        costs.rays += drawn.rays;
        costs.rejected += drawn.rejected;
        self.running &= !drawn.stopped;
        Ok(())
    }

    /// Adds a point.
    fn look(
        &mut self,
        contender: &Contender<'_>,
        spp: u64,
        reference: Option<&Reference>,
    ) -> Result<(), MeasureError> {
        if self.running {
            let pictures: Vec<_> = contender.runs.iter().map(|r| r.picture()).collect();
            let point = Point::new(spp, self.costs.clone(), &pictures, reference)
                .map_err(|e| MeasureError::Contender { name: contender.name.clone(), source: Box::new(e) })?;
            self.curve.points.push(point);
        }
        Ok(())
    }
}
