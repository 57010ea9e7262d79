use std::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Neg, Sub};

use glam::Vec4;

/// A spectral quantity: linear Rec.709 red, green and blue in three lanes. The fourth lane is padding that no
/// reduction or test looks at.
///
/// What it measures (radiance, throughput, albedo …) is said by the item that holds it.
#[derive(Clone, Copy, Default)]
pub struct Spectrum(Vec4);

impl Spectrum {
    /// No light; total absorption.
    pub const BLACK: Self = Self(Vec4::ZERO);
    /// One in every channel.
    pub const ONE: Self = Self(Vec4::new(1.0, 1.0, 1.0, 0.0));

    /// From linear Rec.709.
    #[inline]
    pub const fn rgb(r: f32, g: f32, b: f32) -> Self {
        Self(Vec4::new(r, g, b, 0.0))
    }

    /// The same value in every channel.
    #[inline]
    pub const fn gray(v: f32) -> Self {
        Self(Vec4::new(v, v, v, 0.0))
    }

    /// The channels as an array.
    #[inline]
    pub fn to_array(self) -> [f32; 3] {
        [self.0.x, self.0.y, self.0.z]
    }

    /// Red, linear.
    #[inline]
    pub fn r(self) -> f32 {
        self.0.x
    }
    /// Green, linear.
    #[inline]
    pub fn g(self) -> f32 {
        self.0.y
    }
    /// Blue, linear.
    #[inline]
    pub fn b(self) -> f32 {
        self.0.z
    }

    /// Rec.709 relative luminance.
    #[inline]
    pub fn luminance(self) -> f32 {
        0.2126 * self.0.x + 0.7152 * self.0.y + 0.0722 * self.0.z
    }

    /// Arithmetic mean of the channels.
    #[inline]
    pub fn mean(self) -> f32 {
        (self.0.x + self.0.y + self.0.z) / 3.0
    }

    /// The largest channel.
    #[inline]
    pub fn max_channel(self) -> f32 {
        let m = if self.0.x > self.0.y { self.0.x } else { self.0.y };
        if m > self.0.z { m } else { self.0.z }
    }

    /// Whether every channel is exactly zero.
    #[inline]
    pub fn is_black(self) -> bool {
        self.0.x == 0.0 && self.0.y == 0.0 && self.0.z == 0.0
    }

    /// Whether every channel is a finite number.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.x.is_finite() && self.0.y.is_finite() && self.0.z.is_finite()
    }

    /// Each channel through `f`.
    #[inline]
    #[must_use]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self::rgb(f(self.0.x), f(self.0.y), f(self.0.z))
    }

    /// `self (1 - t) + other t`.
    #[inline]
    #[must_use]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        self * (1.0 - t) + other * t
    }
}

impl PartialEq for Spectrum {
    fn eq(&self, other: &Self) -> bool {
        self.to_array() == other.to_array()
    }
}

impl std::fmt::Debug for Spectrum {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Spectrum({}, {}, {})", self.0.x, self.0.y, self.0.z)
    }
}

impl From<[f32; 3]> for Spectrum {
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self::rgb(r, g, b)
    }
}

impl Index<usize> for Spectrum {
    type Output = f32;
    fn index(&self, i: usize) -> &f32 {
        match i {
            0 => &self.0.x,
            1 => &self.0.y,
            2 => &self.0.z,
            _ => panic!("a spectrum has three channels, not {}", i + 1),
        }
    }
}

impl Add for Spectrum {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0)
    }
}
impl AddAssign for Spectrum {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        self.0 += o.0;
    }
}
impl Sub for Spectrum {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0)
    }
}
impl Neg for Spectrum {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
impl Mul for Spectrum {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Self(self.0 * o.0)
    }
}
impl MulAssign for Spectrum {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        self.0 *= o.0;
    }
}
impl Mul<f32> for Spectrum {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        Self(self.0 * s)
    }
}
impl MulAssign<f32> for Spectrum {
    #[inline]
    fn mul_assign(&mut self, s: f32) {
        self.0 *= s;
    }
}
impl Div<f32> for Spectrum {
    type Output = Self;
    #[inline]
    fn div(self, s: f32) -> Self {
        Self(self.0 / s)
    }
}
impl Mul<Spectrum> for f32 {
    type Output = Spectrum;
    #[inline]
    fn mul(self, s: Spectrum) -> Spectrum {
        s * self
    }
}
