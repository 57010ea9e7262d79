use etendue_core::rounding::U;
use etendue_core::{Ray, Vec3A, Vec4, vector};

/// Triangles of one block.
pub(crate) const BLOCK: usize = 4;

/// Up to four triangles side by side.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(crate) struct Block {
    /// By corner, axis and triangle.
    corners: [[Vec4; 3]; 3],
    /// Geometry of each triangle.
    pub(crate) geom: [u32; BLOCK],
    /// Triangle within its mesh.
    pub(crate) prim: [u32; BLOCK],
    /// A bit for each place that holds a triangle.
    occupied: u32,
}

/// One triangle on its way into a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockTriangle {
    pub(crate) corners: [Vec3A; 3],
    pub(crate) geom: u32,
    pub(crate) prim: u32,
}

impl Block {
    /// At most four are kept.
    pub(crate) fn new(triangles: impl Iterator<Item = BlockTriangle>) -> Self {
        let mut block =
            Self { corners: [[Vec4::ZERO; 3]; 3], geom: [0; BLOCK], prim: [0; BLOCK], occupied: 0 };
        for (place, triangle) in triangles.take(BLOCK).enumerate() {
            for (corner, p) in triangle.corners.iter().enumerate() {
                for axis in 0..3 {
                    block.corners[corner][axis][place] = p[axis];
                }
            }
            block.geom[place] = triangle.geom;
            block.prim[place] = triangle.prim;
            block.occupied |= 1 << place;
        }
        block
    }

    #[inline]
    pub(crate) fn triangle(&self, place: usize) -> [Vec3A; 3] {
        self.corners.each_ref().map(|c| Vec3A::new(c[0][place], c[1][place], c[2][place]))
    }

    /// A bit for each triangle that the ray may meet: every one that the exact test accepts, and few others.
    ///
    /// The edge functions of the exact test in single precision, with a bound on their error. Let s bound the
    /// magnitudes of a corner's translated coordinates and q those of its sheared ones. Translating, shearing and the
    /// rounded shear move a sheared coordinate by at most 5 u s; an edge function of two corners then is off by no
    /// more than 10 u s (q + q') + 64 u² s². Only where one is certainly negative and another certainly positive is
    /// the triangle out. Anything that is not a number stays in.
    #[inline(always)]
    pub(crate) fn candidates(&self, ray: &FilterRay) -> u32 {
        let [kx, ky, kz] = ray.axes;
        let mut x = [Vec4::ZERO; 3];
        let mut y = [Vec4::ZERO; 3];
        let (mut sheared, mut depth) = (Vec4::ZERO, Vec4::ZERO);
        for (c, corner) in self.corners.iter().enumerate() {
            let z = corner[kz] - Vec4::splat(ray.origin[2]);
            x[c] = (corner[kx] - Vec4::splat(ray.origin[0])) - z * ray.shear[0];
            y[c] = (corner[ky] - Vec4::splat(ray.origin[1])) - z * ray.shear[1];
            sheared += x[c].abs() + y[c].abs();
            depth += z.abs();
        }
        let u = x[1] * y[2] - y[1] * x[2];
        let v = x[2] * y[0] - y[2] * x[0];
        let w = x[0] * y[1] - y[0] * x[1];
        // |a| <= |sheared| + |z| on each of the two axes across, and |z| along.
        let s = sheared + depth * 3.0;
        // The last term covers what products lose below the smallest normal number.
        let bound = s * (sheared * (10.0 * U) + s * (64.0 * U * U)) + Vec4::splat(f32::MIN_POSITIVE);
        let negative = u.cmplt(-bound) | v.cmplt(-bound) | w.cmplt(-bound);
        let positive = u.cmpgt(bound) | v.cmpgt(bound) | w.cmpgt(bound);
        !(negative & positive).bitmask() & self.occupied
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
