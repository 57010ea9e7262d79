use std::sync::Arc;

use etendue_core::Fingerprint;

use crate::part_table::PartTable;
use crate::{Light, LightId, LightPicker, LitPoint, Pick};

/// Every light part alike, dark ones included. Cheap, and only good where all parts matter alike.
#[derive(Clone, Debug)]
pub struct UniformPicker {
    table: PartTable,
    pmf: f32,
}

impl UniformPicker {
    /// `None` where there is nothing to choose from, or more than 2³² − 1 parts.
    pub fn new(lights: &[Arc<dyn Light>]) -> Option<Self> {
        let table = PartTable::new(lights)?;
        let pmf = (1.0 / f64::from(table.len())) as f32;
        (table.len() > 0).then_some(Self { table, pmf })
    }
}

impl LightPicker for UniformPicker {
    #[inline]
    fn pick(&self, _at: &LitPoint, u: f32) -> Option<Pick> {
        let n = self.table.len();
        let scaled = f64::from(u.clamp(0.0, 1.0)) * f64::from(n);
        let place = (scaled as u32).min(n - 1);
        let rest = (scaled - f64::from(place)) as f32;
        let u = if rest < 1.0 { rest } else { 1.0 - f32::EPSILON / 2.0 };
        Some(Pick { id: self.table.id(place), pmf: self.pmf, u })
    }

    #[inline]
    fn pmf(&self, _at: &LitPoint, id: LightId) -> f32 {
        if self.table.place(id).is_some() { self.pmf } else { 0.0 }
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("uniform picker");
        self.table.fingerprint(f);
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }
}
