use rand_pcg::Pcg32;

use crate::hash::mix2;
use crate::{Dim, Sampler, Slot};

/// A conventional generator for code that wants one (`rand`'s traits are implemented for [`Pcg32`]), seeded by the
/// sampler's fork of `key`: equal samplers and keys give equal generators. Its numbers are independent, not
/// stratified.
///
/// ```
/// use etendue_sampling::{Sampler, Sobol, pcg32};
/// let at = Sobol::new(1, 64).start(17, 3);
/// assert_eq!(pcg32(&at, 5), pcg32(&at, 5));
/// assert_ne!(pcg32(&at, 5), pcg32(&at, 6));
/// ```
pub fn pcg32<S: Sampler>(sampler: &S, key: u32) -> Pcg32 {
    let fork = sampler.fork(key);
    // Spare numbers, which no rendering code draws; several, because a stratified one alone has little entropy.
    let word = |depth| {
        let bits = |slot| u64::from(fork.bits_1d(Dim::bounce(depth, slot)));
        mix2(bits(Slot::Spare0) << 32 | bits(Slot::Spare1), u64::from(key))
    };
    Pcg32::new(mix2(word(0), word(1)), mix2(word(2), word(3)))
}
