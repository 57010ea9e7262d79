//! Integrals with known answers as pictures, and clocks that tests wind.
#![allow(dead_code)] // Each test file uses its part.

use std::cell::RefCell;
use std::error::Error;
use std::ops::Range;
use std::rc::Rc;
use std::sync::atomic::{AtomicU64, Ordering};

use etendue_core::Clock;
use etendue_measure::{Contender, Drawn, Estimator};
use etendue_sampling::{mix2, unit_f32};

/// Seconds that pass only when told to.
#[derive(Default)]
pub(crate) struct Wound(AtomicU64);

impl Wound {
    pub(crate) fn pass(&self, seconds: f64) {
        self.0.fetch_add((seconds * 1e9) as u64, Ordering::Relaxed);
    }
}

impl Clock for Wound {
    fn seconds(&self) -> f64 {
        self.0.load(Ordering::Relaxed) as f64 * 1e-9
    }
}

pub(crate) fn uniform(seed: u64, a: u64, b: u64) -> f64 {
    f64::from(unit_f32((mix2(mix2(seed, a), b) >> 32) as u32))
}

/// Who drew which samples.
pub(crate) type Log = RefCell<Vec<(char, Range<u64>)>>;

/// Variance of one sample of `2u`.
pub(crate) const VARIANCE: f64 = 1.0 / 3.0;

/// The mean of `factor` · 2u, which is `factor`, in every channel of every pixel.
pub(crate) struct Ramp<'a> {
    pub(crate) pixels: usize,
    pub(crate) factor: f64,
    pub(crate) seed: u64,
    pub(crate) clock: &'a Wound,
    /// Seconds a sample of the whole picture takes on a quiet machine.
    pub(crate) seconds: f64,
    /// Gives the machine's slowness at a moment: 1 is quiet.
    pub(crate) slowness: &'a dyn Fn(f64, u64) -> f64,
    pub(crate) anew: bool,
    pub(crate) log: Option<(char, Rc<Log>)>,
    pub(crate) sums: Vec<[f64; 3]>,
    pub(crate) count: u64,
}

impl<'a> Ramp<'a> {
    pub(crate) fn new(pixels: usize, seed: u64, clock: &'a Wound) -> Self {
        Self {
            pixels,
            factor: 1.0,
            seed,
            clock,
            seconds: 1e-3,
            slowness: &|_, _| 1.0,
            anew: false,
            log: None,
            sums: vec![[0.0; 3]; pixels],
            count: 0,
        }
    }
}

impl Estimator for Ramp<'_> {
    fn draw(&mut self, indices: Range<u64>) -> Result<Drawn, Box<dyn Error + Send + Sync>> {
        if let Some((name, log)) = &self.log {
            log.borrow_mut().push((*name, indices.clone()));
        }
        let n = indices.end - indices.start;
        for (pixel, sum) in self.sums.iter_mut().enumerate() {
            for (c, s) in sum.iter_mut().enumerate() {
                for index in indices.clone() {
                    *s += self.factor * 2.0 * uniform(self.seed, (3 * pixel + c) as u64, index);
                }
            }
        }
        self.count += n;
        let slowness = (self.slowness)(self.clock.seconds(), mix2(self.seed, indices.end));
        self.clock.pass(self.seconds * n as f64 * slowness);
        Ok(Drawn { samples: n * self.pixels as u64, rays: 3 * n * self.pixels as u64, ..Drawn::default() })
    }

    fn reset(&mut self) {
        self.sums.fill([0.0; 3]);
        self.count = 0;
    }

    fn picture(&self) -> Vec<[f32; 3]> {
        self.sums.iter().map(|s| s.map(|v| (v / self.count as f64) as f32)).collect()
    }

    fn starts_anew(&self) -> bool {
        self.anew
    }
}

/// Runs of one estimator that differ in their seeds.
pub(crate) fn contender<'a>(name: &str, runs: u64, mut run: impl FnMut(u64) -> Ramp<'a>) -> Contender<'a> {
    Contender { name: name.into(), runs: (0..runs).map(|k| Box::new(run(k)) as Box<dyn Estimator>).collect() }
}
