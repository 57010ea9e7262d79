//! What runs for every ray: boxes, nodes, triangle blocks. Portable code that compilers turn into vector
//! instructions; no trait objects below this line.

mod boxes;
mod tree;
mod triangles;

pub(crate) use boxes::{BoxRay, FAR_PAD};
pub(crate) use tree::{Child, Node, Tree, Visitor, WIDTH};
pub(crate) use triangles::{BLOCK, Block, BlockTriangle, FilterRay};
