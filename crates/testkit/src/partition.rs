use etendue_core::{Vec3A, vector};

use crate::budget::Random;
use crate::cube::{Cell, OnCube, Sums};
use crate::stats::{Chi2, chi2_test_within};

/// Cells with about this many of the scouts each are made.
const CELLS: usize = 400;
/// The same for the coarse cells.
const GROUPS: usize = 24;
/// Every face is divided at least into 4 × 4.
const SHALLOWEST: u32 = 2;
/// The smallest cells have 2⁻¹⁸ of a face's side: a hundred times the rounding of a direction.
const DEEPEST: u32 = 18;
/// Subdivisions of a cell while densities are integrated over it.
const REFINEMENTS: u32 = 6;

/// A number with the error of the quadrature that gave it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Known {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Known {
    fn add(&mut self, o: Self) {
        self.value += o.value;
        self.error += o.error;
    }
}

/// One cell of the sphere.
struct Leaf {
    /// The coarse cell it is part of.
    group: usize,
    /// Samples that fell here.
    seen: u64,
    /// Integral of the density.
    density: Known,
    /// Integral of the other function.
    other: Known,
}

/// The sphere in cells that hold about equally much of what was drawn, with a density and another function integrated
/// over each.
///
/// *Scouts*, samples that are not tested, decide the cells, so a lobe of any width is divided as finely as one that
/// fills the hemisphere, and the counts stay multinomial. The integration refines where its two rules differ, where a
/// function is steep, and where a probe has met a value that no node has seen. Probes are the samples, so a peak between the nodes cannot be
/// overlooked if anything was drawn from it, and places around them at the distances that the samples have among
/// themselves, where the tails of narrow lobes reach into large cells.
pub(crate) struct Partition {
    leaves: Vec<Leaf>,
    groups: usize,
    /// Attempts to draw.
    attempts: u64,
}

/// A direction with the functions' values there.
#[derive(Clone, Copy)]
struct Probe {
    on: OnCube,
    value: [f64; 2],
    /// Whether it is a sample.
    counts: bool,
}

/// Places around the directions: each moved by a difference of two others, stretched or shrunk (the moves of
/// differential evolution, Storn & Price 1997).
fn around(directions: &[Vec3A], count: usize, random: &mut Random) -> Vec<Vec3A> {
    let mut any = || directions[random.below(directions.len())];
    (0..if directions.is_empty() { 0 } else { count })
        .filter_map(|i| {
            let stretch = [0.25, 1.0, 4.0][i % 3];
            let moved = any() + (any() - any()) * stretch;
            vector::try_normalize(moved)
        })
        .collect()
}

impl Partition {
    /// Divides by `scouts`, counts `samples` (what `attempts` gave), and integrates `f` (the density of the samples, and
    /// another function whose values are about `scale` times as large).
    pub(crate) fn new(
        scouts: &[Vec3A],
        samples: &[Vec3A],
        attempts: usize,
        scale: f64,
        random: &mut Random,
        f: &dyn Fn(Vec3A) -> [f64; 2],
    ) -> Self {
        let extra = around(scouts, samples.len() / 2, random);
        let probe = |d: Vec3A, counts| Probe { on: OnCube::of(d), value: f(d), counts };
        let mut probes: Vec<Probe> = samples.iter().map(|&d| probe(d, true)).collect();
        probes.extend(extra.into_iter().map(|d| probe(d, false)));
        let mut scouts: Vec<OnCube> = scouts.iter().map(|&d| OnCube::of(d)).collect();
        let (drawn, n) = (scouts.len(), attempts.max(1) as f64);
        let mut build = Build {
            out: Self { leaves: Vec::new(), groups: 0, attempts: attempts as u64 },
            f,
            leaf: (drawn / CELLS).max(4),
            group: (drawn / GROUPS).max(4),
            n,
            scale: if scale > 0.0 { scale } else { 1.0 },
        };
        for face in Cell::faces() {
            let on_face = |on: &OnCube| on.face == face.face;
            let s = split(&mut scouts, on_face);
            let p = split(&mut probes, |p| on_face(&p.on));
            let (scouts, probes) = (&mut scouts[..s], &mut probes[..p]);
            build.grow(face, 0, None, scouts, probes);
        }
        build.out
    }

    /// Integral of the density: the fraction of attempts that should succeed.
    pub(crate) fn mass(&self) -> Known {
        self.sum(|l| l.density)
    }

    /// Integral of the other function.
    pub(crate) fn other(&self) -> Known {
        self.sum(|l| l.other)
    }

    fn sum(&self, of: impl Fn(&Leaf) -> Known) -> Known {
        let mut out = Known::default();
        for leaf in &self.leaves {
            out.add(of(leaf));
        }
        out
    }

    /// Pearson's test on all cells: sees local defects.
    pub(crate) fn fine(&self) -> Chi2 {
        self.chi2(self.leaves.len(), |i, _| i)
    }

    /// Pearson's test on some dozens of cells: sees broad defects of half the size.
    pub(crate) fn coarse(&self) -> Chi2 {
        self.chi2(self.groups, |_, leaf| leaf.group)
    }

    fn chi2(&self, cells: usize, place: impl Fn(usize, &Leaf) -> usize) -> Chi2 {
        let mut seen = vec![0u64; cells];
        let mut expected = vec![Known::default(); cells];
        for (i, leaf) in self.leaves.iter().enumerate() {
            let c = place(i, leaf);
            seen[c] += leaf.seen;
            expected[c].add(leaf.density);
        }
        // What the density leaves out are the failed attempts.
        let (all, n) = (self.mass(), self.attempts as f64);
        let failed = self.attempts.saturating_sub(seen.iter().sum());
        if (1.0 - all.value) * n >= 5.0 {
            seen.push(failed);
            expected.push(Known { value: 1.0 - all.value, error: all.error });
        }
        let values: Vec<f64> = expected.iter().map(|e| e.value * n).collect();
        let errors: Vec<f64> = expected.iter().map(|e| e.error * n).collect();
        chi2_test_within(&seen, &values, &errors)
    }
}

/// The recursion over cells.
struct Build<'a> {
    out: Partition,
    f: &'a dyn Fn(Vec3A) -> [f64; 2],
    /// Scouts that a cell may hold.
    leaf: usize,
    /// Scouts that a coarse cell may hold.
    group: usize,
    n: f64,
    scale: f64,
}

impl Build<'_> {
    fn grow(
        &mut self,
        cell: Cell,
        depth: u32,
        group: Option<usize>,
        scouts: &mut [OnCube],
        probes: &mut [Probe],
    ) {
        let deep = depth >= SHALLOWEST;
        let is_leaf = deep && (scouts.len() <= self.leaf || depth >= DEEPEST);
        let group = match group {
            None if is_leaf || (deep && scouts.len() <= self.group) => {
                self.out.groups += 1;
                Some(self.out.groups - 1)
            }
            g => g,
        };
        if is_leaf {
            self.leaf(cell, depth, group.unwrap_or(0), probes);
            return;
        }
        let (mut scouts, mut probes) = (scouts, probes);
        for (q, quarter) in cell.quarters().into_iter().enumerate() {
            let (own, rest) = take(scouts, |on| quarter_of(&cell, on) == q);
            let (own_probes, rest_probes) = take(probes, |p| quarter_of(&cell, &p.on) == q);
            self.grow(quarter, depth + 1, group, own, own_probes);
            (scouts, probes) = (rest, rest_probes);
        }
    }

    fn leaf(&mut self, cell: Cell, depth: u32, group: usize, probes: &mut [Probe]) {
        let seen = probes.iter().filter(|p| p.counts).count() as u64;
        // A twentieth of the scatter of the count.
        let tolerance = 0.05 * (seen as f64 + 1.0).sqrt() / self.n;
        let mut sums = [Known::default(); 2];
        let coarse = cell.gauss(self.f);
        let left = REFINEMENTS.min(DEEPEST + 2 - depth.min(DEEPEST));
        self.integrate(cell, coarse, left, [tolerance, tolerance * self.scale], probes, &mut sums);
        let [density, other] = sums;
        self.out.leaves.push(Leaf { group, seen, density, other });
    }

    fn integrate(
        &self,
        cell: Cell,
        coarse: Sums,
        left: u32,
        tolerance: [f64; 2],
        probes: &mut [Probe],
        out: &mut [Known; 2],
    ) {
        let quarters = cell.quarters();
        let parts = quarters.map(|q| q.gauss(self.f));
        let fine = parts.iter().fold(Sums::default(), |a, &b| a.plus(b));
        let off = [0, 1].map(|k| (fine.integral[k] - coarse.integral[k]).abs());
        // Rules may agree by chance where most of the integral is near one node, or beside all of them.
        let steep = |k: usize| {
            let most = fine.peak[k] * fine.solid_angle;
            most > 4.0 * fine.integral[k] && most > tolerance[k]
        };
        let hidden = |k: usize| probes.iter().any(|p| p.value[k] > 4.0 * fine.peak[k]);
        let settled = (0..2).all(|k| off[k] <= tolerance[k] && !steep(k) && !hidden(k));
        if settled || left == 0 {
            for k in 0..2 {
                out[k].add(Known { value: fine.integral[k], error: off[k] });
            }
            return;
        }
        let mut probes = probes;
        for (q, quarter) in quarters.into_iter().enumerate() {
            let (own, rest) = take(probes, |p| quarter_of(&cell, &p.on) == q);
            self.integrate(quarter, parts[q], left - 1, tolerance.map(|t| t * 0.5), own, out);
            probes = rest;
        }
    }
}

/// Which quarter of a cell a point of its face lies in.
fn quarter_of(cell: &Cell, on: &OnCube) -> usize {
    let middle = cell.middle();
    usize::from(on.at[0] >= middle[0]) + 2 * usize::from(on.at[1] >= middle[1])
}

/// Moves what `belongs` to the front; returns how many.
fn split<T: Copy>(items: &mut [T], belongs: impl Fn(&T) -> bool) -> usize {
    let mut front = 0;
    for i in 0..items.len() {
        if belongs(&items[i]) {
            items.swap(front, i);
            front += 1;
        }
    }
    front
}

/// What `belongs`, and the rest.
fn take<T: Copy>(items: &mut [T], belongs: impl Fn(&T) -> bool) -> (&mut [T], &mut [T]) {
    let front = split(items, belongs);
    items.split_at_mut(front)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Budget;

    const TAU: f64 = std::f64::consts::TAU;

    /// Samples of the lobe (n + 1)/2π cosⁿ around an axis, and its density.
    fn lobe(axis: Vec3A, n: f64, count: usize, key: u64) -> Vec<Vec3A> {
        let mut random = Budget::default().random(key);
        let frame = etendue_core::Frame::from_normal(axis);
        (0..count)
            .map(|_| {
                // 1 − cos θ keeps its digits where the lobe is narrow.
                let one_minus_cos = -(f64::from(1.0 - random.unit()).ln() / (n + 1.0)).exp_m1();
                let sin = (one_minus_cos * (2.0 - one_minus_cos)).sqrt();
                let (s, c) = (TAU * f64::from(random.unit())).sin_cos();
                frame.to_world(Vec3A::new((sin * c) as f32, (sin * s) as f32, (1.0 - one_minus_cos) as f32))
            })
            .collect()
    }

    fn density(axis: Vec3A, n: f64) -> impl Fn(Vec3A) -> [f64; 2] {
        move |d| {
            // |d − a|² / 2 = 1 − cos.
            let off = (d - axis).to_array().map(f64::from);
            let one_minus_cos = 0.5 * (off[0] * off[0] + off[1] * off[1] + off[2] * off[2]);
            let p = if one_minus_cos < 1.0 {
                (n * (-one_minus_cos).ln_1p()).exp() * (n + 1.0) / TAU
            } else {
                0.0
            };
            [p, 2.0 * p]
        }
    }

    /// Lobes from a hemisphere to a thousandth of a radian, along an axis, slanted, and across a corner of the cube.
    /// The mutants, drawn with nine tenths of the exponent, must be seen (8 % rms).
    #[test]
    fn lobes_of_any_width_fit_their_density_and_no_other() {
        let mut random = Budget::default().random(99);
        let third = 1.0 / 3f32.sqrt();
        let axes = [Vec3A::Z, Vec3A::new(0.6, 0.0, 0.8), Vec3A::new(third, -third, third)];
        for (i, &axis) in axes.iter().enumerate() {
            for n in [1.0, 100.0, 1e4, 1e6] {
                let (scouts, samples) =
                    (lobe(axis, n, 5_000, 2 * i as u64), lobe(axis, n, 20_000, 2 * i as u64 + 1));
                let right = Partition::new(&scouts, &samples, 20_000, 2.0, &mut random, &density(axis, n));
                let (mass, other) = (right.mass(), right.other());
                assert!((mass.value - 1.0).abs() < 1e-3 && mass.error < 0.02, "n = {n}: {mass:?}");
                assert!((other.value - 2.0).abs() < 2e-3, "n = {n}: {other:?}");
                assert!(
                    right.fine().p > 1e-4 && right.coarse().p > 1e-4,
                    "{:?} {:?}",
                    right.fine(),
                    right.coarse()
                );
                let wider = lobe(axis, 0.9 * n, 20_000, 7);
                let wrong = Partition::new(&scouts, &wider, 20_000, 2.0, &mut random, &density(axis, n));
                // On a hemisphere a tenth less exponent moves too little.
                assert!(n == 1.0 || wrong.coarse().p < 1e-8, "n = {n}: {:?}", wrong.coarse());
            }
        }
    }

    #[test]
    fn outlines_are_integrated_within_the_stated_error() {
        // A cone of half angle 0.01 rad, of which nothing was drawn outside.
        let axis = Vec3A::new(0.6, 0.0, 0.8);
        let frame = etendue_core::Frame::from_normal(axis);
        let one_minus_cos = 5e-5f32;
        let mut random = Budget::default().random(9);
        let mut draw = |count: usize| -> Vec<Vec3A> {
            (0..count)
                .map(|_| frame.to_world(etendue_sampling::warp::cone(random.pair(), one_minus_cos)))
                .collect()
        };
        let (scouts, samples) = (draw(5_000), draw(20_000));
        let pdf = f64::from(etendue_sampling::warp::cone_pdf(one_minus_cos));
        let inside = |d: Vec3A| {
            let off = d - axis;
            let p = if 0.5 * off.dot(off) <= one_minus_cos { pdf } else { 0.0 };
            [p, 1.0]
        };
        let p = Partition::new(&scouts, &samples, 20_000, 1.0, &mut random, &inside);
        assert!((p.mass().value - 1.0).abs() < 2e-3 && p.mass().error < 0.05, "{:?}", p.mass());
        assert!((p.other().value / (2.0 * TAU) - 1.0).abs() < 1e-4, "{:?}", p.other());
        assert!(p.fine().p > 1e-4 && p.coarse().p > 1e-4);
    }
}
