use etendue_core::Spectrum;

/// Scattering events after which even a lossless path may end.
const LONG_PATH: u32 = 256;
/// The most probable survival of a long path.
const LONG_SURVIVAL: f32 = 1.0 - 1.0 / 32_768.0;
/// The least probable survival: rarer survivors would be fireflies.
const LEAST_SURVIVAL: f32 = 0.05;

/// When paths are ended early (Arvo & Kirk 1990). Unbiased: a survivor carries 1/P, where P is the probability of going
/// on, never less than 5 %.
///
/// The coin is a number of its own (`Slot::Roulette`), not the number that the sample was drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roulette {
    /// As below, but only past 256 scattering events, where a path could otherwise go on for ever.
    Off,
    /// P is a constant.
    Fixed {
        /// Probability of going on, in `(0, 1]`; what is not counts as 1.
        p: f32,
        /// Scattering events that are always allowed.
        from: u32,
    },
    /// P is the largest channel of the surface's albedo toward the path: what is reflected *and transmitted*. Water reflects
    /// 7 % and absorbs next to nothing, so its P is near 1, not 0.07.
    Albedo {
        /// Scattering events that are always allowed.
        from: u32,
    },
    /// P is the largest channel of what the path still carries (radiance scaling by refraction taken out).
    Throughput {
        /// Scattering events that are always allowed.
        from: u32,
    },
}

/// What a ray of a tree must carry to be followed for sure, while the tree is shallow: about 64 such rays stand side by side.
const FAINT: f32 = 1.0 / 64.0;
/// From this depth on only rays that carry everything are: about one is left.
const DEEP: u32 = 64;

/// Probability of following a ray of a tree of rays that has no other end. Survivors carry [`FAINT`], and all light in the
/// end, so there is no least probability that would keep out fireflies; one would let the tree grow.
pub(crate) fn survival_in_tree(depth: u32, carried: f32) -> f32 {
    let p = if depth < DEEP { carried / FAINT } else { carried };
    let most = if depth < LONG_PATH { 1.0 } else { LONG_SURVIVAL };
    if p > 0.0 && p < most { p } else { most }
}

impl Roulette {
    /// Probability of going on after `depth` scattering events; 1 draws no random number. `carried` is the largest channel
    /// of the throughput, `albedo` that of the surface just left.
    #[inline(always)]
    pub(crate) fn survival(self, depth: u32, carried: f32, albedo: impl FnOnce() -> Spectrum) -> f32 {
        let from = match self {
            Self::Off => LONG_PATH,
            Self::Fixed { from, .. } | Self::Albedo { from } | Self::Throughput { from } => {
                from.min(LONG_PATH)
            }
        };
        if depth < from {
            return 1.0;
        }
        let p = match self {
            Self::Fixed { p, .. } => p,
            Self::Albedo { .. } => albedo().max_channel(),
            Self::Off | Self::Throughput { .. } => carried,
        };
        let p = if p > 0.0 { p.clamp(LEAST_SURVIVAL, 1.0) } else { 1.0 };
        if depth >= LONG_PATH && p > LONG_SURVIVAL { LONG_SURVIVAL } else { p }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trees_stay_narrow() {
        assert_eq!(survival_in_tree(3, 0.5), 1.0);
        assert_eq!(survival_in_tree(3, FAINT / 4.0), 0.25);
        assert_eq!(survival_in_tree(DEEP, 0.5), 0.5);
        assert_eq!(survival_in_tree(LONG_PATH, 1.0), LONG_SURVIVAL);
        assert_eq!(survival_in_tree(0, f32::NAN), 1.0);
    }

    #[test]
    fn probabilities_of_going_on() {
        let of = |r: Roulette, depth, carried| r.survival(depth, carried, || Spectrum::rgb(0.2, 0.6, 0.4));
        for (r, p) in [
            (Roulette::Fixed { p: 0.7, from: 2 }, 0.7),
            (Roulette::Albedo { from: 2 }, 0.6),
            (Roulette::Throughput { from: 2 }, 0.3),
        ] {
            assert_eq!((of(r, 1, 0.3), of(r, 2, 0.3)), (1.0, p), "{r:?}");
        }
        assert_eq!(of(Roulette::Off, 255, 0.3), 1.0);
        assert_eq!(of(Roulette::Off, 256, 0.3), 0.3);
        // Light between perfect mirrors ends too, whatever was asked for.
        for r in [Roulette::Fixed { p: 1.0, from: u32::MAX }, Roulette::Throughput { from: u32::MAX }] {
            assert_eq!(of(r, 256, 1.0), LONG_SURVIVAL, "{r:?}");
        }
        assert_eq!(of(Roulette::Throughput { from: 0 }, 0, 1e-9), LEAST_SURVIVAL);
        for odd in [0.0, -1.0, f32::NAN, 2.0] {
            assert_eq!(of(Roulette::Fixed { p: odd, from: 0 }, 0, 0.5), 1.0, "{odd}");
        }
    }
}
