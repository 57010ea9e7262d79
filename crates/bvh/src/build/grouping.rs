use std::ops::Range;

use etendue_core::{Aabb, Vec3A};

/// Cells per axis: as fine as the clustering sorts.
const CELLS: f64 = (1u64 << 21) as f64;

/// More than this many primitives of one cell become a group of their own. Clustering compares neighbours in the
/// order of the cells; among many of the same place it degenerates to one merge a pass.
const CROWD: usize = 4;

pub(super) fn centroid(boxes: &[Aabb], i: u32) -> Vec3A {
    boxes.get(i as usize).map_or(Vec3A::ZERO, Aabb::center)
}

/// The box of the centres.
pub(super) fn centroids(boxes: &[Aabb], members: &[u32]) -> Aabb {
    Aabb::of_points(members.iter().map(|&i| centroid(boxes, i)))
}

/// Sorts the members along a space-filling curve through their centres and cuts the order into groups: single
/// primitives, and crowds. `None` where all centres are equal.
pub(super) fn grouped(boxes: &[Aabb], members: &mut [u32]) -> Option<Vec<Range<usize>>> {
    let range = centroids(boxes, members);
    if range.lo == range.hi {
        return None;
    }
    let widths = range.extent();
    let scale: [f64; 3] = std::array::from_fn(|i| {
        let w = f64::from(widths[i]);
        if w > 0.0 { (CELLS - 1.0) / w } else { 0.0 }
    });
    let code = |i: u32| {
        let c = centroid(boxes, i);
        let cell = |axis: usize| ((f64::from(c[axis]) - f64::from(range.lo[axis])) * scale[axis]) as u64;
        spread(cell(0)) | spread(cell(1)) << 1 | spread(cell(2)) << 2
    };
    let mut sorted: Vec<(u64, u32)> = members.iter().map(|&i| (code(i), i)).collect();
    sorted.sort_unstable();

    let mut groups = Vec::with_capacity(sorted.len());
    let mut start = 0;
    for run in sorted.chunk_by(|a, b| a.0 == b.0) {
        if run.len() > CROWD {
            groups.push(start..start + run.len());
        } else {
            groups.extend((start..start + run.len()).map(|i| i..i + 1));
        }
        start += run.len();
    }
    for (place, (_, i)) in members.iter_mut().zip(&sorted) {
        *place = *i;
    }
    // One crowd of everything would not get smaller.
    (groups.len() > 1).then_some(groups)
}

/// Two zero bits after each of the lower 21.
fn spread(x: u64) -> u64 {
    let x = x & 0x1f_ffff;
    let x = (x | x << 32) & 0x1f_0000_0000_ffff;
    let x = (x | x << 16) & 0x1f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_leaves_two_gaps() {
        assert_eq!(spread(0b111), 0b1001001);
        assert_eq!(spread(0x1f_ffff).count_ones(), 21);
        assert_eq!(spread(1 << 20), 1 << 60);
    }

    #[test]
    fn crowds_are_groups() {
        let cube = |x: f32| Aabb { lo: Vec3A::splat(x), hi: Vec3A::splat(x + 1.0) };
        let mut boxes = vec![cube(0.0); 10];
        boxes.push(cube(5.0));
        let mut members: Vec<u32> = (0..11).collect();
        let groups = grouped(&boxes, &mut members).unwrap();
        assert_eq!(groups, vec![0..10, 10..11]);
        assert!(grouped(&boxes, &mut [0, 1, 2]).is_none(), "equal centres cannot be told apart");
    }
}
