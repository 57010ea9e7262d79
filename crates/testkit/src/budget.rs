use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};

use etendue_core::{Vec2, Vec3A};
use etendue_sampling::{unit_f32, warp};

/// How hard a check suite looks, and how sure it must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Decides every random choice: the same seed gives the same verdict.
    pub seed: u64,
    /// Probability that a right part fails, over all tests of one call together.
    pub alpha: f64,
    /// Factor on the number of samples; the defect that is just seen shrinks with its root.
    pub effort: f64,
}

impl Default for Budget {
    fn default() -> Self {
        Self { seed: 1, alpha: 1e-6, effort: 1.0 }
    }
}

impl Budget {
    /// The same budget with another seed.
    #[must_use]
    pub fn seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// The same budget with another effort.
    #[must_use]
    pub fn effort(self, effort: f64) -> Self {
        Self { effort, ..self }
    }

    /// The same budget with another level.
    #[must_use]
    pub fn alpha(self, alpha: f64) -> Self {
        Self { alpha, ..self }
    }

    /// The budget of one of `calls` calls that together keep the level: for a property test over `calls` cases, or a
    /// list of parts.
    ///
    /// ```
    /// # use etendue_testkit::Budget;
    /// let each = Budget::default().shared(1000);
    /// assert!((each.alpha / 1e-9 - 1.0).abs() < 1e-3);
    /// ```
    #[must_use]
    pub fn shared(self, calls: usize) -> Self {
        Self { alpha: crate::stats::sidak(self.alpha, calls), ..self }
    }

    /// A number of samples scaled by the effort; at least 16.
    pub(crate) fn samples(&self, n: usize) -> usize {
        ((n as f64 * self.effort) as usize).max(16)
    }

    /// A source of random numbers of its own for each `key`.
    pub(crate) fn random(&self, key: u64) -> Random {
        Random(Pcg64Mcg::seed_from_u64(self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ key))
    }
}

/// What a suite found in order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Passed {
    /// Tests made.
    pub tests: usize,
    /// How many of them had chance in them.
    pub statistical: usize,
    /// The smallest p-value among the statistical ones; 1 if there were none.
    pub smallest_p: f64,
}

impl Passed {
    /// The probability that the smallest of so many independent p-values is this small. Over seeds it is uniform or
    /// larger: a suite whose values crowd near 0 is wrong itself, or sees a defect that is just below its power.
    pub fn p(&self) -> f64 {
        -(self.statistical as f64 * (-self.smallest_p).ln_1p()).exp_m1()
    }
}

/// The first thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Which test, in a word.
    pub test: &'static str,
    /// Where, what was found and what was expected.
    pub what: String,
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.test, self.what)
    }
}

impl std::error::Error for Failure {}

/// The verdict of a suite.
pub type Outcome = Result<Passed, Failure>;

/// Counts tests and shares the level among them. The number of statistical tests is said beforehand, so that each
/// can be judged as it is made.
pub(crate) struct Judge {
    level: f64,
    expected: usize,
    passed: Passed,
}

impl Judge {
    pub(crate) fn new(budget: &Budget, statistical_tests: usize) -> Self {
        let level = crate::stats::sidak(budget.alpha, statistical_tests);
        Self {
            level,
            expected: statistical_tests,
            passed: Passed { tests: 0, statistical: 0, smallest_p: 1.0 },
        }
    }

    /// A test that has no chance in it.
    pub(crate) fn require(
        &mut self,
        ok: bool,
        test: &'static str,
        what: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        self.passed.tests += 1;
        if ok { Ok(()) } else { Err(Failure { test, what: what() }) }
    }

    /// A statistical test.
    pub(crate) fn p_value(
        &mut self,
        p: f64,
        test: &'static str,
        what: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        self.passed.tests += 1;
        self.passed.statistical += 1;
        self.passed.smallest_p = self.passed.smallest_p.min(p);
        if p >= self.level {
            return Ok(());
        }
        Err(Failure { test, what: format!("{} (p = {p:.1e}, level {:.1e})", what(), self.level) })
    }

    pub(crate) fn done(self) -> Outcome {
        debug_assert!(self.passed.statistical <= self.expected, "{:?} of {}", self.passed, self.expected);
        Ok(self.passed)
    }
}

/// Uniform numbers for the suites' own choices.
pub(crate) struct Random(Pcg64Mcg);

impl Random {
    pub(crate) fn bits(&mut self) -> u32 {
        self.0.next_u32()
    }

    /// Uniform in `[0, 1)`.
    pub(crate) fn unit(&mut self) -> f32 {
        unit_f32(self.bits())
    }

    /// Uniform below `n`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        ((u64::from(self.bits()) * n as u64) >> 32) as usize
    }

    /// Uniform in `[0, 1)²`.
    pub(crate) fn pair(&mut self) -> Vec2 {
        Vec2::new(self.unit(), self.unit())
    }

    /// Uniform on the sphere.
    pub(crate) fn direction(&mut self) -> Vec3A {
        warp::sphere(self.pair())
    }
}

/// The ends of `[0, 1)` and its middle: what breaks samplers first.
pub(crate) const EXTREMES: [f32; 5] = [0.0, 1.0 / 16_777_216.0, 0.5, 0.75, 1.0 - 1.0 / 16_777_216.0];
