use etendue_core::Ray;
use etendue_geometry::{Hit, Shape};

use crate::sink::{Answer, Sink};

/// A shape can be crossed more often than this only behind a filter that keeps nothing; then the rest is not seen.
const MOST_CROSSINGS: usize = 64;

/// Offers the hits of one shape, from the nearest on, until one is not let through. True ends the query.
#[inline]
pub(crate) fn offer_shape<S: Sink, T: Shape + ?Sized>(
    shape: &T,
    ray: &Ray,
    inst: u32,
    geom: u32,
    sink: &mut S,
) -> bool {
    let mut ray = *ray;
    for _ in 0..MOST_CROSSINGS {
        let Some(at) = shape.intersect(&ray) else { return false };
        // A shape from outside may not keep its word; a hit out of the interval would loop or lie.
        if !ray.accepts(at.t) {
            return false;
        }
        match sink.offer(&Hit { t: at.t, uv: at.uv, inst, geom, prim: 0 }) {
            Answer::Done => return true,
            Answer::Seen => return false,
            Answer::Passed => ray.t_min = at.t,
        }
    }
    false
}
