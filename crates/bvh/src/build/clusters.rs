//! The door to obvhs: parallel locally ordered clustering (Meister & Bittner 2018) and parallel reinsertion (Meister
//! & Bittner 2018), on boxes that it can work with.

use std::ops::Range;

use etendue_core::glam::DVec3;
use etendue_core::{Aabb, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::Cancel;
use crate::{BuildError, Quality};

/// A tree deeper than this is not improved any further. The optimiser's own stack holds many times as much.
const MOST_DEPTH: u32 = 64;

/// Room on the optimiser's stack, in levels. It panics when that is full, so depth is looked at after each pass.
const STACK_LEVELS: usize = 512;

/// The clustering of some groups.
pub(super) struct Clusters(Bvh2);

/// What a node of the clustering is.
pub(super) enum Step {
    /// The first of two neighbouring children.
    Children(u32),
    /// A group.
    Group(u32),
}

impl Clusters {
    pub(super) fn at(&self, node: u32) -> Step {
        match self.0.nodes.get(node as usize) {
            Some(n) if n.prim_count == 0 => Step::Children(n.first_index),
            Some(n) => {
                Step::Group(self.0.primitive_indices.get(n.first_index as usize).copied().unwrap_or(u32::MAX))
            }
            None => Step::Group(u32::MAX),
        }
    }
}

/// Clusters at least two groups; `None` where the tree becomes too deep.
pub(super) fn cluster(
    boxes: &[Aabb],
    members: &[u32],
    groups: &[Range<usize>],
    quality: Quality,
    cancel: Cancel<'_>,
) -> Result<Option<Clusters>, BuildError> {
    let normal = normalised(boxes, members, groups);
    let (search, first_passes) = match quality {
        Quality::Fast => (PlocSearchDistance::Low, 2),
        Quality::Balanced => (PlocSearchDistance::Medium, 3),
        Quality::High => (PlocSearchDistance::High, 2),
    };
    let indices = (0..groups.len() as u32).collect();
    let mut bvh = PlocBuilder::with_capacity(groups.len()).build(
        search,
        &normal,
        indices,
        SortPrecision::U64,
        first_passes,
    );
    bvh.max_depth = STACK_LEVELS;
    bvh.init_parents_if_uninit();
    let mut optimizer = ReinsertionOptimizer::default();
    for ratio in passes(quality) {
        if cancel() {
            return Err(BuildError::Cancelled);
        }
        if depth(&bvh) > MOST_DEPTH {
            return Ok(None);
        }
        optimizer.run(&mut bvh, ratio, Some(vec![1.0]));
    }
    Ok((depth(&bvh) <= MOST_DEPTH).then_some(Clusters(bvh)))
}

/// The part of the nodes that each pass of the optimiser moves, most at first.
fn passes(quality: Quality) -> Vec<f32> {
    let sequence = |ratio: f32, count: u32| (0..count).map(|n| ratio / (2 * n + 1) as f32).collect();
    match quality {
        Quality::Fast => Vec::new(),
        Quality::Balanced => sequence(0.1, 8),
        Quality::High => sequence(0.5, 16),
    }
}

/// The groups' boxes in the unit cube, made distinct: each grows by a hash of its number, by less than a thousandth
/// of its own size and a cell of the sorting grid. Equal areas would make each box choose its last neighbour, and
/// no two would choose each other. Only the shape of the tree sees these boxes.
fn normalised(boxes: &[Aabb], members: &[u32], groups: &[Range<usize>]) -> Vec<obvhs::aabb::Aabb> {
    let of_group = |g: &Range<usize>| {
        members.get(g.clone()).unwrap_or(&[]).iter().fold(Aabb::EMPTY, |b, &i| match boxes.get(i as usize) {
            Some(other) => b.union(*other),
            None => b,
        })
    };
    let wide = |v: Vec3A| DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z));
    let grouped: Vec<Aabb> = groups.iter().map(of_group).collect();
    let all = grouped.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    let origin = wide(all.lo);
    let extent = wide(all.hi) - origin;
    let largest = [extent.x, extent.y, extent.z].into_iter().fold(0.0, |a: f64, b| if b > a { b } else { a });
    let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
    let narrow = |v: DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
    grouped
        .iter()
        .enumerate()
        .map(|(i, b)| {
            let (lo, hi) = ((wide(b.lo) - origin) * scale, (wide(b.hi) - origin) * scale);
            let grow = ((hi - lo) * 1e-3 + DVec3::splat(5e-7)) * hashed(i as u32);
            obvhs::aabb::Aabb { min: narrow(lo - grow), max: narrow(hi + grow) }
        })
        .collect()
}

/// A number in `[0, 1)` for each number.
fn hashed(i: u32) -> f64 {
    let h = i.wrapping_mul(0x9e37_79b1);
    let h = (h ^ h >> 15).wrapping_mul(0x85eb_ca77);
    f64::from(h ^ h >> 13) / 4_294_967_296.0
}

fn depth(bvh: &Bvh2) -> u32 {
    // Parents mostly stand before their children, so most walks end at once.
    let mut depths = vec![0u32; bvh.nodes.len()];
    let mut walked = Vec::new();
    let mut deepest = 1;
    for node in 0..bvh.nodes.len() {
        let mut at = node;
        while at != 0 && depths[at] == 0 {
            walked.push(at);
            at = bvh.parents.get(at).map_or(0, |&p| p as usize).min(node_limit(bvh));
        }
        let mut d = if at == 0 { 1 } else { depths[at] };
        while let Some(n) = walked.pop() {
            d += 1;
            depths[n] = d;
        }
        deepest = deepest.max(d);
    }
    deepest
}

fn node_limit(bvh: &Bvh2) -> usize {
    bvh.nodes.len().saturating_sub(1)
}
