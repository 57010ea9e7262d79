use etendue::core::Fingerprint;
use etendue::io::{Digest, FilmFile, FilmInfo, IndexRanges};
use etendue::sampling::{
    CorrelatedMultiJittered, Halton, Independent, LatinHypercube, Sampler, Sobol, Stratified,
};

use super::work::{Outcome, Work};
use crate::args::SamplerName;
use crate::error::CliError;

/// Renders with the sampler that was asked for.
pub(super) fn run(work: &Work<'_>, resumed: Option<FilmFile>) -> Result<Outcome, CliError> {
    let (seed, spp) = (work.settings.seed, work.settings.spp);
    match work.settings.sampler {
        SamplerName::Sobol => {
            with(work, Sobol::new(seed, spp).with_replicates(work.settings.replicates), resumed)
        }
        SamplerName::Stratified => with(work, Stratified::new(seed, spp), resumed),
        SamplerName::Halton => {
            with(work, Halton::new(seed, spp).with_replicates(work.settings.replicates), resumed)
        }
        SamplerName::Latin => with(work, LatinHypercube::new(seed, spp), resumed),
        SamplerName::Cmj => with(work, CorrelatedMultiJittered::new(seed, spp), resumed),
        SamplerName::Independent => with(work, Independent::new(seed, spp), resumed),
    }
}

fn with<S: Sampler>(work: &Work<'_>, sampler: S, resumed: Option<FilmFile>) -> Result<Outcome, CliError> {
    let bias = work.integrator.bias();
    let mut words = work.words.clone();
    words.insert("bias".into(), if bias.is_empty() { "none".into() } else { bias.join("; ") });
    let info = FilmInfo {
        scene: Digest::from(&work.scene.fingerprint()),
        settings: settings_digest(work, &sampler),
        words,
        samples: IndexRanges::new(),
    };
    let mut outcome = work.run(sampler, info, resumed)?;
    outcome.totals.bias = bias;
    Ok(outcome)
}

/// Everything beside the scene that decides a sample. The program's version is part of it: another one may draw
/// other numbers.
fn settings_digest<S: Sampler>(work: &Work<'_>, sampler: &S) -> Digest {
    let mut f = Fingerprint::default();
    f.tag(env!("CARGO_PKG_VERSION"));
    work.camera.fingerprint(&mut f);
    work.integrator.integrator::<S>().fingerprint(&mut f);
    sampler.fingerprint(&mut f);
    work.settings.filter.fingerprint(&mut f);
    Digest::from(&f)
}
