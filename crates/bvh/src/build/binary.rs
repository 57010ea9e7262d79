use etendue_core::{Aabb, Vec3A, vector};

use super::{Cancel, clusters, grouping};
use crate::{BuildError, Quality};

/// A binary tree with one primitive in each leaf. Children come after their parent.
pub(super) struct Binary {
    pub(super) nodes: Vec<BinaryNode>,
}

/// Two children, or a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    pub(super) bounds: Aabb,
    /// First child, or the primitive.
    pub(super) left: u32,
    /// Second child, or [`BinaryNode::LEAF`].
    pub(super) right: u32,
}

impl BinaryNode {
    const LEAF: u32 = u32::MAX;

    const UNFINISHED: Self = Self { bounds: Aabb::EMPTY, left: 0, right: Self::LEAF };

    pub(super) fn is_leaf(&self) -> bool {
        self.right == Self::LEAF
    }
}

/// Sets of primitives nest no deeper than this; what is left is halved. Each level magnifies by up to 2²¹, so that
/// twelve of them span the range of single precision.
const MOST_LEVELS: u32 = 12;

/// Sets no larger than this are halved at once.
const SMALL: usize = 3;

/// A set of primitives that waits to become the subtree at a node.
struct Pending {
    node: u32,
    members: Vec<u32>,
    level: u32,
}

impl Binary {
    /// By clustering, with nested clusterings where many primitives crowd in one cell of the larger one.
    pub(super) fn clustered(
        boxes: &[Aabb],
        quality: Quality,
        cancel: Cancel<'_>,
    ) -> Result<Self, BuildError> {
        let mut tree = Self::with_room_for(boxes.len());
        let mut pending = vec![Pending { node: 0, members: (0..boxes.len() as u32).collect(), level: 0 }];
        while let Some(Pending { node, mut members, level }) = pending.pop() {
            if cancel() {
                return Err(BuildError::Cancelled);
            }
            let groups = if members.len() <= SMALL || level >= MOST_LEVELS {
                None
            } else {
                grouping::grouped(boxes, &mut members)
            };
            let Some(groups) = groups else {
                tree.halve(boxes, node, &mut members, cancel)?;
                continue;
            };
            let Some(clusters) = clusters::cluster(boxes, &members, &groups, quality, cancel)? else {
                tree.halve(boxes, node, &mut members, cancel)?;
                continue;
            };
            // Copy the clusters' tree; a leaf that is a group waits for its turn.
            let mut open = vec![(0u32, node)];
            while let Some((from, to)) = open.pop() {
                match clusters.at(from) {
                    clusters::Step::Children(first) => {
                        let left = tree.add_pair(to);
                        open.push((first + 1, left + 1));
                        open.push((first, left));
                    }
                    clusters::Step::Group(group) => {
                        let range = groups.get(group as usize).cloned().unwrap_or(0..0);
                        match members.get(range).unwrap_or(&[]) {
                            [only] => tree.set_leaf(to, *only),
                            many => {
                                pending.push(Pending { node: to, members: many.to_vec(), level: level + 1 })
                            }
                        }
                    }
                }
            }
        }
        Ok(tree)
    }

    /// By halving along the widest axis: no deeper than the logarithm of the number of primitives.
    pub(super) fn halved(boxes: &[Aabb], cancel: Cancel<'_>) -> Result<Self, BuildError> {
        let mut tree = Self::with_room_for(boxes.len());
        let mut members: Vec<u32> = (0..boxes.len() as u32).collect();
        tree.halve(boxes, 0, &mut members, cancel)?;
        Ok(tree)
    }

    fn with_room_for(primitives: usize) -> Self {
        let mut nodes = Vec::with_capacity(2 * primitives);
        nodes.push(BinaryNode::UNFINISHED);
        Self { nodes }
    }

    /// Gives a node two unfinished children and returns the first.
    fn add_pair(&mut self, node: u32) -> u32 {
        let left = self.nodes.len() as u32;
        self.nodes.extend([BinaryNode::UNFINISHED; 2]);
        if let Some(n) = self.nodes.get_mut(node as usize) {
            (n.left, n.right) = (left, left + 1);
        }
        left
    }

    fn set_leaf(&mut self, node: u32, primitive: u32) {
        if let Some(n) = self.nodes.get_mut(node as usize) {
            (n.left, n.right) = (primitive, BinaryNode::LEAF);
        }
    }

    fn halve(
        &mut self,
        boxes: &[Aabb],
        node: u32,
        members: &mut [u32],
        cancel: Cancel<'_>,
    ) -> Result<(), BuildError> {
        let mut open = vec![(node, members)];
        while let Some((node, members)) = open.pop() {
            if members.len() > 4096 && cancel() {
                return Err(BuildError::Cancelled);
            }
            match members {
                [] => {}
                [only] => self.set_leaf(node, *only),
                many => {
                    let axis = vector::max_axis(grouping::centroids(boxes, many).extent());
                    let key = |&i: &u32| grouping::centroid(boxes, i)[axis];
                    let half = many.len() / 2;
                    // The number breaks ties, so that the tree is the same wherever it is built.
                    many.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
                    let (low, high) = many.split_at_mut(half);
                    let left = self.add_pair(node);
                    open.push((left + 1, high));
                    open.push((left, low));
                }
            }
        }
        Ok(())
    }

    /// Computes all boxes from those of the primitives.
    pub(super) fn fit(&mut self, boxes: &[Aabb]) {
        for i in (0..self.nodes.len()).rev() {
            let bounds = |n: u32| self.nodes.get(n as usize).map_or(Aabb::EMPTY, |n| n.bounds);
            let n = self.nodes[i];
            let fitted = if n.is_leaf() {
                boxes.get(n.left as usize).copied().unwrap_or(Aabb::EMPTY)
            } else {
                bounds(n.left).union(bounds(n.right))
            };
            self.nodes[i].bounds = fitted;
        }
    }

    /// Nodes on the longest way from the root to a leaf.
    pub(super) fn depth(&self) -> u32 {
        let mut depths = vec![1u32; self.nodes.len()];
        let mut deepest = 1;
        for (i, n) in self.nodes.iter().enumerate() {
            let d = depths[i];
            deepest = deepest.max(d);
            if !n.is_leaf() {
                for child in [n.left, n.right] {
                    if let Some(c) = depths.get_mut(child as usize) {
                        *c = d + 1;
                    }
                }
            }
        }
        deepest
    }
}

/// Half the surface area of a box, m², in double precision so that no scale overflows it.
pub(super) fn half_area(b: &Aabb) -> f64 {
    let e: Vec3A = b.extent();
    let (x, y, z) = (f64::from(e.x), f64::from(e.y), f64::from(e.z));
    x * y + y * z + z * x
}
