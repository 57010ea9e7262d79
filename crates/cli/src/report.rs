use etendue::integrator::{Counts, Ended};
use etendue::io::{FilmInfo, IndexRanges};
use serde_json::{Value, json};

use crate::session::{Spent, peak_bytes};

/// What all render calls of one command did together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Totals {
    pub(crate) samples: u64,
    pub(crate) rays: u64,
    pub(crate) rejected: u64,
    /// Places of the first rejected samples.
    pub(crate) rejected_at: Vec<String>,
    pub(crate) ended: Ended,
    pub(crate) bias: Vec<String>,
    pub(crate) needs: Vec<String>,
}

impl Totals {
    /// Adds what one call did.
    pub(crate) fn add(&mut self, r: &etendue::integrator::Report) {
        let rays: fn(&Counts) -> u64 = Counts::rays;
        self.samples += r.samples;
        self.rays += rays(&r.counts);
        self.rejected += r.rejected;
        let room = 8usize.saturating_sub(self.rejected_at.len());
        let place = |r: &etendue::integrator::Rejected| {
            format!("pixel {},{} sample {}", r.pixel.x, r.pixel.y, r.index)
        };
        self.rejected_at.extend(r.rejected_at.iter().take(room).map(place));
        self.ended = r.ended;
    }
}

/// Everything that the report of a render says.
pub(crate) struct RenderReport<'a> {
    pub(crate) scene: String,
    pub(crate) load: Spent,
    pub(crate) build: Spent,
    pub(crate) render: Spent,
    pub(crate) size: [u32; 2],
    pub(crate) seed: u64,
    pub(crate) sampler: String,
    pub(crate) integrator: String,
    pub(crate) filter: String,
    pub(crate) camera: String,
    pub(crate) info: &'a FilmInfo,
    pub(crate) totals: &'a Totals,
    pub(crate) skipped: &'a [String],
    pub(crate) warnings: &'a [String],
    pub(crate) outputs: Vec<String>,
    pub(crate) threads: usize,
}

impl RenderReport<'_> {
    pub(crate) fn json(&self) -> Value {
        let t = self.totals;
        json!({
            "scene": self.scene,
            "seconds": { "load": self.load.wall, "build": self.build.wall, "render": self.render.wall },
            "cpu_seconds": { "load": self.load.cpu, "build": self.build.cpu, "render": self.render.cpu },
            "spp": self.info.samples.count(),
            "rays": t.rays,
            "rejected": t.rejected,
            "rejected_at": t.rejected_at,
            "peak_bytes": peak_bytes(),
            "needs": t.needs,
            "skipped": self.skipped,
            "warnings": self.warnings,
            "size": self.size,
            "seed": self.seed,
            "sampler": self.sampler,
            "integrator": self.integrator,
            "filter": self.filter,
            "camera": self.camera,
            "threads": self.threads,
            "scene_hash": format!("{:032x}", self.info.scene.value),
            "settings_hash": format!("{:032x}", self.info.settings.value),
            "opaque": self.info.is_opaque(),
            "ended": ended(t.ended),
            "bias": t.bias,
            "outputs": self.outputs,
            "samples": t.samples,
            "sample_ranges": ranges(&self.info.samples),
        })
    }
}

pub(crate) fn ranges(samples: &IndexRanges) -> Vec<[u64; 2]> {
    samples.as_slice().iter().map(|r| [r.start, r.end]).collect()
}

fn ended(e: Ended) -> &'static str {
    match e {
        Ended::Complete => "complete",
        Ended::Time => "time",
        Ended::Cancelled => "interrupted",
        _ => "other",
    }
}

/// The bits of a census as words.
pub(crate) fn needs(needs: etendue::core::Needs) -> Vec<String> {
    needs.iter_names().map(|(name, _)| name.to_ascii_lowercase()).collect()
}
