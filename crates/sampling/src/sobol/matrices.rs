//! Generator matrices of the Sobol sequence with the direction numbers of Joe & Kuo (2008, table new-joe-kuo-6).
//!
//! Everything here is bit-reversed: bit 0 of a value is its first binary digit after the point. That is the order in
//! which Owen scrambling wants it, and in which dimension 0 is the index itself.

/// How many dimensions there are.
pub(super) const DIMENSIONS: u32 = 2 + TABLE.len() as u32;

/// One row of the table: degree and inner coefficients of the primitive polynomial, and the initial numbers.
struct Polynomial {
    degree: usize,
    coefficients: u32,
    initial: [u32; 5],
}

const fn poly(degree: usize, coefficients: u32, initial: [u32; 5]) -> Polynomial {
    Polynomial { degree, coefficients, initial }
}

/// Dimensions 2 to 9 (dimension 0 is the identity, 1 has a closed form).
const TABLE: [Polynomial; 8] = [
    poly(2, 1, [1, 3, 0, 0, 0]),
    poly(3, 1, [1, 3, 1, 0, 0]),
    poly(3, 2, [1, 1, 1, 0, 0]),
    poly(4, 1, [1, 1, 3, 3, 0]),
    poly(4, 4, [1, 3, 5, 13, 0]),
    poly(5, 2, [1, 1, 5, 5, 17]),
    poly(5, 4, [1, 1, 5, 5, 5]),
    poly(5, 7, [1, 1, 7, 11, 19]),
];

/// The 32 columns of a dimension's matrix, bit-reversed, by the recurrence of Sobol (Bratley & Fox 1988, equation 2).
const fn columns(p: &Polynomial) -> [u32; 32] {
    let mut v = [0u32; 32];
    let mut k = 0;
    while k < 32 {
        if k < p.degree {
            v[k] = p.initial[k] << (31 - k);
        } else {
            let mut x = v[k - p.degree] ^ (v[k - p.degree] >> p.degree);
            let mut j = 1;
            while j < p.degree {
                if (p.coefficients >> (p.degree - 1 - j)) & 1 == 1 {
                    x ^= v[k - j];
                }
                j += 1;
            }
            v[k] = x;
        }
        k += 1;
    }
    k = 0;
    while k < 32 {
        v[k] = v[k].reverse_bits();
        k += 1;
    }
    v
}

/// Contributions of one index byte to the eight tabulated dimensions: one half of a cache line.
type Row = [u32; 8];

const fn byte_tables() -> [[Row; 256]; 4] {
    let mut out = [[[0; 8]; 256]; 4];
    let mut d = 0;
    while d < 8 {
        let columns = columns(&TABLE[d]);
        let mut byte = 0;
        while byte < 4 {
            let mut value = 1;
            while value < 256usize {
                // One set bit less is already there.
                let bit = value.trailing_zeros() as usize;
                out[byte][value][d] = out[byte][value & (value - 1)][d] ^ columns[8 * byte + bit];
                value += 1;
            }
            byte += 1;
        }
        d += 1;
    }
    out
}

static BYTES: [[Row; 256]; 4] = byte_tables();

/// Dimension 1: the Pascal matrix modulo 2, by a logarithmic number of shifts (Ahmed 2024).
#[inline(always)]
pub(super) fn pascal(mut v: u32) -> u32 {
    v ^= (v >> 1) & 0x5555_5555;
    v ^= (v >> 2) & 0x3333_3333;
    v ^= (v >> 4) & 0x0f0f_0f0f;
    v ^= (v >> 8) & 0x00ff_00ff;
    v ^ (v >> 16)
}

/// `N` tabulated dimensions from `2 + FIRST` on.
#[inline(always)]
pub(super) fn tabulated<const FIRST: usize, const N: usize>(index: u32) -> [u32; N] {
    let mut out = [0; N];
    let mut rest = index;
    // Leading zero bytes contribute nothing: two turns of the loop below 65,536.
    for table in &BYTES {
        let row = &table[(rest & 255) as usize];
        for (k, o) in out.iter_mut().enumerate() {
            *o ^= row[FIRST + k];
        }
        rest >>= 8;
        if rest == 0 {
            break;
        }
    }
    out
}

/// Any one dimension; 0 past the last.
#[inline]
pub(super) fn dimension(index: u32, dimension: u32) -> u32 {
    match dimension {
        0 => index,
        1 => pascal(index),
        2..=9 => {
            let d = dimension as usize - 2;
            let byte = |b: usize| BYTES[b][((index >> (8 * b)) & 255) as usize][d];
            let low = byte(0) ^ byte(1);
            if index >> 16 == 0 { low } else { low ^ byte(2) ^ byte(3) }
        }
        _ => 0,
    }
}
