//! Gradient noise on the integer lattice (Perlin 1985, "An image synthesizer"; fade curve and gradients of Perlin 2002,
//! "Improving noise"), hashed by integers so that it has the same bits everywhere and no period.

use etendue_core::Vec3A;

use crate::lookup::floor;

/// Twelve directions to a cube's edges have this much at most: the largest sum over all choices of gradients is
/// 1.036354 (found by search; see the tests), so that noise times this stays within [−1, 1].
const WITHIN_ONE: f32 = 0.964;

/// A bijection of 64-bit words that mixes well (the finaliser structure of MurmurHash3 with the constants of Stafford
/// 2011, variant 13).
#[inline]
fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// 64 bits for a place of the lattice.
#[inline]
fn hash(x: i32, y: i32, z: i32, seed: u64) -> u64 {
    let xy = u64::from(x.cast_unsigned()) << 32 | u64::from(y.cast_unsigned());
    mix(mix(xy ^ seed).wrapping_add(u64::from(z.cast_unsigned()).wrapping_mul(0x9e37_79b9_7f4a_7c15)))
}

/// The product of `d` with one of the twelve directions (±1, ±1, 0), (±1, 0, ±1), (0, ±1, ±1).
#[inline]
fn slope(hash: u64, d: Vec3A) -> f32 {
    // The upper bits, so that the choice is even to 2⁻³⁰.
    let edge = ((hash >> 32) * 3) >> 32;
    let (a, b) = match edge {
        0 => (d.x, d.y),
        1 => (d.x, d.z),
        _ => (d.y, d.z),
    };
    let signed = |v: f32, bit: u64| if hash & bit == 0 { v } else { -v };
    signed(a, 1) + signed(b, 2)
}

/// 6t⁵ − 15t⁴ + 10t³: flat to the second derivative at both ends.
#[inline]
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Noise of one octave, in [−1, 1], 0 on the lattice, and 0 where a coordinate is beyond 2²³, from where on there are no
/// fractions, or no number.
pub(crate) fn gradient_noise(p: Vec3A, seed: u64) -> f32 {
    let far = 8_388_608.0;
    if !(p.x.abs() < far && p.y.abs() < far && p.z.abs() < far) {
        return 0.0;
    }
    let (x, y, z) = (floor(p.x), floor(p.y), floor(p.z));
    let d = Vec3A::new(p.x - x as f32, p.y - y as f32, p.z - z as f32);
    let (u, v, w) = (fade(d.x), fade(d.y), fade(d.z));
    let corner = |i: i32, j: i32, k: i32| {
        slope(hash(x + i, y + j, z + k, seed), d - Vec3A::new(i as f32, j as f32, k as f32))
    };
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let row = |j: i32, k: i32| mix(corner(0, j, k), corner(1, j, k), u);
    let layer = |k: i32| mix(row(0, k), row(1, k), v);
    (mix(layer(0), layer(1), w) * WITHIN_ONE).clamp(-1.0, 1.0)
}

/// A shift of a lattice, each coordinate in [0, 1).
pub(crate) fn shift(seed: u64) -> Vec3A {
    let unit = |k: u64| (mix(mix(seed).wrapping_add(k)) >> 40) as f32 / 16_777_216.0;
    Vec3A::new(unit(1), unit(2), unit(3))
}

/// A seed for each octave of a seed.
pub(crate) fn octave_seed(seed: u32, octave: u32) -> u64 {
    mix(u64::from(seed) << 32 | u64::from(octave))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over all choices of gradients: at every place the corners' largest slopes, weighted.
    fn largest(d: [f64; 3]) -> f64 {
        let fade = d.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
        let mut sum = 0.0;
        for corner in 0..8 {
            let mut weight = 1.0;
            let mut off = [0.0; 3];
            for axis in 0..3 {
                let far = corner >> axis & 1 == 1;
                weight *= if far { fade[axis] } else { 1.0 - fade[axis] };
                off[axis] = if far { (1.0 - d[axis]).abs() } else { d[axis] };
            }
            let all: f64 = off.iter().sum();
            sum += weight * (all - off[0].min(off[1]).min(off[2]));
        }
        sum
    }

    /// The bound is that of the gradients, not of the hash; and it is met within half a percent.
    #[test]
    fn no_choice_of_gradients_goes_beyond_one() {
        let n = 100;
        let at = |i: i32| f64::from(i) / f64::from(n);
        let mut most = 0.0f64;
        for i in 0..=n {
            for j in 0..=i {
                for k in 0..=j {
                    most = most.max(largest([at(i), at(j), at(k)]));
                }
            }
        }
        println!("largest sum of slopes {most:.6}");
        assert!(most * f64::from(WITHIN_ONE) <= 1.0 && most * f64::from(WITHIN_ONE) > 0.995, "{most}");
    }

    #[test]
    fn zero_on_the_lattice_and_beyond_numbers() {
        for i in -3..4 {
            let p = Vec3A::new(i as f32, (i * 7) as f32, (1 - i) as f32);
            assert_eq!(gradient_noise(p, 5).abs(), 0.0);
        }
        for bad in [f32::NAN, f32::INFINITY, -1e30, 8_388_608.0] {
            assert_eq!(gradient_noise(Vec3A::new(0.5, bad, 0.5), 5), 0.0);
        }
        let edge = gradient_noise(Vec3A::new(8_388_607.5, -8_388_607.5, 0.3), 5);
        assert!(edge.abs() <= 1.0);
    }

    /// Along a line the noise and its slope go on across the cells' borders.
    #[test]
    fn smooth_across_cells() {
        let step = 1.0 / 1024.0;
        let at = |i: i32| gradient_noise(Vec3A::new(i as f32 * step, 0.37, -2.61), 9);
        for i in -4096..4096 {
            let bend = (at(i + 1) - 2.0 * at(i) + at(i - 1)) / (step * step);
            // Second derivatives of the cells' polynomials are at most about 20; a kink would be 1/step.
            assert!(bend.abs() < 40.0, "at {i}: {bend}");
        }
    }

    #[test]
    fn gradients_are_even() {
        let mut counts = std::collections::BTreeMap::<[i32; 3], u32>::new();
        let n = 48;
        for x in 0..n {
            for y in 0..n {
                for z in 0..n {
                    let h = hash(x, y - 20, z, 77);
                    let g = [Vec3A::X, Vec3A::Y, Vec3A::Z].map(|a| slope(h, a) as i32);
                    *counts.entry(g).or_default() += 1;
                }
            }
        }
        assert_eq!(counts.len(), 12);
        let expected = f64::from(n * n * n) / 12.0;
        let chi2: f64 = counts.values().map(|&c| (f64::from(c) - expected).powi(2) / expected).sum();
        assert!(chi2 < 45.0, "11 degrees of freedom: {chi2}");
    }
}
