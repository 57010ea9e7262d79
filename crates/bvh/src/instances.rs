use std::collections::BTreeMap;

use etendue_core::{Aabb, Ray, Transform};

use crate::group::{BuildContext, Group};
use crate::level::{Level, Moving, Placed};
use crate::sink::{Apart, Sink};
use crate::{BuildError, BuildReport, World};

/// The top level: what stands still and what moves, over the groups that both share.
pub(crate) struct Instances {
    groups: Vec<Group>,
    still: Level<Transform>,
    /// Absent where nothing moves.
    moving: Option<Box<Level<Moving>>>,
}

impl Instances {
    pub(crate) fn build(world: &World, cx: &mut BuildContext<'_>) -> Result<Self, BuildError> {
        // Groups are told apart by what is in them, so that instances share wherever they can.
        let mut numbers: BTreeMap<&[u32], u32> = BTreeMap::new();
        let mut lists: Vec<&[u32]> = Vec::new();
        for instance in &world.instances {
            numbers.entry(&instance.geoms).or_insert_with(|| {
                lists.push(&instance.geoms);
                lists.len() as u32 - 1
            });
        }
        let mut groups = Vec::with_capacity(lists.len());
        for built in build_groups(world, &lists, cx) {
            let BuiltGroup { group, report } = built?;
            cx.report.add(&report);
            groups.push(group);
        }
        let (mut still, mut moving) = (Vec::new(), Vec::new());
        for (inst, instance) in world.instances.iter().enumerate() {
            let Some(&group) = numbers.get(&*instance.geoms) else { continue };
            if groups.get(group as usize).is_none_or(Group::is_empty) {
                continue;
            }
            let (inst, mask, to_world) = (inst as u32, instance.mask, instance.to_world);
            match &instance.motion {
                None => still.push(Placed { stand: to_world, group, inst, mask }),
                Some(motion) => {
                    let stand = Moving { start: to_world, motion: motion.clone() };
                    moving.push(Placed { stand, group, inst, mask });
                }
            }
        }
        let still = Level::build(still, &groups, cx)?;
        let moving =
            if moving.is_empty() { None } else { Some(Box::new(Level::build(moving, &groups, cx)?)) };
        Ok(Self { groups, still, moving })
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let moving = self.moving.as_ref().map_or(Aabb::EMPTY, |m| m.bounds(&self.groups));
        self.still.bounds(&self.groups).union(moving)
    }

    /// Offers what the world-space ray hits. True ends the query.
    pub(crate) fn query<S: Sink>(&self, ray: &Ray, masks: &[u32], sink: &mut S) -> bool {
        self.still.query(&self.groups, ray, masks, sink)
            || self.moving.as_ref().is_some_and(|m| m.query(&self.groups, ray, masks, &mut Apart(sink)))
    }
}

struct BuiltGroup {
    group: Group,
    report: BuildReport,
}
/// Each on its own; with the feature `parallel` on the current rayon pool.
fn build_groups(
    world: &World,
    lists: &[&[u32]],
    cx: &BuildContext<'_>,
) -> Vec<Result<BuiltGroup, BuildError>> {
    let (options, cancel) = (cx.options, cx.cancel);
    let build = |geoms: &&[u32]| {
        let mut cx = BuildContext { options, cancel, report: BuildReport::default() };
        let group = Group::build(world, geoms, &mut cx)?;
        Ok(BuiltGroup { group, report: cx.report })
    };
    #[cfg(feature = "parallel")]
    {
        use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
        lists.par_iter().map(build).collect()
    }
    #[cfg(not(feature = "parallel"))]
    lists.iter().map(build).collect()
}
