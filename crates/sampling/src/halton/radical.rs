//! Radical inverses: the digits of an index, mirrored at the point.

use crate::hash::{keyed, mix};
use crate::permutation::permute;

/// The first primes: bases of the dimensions.
pub(super) const PRIMES: [u32; 32] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103,
    107, 109, 113, 127, 131,
];

/// The radical inverse of `index`: Σ dₖ b^(−k−1) where Σ dₖ bᵏ is the index (van der Corput 1935, Halton 1960), rounded
/// once to the nearest `f64`. In `[0, 1)`: never above 1 − 2⁻³². A base below 2 counts as 2.
///
/// ```
/// assert_eq!(etendue_sampling::radical_inverse(3, 5), 7.0 / 9.0); // 5 is 12 in base 3; 0.21 is 7/9
/// ```
pub fn radical_inverse(base: u32, index: u32) -> f64 {
    let (digits, power) = mirrored(index, base.max(2));
    digits as f64 / power as f64
}

/// The digits of the index in opposite order, and b^(their number), which is at most index · b.
#[inline]
fn mirrored(index: u32, base: u32) -> (u64, u64) {
    let (mut rest, mut digits, mut power) = (index, 0u64, 1u64);
    while rest != 0 {
        digits = digits * u64::from(base) + u64::from(rest % base);
        power *= u64::from(base);
        rest /= base;
    }
    (digits, power)
}

/// (digits + tail · 2⁻³²) / power in 32-bit fixed point, rounded down; exact, and below 1 for digits < power.
#[inline(always)]
fn fixed(digits: u64, tail: u32, power: u64) -> u32 {
    if digits >> 32 == 0 {
        ((digits << 32 | u64::from(tail)) / power) as u32
    } else {
        ((u128::from(digits) << 32 | u128::from(tail)) / u128::from(power)) as u32
    }
}

/// The radical inverse as it is.
#[inline]
pub(super) fn plain(index: u32, base: u32) -> u32 {
    let (digits, power) = mirrored(index, base);
    fixed(digits, 0, power)
}

/// Sets the hash for the images of zeros apart from those for permutations and digits.
const ZEROS: u32 = 1 << 31;

/// Takes the next digit off a fraction.
#[inline(always)]
fn next_digit(fraction: &mut u64, base: u32) -> u32 {
    let wide = u128::from(*fraction) * u128::from(base);
    *fraction = wide as u64;
    (wide >> 64) as u32
}

/// Where a digit goes in a random permutation of `0..base` that takes 0 to `zero`.
#[inline(always)]
fn image(digit: u32, zero: u32, base: u32, key: u64) -> u32 {
    let step = match (digit, base) {
        (0, _) => 0,
        (_, 2) => 1,
        (_, 3) => 1 + ((digit - 1) ^ (key >> 63) as u32),
        _ => 1 + permute(digit - 1, base - 1, key),
    };
    let moved = zero + step;
    if moved >= base { moved - base } else { moved }
}

/// The radical inverse with a random permutation for each place of the digits.
///
/// An index has endlessly many leading zeros, and every one of them is permuted. Their images, drawn one by one, would
/// be the digits of a uniform number; so that number is drawn instead, and each place's permutation is made to take
/// zero to its digit there. What is left of it after the index's last digit is the tail.
#[inline]
pub(super) fn permuted(index: u32, base: u32, key: u64) -> u32 {
    let mut zeros = keyed(key, 0, ZEROS);
    let (mut rest, mut digits, mut power, mut place) = (index, 0u64, 1u64, 0);
    while rest != 0 {
        let zero = next_digit(&mut zeros, base);
        let digit = image(rest % base, zero, base, keyed(key, place, 0));
        digits = digits * u64::from(base) + u64::from(digit);
        power *= u64::from(base);
        place += 1;
        rest /= base;
    }
    fixed(digits, (zeros >> 32) as u32, power)
}

/// The radical inverse with nested permutations: that of a digit depends on all digits before it (Owen 1995).
///
/// As [`permuted`], except that every digit other than zero opens a branch with images and permutations of its own.
#[inline]
pub(super) fn nested(index: u32, base: u32, key: u64) -> u32 {
    let (mut branch, mut zeros) = (key, keyed(key, 0, ZEROS));
    let (mut rest, mut digits, mut power, mut place) = (index, 0u64, 1u64, 0);
    while rest != 0 {
        let raw = rest % base;
        let zero = next_digit(&mut zeros, base);
        let digit = image(raw, zero, base, keyed(branch, place, 0));
        if raw != 0 {
            branch = keyed(mix(branch), place, raw);
            zeros = keyed(branch, 0, ZEROS);
        }
        digits = digits * u64::from(base) + u64::from(digit);
        power *= u64::from(base);
        place += 1;
        rest /= base;
    }
    fixed(digits, (zeros >> 32) as u32, power)
}

#[cfg(test)]
mod tests {
    use super::*;

    const AWKWARD: [u32; 8] = [0, 1, 2, 1000, 0x7fff_ffff, 0x8000_0000, 0xffff_fffe, u32::MAX];

    #[test]
    fn plain_radical_inverses_are_exact() {
        for index in AWKWARD.into_iter().chain(0..3000) {
            assert_eq!(plain(index, 2), index.reverse_bits());
            for base in PRIMES {
                // Digit by digit in integers of 128 bits.
                let (mut rest, mut sum, mut power) = (index, 0u128, 1u128);
                while rest != 0 {
                    power *= u128::from(base);
                    sum = sum * u128::from(base) + u128::from(rest % base);
                    rest /= base;
                }
                assert_eq!(u128::from(plain(index, base)), (sum << 32) / power, "{index} in base {base}");
                let x = radical_inverse(base, index);
                assert!(x <= 1.0 - 1.0 / 4_294_967_296.0);
                assert_eq!((x * power as f64).round() as u128, sum, "{index} in base {base}");
            }
        }
        assert_eq!(radical_inverse(0, 1), 0.5);
        assert_eq!(radical_inverse(u32::MAX, u32::MAX - 1), f64::from(u32::MAX - 1) / f64::from(u32::MAX));
    }

    /// Interval of the value among `n`. A value may lie anywhere in the 2⁻³² above its bits: take the upper end.
    fn interval(bits: u32, n: u32) -> usize {
        (((u64::from(bits) + 1) * u64::from(n) - 1) >> 32) as usize
    }

    /// Whether `n` successive indices from every multiple of `n` fill all of `n` intervals.
    fn fills(n: u32, f: &dyn Fn(u32) -> u32) -> bool {
        (0..4).all(|run| {
            let mut seen = vec![false; n as usize];
            (run * n..(run + 1) * n).for_each(|i| seen[interval(f(i), n)] = true);
            seen.iter().all(|&s| s)
        })
    }

    /// Up to 1000 intervals: an edge that falls into the 2⁻³² of a value, which its bits cannot tell, is met with a
    /// probability of n²/2³² a run.
    #[test]
    fn every_power_of_the_base_fills_its_intervals() {
        for base in &PRIMES[..10] {
            for n in [*base, base * base, base * base * base].into_iter().filter(|n| *n < 1000) {
                for key in (1..20).map(mix) {
                    assert!(fills(n, &|i| permuted(i, *base, key)), "permuted {n}");
                    assert!(fills(n, &|i| nested(i, *base, key)), "nested {n}");
                }
                assert!(fills(n, &|i| plain(i, *base)), "plain {n}");
                // The mutant: each place's digit drawn anew for each index.
                assert!(!fills(n.max(9), &|i| nested(i, *base, mix(u64::from(i)))), "mutant {n}");
            }
        }
    }

    /// Digits 0 and 1 of indices that share or do not share digit 0: per place, the second digit's permutation is the
    /// same for all; nested, it is drawn anew for each first digit. With 9 images each over 4000 keys, agreement
    /// of the images of one digit under two first digits is 1 or 1/b, with a standard error under 0.008.
    #[test]
    fn only_nested_permutations_depend_on_the_digits_before() {
        for base in [2u32, 3, 5, 7, 29] {
            let agreement = |f: &dyn Fn(u32, u32, u64) -> u32, digit: u32| {
                let second = |i: u32, key: u64| interval(f(i, base, key), base * base) as u32 % base;
                let same = |k: &u64| second(digit * base, mix(*k)) == second(digit * base + 1, mix(*k));
                (0..4000).filter(same).count() as f64 / 4000.0
            };
            for digit in [0, 1, base - 1] {
                assert_eq!(agreement(&permuted, digit), 1.0, "base {base}, digit {digit}");
                let a = agreement(&nested, digit) - 1.0 / f64::from(base);
                assert!(a.abs() < 0.035, "base {base}, digit {digit}: {a}");
            }
        }
    }

    /// Every pair of images of two digits is equally likely: χ² within 4.5 standard deviations of its mean over 20,000
    /// keys. Cyclic shifts, the mutant, reach b of b (b − 1) pairs only.
    #[test]
    fn permutations_of_digits_are_uniform_in_pairs() {
        for base in [3u32, 5, 7, 11] {
            let chi2 = |f: &dyn Fn(u32, u64) -> u32| {
                let mut counts = vec![0u32; (base * base) as usize];
                (0..20_000).for_each(|k| counts[(f(1, mix(k)) * base + f(base - 1, mix(k))) as usize] += 1);
                let cells = f64::from(base * (base - 1));
                let expected = 20_000.0 / cells;
                let off_diagonal =
                    counts.iter().enumerate().filter(|(c, _)| *c as u32 / base != *c as u32 % base);
                let sum: f64 = off_diagonal.map(|(_, &n)| (f64::from(n) - expected).powi(2) / expected).sum();
                (sum - (cells - 1.0)) / (2.0 * (cells - 1.0)).sqrt()
            };
            for f in [permuted, nested] {
                let z = chi2(&|digit, key| interval(f(digit, base, key), base) as u32);
                assert!(z.abs() < 4.5, "base {base}: {z}");
            }
            let shifts = chi2(&|digit, key| (digit + (key >> 32) as u32) % base);
            assert!(shifts > 100.0, "base {base}: {shifts}");
        }
    }
}
