//! Random numbers and double-double arithmetic (Dekker 1971) for references.
#![allow(dead_code)]

use std::ops::{Add, Mul, Sub};

use etendue_core::{Vec3A, vector};

/// SplitMix64 (Steele, Lea & Flood 2014).
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1u64 << 24) as f32
    }

    pub(crate) fn range(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * self.unit()
    }

    pub(crate) fn magnitude(&mut self, lo: f64, hi: f64) -> f32 {
        10f64.powf(lo + (hi - lo) * f64::from(self.unit())) as f32
    }

    pub(crate) fn direction(&mut self) -> Vec3A {
        loop {
            let v = Vec3A::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0));
            if v.dot(v) > 0.01 && v.dot(v) <= 1.0 {
                return vector::normalize(v);
            }
        }
    }
}

/// A sum of two doubles: about 106 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Twice {
    pub(crate) hi: f64,
    lo: f64,
}

impl Twice {
    pub(crate) fn new(x: f32) -> Self {
        Self { hi: f64::from(x), lo: 0.0 }
    }

    fn renormalised(hi: f64, lo: f64) -> Self {
        let s = hi + lo;
        Self { hi: s, lo: lo - (s - hi) }
    }

    /// By one Newton step from the double-precision root.
    pub(crate) fn sqrt(self) -> Self {
        let x = self.hi.sqrt();
        if x == 0.0 {
            return Self { hi: 0.0, lo: 0.0 };
        }
        let root = Self { hi: x, lo: 0.0 };
        let rest = (self - root * root).hi / (2.0 * x);
        Self::renormalised(x, rest)
    }

    pub(crate) fn ratio(self, o: Self) -> f64 {
        let q = self.hi / o.hi;
        let rest = self - o * Self { hi: q, lo: 0.0 };
        q + rest.hi / o.hi
    }
}

impl Add for Twice {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let s = self.hi + o.hi;
        let b = s - self.hi;
        let e = (self.hi - (s - b)) + (o.hi - b);
        Self::renormalised(s, e + self.lo + o.lo)
    }
}

impl Sub for Twice {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + Self { hi: -o.hi, lo: -o.lo }
    }
}

impl Mul for Twice {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let p = self.hi * o.hi;
        let e = self.hi.mul_add(o.hi, -p);
        Self::renormalised(p, e + self.hi * o.lo + self.lo * o.hi)
    }
}

pub(crate) type Point = [Twice; 3];

pub(crate) fn point(v: Vec3A) -> Point {
    v.to_array().map(Twice::new)
}

pub(crate) fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| a[i] - b[i])
}

pub(crate) fn dot(a: Point, b: Point) -> Twice {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Point, b: Point) -> Point {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}
