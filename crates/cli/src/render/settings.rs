use std::collections::BTreeMap;
use std::ops::Range;

use etendue::camera::{Filter, Planes};
use etendue::core::UVec2;

use crate::args::{Aov, IntegratorChoice, Materials, Method, RenderArgs, SamplerName};
use crate::error::CliError;
use crate::prepare::Prepared;

/// Samples per pixel where nobody says how many.
const SPP: u32 = 64;
/// As many as will never be reached.
const UNLIMITED: u32 = 1 << 30;

/// How the samples are made, all flags read.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    pub(crate) spp: u32,
    /// Sample indices to draw.
    pub(crate) indices: Range<u64>,
    pub(crate) seed: u64,
    pub(crate) sampler: SamplerName,
    /// Independent parts of the point set.
    pub(crate) replicates: u32,
    pub(crate) integrator: IntegratorChoice,
    pub(crate) method: Method,
    pub(crate) filter: Filter,
    pub(crate) planes: Planes,
    /// Seconds.
    pub(crate) time: Option<f64>,
    materials: Materials,
    reference: bool,
}

impl Settings {
    pub(crate) fn of(args: &RenderArgs) -> Result<Self, CliError> {
        let spp = match (args.spp, args.time) {
            (Some(n), _) => n,
            (None, None) => SPP,
            (None, Some(_)) => {
                if args.sampler.divides() || args.shard.is_some() {
                    let why = format!(
                        "'--sampler {}' and '--shard' divide a number of samples",
                        args.sampler.word()
                    );
                    return Err(CliError::Usage(format!("{why}; give it with '--spp' beside '--time'")));
                }
                UNLIMITED
            }
        };
        let indices = args.shard.map_or(0..u64::from(spp), |s| s.indices(spp));
        if let Some(shard) = args.shard.filter(|_| indices.is_empty()) {
            let cure = format!("{spp} samples per pixel make at most {spp} parts");
            return Err(CliError::Usage(format!("'--shard {shard}' has no samples: {cure}")));
        }
        let has = |aov: Aov| args.aov.contains(&aov);
        Ok(Self {
            spp,
            indices,
            seed: args.method.seed,
            sampler: args.sampler,
            replicates: args.replicates,
            integrator: args.integrator.clone(),
            method: args.integrator.method.limited(args.method.max_depth),
            filter: args.method.filter,
            planes: Planes {
                albedo: has(Aov::Albedo),
                normal: has(Aov::Normal),
                depth: has(Aov::Depth),
                ids: has(Aov::Ids),
                alpha: has(Aov::Alpha),
            },
            time: args.time,
            materials: args.view.materials,
            reference: args.reference.is_some(),
        })
    }

    pub(crate) fn size_of(&self, prepared: &Prepared) -> UVec2 {
        prepared.camera.resolution()
    }

    pub(crate) fn sampler_word(&self) -> String {
        match self.sampler {
            s if s.divides() => format!("{} of {}", s.word(), self.spp),
            s => s.word().into(),
        }
    }

    pub(crate) fn integrator_word(&self) -> &str {
        &self.integrator.word
    }

    pub(crate) fn filter_word(&self) -> String {
        match self.filter {
            Filter::Box { radius } => format!("box:{radius}"),
            Filter::Tent { radius } => format!("tent:{radius}"),
            Filter::Gaussian { radius, .. } => format!("gaussian:{radius}"),
            Filter::Mitchell { radius, .. } => format!("mitchell:{radius}"),
        }
    }

    /// The settings as a film keeps them, so that two films that differ can say in what. Nothing that parts of one
    /// picture may differ in is among them.
    pub(crate) fn words(&self, prepared: &Prepared) -> BTreeMap<String, String> {
        let size = self.size_of(prepared);
        let depth = self.method.max_depth().map_or("none".to_owned(), |d| d.to_string());
        let mut words = vec![
            ("program", format!("etendue {}", env!("CARGO_PKG_VERSION"))),
            ("scene", prepared.scene_name.clone()),
            ("camera", prepared.camera_name.clone()),
            ("size", format!("{}x{}", size.x, size.y)),
            ("integrator", self.integrator_word().into()),
            ("max-depth", depth),
            ("sampler", self.sampler_word()),
            ("seed", self.seed.to_string()),
            ("filter", self.filter_word()),
            ("materials", if self.materials == Materials::GltfB { "gltf-b" } else { "default" }.into()),
            ("reference", if self.reference { "yes" } else { "no" }.into()),
        ];
        words.extend(prepared.environment.iter().map(|e| ("env", e.clone())));
        words.extend(prepared.variant.iter().map(|v| ("variant", v.clone())));
        words.into_iter().map(|(k, v)| (k.to_owned(), v)).collect()
    }
}
