//! Random numbers, directions and worlds for the tests. Seeds are fixed.
#![allow(dead_code)]

use etendue_bvh::{BuildOptions, TreeAccel, World};
use etendue_core::glam::DVec3;
use etendue_core::{Ray, Vec3, Vec3A, vector};
use etendue_geometry::TriangleMesh;

/// SplitMix64 (Steele, Lea & Flood 2014).
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// `[0, 1)`
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1u64 << 24) as f32
    }

    pub(crate) fn unit_f64(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub(crate) fn range(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * self.unit()
    }

    /// Ten to a uniform power.
    pub(crate) fn magnitude(&mut self, lo: f64, hi: f64) -> f32 {
        10f64.powf(lo + (hi - lo) * self.unit_f64()) as f32
    }

    pub(crate) fn point(&mut self, half: f32) -> Vec3A {
        Vec3A::new(self.range(-half, half), self.range(-half, half), self.range(-half, half))
    }

    pub(crate) fn direction(&mut self) -> Vec3A {
        loop {
            let v = self.point(1.0);
            let l = v.dot(v);
            if l > 0.01 && l <= 1.0 {
                return vector::normalize(v);
            }
        }
    }
}

pub(crate) fn tree(world: &World) -> TreeAccel {
    TreeAccel::build(world, &BuildOptions::default(), &|| false).expect("the world is sound")
}

pub(crate) fn soup(rng: &mut Rng, triangles: usize, half: f32, size: f32) -> TriangleMesh {
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for i in 0..triangles as u32 {
        let center = rng.point(half);
        for _ in 0..3 {
            positions.push(Vec3::from(center + rng.point(size)));
        }
        indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    TriangleMesh::new(positions, indices).expect("indices count up")
}

/// The same mesh with other positions.
pub(crate) fn mapped(mesh: &TriangleMesh, f: impl Fn(Vec3A) -> Vec3A) -> TriangleMesh {
    let positions = mesh.positions().iter().map(|&p| Vec3::from(f(Vec3A::from(p)))).collect();
    TriangleMesh::new(positions, mesh.indices().to_vec()).expect("same indices")
}

/// From `o` toward `target`, in the best single-precision direction.
pub(crate) fn aimed(o: Vec3A, target: DVec3) -> Option<Ray> {
    let d = target - wide(o);
    let l = d.dot(d).sqrt();
    if !(l > 0.0 && l.is_finite()) {
        return None;
    }
    let d = d / l;
    Some(Ray::new(o, Vec3A::new(d.x as f32, d.y as f32, d.z as f32)))
}

pub(crate) fn wide(v: Vec3A) -> DVec3 {
    DVec3::new(v.x as f64, v.y as f64, v.z as f64)
}

/// 2^k.
pub(crate) fn power(k: i32) -> f32 {
    f32::from_bits(((127 + k) as u32) << 23)
}
