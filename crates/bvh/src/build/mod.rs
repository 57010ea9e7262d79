//! From boxes to a tree. Nothing here decides what a ray hits; only how fast.
//!
//! Order of work: group what falls into one cell (`grouping`), cluster the groups (`clusters`, obvhs), split groups
//! further or halve them (`binary`), cut the binary tree into wide nodes and leaves of least cost (`collapse`).

mod binary;
mod clusters;
mod collapse;
mod grouping;

pub(crate) use collapse::{Costs, Leaves, Stored};

use etendue_core::Aabb;

use crate::kernel::Tree;
use crate::{BuildError, BuildOptions};

/// A tree and what building it was like.
pub(crate) struct Built {
    pub(crate) tree: Tree,
    /// Depth of the binary tree.
    pub(crate) depth: u32,
    /// Whether it had to be halved.
    pub(crate) fell_back: bool,
}

/// Says whether the caller wants to stop.
pub(crate) type Cancel<'a> = &'a (dyn Fn() -> bool + Sync);

/// A tree over boxes that are finite and not empty; `None` where there are none. `leaves` is handed the members of
/// each leaf in the order of the tree.
pub(crate) fn build_tree(
    boxes: &[Aabb],
    costs: &Costs,
    options: &BuildOptions,
    leaves: &mut impl Leaves,
    cancel: Cancel<'_>,
) -> Result<Option<Built>, BuildError> {
    if boxes.is_empty() {
        return Ok(None);
    }
    let most = options.max_depth.clamp(33, 64);
    let mut binary = binary::Binary::clustered(boxes, options.quality, cancel)?;
    let mut depth = binary.depth();
    let fell_back = depth > most;
    if fell_back {
        binary = binary::Binary::halved(boxes, cancel)?;
        depth = binary.depth();
    }
    binary.fit(boxes);
    if cancel() {
        return Err(BuildError::Cancelled);
    }
    let tree = collapse::collapse(&binary, costs, leaves);
    Ok(Some(Built { tree, depth, fell_back }))
}
