use etendue_core::Fingerprint;

use crate::{LightId, LightPicker, LitPoint, Pick};

/// The only light part there is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SinglePicker {
    /// The part.
    pub id: LightId,
}

impl SinglePicker {
    /// Always this part.
    pub fn new(id: LightId) -> Self {
        Self { id }
    }
}

impl LightPicker for SinglePicker {
    #[inline]
    fn pick(&self, _at: &LitPoint, u: f32) -> Option<Pick> {
        Some(Pick { id: self.id, pmf: 1.0, u })
    }

    #[inline]
    fn pmf(&self, _at: &LitPoint, id: LightId) -> f32 {
        if id == self.id { 1.0 } else { 0.0 }
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("single light");
        f.u64(u64::from(self.id.light) << 32 | u64::from(self.id.part));
    }
}
