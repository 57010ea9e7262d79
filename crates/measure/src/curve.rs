use crate::interval::{Measured, jackknife, jackknife_factor};
use crate::{Axis, Metric, Point};

/// Error against cost of one estimator: the same runs looked at at growing numbers of samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Of the contender.
    pub name: String,
    /// In order of samples.
    pub points: Vec<Point>,
}

/// What it takes to reach an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToError {
    /// The cost.
    pub cost: Measured,
    /// How it is known.
    pub known: Known,
}

/// How a cost is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Between two points, by a straight line on logarithms.
    Measured,
    /// The first point has less error already: it needs at most this.
    AtMost,
    /// Beyond the last point, along the fitted slope.
    Extrapolated,
}

impl Curve {
    /// Runs behind every point.
    pub fn runs(&self) -> usize {
        self.points.first().map_or(0, Point::runs)
    }

    /// Points whose error is mostly their own.
    fn usable(&self, metric: Metric) -> Vec<&Point> {
        let all: Vec<usize> = (0..self.runs()).collect();
        let usable = |p: &&Point| !p.is_limited_by_reference(metric) && p.error_of(metric, &all).is_some();
        self.points.iter().filter(usable).collect()
    }

    /// Exponent of the fall of the error with the cost: the slope of the least-squares line through the points on
    /// logarithms. −1 for independent samples, steeper for a good sequence. Points that are limited by the reference
    /// are left out; `None` below two others. Bias flattens it.
    pub fn slope(&self, metric: Metric, axis: Axis) -> Option<Measured> {
        let points = self.usable(metric);
        jackknife(self.runs(), |kept| slope_of(&points, metric, axis, kept))
    }

    /// The cost of reaching an error. `None` where the curve says nothing: no points, or no fall to go on along.
    pub fn to_error(&self, metric: Metric, target: f64, axis: Axis) -> Option<ToError> {
        let points = self.usable(metric);
        let all: Vec<usize> = (0..self.runs()).collect();
        let known = at_error(&points, metric, target, axis, &all)?.1;
        let cost =
            jackknife_factor(self.runs(), |kept| Some(at_error(&points, metric, target, axis, kept)?.0))?;
        Some(ToError { cost, known })
    }

    /// How many times as fast as `other` this reaches an error, where both are known to.
    pub fn speed_over(&self, other: &Self, metric: Metric, target: f64, axis: Axis) -> Option<Measured> {
        let (mine, theirs) = (self.usable(metric), other.usable(metric));
        jackknife_factor(self.runs().min(other.runs()), |kept| {
            let mine = at_error(&mine, metric, target, axis, kept)?;
            let theirs = at_error(&theirs, metric, target, axis, kept)?;
            let exact = mine.1 != Known::AtMost && theirs.1 != Known::AtMost;
            exact.then(|| theirs.0 / mine.0)
        })
    }

    /// The last point whose number of samples both curves have.
    pub fn last_common<'a>(&'a self, other: &'a Self) -> Option<(&'a Point, &'a Point)> {
        let mine = self.points.iter().rev();
        mine.filter_map(|p| Some((p, other.points.iter().find(|q| q.spp == p.spp)?))).next()
    }
}

fn logs(points: &[&Point], metric: Metric, axis: Axis, kept: &[usize]) -> Option<Vec<[f64; 2]>> {
    points.iter().map(|p| Some([p.cost_of(axis, kept)?.ln(), p.error_of(metric, kept)?.ln()])).collect()
}

fn slope_of(points: &[&Point], metric: Metric, axis: Axis, kept: &[usize]) -> Option<f64> {
    let logs = logs(points, metric, axis, kept)?;
    let n = logs.len() as f64;
    let [mx, my] = [0, 1].map(|i| logs.iter().map(|p| p[i]).sum::<f64>() / n);
    let sxx: f64 = logs.iter().map(|[x, _]| (x - mx).powi(2)).sum();
    let sxy: f64 = logs.iter().map(|[x, y]| (x - mx) * (y - my)).sum();
    (sxx > 0.0).then(|| sxy / sxx)
}

fn at_error(
    points: &[&Point],
    metric: Metric,
    target: f64,
    axis: Axis,
    kept: &[usize],
) -> Option<(f64, Known)> {
    if !(target > 0.0) {
        return None;
    }
    let logs = logs(points, metric, axis, kept)?;
    let want = target.ln();
    let reached = logs.iter().position(|[_, error]| *error <= want);
    match reached {
        Some(0) => Some((logs[0][0].exp(), Known::AtMost)),
        Some(i) => {
            let ([x0, y0], [x1, y1]) = (logs[i - 1], logs[i]);
            // The earlier point is above and the later one not: they differ.
            let t = (want - y0) / (y1 - y0);
            Some(((x0 + t * (x1 - x0)).exp(), Known::Measured))
        }
        None => {
            let slope = slope_of(points, metric, axis, kept).filter(|s| *s < 0.0)?;
            let [x, y] = *logs.last()?;
            Some(((x + (want - y) / slope).exp(), Known::Extrapolated))
        }
    }
}
