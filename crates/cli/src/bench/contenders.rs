use etendue::camera::Filter;
use etendue::measure::{Contender, Estimator, RenderRun};
use etendue::sampling::{
    CorrelatedMultiJittered, Halton, Independent, LatinHypercube, Sampler, Sobol, Stratified,
};

use crate::args::{BenchArgs, Method, Ready, SamplerName};
use crate::error::CliError;
use crate::prepare::Built;
use crate::session::Interrupt;

/// One combination of the flags.
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) method: Method,
    sampler: SamplerName,
    /// Seed of its first run; the others follow.
    seed: u64,
}

/// Every integrator with every sampler, each once, and the first of them again with other seeds: what it differs from itself by
/// is the noise of the machine and of the estimate.
pub(super) fn entries(args: &BenchArgs) -> Vec<Entry> {
    let mut out = Vec::new();
    for integrator in &args.integrator {
        for &sampler in &args.sampler {
            let name = format!("{} {}", integrator.word, sampler.word());
            if out.iter().any(|e: &Entry| e.name == name) {
                continue;
            }
            out.push(Entry {
                name,
                method: integrator.method.limited(args.method.max_depth),
                sampler,
                seed: args.method.seed,
            });
        }
    }
    if let Some(first) = out.first() {
        let again = Entry {
            name: format!("{} again", first.name),
            seed: first.seed.wrapping_add(args.runs.into()),
            ..*first
        };
        out.insert(1, again);
    }
    out
}

/// The runs of one entry on a scene, for which its integrator is ready.
pub(super) fn contender<'a>(
    entry: &Entry,
    integrator: &'a Ready,
    runs: u32,
    filter: Filter,
    built: &'a Built,
    interrupt: &'a Interrupt,
) -> Result<Contender<'a>, CliError> {
    let seeds = (0..u64::from(runs)).map(|k| entry.seed.wrapping_add(k));
    let stage = Stage { integrator, filter, built, interrupt };
    let runs: Result<Vec<Box<dyn Estimator + 'a>>, CliError> = seeds
        .map(|seed| match entry.sampler {
            SamplerName::Sobol => stage.run(move |n| Sobol::new(seed, n), false),
            SamplerName::Stratified => stage.run(move |n| Stratified::new(seed, n), true),
            SamplerName::Halton => stage.run(move |n| Halton::new(seed, n), false),
            SamplerName::Latin => stage.run(move |n| LatinHypercube::new(seed, n), true),
            SamplerName::Cmj => stage.run(move |n| CorrelatedMultiJittered::new(seed, n), true),
            SamplerName::Independent => stage.run(move |n| Independent::new(seed, n), false),
        })
        .collect();
    Ok(Contender { name: entry.name.clone(), runs: runs? })
}

#[derive(Clone, Copy)]
struct Stage<'a> {
    integrator: &'a Ready,
    filter: Filter,
    built: &'a Built,
    interrupt: &'a Interrupt,
}

impl<'a> Stage<'a> {
    fn run<S: Sampler + 'a>(
        self,
        sampler: impl Fn(u32) -> S + 'a,
        anew: bool,
    ) -> Result<Box<dyn Estimator + 'a>, CliError> {
        let Built { scene, prepared } = self.built;
        let run = RenderRun::new(scene, &*prepared.camera, self.integrator.integrator(), sampler)?
            .filter(self.filter)
            .progress(self.interrupt);
        Ok(Box::new(if anew { run.anew() } else { run }))
    }
}
