//! What a traversal does with the hits it finds; one type per kind of query, so that each is compiled on its own.

use etendue_core::Ray;
use etendue_geometry::Hit;

use crate::HitFilter;

/// What became of a hit that was offered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// A filter let the ray pass: what lies behind on the same shape may still count.
    Passed,
    /// It was looked at; go on.
    Seen,
    /// The query is answered.
    Done,
}

/// Takes hits in any order.
pub(crate) trait Sink {
    /// Nothing beyond this ray parameter can change the answer. What lies exactly at it can.
    fn limit(&self) -> f32;
    /// A hit inside of the ray's interval whose mask the ray shares.
    fn offer(&mut self, hit: &Hit) -> Answer;
}

/// The closest hit.
pub(crate) struct Closest {
    pub(crate) best: Option<Hit>,
    limit: f32,
}

impl Closest {
    pub(crate) fn new(ray: &Ray) -> Self {
        Self { best: None, limit: ray.t_max }
    }
}

impl Sink for Closest {
    #[inline]
    fn limit(&self) -> f32 {
        self.limit
    }

    #[inline]
    fn offer(&mut self, hit: &Hit) -> Answer {
        if self.best.is_none_or(|best| hit.precedes(&best)) {
            self.best = Some(*hit);
            self.limit = hit.t;
        }
        Answer::Seen
    }
}

/// Any hit.
pub(crate) struct Any {
    pub(crate) found: bool,
    limit: f32,
}

impl Any {
    pub(crate) fn new(ray: &Ray) -> Self {
        Self { found: false, limit: ray.t_max }
    }
}

impl Sink for Any {
    #[inline]
    fn limit(&self) -> f32 {
        self.limit
    }

    #[inline]
    fn offer(&mut self, _hit: &Hit) -> Answer {
        self.found = true;
        Answer::Done
    }
}

/// The same behind a filter.
pub(crate) struct Filtered<'a, S> {
    pub(crate) inner: S,
    filter: &'a dyn HitFilter,
    ray: &'a Ray,
    ray_index: u32,
}

impl<'a, S: Sink> Filtered<'a, S> {
    pub(crate) fn new(inner: S, ray: &'a Ray, ray_index: u32, filter: &'a dyn HitFilter) -> Self {
        Self { inner, filter, ray, ray_index }
    }
}

impl<S: Sink> Sink for Filtered<'_, S> {
    #[inline]
    fn limit(&self) -> f32 {
        self.inner.limit()
    }

    #[inline]
    fn offer(&mut self, hit: &Hit) -> Answer {
        if hit.t > self.inner.limit() {
            return Answer::Seen;
        }
        if self.filter.keep(self.ray_index, self.ray, hit) { self.inner.offer(hit) } else { Answer::Passed }
    }
}

/// A sink of another type, so that the walk through a group is compiled once more instead of being shared: shared, it is
/// not inlined any more, and everything that stands still pays for what moves.
pub(crate) struct Apart<'a, S>(pub(crate) &'a mut S);

impl<S: Sink> Sink for Apart<'_, S> {
    #[inline]
    fn limit(&self) -> f32 {
        self.0.limit()
    }

    #[inline]
    fn offer(&mut self, hit: &Hit) -> Answer {
        self.0.offer(hit)
    }
}
