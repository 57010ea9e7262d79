use etendue_core::{Needs, Spectrum, Vec3A, math, vector};
use etendue_geometry::Surface;
use etendue_scene::Body;

/// Bodies that a path can be in at once; more are not kept apart.
const DEEPEST: usize = 8;

/// The bodies that a path is inside of, innermost last, for what they absorb.
///
/// A body is entered by a transmission to the back of its surface and left by one to the front; which is left is told by
/// its material. In nested bodies the one entered last absorbs. A path that starts inside of a body does not know it.
/// Past [`DEEPEST`] the innermost entry is replaced.
#[derive(Clone, Copy)]
pub(crate) struct Inside {
    /// Material and absorption, m⁻¹.
    bodies: [(u32, Spectrum); DEEPEST],
    count: usize,
}

impl Inside {
    /// Outside of everything.
    pub(crate) fn nothing() -> Self {
        Self { bodies: [(0, Spectrum::BLACK); DEEPEST], count: 0 }
    }

    /// The same for a scene; `None` where no body absorbs.
    #[inline(always)]
    pub(crate) fn of(needs: Needs) -> Option<Self> {
        needs.contains(Needs::ABSORPTION).then(Self::nothing)
    }

    /// What is left of light after `distance` metres here; infinitely far, only what is not absorbed at all.
    #[inline]
    pub(crate) fn transmittance(&self, distance: f32) -> Spectrum {
        let Some((_, sigma)) = self.count.checked_sub(1).map(|i| self.bodies[i]) else {
            return Spectrum::ONE;
        };
        sigma.map(|s| if s > 0.0 { math::exp(-(s * distance)) } else { 1.0 })
    }

    /// Where a direction leads from a surface that bounds `body`, coming from `wo`; both by their cosines with the
    /// surface's normal.
    #[inline]
    #[must_use]
    pub(crate) fn beyond(self, body: Body, wo_ng: f32, wi_ng: f32) -> Self {
        if (wo_ng >= 0.0) == (wi_ng >= 0.0) {
            self
        } else {
            self.across(body.material, body.absorption, wi_ng < 0.0)
        }
    }

    /// What is left of light that comes to a surface, which bounds `body` and is seen along `wo`, from `end` along `wi`;
    /// `None` is infinitely far.
    pub(crate) fn on_the_way(
        &self,
        surface: &Surface,
        body: Option<Body>,
        wo: Vec3A,
        wi: Vec3A,
        end: Option<Vec3A>,
    ) -> Spectrum {
        let there = body.map_or(*self, |b| self.beyond(b, wo.dot(surface.ng), wi.dot(surface.ng)));
        there.transmittance(end.map_or(f32::INFINITY, |p| vector::length(p - surface.p)))
    }

    /// On the other side of a surface of `material`, which bounds a body that absorbs `sigma`; `inward` is to its back.
    #[must_use]
    fn across(mut self, material: u32, sigma: Spectrum, inward: bool) -> Self {
        if inward {
            let at = self.count.min(DEEPEST - 1);
            self.bodies[at] = (material, sigma);
            self.count = at + 1;
        } else if let Some(at) = self.bodies[..self.count].iter().rposition(|(m, _)| *m == material) {
            self.bodies.copy_within(at + 1..self.count, at);
            self.count -= 1;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sigma(inside: &Inside) -> f32 {
        -math::ln(inside.transmittance(1.0).r())
    }

    #[test]
    fn the_last_one_entered_absorbs() {
        let (water, ink) = (Spectrum::gray(0.5), Spectrum::gray(2.0));
        let i = Inside::nothing();
        assert_eq!(i.transmittance(f32::INFINITY), Spectrum::ONE);
        let i = i.across(1, water, true);
        assert!((sigma(&i) - 0.5).abs() < 1e-6);
        assert_eq!(i.transmittance(f32::INFINITY), Spectrum::BLACK);
        let i = i.across(2, ink, true);
        assert!((sigma(&i) - 2.0).abs() < 1e-6);
        // The outer one may be left first.
        assert!((sigma(&i.across(1, water, false)) - 2.0).abs() < 1e-6);
        let i = i.across(2, ink, false);
        assert!((sigma(&i) - 0.5).abs() < 1e-6);
        // A body never entered is not left.
        assert!((sigma(&i.across(7, ink, false)) - 0.5).abs() < 1e-6);
        assert_eq!(i.across(1, water, false).count, 0);
    }

    #[test]
    fn too_deep_is_not_a_panic() {
        let mut i = Inside::nothing();
        for m in 0..20 {
            i = i.across(m, Spectrum::gray(m as f32), true);
        }
        assert!((sigma(&i) - 19.0).abs() < 1e-4);
        for m in (0..20).rev() {
            i = i.across(m, Spectrum::BLACK, false);
        }
        assert_eq!(i.count, 0);
    }
}
