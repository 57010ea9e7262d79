use etendue_core::Fingerprint;

use crate::{LightId, LitPoint};

/// The outcome of choosing a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// The part chosen.
    pub id: LightId,
    /// Probability of having chosen it.
    pub pmf: f32,
    /// The random number used, stretched back to `[0, 1)` within the chosen part's share.
    pub u: f32,
}

/// Chooses which light part to sample. `check_picker` of `etendue-testkit` tests any implementation.
pub trait LightPicker: Send + Sync {
    /// Chooses with `u` in `[0, 1)`; `None` where no light can reach the point.
    fn pick(&self, at: &LitPoint, u: f32) -> Option<Pick>;

    /// The probability of [`LightPicker::pick`] choosing `id`.
    fn pmf(&self, at: &LitPoint, id: LightId) -> f32;

    /// What decides the choice, for comparing scenes.
    fn fingerprint(&self, f: &mut Fingerprint) {
        f.opaque();
    }

    /// Bytes held, for the memory report.
    fn bytes(&self) -> usize {
        0
    }
}
