use std::sync::Arc;

use etendue_core::Fingerprint;
use etendue_sampling::AliasTable;

use crate::part_table::PartTable;
use crate::{Light, LightId, LightPicker, LitPoint, Pick};

/// Every light part in proportion to its power, wherever the question is asked. Parts without power are never chosen.
///
/// Constant time (alias table of Walker 1977).
#[derive(Clone, Debug)]
pub struct PowerPicker {
    table: PartTable,
    alias: AliasTable,
}

impl PowerPicker {
    /// From the lights' powers, those at infinity for a scene of `scene_radius` metres. `None` where nothing emits, or
    /// there are more than 2³² − 1 parts.
    pub fn new(lights: &[Arc<dyn Light>], scene_radius: f32) -> Option<Self> {
        let table = PartTable::new(lights)?;
        let weights = lights.iter().flat_map(|light| {
            (0..light.parts()).map(|part| {
                let [r, g, b] = light.power(part, scene_radius).to_array().map(usable);
                (r + g + b) / 3.0
            })
        });
        let alias = AliasTable::new(weights).ok()?;
        Some(Self { table, alias })
    }
}

/// A power as a weight: what is not a positive number is none, and too much for single precision is the most it holds.
fn usable(power: f32) -> f64 {
    if power > 0.0 { f64::from(power.clamp(0.0, f32::MAX)) } else { 0.0 }
}

impl LightPicker for PowerPicker {
    #[inline]
    fn pick(&self, _at: &LitPoint, u: f32) -> Option<Pick> {
        let s = self.alias.sample(u);
        // A power too small beside the others rounds to a probability of nothing.
        (s.pmf > 0.0).then(|| Pick { id: self.table.id(s.index as u32), pmf: s.pmf, u: s.u })
    }

    #[inline]
    fn pmf(&self, _at: &LitPoint, id: LightId) -> f32 {
        self.table.place(id).map_or(0.0, |place| self.alias.pmf(place as usize))
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("power picker");
        self.table.fingerprint(f);
        for place in 0..self.alias.len() {
            f.f32(self.alias.pmf(place));
        }
    }

    fn bytes(&self) -> usize {
        self.table.bytes() + self.alias.len() * 4 * size_of::<f32>()
    }
}
