use std::f64::consts::TAU;

use etendue_core::{Aabb, Ray, Vec3A, vector};
use etendue_geometry::Shape;

use crate::budget::{Failure, Judge, Random};
use crate::stats::mean_test;

/// Cells along one axis of the bounds.
const SIDE: usize = 6;
/// Entries, of either kind, that a cell needs to be compared.
const LEAST: f64 = 100.0;

/// Where lines and samples met the surface, in cells of the bounds.
pub(super) struct Places {
    bounds: Aabb,
    /// Crossings of each line.
    counts: Vec<f64>,
    /// Sum and sum of squares over lines of the crossings in each cell.
    cells: Vec<Entry>,
}

#[derive(Clone, Copy, Default)]
struct Entry {
    sum: f64,
    squares: f64,
    lines: f64,
}

impl Entry {
    fn add(&mut self, x: f64) {
        self.sum += x;
        self.squares += x * x;
        self.lines += 1.0;
    }
}

impl Places {
    pub(super) fn new(bounds: &Aabb) -> Self {
        Self { bounds: *bounds, counts: Vec::new(), cells: vec![Entry::default(); SIDE.pow(3)] }
    }

    fn cell(&self, p: Vec3A) -> usize {
        let extent = self.bounds.extent();
        let at = |i: usize| {
            let x = (p[i] - self.bounds.lo[i]) / extent[i];
            // A flat side is not divided: its coordinates are all rounding.
            if x > 0.0 && extent[i] > 1e-4 * self.bounds.radius() {
                ((x * SIDE as f32) as usize).min(SIDE - 1)
            } else {
                0
            }
        };
        (at(0) * SIDE + at(1)) * SIDE + at(2)
    }

    pub(super) fn add_line(&mut self, crossings: &[Vec3A]) {
        self.counts.push(crossings.len() as f64);
        let mut cells: Vec<usize> = crossings.iter().map(|&p| self.cell(p)).collect();
        cells.sort_unstable();
        // One line counts once per cell, with as many crossings as it has there.
        for run in cells.chunk_by(|a, b| a == b) {
            self.cells[run[0]].add(run.len() as f64);
        }
    }
}

/// The claimed area against the lines, and the samples against both.
pub(super) fn check(
    shape: &dyn Shape,
    places: &Places,
    lines: usize,
    radius: f32,
    samples: usize,
    random: &mut Random,
    judge: &mut Judge,
) -> Result<(), Failure> {
    let area = shape.area();
    judge.require(area >= 0.0 && area.is_finite(), "area", || format!("{area}"))?;
    let bounded = places.bounds.is_finite();
    // The mean number of crossings of such a line is A / (2 π R²).
    let of_line = TAU * f64::from(radius) * f64::from(radius);
    if area > 0.0 && bounded {
        let test = mean_test(&places.counts, f64::from(area) / of_line);
        judge.p_value(test.p, "area", || {
            format!("lines cross {} times in the mean, the area says {}", test.estimate, test.truth)
        })?;
    }
    let mut areas = Vec::new();
    let (mut lost, mut example) = (0, None);
    let mut cells = vec![Entry::default(); SIDE.pow(3)];
    for _ in 0..samples {
        let Some(s) = shape.sample(random.pair()) else { continue };
        judge.require(area > 0.0, "sample", || "a shape without area gives samples".into())?;
        let weight = 1.0 / f64::from(s.pdf_area);
        areas.push(weight);
        cells[places.cell(s.p)].add(weight);
        // A ray onto the point from its front finds the shape there.
        let height = 0.01 * radius;
        let ray = Ray::new(s.p + s.ng * height, -s.ng);
        let hit = shape.intersect(&ray).filter(|h| h.t <= height * 1.01 + vector::length(s.p) * 1e-5);
        let found = hit.map(|h| shape.surface(&ray, &h));
        if !found.is_some_and(|f| f.ng.dot(s.ng) > 0.9) {
            lost += 1;
            example = Some(s);
        }
    }
    // In a sharp crease something else may stand in front.
    judge.require(f64::from(lost) <= 0.01 * areas.len() as f64, "sample", || {
        format!("no such surface under {lost} of {} samples: {example:?}", areas.len())
    })?;
    if areas.is_empty() {
        return Ok(());
    }
    let test = mean_test(&areas, f64::from(area));
    judge.p_value(test.p, "density", || {
        format!("1/pdf is {} in the mean, the area {}", test.estimate, test.truth)
    })?;
    if !bounded {
        return Ok(());
    }
    let n = samples as f64;
    let (mut statistic, mut dof) = (0.0, 0.0);
    for (by_lines, by_samples) in places.cells.iter().zip(&cells) {
        if by_lines.lines + by_samples.lines < LEAST {
            continue;
        }
        // Area in the cell by either, in m², and the variances.
        let a = by_lines.sum / lines as f64 * of_line;
        let b = by_samples.sum / n;
        let va = by_lines.squares * (of_line / lines as f64).powi(2);
        let vb = by_samples.squares / (n * n);
        statistic += (a - b) * (a - b) / (va + vb);
        dof += 1.0;
    }
    let p = if dof > 0.0 && statistic > 0.0 {
        statrs::function::gamma::gamma_ur(0.5 * dof, 0.5 * statistic)
    } else {
        1.0
    };
    judge.p_value(p, "distribution", || {
        format!("samples do not lie as the area does: χ² = {statistic:.1} with {dof} degrees of freedom")
    })
}
