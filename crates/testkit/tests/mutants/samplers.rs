use std::sync::atomic::{AtomicU32, Ordering};

use etendue_core::{Fingerprint, Vec2};
use etendue_sampling::{BounceDraws, Dim, Independent, Sampler, unit_f32};
use etendue_testkit::check_sampler;

use crate::Case;

#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    /// The second number of a pair is the first in 7 of 100 draws.
    Correlated,
    /// Counts its draws.
    Cursor,
    /// u to this power.
    Power(f64),
    /// 32 bits as a float: rounds to 1 once in 33 million.
    ReachesOne,
    /// The same, in pairs alone.
    PairsReachOne,
    /// Two neighbouring streams are one.
    Streams,
    /// The seed is not used.
    Seed,
    /// Replicates are alike.
    Replicates,
    /// A fork is the original.
    Fork,
    /// The lobe's number is the roulette's at every vertex.
    Slots,
    /// `bounce` draws from the next vertex.
    Bounce,
    /// Every fourth sample repeats the one before.
    Repeats,
    /// The fingerprint forgets the seed.
    Fingerprint,
}

#[derive(Clone, Copy)]
struct Mutant {
    right: Independent,
    seed: u64,
    wrong: Wrong,
}

static CURSOR: AtomicU32 = AtomicU32::new(0);

impl Mutant {
    fn new(seed: u64, wrong: Wrong) -> Self {
        let used = if wrong == Wrong::Seed { 1 } else { seed };
        Self { right: Independent::new(used, 64).with_replicates(4), seed, wrong }
    }
}

impl Sampler for Mutant {
    fn spp(&self) -> u32 {
        64
    }

    fn replicates(&self) -> u32 {
        4
    }

    fn start(self, stream: u64, index: u64) -> Self {
        let (stream, index) = match self.wrong {
            Wrong::Streams => (stream / 2, index),
            Wrong::Replicates => (stream, index / 4),
            Wrong::Repeats if index % 4 == 3 => (stream, index - 1),
            _ => (stream, index),
        };
        Self { right: self.right.start(stream, index), ..self }
    }

    fn fork(self, key: u32) -> Self {
        if self.wrong == Wrong::Fork { self } else { Self { right: self.right.fork(key), ..self } }
    }

    fn bits_1d(&self, dim: Dim) -> u32 {
        let dim = if self.wrong == Wrong::Slots && dim == Dim::bounce(0, etendue_sampling::Slot::Lobe) {
            Dim::bounce(0, etendue_sampling::Slot::Bsdf)
        } else {
            dim
        };
        let bits = self.right.bits_1d(dim);
        match self.wrong {
            Wrong::Cursor => bits.wrapping_add(CURSOR.fetch_add(1 << 20, Ordering::Relaxed)),
            Wrong::Power(p) => ((f64::from(bits) / 4_294_967_296.0).powf(p) * 4_294_967_296.0) as u32,
            _ => bits,
        }
    }

    fn get_1d(&self, dim: Dim) -> f32 {
        let bits = self.bits_1d(dim);
        if self.wrong == Wrong::ReachesOne { bits as f32 / 4_294_967_296.0 } else { unit_f32(bits) }
    }

    fn get_2d(&self, dim: Dim) -> Vec2 {
        let bits = [self.bits_1d(dim), self.bits_1d(dim.next())];
        let p = if self.wrong == Wrong::PairsReachOne {
            bits.map(|b| b as f32 / 4_294_967_296.0)
        } else {
            bits.map(unit_f32)
        };
        // A dimension nobody else draws decides.
        let decides = self.right.fork(77).get_1d(dim);
        Vec2::new(p[0], if self.wrong == Wrong::Correlated && decides < 0.07 { p[0] } else { p[1] })
    }

    fn bounce(&self, depth: u32) -> BounceDraws {
        let depth = if self.wrong == Wrong::Bounce { depth + 1 } else { depth };
        use etendue_sampling::Slot;
        BounceDraws {
            light: self.get_2d(Dim::bounce(depth, Slot::Light)),
            bsdf: self.get_2d(Dim::bounce(depth, Slot::Bsdf)),
            lobe: self.get_1d(Dim::bounce(depth, Slot::Lobe)),
            roulette: self.get_1d(Dim::bounce(depth, Slot::Roulette)),
        }
    }

    fn fingerprint(&self, f: &mut Fingerprint) {
        f.tag("mutant");
        if self.wrong != Wrong::Fingerprint {
            f.u64(self.seed);
        }
    }
}

pub(crate) fn mutants() -> Vec<Case<'static>> {
    let case =
        |name: &str, wrong| Case::new(name, move |b| check_sampler(&|seed| Mutant::new(seed, wrong), b));
    assert!(
        (case("", Wrong::Power(1.0)).check)(&etendue_testkit::Budget::default()).is_ok(),
        "the right one is accepted"
    );
    vec![
        case("pairs correlated by 0.07", Wrong::Correlated),
        case("a hidden cursor", Wrong::Cursor),
        case("u²", Wrong::Power(2.0)),
        case("a distribution function off by 0.04", Wrong::Power(1.12)),
        case("1 is possible", Wrong::ReachesOne),
        case("1 is possible in pairs", Wrong::PairsReachOne),
        case("two streams are one", Wrong::Streams),
        case("the seed is not used", Wrong::Seed),
        case("replicates are alike", Wrong::Replicates),
        case("a fork is the original", Wrong::Fork),
        case("two slots are one", Wrong::Slots),
        case("bounce draws from the next vertex", Wrong::Bounce),
        case("every fourth sample is a repetition, half more error", Wrong::Repeats),
        case("the fingerprint forgets the seed", Wrong::Fingerprint),
    ]
}
