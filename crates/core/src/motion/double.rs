//! Vectors in double precision, by operations whose bits do not depend on the target.

use glam::{DVec3, Vec3A};

pub(super) fn widened(v: Vec3A) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

pub(super) fn narrowed(v: DVec3) -> Vec3A {
    Vec3A::new(v.x as f32, v.y as f32, v.z as f32)
}

pub(super) fn dot(a: DVec3, b: DVec3) -> f64 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

pub(super) fn cross(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

pub(super) fn length(v: DVec3) -> f64 {
    dot(v, v).sqrt()
}

pub(super) fn min(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::select(a.cmplt(b), a, b)
}

pub(super) fn max(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::select(a.cmpgt(b), a, b)
}
