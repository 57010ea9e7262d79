//! Bounds on the rounding error of single-precision sums (Higham 2002, section 3.1; Pharr, Jakob & Humphreys 2023,
//! section 6.8).

/// Unit round-off of f32: half the distance from 1 to the next number.
pub const U: f32 = f32::EPSILON * 0.5;

/// γ(n) = n u / (1 − n u): the relative error after n rounded operations is at most this.
#[inline]
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * U;
    nu / (1.0 - nu)
}

/// The next f32 toward +∞ (infinity stays).
#[inline]
pub fn next_up(x: f32) -> f32 {
    x.next_up()
}

/// The next f32 toward −∞ (infinity stays).
#[inline]
pub fn next_down(x: f32) -> f32 {
    x.next_down()
}
