use etendue_core::Aabb;

use super::binary::{Binary, half_area};
use crate::kernel::{Child, Node, Tree, WIDTH};

/// What traversal costs, in units of one node.
pub(crate) struct Costs {
    /// Testing one leaf item.
    pub(crate) item: f32,
    /// Primitives of one leaf item.
    pub(crate) per_item: usize,
    /// Most primitives of one leaf.
    pub(crate) most: usize,
}

impl Costs {
    fn leaf(&self, primitives: u32) -> f32 {
        if primitives as usize > self.most {
            f32::INFINITY
        } else {
            self.item * (primitives as usize).div_ceil(self.per_item) as f32
        }
    }
}

/// Where finished leaves go.
pub(crate) trait Leaves {
    /// Stores the primitives of a leaf as consecutive items and returns the first, and how many there are.
    fn store(&mut self, primitives: &[u32]) -> Stored;
}

/// Leaf items that were stored.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored {
    pub(crate) first: u32,
    pub(crate) count: u32,
}

/// The best way to give a subtree up to `j` places in a wide node, for j = 1 … 4: the dynamic programme of Ylitie,
/// Karras & Laine 2017 ("Efficient incoherent ray traversal on GPUs through compressed wide BVHs", section 3.1).
#[derive(Clone, Copy, Default)]
struct Plan {
    /// Least cost with at most 1, 2, 3 places.
    cost: [f32; WIDTH - 1],
    /// Places for the left child where 2, 3, 4 are split.
    left: [u8; WIDTH - 1],
    /// Whether 2, 3 places are better used as fewer.
    fewer: [bool; WIDTH - 2],
    /// Whether one place holds a leaf.
    leaf: bool,
    primitives: u32,
}

/// Cuts a fitted binary tree into a wide one of least expected cost.
pub(super) fn collapse(binary: &Binary, costs: &Costs, leaves: &mut impl Leaves) -> Tree {
    let plans = plan(binary, costs);
    let mut tree = Tree { nodes: vec![Node::EMPTY], bounds: bounds(binary, 0), waiting: 0 };
    let mut deepest = 0;
    let mut primitives = Vec::new();
    // Nodes to fill: binary root, wide index, depth.
    let mut open = vec![(0u32, 0usize, 1usize)];
    while let Some((from, to, depth)) = open.pop() {
        deepest = deepest.max(depth);
        let mut roots = [0u32; WIDTH];
        let count = places(binary, &plans, from, depth == 1, &mut roots);
        for (place, &root) in roots.iter().take(count).enumerate() {
            let child = if plans[root as usize].leaf {
                primitives.clear();
                gather(binary, root, &mut primitives);
                let stored = leaves.store(&primitives);
                Child::leaf(stored.first, stored.count)
            } else {
                let index = tree.nodes.len();
                tree.nodes.push(Node::EMPTY);
                open.push((root, index, depth + 1));
                Child::node(index as u32)
            };
            let b = bounds(binary, root);
            tree.nodes[to].set(place, &b, child);
        }
    }
    // Each level leaves all but one of its children behind, and the last one all of them.
    tree.waiting = (deepest * (WIDTH - 1) + 1).min(Tree::MOST_WAITING);
    tree
}

fn bounds(binary: &Binary, node: u32) -> Aabb {
    binary.nodes.get(node as usize).map_or(Aabb::EMPTY, |n| n.bounds)
}

fn plan(binary: &Binary, costs: &Costs) -> Vec<Plan> {
    let mut plans = vec![Plan::default(); binary.nodes.len()];
    // Relative to the root, so that no scale leaves the range of single precision.
    let whole = half_area(&bounds(binary, 0));
    let inverse = if whole > 0.0 { 1.0 / whole } else { 0.0 };
    for i in (0..binary.nodes.len()).rev() {
        let node = binary.nodes[i];
        let area = (half_area(&node.bounds) * inverse) as f32;
        if node.is_leaf() {
            let cost = area * costs.leaf(1);
            plans[i] = Plan { cost: [cost; WIDTH - 1], leaf: true, primitives: 1, ..Plan::default() };
            continue;
        }
        let (l, r) = (plans[node.left as usize], plans[node.right as usize]);
        let mut p = Plan { primitives: l.primitives + r.primitives, ..Plan::default() };
        let mut split = [f32::INFINITY; WIDTH - 1];
        for j in 2..=WIDTH {
            for k in 1..j {
                let cost = l.cost[k - 1] + r.cost[j - k - 1];
                if cost < split[j - 2] || p.left[j - 2] == 0 {
                    split[j - 2] = cost;
                    p.left[j - 2] = k as u8;
                }
            }
        }
        let inner = split[WIDTH - 2] + area;
        let leaf = area * costs.leaf(p.primitives);
        p.leaf = leaf <= inner;
        p.cost[0] = if p.leaf { leaf } else { inner };
        for j in 2..WIDTH {
            p.fewer[j - 2] = p.cost[j - 2] <= split[j - 2];
            p.cost[j - 1] = if p.fewer[j - 2] { p.cost[j - 2] } else { split[j - 2] };
        }
        plans[i] = p;
    }
    plans
}

/// The subtrees that fill the places of the wide node made from `from`.
fn places(binary: &Binary, plans: &[Plan], from: u32, is_root: bool, roots: &mut [u32; WIDTH]) -> usize {
    let mut count = 0;
    let mut open = [(0u32, 0usize); WIDTH];
    let mut top = 0;
    let node = binary.nodes[from as usize];
    if is_root && plans[from as usize].leaf {
        // The whole tree is one leaf.
        roots[0] = from;
        return 1;
    }
    let k = usize::from(plans[from as usize].left[WIDTH - 2]);
    for entry in [(node.right, WIDTH - k), (node.left, k)] {
        open[top] = entry;
        top += 1;
    }
    while top > 0 {
        top -= 1;
        let (at, mut j) = open[top];
        let p = &plans[at as usize];
        let n = binary.nodes[at as usize];
        while j > 1 && (n.is_leaf() || p.fewer[j - 2]) {
            j -= 1;
        }
        if j <= 1 {
            roots[count] = at;
            count += 1;
            continue;
        }
        let k = usize::from(p.left[j - 2]);
        for entry in [(n.right, j - k), (n.left, k)] {
            open[top] = entry;
            top += 1;
        }
    }
    count
}

fn gather(binary: &Binary, root: u32, primitives: &mut Vec<u32>) {
    let mut open = vec![root];
    while let Some(at) = open.pop() {
        let Some(n) = binary.nodes.get(at as usize) else { continue };
        if n.is_leaf() {
            primitives.push(n.left);
        } else {
            open.push(n.right);
            open.push(n.left);
        }
    }
}
