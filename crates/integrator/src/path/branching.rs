use super::leg::Carried;

/// How many ways a path goes on from a surface: the branching factor. Unbiased, whatever the numbers.
///
/// Each branch draws its own light and its own direction, from an independent point of the sampler, and carries its part
/// of the weight. One is path tracing (Kajiya 1986); more multiply the rays with every level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Branching {
    /// Ways that a path goes on; 0 and 1 are one way.
    pub factor: u32,
    /// Scattering events at which it branches, from the camera on. Past [`Branching::MOST`] branches of a camera
    /// ray it does not branch any more.
    pub levels: u32,
}

impl Branching {
    /// Most paths that one camera ray is split into.
    pub const MOST: u32 = 1 << 16;

    /// One way on.
    pub const NONE: Self = Self { factor: 1, levels: 0 };

    /// Ways on after `depth` scattering events, at least one.
    #[inline(always)]
    pub(super) fn ways(self, depth: u32) -> u32 {
        if self.factor <= 1 {
            return 1;
        }
        let all = self.factor.checked_pow(depth.saturating_add(1)).filter(|&n| n <= Self::MOST);
        if depth < self.levels && all.is_some() { self.factor } else { 1 }
    }
}

impl Default for Branching {
    fn default() -> Self {
        Self::NONE
    }
}

impl Carried {
    /// By one of `ways` equal branches. Roulette and cut-offs look at what the branch carries since it branched.
    pub(super) fn shared(&self, ways: u32) -> Self {
        let n = ways as f32;
        Self { beta: self.beta / n, eta_scale: self.eta_scale * n, ..*self }
    }
}
