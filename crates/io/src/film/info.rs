use std::collections::BTreeMap;

use etendue_core::Fingerprint;

use super::IndexRanges;

/// A digest of what decides a picture, and whether equality proves anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Digest {
    /// The number.
    pub value: u128,
    /// Whether a part that cannot describe itself went in: equal digests are then no proof.
    pub opaque: bool,
}

impl From<&Fingerprint> for Digest {
    fn from(f: &Fingerprint) -> Self {
        Self { value: f.value(), opaque: f.is_opaque() }
    }
}

/// What a film was made of and which samples it holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FilmInfo {
    /// The scene's fingerprint.
    pub scene: Digest,
    /// That of camera, integrator, sampler and filter, made by the caller. What may differ between parts of one
    /// picture (the number of samples asked for, the threads) must stay out of it.
    pub settings: Digest,
    /// The settings in words, so that a difference can be named: `seed` → `1`. Told, not compared, while the digests
    /// are equal.
    pub words: BTreeMap<String, String>,
    /// Sample indices that every pixel has, and no pixel more.
    pub samples: IndexRanges,
}

impl FilmInfo {
    /// Whether equality of the digests is no proof, since a user's part does not describe itself.
    pub fn is_opaque(&self) -> bool {
        self.scene.opaque || self.settings.opaque
    }

    /// The settings that differ, in words: `seed: 1 and 2; filter: box:0.5 and none`. Empty where no word differs.
    pub fn differences(&self, other: &Self) -> String {
        let mut keys: Vec<&String> = self.words.keys().chain(other.words.keys()).collect();
        keys.sort();
        keys.dedup();
        let word = |info: &Self, key: &String| info.words.get(key).map_or("none", String::as_str).to_owned();
        let differing: Vec<String> = keys
            .into_iter()
            .map(|key| (key, word(self, key), word(other, key)))
            .filter(|(_, a, b)| a != b)
            .map(|(key, a, b)| format!("{key}: {a} and {b}"))
            .collect();
        differing.join("; ")
    }
}
