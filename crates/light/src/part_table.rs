use std::sync::Arc;

use etendue_core::Fingerprint;

use crate::{Light, LightId};

/// The parts of all lights in one row, light by light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PartTable {
    /// Place of each light's first part, and behind the last the number of all.
    first: Vec<u32>,
}

impl PartTable {
    /// `None` where the parts are more than 32 bits can name.
    pub(crate) fn new(lights: &[Arc<dyn Light>]) -> Option<Self> {
        let mut first = vec![0u32];
        let mut total = 0u32;
        for light in lights {
            total = total.checked_add(light.parts())?;
            first.push(total);
        }
        u32::try_from(lights.len()).ok()?;
        Some(Self { first })
    }

    pub(crate) fn len(&self) -> u32 {
        self.first.last().copied().unwrap_or(0)
    }

    /// The part at a place, which must be below [`PartTable::len`].
    #[inline]
    pub(crate) fn id(&self, place: u32) -> LightId {
        // Lights without parts share their first place with the next: the last light that begins at or before it.
        let light = self.first.partition_point(|&f| f <= place).saturating_sub(1);
        LightId { light: light as u32, part: place - self.first.get(light).copied().unwrap_or(0) }
    }

    /// Where a part is; `None` where there is no such part.
    #[inline]
    pub(crate) fn place(&self, id: LightId) -> Option<u32> {
        let light = id.light as usize;
        let (first, end) = (*self.first.get(light)?, *self.first.get(light + 1)?);
        (id.part < end - first).then(|| first + id.part)
    }

    pub(crate) fn fingerprint(&self, f: &mut Fingerprint) {
        for &v in &self.first {
            f.u64(u64::from(v));
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        self.first.capacity() * size_of::<u32>()
    }
}

#[cfg(test)]
mod tests {
    use etendue_core::{Spectrum, Vec2, Vec3A};
    use etendue_geometry::Surface;

    use super::*;
    use crate::{LightBounds, LightSample, LitPoint};

    struct Parts(u32);
    impl Light for Parts {
        fn parts(&self) -> u32 {
            self.0
        }
        fn sample(&self, _: &LitPoint, _: u32, _: Vec2) -> Option<LightSample> {
            None
        }
        fn pdf(&self, _: &LitPoint, _: u32, _: Vec3A, _: Option<&Surface>) -> f32 {
            0.0
        }
        fn power(&self, _: u32, _: f32) -> Spectrum {
            Spectrum::BLACK
        }
        fn bounds(&self, _: u32) -> Option<LightBounds> {
            None
        }
    }

    #[test]
    fn places_and_ids_are_inverse() {
        let lights: Vec<Arc<dyn Light>> = [0, 3, 0, 0, 1, 2, 0].map(|n| Arc::new(Parts(n)) as _).into();
        let table = PartTable::new(&lights).expect("few parts");
        assert_eq!(table.len(), 6);
        let ids: Vec<_> = (0..6).map(|i| table.id(i)).map(|id| (id.light, id.part)).collect();
        assert_eq!(ids, [(1, 0), (1, 1), (1, 2), (4, 0), (5, 0), (5, 1)]);
        for place in 0..6 {
            assert_eq!(table.place(table.id(place)), Some(place));
        }
        for (light, part) in [(0, 0), (1, 3), (6, 0), (7, 0), (9, 9)] {
            assert_eq!(table.place(LightId { light, part }), None);
        }
        let many: Vec<Arc<dyn Light>> = vec![Arc::new(Parts(u32::MAX)), Arc::new(Parts(1))];
        assert_eq!(PartTable::new(&many), None);
    }
}
