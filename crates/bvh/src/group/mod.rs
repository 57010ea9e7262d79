//! Geometries that share one space.

mod query;

pub(crate) use query::GroupQuery;

use std::sync::Arc;

use etendue_core::{Aabb, Vec3A};
use etendue_geometry::{Cylinder, Disc, Geometry, Parallelogram, Plane, Shape, Sphere};

use crate::build::{Cancel, Costs, Leaves, Stored, build_tree};
use crate::kernel::{BLOCK, Block, BlockTriangle, Child, Tree};
use crate::{BuildError, BuildOptions, BuildReport, World};

/// A shape of the closed set.
#[derive(Clone, Copy, Debug)]
enum Solid {
    Sphere(Sphere),
    Plane(Plane),
    Parallelogram(Parallelogram),
    Disc(Disc),
    Cylinder(Cylinder),
}

#[derive(Clone, Copy, Debug)]
struct SolidItem {
    geom: u32,
    solid: Solid,
}

#[derive(Clone)]
struct OpenItem {
    geom: u32,
    shape: Arc<dyn Shape>,
}

/// A tree with the items of its leaves, in the tree's order.
struct Part<T> {
    tree: Option<Tree>,
    items: Vec<T>,
}

impl<T> Part<T> {
    const fn empty() -> Self {
        Self { tree: None, items: Vec::new() }
    }

    fn bounds(&self) -> Aabb {
        self.tree.as_ref().map_or(Aabb::EMPTY, |t| t.bounds)
    }

    fn bytes(&self) -> usize {
        self.tree.as_ref().map_or(0, |t| size_of_val(t.nodes.as_slice())) + size_of_val(self.items.as_slice())
    }
}

/// Geometries that share one space, with a hierarchy for each kind that is present.
pub(crate) struct Group {
    triangles: Part<Block>,
    solids: Part<SolidItem>,
    open: Part<OpenItem>,
    /// What no box holds; tested by every ray.
    unbounded_solids: Vec<SolidItem>,
    unbounded_open: Vec<OpenItem>,
}

struct Collected<T> {
    boxes: Vec<Aabb>,
    items: Vec<T>,
}

impl<T: Clone> Collected<T> {
    const fn new() -> Self {
        Self { boxes: Vec::new(), items: Vec::new() }
    }

    /// The tree over what was collected.
    fn part<U>(
        &self,
        costs: &Costs,
        into: &mut impl FnMut(&mut Vec<U>, &[u32], &[T]),
        cx: &mut BuildContext<'_>,
    ) -> Result<Part<U>, BuildError> {
        struct Store<'a, T, U, F> {
            items: Vec<U>,
            source: &'a [T],
            into: &'a mut F,
        }
        impl<T, U, F: FnMut(&mut Vec<U>, &[u32], &[T])> Leaves for Store<'_, T, U, F> {
            fn store(&mut self, primitives: &[u32]) -> Stored {
                let first = self.items.len();
                (self.into)(&mut self.items, primitives, self.source);
                Stored { first: first as u32, count: (self.items.len() - first) as u32 }
            }
        }
        let limit = Child::MOST_FIRST;
        if self.items.len() > limit {
            return Err(BuildError::TooMany { what: "primitives", count: self.items.len(), limit });
        }
        let mut store = Store { items: Vec::new(), source: &self.items, into };
        let built = build_tree(&self.boxes, costs, cx.options, &mut store, cx.cancel)?;
        let items = store.items;
        let tree = built.map(|b| {
            cx.report.primitives += self.items.len();
            cx.report.nodes += b.tree.nodes.len();
            cx.report.depth = cx.report.depth.max(b.depth);
            cx.report.fallbacks += usize::from(b.fell_back);
            b.tree
        });
        let part = Part { tree, items };
        cx.report.bytes += part.bytes();
        Ok(part)
    }
}

/// What a build carries along.
pub(crate) struct BuildContext<'a> {
    pub(crate) options: &'a BuildOptions,
    pub(crate) cancel: Cancel<'a>,
    pub(crate) report: BuildReport,
}

impl Group {
    pub(crate) fn build(world: &World, geoms: &[u32], cx: &mut BuildContext<'_>) -> Result<Self, BuildError> {
        let mut triangles = Collected::new();
        let mut solids = Collected::new();
        let mut open = Collected::new();
        let mut group = Self {
            triangles: Part::empty(),
            solids: Part::empty(),
            open: Part::empty(),
            unbounded_solids: Vec::new(),
            unbounded_open: Vec::new(),
        };
        for &geom in geoms {
            let Some(geometry) = world.geometries.get(geom as usize) else { continue };
            let bounds = geometry.bounds();
            let solid = match geometry {
                Geometry::Mesh(mesh) => {
                    let report = mesh.report();
                    cx.report.dropped_degenerate += report.degenerate;
                    cx.report.dropped_non_finite += report.non_finite;
                    cx.report.dropped_duplicates += report.duplicate;
                    let clean = report.degenerate + report.non_finite + report.duplicate == 0;
                    for prim in 0..mesh.triangle_count() as u32 {
                        if !clean && mesh.is_degenerate(prim) {
                            continue;
                        }
                        let corners = mesh.triangle(prim);
                        triangles.boxes.push(Aabb::of_points(corners));
                        triangles.items.push(BlockTriangle { corners, geom, prim });
                    }
                    continue;
                }
                Geometry::Open(shape) => {
                    let item = OpenItem { geom, shape: shape.clone() };
                    if bounds.is_empty() {
                        cx.report.dropped_non_finite += 1;
                    } else if manageable(&bounds) {
                        open.boxes.push(bounds);
                        open.items.push(item);
                    } else {
                        group.unbounded_open.push(item);
                    }
                    continue;
                }
                Geometry::Sphere(s) => Solid::Sphere(*s),
                Geometry::Plane(s) => Solid::Plane(*s),
                Geometry::Parallelogram(s) => Solid::Parallelogram(*s),
                Geometry::Disc(s) => Solid::Disc(*s),
                Geometry::Cylinder(s) => Solid::Cylinder(*s),
            };
            let item = SolidItem { geom, solid };
            if manageable(&bounds) {
                solids.boxes.push(bounds);
                solids.items.push(item);
            } else {
                group.unbounded_solids.push(item);
            }
        }

        let blocks = Costs { item: 0.6, per_item: BLOCK, most: 2 * BLOCK };
        let single = Costs { item: 2.0, per_item: 1, most: 4 };
        group.triangles =
            triangles.part(
                &blocks,
                &mut |items, primitives, source| {
                    items.extend(primitives.chunks(BLOCK).map(|chunk| {
                        Block::new(chunk.iter().filter_map(|&i| source.get(i as usize).copied()))
                    }));
                },
                cx,
            )?;
        group.solids = solids.part(&single, &mut copied, cx)?;
        group.open = open.part(&single, &mut copied, cx)?;
        Ok(group)
    }

    /// A box around everything bounded.
    pub(crate) fn bounds(&self) -> Aabb {
        self.triangles.bounds().union(self.solids.bounds()).union(self.open.bounds())
    }

    /// Whether some of it is in no box.
    pub(crate) fn is_unbounded(&self) -> bool {
        !(self.unbounded_solids.is_empty() && self.unbounded_open.is_empty())
    }

    /// Whether nothing is in it.
    pub(crate) fn is_empty(&self) -> bool {
        self.bounds().is_empty() && !self.is_unbounded()
    }
}

/// Finite, and small enough that areas and distances of boxes stay in range.
fn manageable(b: &Aabb) -> bool {
    const LIMIT: f32 = 1_152_921_504_606_846_976.0; // 2^60
    b.is_finite()
        && b.lo.abs().cmple(Vec3A::splat(LIMIT)).all()
        && b.hi.abs().cmple(Vec3A::splat(LIMIT)).all()
}

fn copied<T: Clone>(items: &mut Vec<T>, primitives: &[u32], source: &[T]) {
    items.extend(primitives.iter().filter_map(|&i| source.get(i as usize).cloned()));
}
