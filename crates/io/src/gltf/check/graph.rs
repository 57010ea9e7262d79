//! The nodes as a forest. Only parents are followed, of which a node has one, so that no graph is too deep or too
//! tangled.

use super::model::Model;
use super::report::{At, Report};
use super::values::{index, list};

/// The forest of the nodes. Nodes on a loop, and all below them, belong to no root.
pub(super) struct Forest {
    /// The last parent that a node was given.
    pub parent: Vec<Option<usize>>,
    /// The root above a node.
    pub root: Vec<Option<usize>>,
    /// Entry into and exit from a node in a walk of the forest: an ancestor's span contains its descendants'.
    span: Vec<(usize, usize)>,
}

impl Forest {
    /// Reads the children of all nodes, and says which have two parents or are on a loop.
    pub(super) fn new(model: &Model<'_>, report: &mut Report) -> Self {
        let nodes = model.list("nodes");
        let mut parent: Vec<Option<usize>> = vec![None; nodes.len()];
        let array = At::Root.key("nodes");
        for (i, node) in nodes.iter().enumerate() {
            let here = array.index(i);
            let here = here.key("children");
            for (k, child) in list(node, "children").iter().enumerate() {
                let Some(slot) = index(child).and_then(|c| parent.get_mut(c)) else { continue };
                if let Some(first) = slot.filter(|first| *first != i) {
                    report.error("NODE_PARENT_OVERRIDE", &here.index(k), || {
                        format!("the node is already a child of node {first}; a node has one parent")
                    });
                }
                *slot = Some(i);
            }
        }
        let mut forest = Self { root: vec![None; nodes.len()], span: vec![(0, 0); nodes.len()], parent };
        forest.walk();
        for (i, _) in forest.loops().iter().enumerate().filter(|(_, l)| **l) {
            report.error("NODE_LOOP", &array.index(i), || {
                "the node is its own descendant; take it out of the 'children' of one of them".into()
            });
        }
        forest
    }

    /// Roots and spans, from the roots downwards with a stack of its own.
    fn walk(&mut self) {
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); self.parent.len()];
        for (i, parent) in self.parent.iter().enumerate() {
            if let Some(list) = parent.and_then(|p| children.get_mut(p)) {
                list.push(i);
            }
        }
        let mut clock = 0usize;
        let mut stack: Vec<(usize, usize, bool)> = Vec::new();
        for root in (0..self.parent.len()).filter(|i| self.parent.get(*i) == Some(&None)) {
            stack.push((root, root, false));
            while let Some((node, root, left)) = stack.pop() {
                clock = clock.saturating_add(1);
                let Some(span) = self.span.get_mut(node) else { continue };
                if left {
                    span.1 = clock;
                    continue;
                }
                span.0 = clock;
                if let Some(r) = self.root.get_mut(node) {
                    *r = Some(root);
                }
                stack.push((node, root, true));
                stack.extend(children.get(node).into_iter().flatten().map(|c| (*c, root, false)));
            }
        }
    }

    /// Whether a node is on a loop of parents.
    fn loops(&self) -> Vec<bool> {
        let mut on_loop = vec![false; self.parent.len()];
        // The walk upwards on which a node was met first.
        let mut met = vec![usize::MAX; self.parent.len()];
        let parent = |node: usize| self.parent.get(node).copied().flatten();
        for start in 0..self.parent.len() {
            let mut here = Some(start);
            while let Some(node) = here {
                match met.get_mut(node) {
                    Some(walk) if *walk == usize::MAX => *walk = start,
                    // Met on this very walk: from here once around.
                    Some(walk) if *walk == start => {
                        let mut around = node;
                        while let Some(mark) = on_loop.get_mut(around).filter(|mark| !**mark) {
                            *mark = true;
                            around = parent(around).unwrap_or(around);
                        }
                        break;
                    }
                    _ => break,
                }
                here = parent(node);
            }
        }
        on_loop
    }

    /// The root above a node.
    pub(super) fn root_of(&self, node: usize) -> Option<usize> {
        self.root.get(node).copied().flatten()
    }

    /// Whether `above` is `below` or an ancestor of it.
    pub(super) fn is_above(&self, above: usize, below: usize) -> bool {
        let span = |node: usize| self.root_of(node).and_then(|_| self.span.get(node).copied());
        match (span(above), span(below)) {
            (Some(a), Some(b)) => a.0 <= b.0 && b.1 <= a.1,
            _ => false,
        }
    }
}
