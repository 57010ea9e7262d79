use etendue_sampling::Sampler;

use super::PathTracer;
use super::leg::{Carried, Leg, Parts};
use crate::{Context, Recorder, Sample};

/// Most paths that one camera ray is split into.
const MOST: u32 = 1 << 16;

/// How many ways a path goes on from a surface: the branching factor. Unbiased, whatever the numbers.
///
/// Each branch draws its own light and its own direction, from an independent point of the sampler, and carries its part
/// of the weight. One is path tracing (Kajiya 1986); more multiply the rays with every level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Branching {
    /// Ways that a path goes on; 0 and 1 are one way.
    pub factor: u32,
    /// Scattering events at which it branches, from the camera on. Past 65,536 branches of a camera ray it does not
    /// branch any more.
    pub levels: u32,
}

impl Branching {
    /// One way on.
    pub const NONE: Self = Self { factor: 1, levels: 0 };

    /// Ways on after `depth` scattering events.
    fn ways(self, depth: u32) -> u32 {
        let all = self.factor.checked_pow(depth.saturating_add(1)).filter(|&n| n <= MOST);
        if depth < self.levels && all.is_some() { self.factor } else { 1 }
    }
}

impl Default for Branching {
    fn default() -> Self {
        Self::NONE
    }
}

impl PathTracer {
    /// All branches from one camera ray, one after the other; those not yet followed wait in a list no longer than
    /// `factor · levels`.
    pub(super) fn tree<S: Sampler, R: Recorder + ?Sized>(
        &self,
        cx: &Context<'_>,
        first: Leg<S>,
        spread: f32,
        out: &mut Sample,
        rec: &mut R,
    ) {
        let mut waiting = vec![first];
        while let Some(mut leg) = waiting.pop() {
            while self.arrive(cx, leg.parts(), spread, out, rec, |here, leg, out, rec| {
                let Parts { ray, from, carried, u } = leg;
                let ways = self.branching.ways(carried.depth);
                *carried = carried.shared(ways);
                for way in 1..ways {
                    let mut branch = Leg {
                        ray: *ray,
                        from: *from,
                        carried: *carried,
                        u: u.fork(carried.depth << 16 ^ way),
                    };
                    if self.scatter(cx, here, branch.parts(), out, rec) {
                        waiting.push(branch);
                    }
                }
                self.scatter(cx, here, Parts { ray, from, carried, u }, out, rec)
            }) {}
        }
    }
}

impl Carried {
    /// By one of `ways` equal branches. Roulette and cut-offs look at what the branch carries since it branched.
    fn shared(&self, ways: u32) -> Self {
        let n = ways as f32;
        Self { beta: self.beta / n, eta_scale: self.eta_scale * n, ..*self }
    }
}
