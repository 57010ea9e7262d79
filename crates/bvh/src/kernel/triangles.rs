use etendue_core::rounding::U;
use etendue_core::{Ray, Vec3A, vector};

/// Triangles of one block.
pub(crate) const BLOCK: usize = 4;

/// Up to four triangles side by side.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(crate) struct Block {
    /// By corner, axis and triangle.
    corners: [[[f32; BLOCK]; 3]; 3],
    /// Geometry of each triangle.
    pub(crate) geom: [u32; BLOCK],
    /// Triangle within its mesh.
    pub(crate) prim: [u32; BLOCK],
}

/// One triangle on its way into a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockTriangle {
    pub(crate) corners: [Vec3A; 3],
    pub(crate) geom: u32,
    pub(crate) prim: u32,
}

impl Block {
    /// Marks a place without a triangle.
    const VACANT: u32 = u32::MAX;

    /// At most four are kept.
    pub(crate) fn new(triangles: impl Iterator<Item = BlockTriangle>) -> Self {
        let mut block = Self {
            corners: [[[0.0; BLOCK]; 3]; 3],
            geom: [Self::VACANT; BLOCK],
            prim: [Self::VACANT; BLOCK],
        };
        for (place, triangle) in triangles.take(BLOCK).enumerate() {
            for (corner, p) in triangle.corners.iter().enumerate() {
                for axis in 0..3 {
                    block.corners[corner][axis][place] = p[axis];
                }
            }
            block.geom[place] = triangle.geom;
            block.prim[place] = triangle.prim;
        }
        block
    }

    #[inline]
    pub(crate) fn triangle(&self, place: usize) -> [Vec3A; 3] {
        self.corners.each_ref().map(|c| Vec3A::new(c[0][place], c[1][place], c[2][place]))
    }

    /// Which triangles the ray may meet: every one that the exact test accepts, and few others.
    ///
    /// The edge functions of the exact test in single precision, with a bound on their error. Let s bound the
    /// magnitudes of a corner's translated coordinates and q those of its sheared ones. Translating, shearing and the
    /// rounded shear move a sheared coordinate by at most 5 u s; an edge function of two corners then is off by no
    /// more than 10 u s (q + q') + 64 u² s². Only where one is certainly negative and another certainly positive is
    /// the triangle out. Anything that is not a number stays in.
    #[inline(always)]
    pub(crate) fn candidates(&self, ray: &FilterRay) -> [bool; BLOCK] {
        let [kx, ky, kz] = ray.axes;
        let (mut x, mut y) = ([[0.0f32; BLOCK]; 3], [[0.0f32; BLOCK]; 3]);
        let (mut sheared, mut depth) = ([0.0f32; BLOCK], [0.0f32; BLOCK]);
        for c in 0..3 {
            let corner = &self.corners[c];
            for i in 0..BLOCK {
                let z = corner[kz][i] - ray.origin[2];
                let px = (corner[kx][i] - ray.origin[0]) - ray.shear[0] * z;
                let py = (corner[ky][i] - ray.origin[1]) - ray.shear[1] * z;
                x[c][i] = px;
                y[c][i] = py;
                sheared[i] += px.abs() + py.abs();
                depth[i] += z.abs();
            }
        }
        let mut out = [false; BLOCK];
        for i in 0..BLOCK {
            let u = x[1][i] * y[2][i] - y[1][i] * x[2][i];
            let v = x[2][i] * y[0][i] - y[2][i] * x[0][i];
            let w = x[0][i] * y[1][i] - y[0][i] * x[1][i];
            // |a| <= |sheared| + |z| on each of the two axes across, and |z| along.
            let s = sheared[i] + 3.0 * depth[i];
            // The last term covers what products lose below the smallest normal number.
            let bound = s * (10.0 * U * sheared[i] + 64.0 * U * U * s) + f32::MIN_POSITIVE;
            let negative = (u < -bound) | (v < -bound) | (w < -bound);
            let positive = (u > bound) | (v > bound) | (w > bound);
            out[i] = !(negative & positive) & (self.geom[i] != Self::VACANT);
        }
        out
    }
}

/// A ray prepared for [`Block::candidates`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct FilterRay {
    axes: [usize; 3],
    origin: [f32; 3],
    shear: [f32; 2],
}

impl FilterRay {
    #[inline]
    pub(crate) fn new(ray: &Ray) -> Self {
        let axes = match vector::max_axis(ray.d.abs()) {
            0 => [1, 2, 0],
            1 => [2, 0, 1],
            _ => [0, 1, 2],
        };
        let d = axes.map(|k| ray.d[k]);
        Self { axes, origin: axes.map(|k| ray.o[k]), shear: [d[0] / d[2], d[1] / d[2]] }
    }
}
