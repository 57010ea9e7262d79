//! Directions as points of a cube's faces, and square cells on them.
//!
//! Coordinates are quotients of components, so a direction a thousandth of a degree from an axis keeps its digits, as
//! it would not in (cos θ, φ); and the planes x = 0, y = 0, z = 0 are borders of cells, so a horizon cuts none.

use etendue_core::Vec3A;

/// Where a direction leaves the cube.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnCube {
    pub(crate) face: u8,
    /// In `[-1, 1]²`.
    pub(crate) at: [f64; 2],
}

impl OnCube {
    pub(crate) fn of(d: Vec3A) -> Self {
        let d = d.to_array().map(f64::from);
        let mut axis = 0;
        for i in 1..3 {
            if d[i].abs() > d[axis].abs() {
                axis = i;
            }
        }
        let face = 2 * axis as u8 + u8::from(d[axis] < 0.0);
        let scale = 1.0 / d[axis].abs();
        Self { face, at: [d[(axis + 1) % 3] * scale, d[(axis + 2) % 3] * scale] }
    }
}

/// A square cell of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub(crate) face: u8,
    pub(crate) corner: [f64; 2],
    pub(crate) size: f64,
}

/// Two integrands over one cell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// The integrals.
    pub(crate) integral: [f64; 2],
    /// The largest values met.
    pub(crate) peak: [f64; 2],
    pub(crate) solid_angle: f64,
}

impl Sums {
    pub(crate) fn plus(self, o: Self) -> Self {
        Self {
            integral: [self.integral[0] + o.integral[0], self.integral[1] + o.integral[1]],
            peak: [self.peak[0].max(o.peak[0]), self.peak[1].max(o.peak[1])],
            solid_angle: self.solid_angle + o.solid_angle,
        }
    }
}

impl Cell {
    pub(crate) fn faces() -> impl Iterator<Item = Self> {
        (0..6).map(|face| Self { face, corner: [-1.0, -1.0], size: 2.0 })
    }

    pub(crate) fn middle(&self) -> [f64; 2] {
        self.corner.map(|c| c + 0.5 * self.size)
    }

    /// The quarters, in the order low-low, high-low, low-high, high-high.
    pub(crate) fn quarters(&self) -> [Self; 4] {
        let size = 0.5 * self.size;
        [[0.0, 0.0], [size, 0.0], [0.0, size], [size, size]].map(|offset: [f64; 2]| Self {
            face: self.face,
            corner: [self.corner[0] + offset[0], self.corner[1] + offset[1]],
            size,
        })
    }

    fn direction(&self, u: f64, v: f64) -> Vec3A {
        let length = (1.0 + u * u + v * v).sqrt();
        let axis = usize::from(self.face / 2);
        let mut d = [0.0; 3];
        d[axis] = if self.face.is_multiple_of(2) { 1.0 } else { -1.0 } / length;
        d[(axis + 1) % 3] = u / length;
        d[(axis + 2) % 3] = v / length;
        Vec3A::from(d.map(|x| x as f32))
    }

    /// Gauss–Legendre with 3 × 3 nodes, in solid angle.
    pub(crate) fn gauss(&self, f: &dyn Fn(Vec3A) -> [f64; 2]) -> Sums {
        const NODES: [[f64; 2]; 3] =
            [[0.112_701_665_379_258_3, 5.0 / 18.0], [0.5, 8.0 / 18.0], [0.887_298_334_620_741_7, 5.0 / 18.0]];
        let mut out = Sums::default();
        for [x, wx] in NODES {
            let u = self.corner[0] + self.size * x;
            for [y, wy] in NODES {
                let v = self.corner[1] + self.size * y;
                let value = f(self.direction(u, v));
                let q = 1.0 + u * u + v * v;
                let weight = wx * wy * self.size * self.size / (q * q.sqrt());
                out.solid_angle += weight;
                for ((integral, peak), v) in out.integral.iter_mut().zip(&mut out.peak).zip(value) {
                    *integral += weight * v;
                    *peak = peak.max(v);
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_come_back_and_cells_fill_the_sphere() {
        let sixteenths = Cell::faces().flat_map(|c| c.quarters()).flat_map(|c| c.quarters());
        let whole: f64 = sixteenths.map(|c| c.gauss(&|_| [1.0, 0.0]).integral[0]).sum();
        assert!((whole / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-5, "{whole}");
        for cell in Cell::faces() {
            for [u, v] in [[0.0, 0.0], [0.25, -0.75], [-0.5, 0.125]] {
                let on = OnCube::of(cell.direction(u, v));
                assert_eq!(on.face, cell.face);
                assert!((on.at[0] - u).abs() < 1e-6 && (on.at[1] - v).abs() < 1e-6);
            }
        }
    }
}
